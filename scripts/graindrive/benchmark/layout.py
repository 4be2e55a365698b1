"""The layout of the benchmark's scenes, in the plane and in space: a dict of arrays and numbers, and functions that read it.

Arrays of shape (n,): r, kind (0 free, 1 wall, 2 driven disk); numbers: law, constants, friction, density, dt.
Disks have x, y, vx, vy, spin, and numbers gravity (against y), period (in x, 0 for none), drive (vx, vy, spin of the
driven disk or of the drum). Spheres have x, y, z, vx, vy, vz, wx, wy, wz, and gravity (3,), period (2,) in x and y.
Velocities are on the step.
"""

import numpy as np

FREE, WALL, DRIVEN = 0, 1, 2
MOTION = ("vx", "vy", "vz", "wx", "wy", "wz", "spin")
ARRAYS = ("x", "y", "z", "r", "kind", *MOTION)


def in_space(a_scene):
    """Return True for a scene of spheres, False for disks."""
    return "z" in a_scene


def vectors(a_scene, x, y, z):
    """Return three arrays of the scene side by side, shape (n, 3); zeros for one that it does not have."""
    nothing = np.zeros(len(a_scene["r"]))
    return np.stack([a_scene.get(key, nothing) for key in (x, y, z)], axis=1)


def places(a_scene):
    """Return the centres, shape (n, 3)."""
    return vectors(a_scene, "x", "y", "z")


def velocities(a_scene):
    """Return the velocities, shape (n, 3)."""
    return vectors(a_scene, "vx", "vy", "vz")


def spins(a_scene):
    """Return the angular velocities, shape (n, 3)."""
    return vectors(a_scene, "wx", "wy", "wz" if in_space(a_scene) else "spin")


def with_motion(a_scene, place, velocity, spin):
    """Return the scene with other centres, velocities and spins, in GrainLoop's shapes: (n, 2), (n, 2), (n,) or all (n, 3)."""
    names = (
        (("x", "y", "z"), ("vx", "vy", "vz"), ("wx", "wy", "wz"))
        if in_space(a_scene)
        else ("xy", ("vx", "vy"), ["spin"])
    )
    moved = {}
    for keys, table in zip(names, (place, velocity, spin)):
        moved.update(zip(keys, np.array(table).reshape(len(a_scene["r"]), -1).T))
    return dict(a_scene, **moved)


def at_standstill(a_scene):
    """Return the scene with nothing in motion."""
    return dict(a_scene, **{key: np.zeros(len(a_scene["r"])) for key in MOTION if key in a_scene})


def periods(a_scene):
    """Return the periods (x, y, z) of the scene, 0 along axes that are not periodic."""
    given = np.atleast_1d(a_scene["period"]).astype(float).tolist()
    return tuple(given + [0.0] * (3 - len(given)))


def gravity(a_scene):
    """Return the acceleration, three numbers."""
    return tuple(map(float, a_scene["gravity"])) if in_space(a_scene) else (0.0, -float(a_scene["gravity"]), 0.0)


def masses(a_scene):
    """Return mass and moment of inertia of each disk (in the plane) or sphere."""
    r = np.asarray(a_scene["r"], float)
    mass = float(a_scene["density"]) * np.pi * (4 / 3 * r**3 if in_space(a_scene) else r ** 2)
    return mass, mass * r**2 * (0.4 if in_space(a_scene) else 0.5)


def kinetic_energy(a_scene):
    """Return the kinetic energy of what is free, with the scene's own velocities."""
    mass, inertia = masses(a_scene)
    energy = mass / 2 * (velocities(a_scene) ** 2).sum(axis=1) + inertia / 2 * (spins(a_scene) ** 2).sum(axis=1)
    return float(energy[a_scene["kind"] == FREE].sum())


def beside_each_other(a_scene, copies):
    """Return the scene and its copies side by side along x, the period as many times as long, so that the seams fit."""
    first = periods(a_scene)[0]
    arrays = {key: np.tile(a_scene[key], copies) for key in ARRAYS if key in a_scene}
    arrays["x"] = np.concatenate([np.asarray(a_scene["x"]) % first + k * first for k in range(copies)])
    period = np.array(a_scene["period"], float)
    period[(0,) * period.ndim] *= copies
    return dict(a_scene, **arrays, period=period)
