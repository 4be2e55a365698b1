"""The scenes that are timed, each under its name: beds, channels and drums of disks here, beds of spheres in lift.py."""

import numpy as np

from ..beds import channel
from ..scenes.material import HertzHistoryMaterial
from . import layout, lift
from .kept import kept
from .layout import DRIVEN, FREE, WALL

WIGGLE = dict(law="hertzHistory", constants=(2e6, 2.46e6, 2500.0, 2500.0), density=1.0)
MAGNUS = dict(law="hertzHistory", constants=(2e9, 2.45e9, 8e6, 8e6), density=20.0)
DRUM = dict(law="springDashpot", constants=(2e5, 2e5 * 2 / 7, 0.92), density=4 / np.pi)


def scene(name):
    """Return the scene of that name, from the cache or by making it."""
    return kept(name, SCENES[name])


def with_restitution(a_scene):
    """Return a bed under the Hertz law with restitution damping, as stiff as before.

    K_n = 4/3 E_eff, E_eff = E / (2 (1 - nu^2)); nu = 0.3 gives the wiggle study's K_t / K_n = 1.23.
    """
    poisson = 0.3
    young = 1.5 * float(a_scene["constants"][0]) * (1 - poisson**2)
    return dict(a_scene, law="hertzRestitution", constants=(young, poisson, 0.5))


def together(parts, **numbers):
    """Join parts (dicts of x, y, r, kind) into a scene at rest."""
    arrays = {key: np.concatenate([np.asarray(part[key], float) for part in parts]) for key in ("x", "y", "r")}
    kind = np.concatenate([np.full(len(part["x"]), part["kind"]) for part in parts])
    rest = np.zeros(len(kind))
    return dict(arrays, kind=kind, vx=rest, vy=rest.copy(), spin=rest.copy(), **numbers)


def lattice(width, rows, diameters, seed, bottom=1.2):
    """Return free disks on a loose square lattice, jittered: what a bed is poured from."""
    rng = np.random.default_rng(seed)
    spacing = diameters[1] * 1.02
    columns = int(width / spacing)
    k = np.arange(columns * rows)
    x = width * (k % columns + 0.5) / columns + rng.uniform(-0.01, 0.01, len(k))
    return dict(x=x, y=bottom + spacing * (k // columns), r=rng.uniform(*diameters, len(k)) / 2, kind=FREE)


def base(width):
    """Return a row of wall disks of diameter 1 at y = 0."""
    return dict(x=np.arange(width) + 0.5, y=np.zeros(width), r=np.full(width, 0.5), kind=WALL)


def run(a_scene, until, dt=None):
    """Move a scene on with GrainLoop, until `until(loop, steps)` is true every 1000 steps; return it at rest or in motion."""
    from . import ours

    return ours.move_on(a_scene, until, dt)


def at_rest(loop, steps, per_grain=1e-5, at_least=60_000):
    """True when grains of unit mass keep less than `per_grain`, and the highest have had the time to fall."""
    return steps >= at_least and loop.kineticEnergy < per_grain * len(loop.ids)


def bed(width, rows):
    """Return a settled bed of the wiggle study's disks, periodic in x."""
    poured = together(
        [lattice(width, rows, (0.9, 1.1), seed=rows), base(width)],
        **WIGGLE,
        friction=0.1,
        gravity=1.0,
        dt=1e-4,
        period=float(width),
        drive=(0.0, 0.0, 0.0),
    )
    return layout.at_standstill(run(poured, at_rest, dt=3e-4))


def bed10k():
    """Return 9,800 settled disks."""
    return bed(100, 110)


def wiggle63k():
    """Return 63,000 settled disks: three beds side by side, each periodic, so that the seams fit."""
    return layout.beside_each_other(bed(100, 237), 3)


def magnus(fraction):
    """Return a flowing scene of the Magnus study in SI units: its channel, an intruder of 5 d after 10 d of travel."""
    d, radius, speed = 0.02, 0.05, 5.0  # [m], [m], V0 [m/s]; the spin ratio is 1
    width, height = 300 * d, 200 * d
    recipe = channel.ChannelRecipe(
        width=width,
        height=height,
        d=d,
        d_min=0.9 * d,
        d_max=1.1 * d,
        phi=fraction,
        material=HertzHistoryMaterial(2e9, 2.45e9, 4e7, 4e7, 0.0, MAGNUS["density"]),
        beads=((width / 2, 0.0),),
        bead_radius=radius,
        outline=(),
        body_area=np.pi * radius**2,
        closing_speed=1.0,
        rest_speed=5e-3,
        seed=1,
    )
    grains = dict(channel.channel(recipe), kind=FREE)
    row = base(300)
    walls = [
        dict(x=row["x"] * d, y=np.full(300, side * (height - d) / 2), r=row["r"] * d, kind=WALL) for side in (-1, 1)
    ]
    numbers = dict(MAGNUS, friction=0.5, gravity=0.0, dt=2e-6, period=width, drive=(speed, 0.0, speed / radius))
    start = together([grains, *walls, dict(x=[width / 2], y=[0.0], r=[radius], kind=DRIVEN)], **numbers)
    start["vx"][-1], start["spin"][-1] = speed, speed / radius
    return run(start, lambda loop, steps: steps * 2e-6 * speed > 10 * d)


def magnus_dilute():
    """Return 26,000 disks at an area fraction of 0.352."""
    return magnus(0.352)


def magnus_dense():
    """Return 61,700 disks at an area fraction of 0.818; the packing takes some minutes the first time."""
    return magnus(0.818)


def drum150():
    """Return a turning drum of diameter 150, half full of 7,700 disks of 1 to 1.2."""
    angle = 2 * np.pi * np.arange(475) / 475
    wall = dict(x=75.5 * np.cos(angle), y=75.5 * np.sin(angle), r=np.full(475, 0.5), kind=WALL)
    rng = np.random.default_rng(3)
    x, y = (a.ravel() for a in np.meshgrid(np.arange(-74, 74, 1.22), np.arange(-74, 40, 1.22)))
    inside = np.flatnonzero(np.hypot(x, y) < 74)[:7700]
    grains = dict(x=x[inside], y=y[inside], r=rng.uniform(0.5, 0.6, len(inside)), kind=FREE)
    start = together([grains, wall], **DRUM, friction=0.5, gravity=1.0, dt=1e-4, period=0.0, drive=(0.0, 0.0, 6.3e-3))
    return run(start, lambda loop, steps: steps >= 300_000)


OF_DISKS = bed10k, magnus_dilute, magnus_dense, wiggle63k, drum150
OF_SPHERES = lift.lift20k, lift.lift190k, lift.lift_flow
SCENES = {f.__name__: f for f in (*OF_DISKS, *OF_SPHERES)}
