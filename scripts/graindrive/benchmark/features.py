"""The price of what a scene asks GrainLoop for: a base scene without it and with it, by turns, on one core.

Base: 10,000 held-together disks of diameter 1 on a triangular lattice that is pressed to 0.99, periodic in x and y, six
contacts each, linear spring and dashpot, no friction, no gravity. A feature hardly moves them, so that contacts stay as they
are and the ratio is the feature's own. What a feature costs and what it does when it is set to nothing stands in one table,
`FEATURES`; the tests hold each of them to its promise on a small crowd (`crowd`).
"""

from dataclasses import dataclass, field
from typing import Callable, Optional

import numpy as np

from .layout import DRIVEN, FREE

NAME = "lattice"
BITS = 0.0  # no difference is allowed, not even in the last bit
ROUND_OFF = 1e-10  # largest effect of the order of sums in the tests' crowd, which collides for some contact times [d]
SPRING = dict(law="springDashpot", constants=(2e5, 2e5 * 2 / 7, 0.92), density=4 / np.pi)
HERTZ = dict(law="hertzHistory", constants=(2e6, 2.46e6, 2500.0, 2500.0))
NEARLY_NOTHING = 1e-290  # too small to change any number of a scene, and not 0, which would compile friction out


@dataclass(frozen=True)
class Feature:
    """A feature that a scene may use.

    `scene` changes the base scene, `against` the scene without the feature where that is not the base, `settings` go to
    `ours.serve`. `nothing` = (change of the scene, settings) sets the feature to nothing, and the result then differs by
    at most `differs` [d] from the scene without it, `BITS` for equal bits; `words` say so. None: it cannot be nothing.
    """

    name: str
    scene: Callable = dict
    settings: dict = field(default_factory=dict)
    against: Callable = dict
    nothing: Optional[tuple] = None
    differs: float = BITS
    words: str = ""


def changed(**changes):
    """Return the function that gives a scene other numbers."""
    return lambda a_scene: dict(a_scene, **changes)


def in_space(a_scene):
    """Return the disks of a scene as spheres of the same mass in one layer, with no force out of the layer."""
    zeros = np.zeros(len(a_scene["r"]))
    rest = {key: zeros.copy() for key in ("z", "vz", "wx", "wy", "wz")}
    kept = {key: value for key, value in a_scene.items() if key != "spin"}
    density = a_scene["density"] * 3 / (4 * float(a_scene["r"].mean()))  # the same mass where all radii are alike
    weight = np.array([0.0, -float(a_scene["gravity"]), 0.0])
    return dict(kept, **rest, density=density, gravity=weight)


def walled(a_scene):
    """Return a scene without its periodic sides."""
    return dict(a_scene, period=np.zeros(2))


def far_periods(a_scene):
    """Return a scene whose periods are twenty times its extent."""
    return dict(a_scene, period=20 * extent(a_scene))


def extent(a_scene):
    """Return the extent of a scene along x and y (2,), including the grains' size."""
    return np.array([a_scene[axis].max() - a_scene[axis].min() + 2 for axis in "xy"])


def walls_of(a_scene, away=0.0):
    """Return the positions of four walls, half a diameter beyond the outer centres plus `away`."""
    off = 0.495 + away
    names = [(f"{axis}_{end}", a_scene[axis], sign) for axis in "xy" for end, sign in (("low", -1), ("high", 1))]
    return {name: float((x.min() if sign < 0 else x.max()) + sign * off) for name, x, sign in names}


FAR = 50.0  # distance of walls that no grain touches [d]

FEATURES = (
    Feature("Hertz in place of a linear spring", changed(**HERTZ), words="another law; not nothing"),
    Feature(
        "friction, rotation, history",
        changed(friction=0.5),
        nothing=(changed(friction=NEARLY_NOTHING), {}),
        words="friction=0 compiles it out; as small as 1e-290: same bits",
    ),
    Feature("gravity", changed(gravity=1.0), nothing=(changed(gravity=0.0), {}), words="(0, 0, 0): same bits"),
    Feature(
        "four flat walls in place of periodic sides",
        walled,
        dict(walls="near"),
        nothing=(walled, dict(walls="far")),
        words="walls that nothing meets: same bits as an open scene",
    ),
    Feature(
        "periodic sides",
        against=walled,
        nothing=(far_periods, {}),
        differs=ROUND_OFF,
        words="far periods: other lists, so another order of sums; round-off",
    ),
    Feature(
        "Cundall's damping",
        settings=dict(damping=0.1),
        nothing=(dict, dict(damping=0.0)),
        words="damping=0: same bits",
    ),
    Feature(
        "energy ledger",
        settings=dict(trackEnergy=True),
        nothing=(dict, dict(trackEnergy=True)),
        words="on, it only watches: same bits",
    ),
    Feature(
        "forces binned by angle, every step",
        settings=dict(binned=True),
        nothing=(dict, dict(binned=True)),
        words="it only watches: same bits",
    ),
    Feature(
        "fields, every 100 steps",
        settings=dict(averaged=100),
        nothing=(dict, dict(averaged=5)),
        words="they only watch: same bits",
    ),
    Feature(
        "bodies written at every step",
        settings=dict(syncEvery=1),
        nothing=(dict, dict(syncEvery=1)),
        words="writing changes nothing: same bits",
    ),
    Feature(
        "third dimension",
        in_space,
        nothing=(in_space, {}),
        differs=ROUND_OFF,
        words="a layer in the plane: other kernels, another order of sums; round-off",
    ),
    Feature(
        "single precision",
        settings=dict(precision="single"),
        words="rounds contacts to 24 bits; studies/rounding.py",
    ),
)


