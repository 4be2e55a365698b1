"""Scenes that the tests of FieldAverager share, and functions that read its fields."""

import numpy as np
from disks import clump, disk, engines, hertz, loop, new_scene
from yade import O

FIELDS = [
    "areaFraction",
    "density",
    "velocity",
    "temperature",
    "contactStress",
    "kineticStress",
    "totalStress",
    "pressure",
]
LENGTH = 9.0  # edge of the periodic box


def averager(label="fields", **options):
    """Return a FieldAverager of 24 x 24 points around the origin, unless `options` say otherwise."""
    options = {"low": (-3, -3, 0), "high": (3, 3, 0), "spacing": 0.25, "width": 0.6, **options}
    return engines.FieldAverager(label=label, **options)


def fields_of(measure):
    """Return {name: array} of all arrays of an averager."""
    return {name: getattr(measure, name) for name in FIELDS}


def crowd(friction=0.4, seed=4, **options):
    """A periodic crowd of overlapping, spinning disks with an averager in it; one disk keeps its motion, a row is frozen.

    body="disk" stands for the one that keeps its motion, body="clump" for a clump of two; other `options` are the averager's.
    """
    new_scene(dt=1e-4, period=(LENGTH, LENGTH, LENGTH))
    rng = np.random.default_rng(seed)
    bodies = {}
    for x, y in np.argwhere(np.ones((9, 9))):
        if y == 4 and x in (7, 8):
            continue
        speed, spin = rng.uniform(-1, 1, 2), rng.uniform(-2, 2)
        moves = dict(frozen=True) if y == 0 else dict(velocity=speed, spin=spin)
        body = disk(x + 0.5, y + 0.5, rng.uniform(0.505, 0.52), **moves)
        if (x, y) == (4, 4):
            O.bodies[body].state.blockedDOFs = "xyzXYZ"
            bodies["disk"] = body
    bodies["clump"], members = clump([(-0.5, 0), (0.5, 0)], at=(8, 4.5), radius=0.51)
    for part in (
        bodies["clump"],
        *members,
    ):  # YADE's integrator would set the members' velocities only after the first contacts
        O.bodies[part].state.vel = (0.3, -0.2, 0)
    if "body" in options:
        options["body"] = bodies[options["body"]]
    loop(hertz(gamma_n=100, gamma_t=100), friction=friction, before_newton=[averager(**options)])
