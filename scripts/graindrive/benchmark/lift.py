"""Beds of spheres as in the lift study (Guillard, Forterre, Pouliquen, Phys. Fluids 26, 043301 (2014)), at rest or flowing.

Grains of Table I on a base of one layer of held spheres, x and y periodic. Diameters are uniform in 0.95 to 1.05 d, so that
beds do not order as equal spheres would. Beds begin without tangential springs, in GrainLoop as in its peers.
"""

import numpy as np

from . import layout
from .kept import kept
from .layout import FREE, WALL

D = 1.5e-3  # diameter [m]
GRAVITY = 9.81
LIFT = dict(law="hertzRestitution", constants=(5e6, 0.45, 0.6), friction=0.5, density=2500.0, dt=1e-5)
PACKED = 0.6  # fraction of the volume that spheres take in a settled bed, about
SLOPE = np.radians(24)


def base(length, width):
    """Return one layer of held spheres of diameter d on a square lattice, d apart, centres at z = 0; lengths in d."""
    i, j = (index.ravel() for index in np.mgrid[0:length, 0:width])
    n = length * width
    return dict(x=(i + 0.5) * D, y=(j + 0.5) * D, z=np.zeros(n), r=np.full(n, D / 2), kind=np.full(n, WALL))


def lattice(length, width, grains, seed):
    """Return free spheres on a jittered cubic lattice above the base, as dense as the largest of them allow; lengths in d."""
    rng = np.random.default_rng(seed)
    spacing = 1.07  # the largest are 1.05 d; jitter moves two of them together by up to 0.02 d
    columns, rows = int(length / spacing), int(width / spacing)
    k = np.arange(grains)
    layer, cell = k // (columns * rows), k % (columns * rows)
    jitter = rng.uniform(-0.01, 0.01, (3, grains)) * D
    return dict(
        x=(cell % columns + 0.5) * length / columns * D + jitter[0],
        y=(cell // columns + 0.5) * width / rows * D + jitter[1],
        z=(layer + 1.1) * spacing * D + jitter[2],
        r=rng.uniform(0.95, 1.05, grains) * D / 2,
        kind=np.full(grains, FREE),
    )


def poured(length, width, grains, seed=1):
    """Return the lattice above the base, at rest: what a bed is made of."""
    parts = lattice(length, width, grains, seed), base(length, width)
    arrays = {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
    rest = {key: np.zeros(len(arrays["r"])) for key in ("vx", "vy", "vz", "wx", "wy", "wz")}
    weight = np.array([0, 0, -GRAVITY])
    return dict(arrays, **rest, **LIFT, gravity=weight, period=np.array([length, width]) * D)


def settled(start, per_grain=1e-5):
    """Return the bed after it has settled: kinetic energy per grain below `per_grain` m g d in 1000 steps from rest.

    Grains bounce little. After they have fallen, all motion is stopped every 1000 steps, because a bed oscillates up and down
    for long, with a period of some thousand steps, and contacts damp this motion little.
    """
    from . import ours

    young, poisson, _ = start["constants"]
    dull = dict(start, constants=(young, poisson, 0.3))
    mass, _ = layout.masses(start)
    allowed = per_grain * GRAVITY * D * mass[start["kind"] == FREE].sum()
    fall = steps_of_fall(start)

    def rule(loop, steps):
        at_rest = steps > fall and loop.kineticEnergy < allowed
        if steps > fall and not at_rest:
            ours.halt()
        return at_rest

    bed = ours.move_on(dull, rule, largestOverlap=0.3)  # a tall column that lands presses its foot hard
    return layout.at_standstill(dict(bed, constants=start["constants"]))


def steps_of_fall(start):
    """Return the steps that the highest grain takes to fall freely to where the bed will end."""
    length, width, _ = layout.periods(start)
    free = start["kind"] == FREE
    volume = 4 / 3 * np.pi * (start["r"][free] ** 3).sum()
    depth = start["z"].max() - volume / (PACKED * length * width)
    return np.sqrt(2 * max(depth, 0) / GRAVITY) / start["dt"]


def lift20k():
    """Return 20,000 settled spheres, 460 of them the base of 46 x 10 d."""
    return settled(poured(46, 10, 19_540))


def lift190k():
    """Return 190,000 settled spheres, 140 x 10 d and 120 d high: seven beds of 20 x 10 d side by side."""
    return layout.beside_each_other(settled(poured(20, 10, 26_943)), 7)


def tilted(bed, slope=SLOPE):
    """Return a bed with gravity tilted towards x [rad], in the motion of a flow of that slope (Bagnold's profile).

    u(z) = 2/3 I sqrt(phi g cos(slope)) (h^(3/2) - (h - z)^(3/2)) / d, h the bed's height, with the inertial number I = 0.1.
    """
    free = bed["kind"] == FREE
    height = bed["z"][free].max()
    deep = np.clip(height - bed["z"], 0, height)
    speed = 2 / 3 * 0.1 * np.sqrt(PACKED * GRAVITY * np.cos(slope)) * (height**1.5 - deep**1.5) / D
    weight = GRAVITY * np.array([np.sin(slope), 0, -np.cos(slope)])
    return dict(bed, gravity=weight, vx=np.where(free, speed, 0.0))


def lift_flow():
    """Return lift20k on a slope of 24 degrees, flowing; 0.2 s after it was set in motion the shear has renewed its contacts."""
    from . import ours

    return ours.move_on(tilted(kept("lift20k", lift20k)), lambda loop, steps: steps >= 20_000)