def lattice(columns=100, rows=100):
    """Return the base scene; the disk in the middle is held, for the measures that look at one body."""
    spacing = 0.99
    k = np.arange(columns * rows)
    column, row = k % columns, k // columns
    x = spacing * (column + 0.5 * (row % 2) + 0.25)
    y = spacing * np.sqrt(3) / 2 * (row + 0.5)
    return scene_of(x, y, period=spacing * np.array([columns, rows * np.sqrt(3) / 2]))


def crowd(columns=8, rows=8, seed=1):
    """Return a small crowd that flies together and apart again, in the open, away from 0, where a period would cut it."""
    rng = np.random.default_rng(seed)
    k = np.arange(columns * rows)
    x, y = (10 + 1.05 * where + rng.uniform(0, 0.04, len(k)) for where in (k % columns, k // columns))
    made = scene_of(x, y, period=np.zeros(2))
    to_centre = np.array([x.mean() - x, y.mean() - y])
    free = made["kind"] == FREE
    made["vx"], made["vy"] = 2 * to_centre * free + rng.uniform(-1, 1, (2, len(k))) * free
    return made


def scene_of(x, y, period):
    """Return disks of diameter 1 at rest in the laid-out form of `layout`."""
    rest = np.zeros(len(x))
    kind = np.full(len(x), FREE)
    kind[int(np.argmin(np.hypot(x - x.mean(), y - y.mean())))] = DRIVEN
    numbers = dict(SPRING, friction=0.0, gravity=0.0, dt=1e-4, period=period, drive=np.zeros(3))
    motion = dict(vx=rest, vy=rest.copy(), spin=rest.copy())
    return dict(x=x, y=y, r=np.full(len(x), 0.5), kind=kind, **motion, **numbers)


def measure(worker, save, rounds, steps, features=FEATURES):
    """Yield one dict a feature: its name, median, lowest and highest ratio of the time per particle-step, and `words`.

    `worker(path, **settings)` starts a process that runs a saved scene (`Ours`), `save(scene, name)` returns the path. Both
    sides run by turns, each round gives one ratio of processor times.
    """
    base, without = lattice(), {}
    try:
        for number, feature in enumerate(features):
            if feature.against not in without:  # one process for all features that are compared with the same scene
                without[feature.against] = worker(save(feature.against(base), f"without_{number}.npz"), onStep=False)
                without[feature.against].warm_up()
            one = worker(save(feature.scene(base), f"with_{number}.npz"), onStep=False, **feature.settings)
            try:
                one.warm_up()
                pairs = [(one.run(steps), without[feature.against].run(steps)) for _ in range(rounds)]
            finally:
                one.close()
            yield row(feature, len(base["x"]) * steps, pairs)
    finally:
        for other in without.values():
            other.close()


def row(feature, particle_steps, pairs):
    """Return the line of a feature from the answers of both sides, round by round."""
    ratios = [one["cpu"] / other["cpu"] for one, other in pairs]
    times = [1e9 * np.median([answer["cpu"] for answer in side]) / particle_steps for side in zip(*pairs)]
    return dict(
        feature=feature.name,
        ratio=float(np.median(ratios)),
        lowest=float(min(ratios)),
        highest=float(max(ratios)),
        with_it_ns=float(times[0]),
        without_it_ns=float(times[1]),
        kernel=pairs[0][0]["processor"],
        contacts=[answer["contacts"] for answer in pairs[-1]],
        when_nothing=feature.words,
    )


HEADING = (
    "feature                                     ratio  lowest highest  ns/particle-step  when it is set to nothing"
)


def line(found):
    """Return a row as text."""
    return (
        f"{found['feature']:43} {found['ratio']:6.2f} {found['lowest']:7.2f} {found['highest']:7.2f}"
        f" {found['without_it_ns']:7.1f} {found['with_it_ns']:8.1f}  {found['when_nothing']}"
    )
