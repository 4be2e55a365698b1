"""Rounding: how far runs in double and single precision drift from a run with 150 digits, and which averages still agree.

Elastic disks without friction with a linear spring (YADE's Law2_ScGeom_FrictPhys_CundallStrack) are computed with six number
types from the same first state, bit for bit: by YADE's builds with 150 decimal digits, 113, 64 and 53 bits, each a separate
program, and by GrainLoop in double and in single precision. The first one is the reference for the others. Units are the disks'
diameter d and mass m, and t_0, with k_n = 512 m/t_0^2; a contact of two disks takes 0.098 t_0, a hundred steps at dt_factor=1.

chaotic: disks that collide in a periodic square, area fraction 0.44. A difference grows as exp(rate t), with the Lyapunov rate of
the scene, with any number type; the number of bits only decides how small the difference is at first, so that each further bit
makes the prediction valid for ln 2/rate longer. Averages over a long window (kinetic energy, pressure by motion and contacts, the
velocities' distribution) are compared at times when the trajectories are no longer correlated.

regular: disks that oscillate, each in a well between two held disks, and do not touch each other. A difference grows with a power
of time: 1/2 if rounding errors add up at random, 1 if they change the frequency. In single precision GrainLoop rounds contacts,
not positions and velocities: this shifts forces, so the difference appears at once and then grows little.

Cost on one core: the run with 150 digits takes most of the time, at some 40,000 particle-steps per second; the demo takes a
minute or two. Ctrl-C ends the programs too; resume=1 continues after the last program that a checkpoint holds.

    scripts/run rounding                                       the chaotic scene
    scripts/run rounding scene=regular
    scripts/campaign studies/campaigns/rounding.yaml           both, with repeats, and the report
"""

import math
import os
import random
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Literal, Optional

if __name__ == "__main__":  # `yade` runs scripts by exec: __file__ is YADE's own
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))

import house  # noqa: E402, F401

import numpy as np  # noqa: E402

from graindrive.commands import headless  # noqa: E402
from graindrive.rounding import number_types  # noqa: E402
from graindrive.runs import recording  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.rounding.number_types import TRUTH, TYPES  # noqa: E402
from graindrive.parameters import StudyParameters, When, quantity  # noqa: E402
from graindrive.lazily import Lazily  # noqa: E402
from graindrive.postproc.rounding import averages, distances  # noqa: E402
from graindrive.study import Constant, Cost, Study, observables  # noqa: E402

# Parameters -----------------------------------------------------------------------------------------------------------

TIME_STEP = 2.0**-10  # [t_0], at dt_factor=1
STIFFNESS = 512.0  # k_n [m/t_0^2], of two disks; YADE's FrictMat has k_n = young d/2 of two alike
EVERY = 0.125  # between two rows [t_0]
SPEED = 1.0  # largest velocity along each axis at the start [d/t_0]
SPACING = 4 / 3  # of the disks at the start [d]
GRAVITY = 16.0  # in the regular scene [d/t_0^2]
CHAOTIC = When("scene", ("chaotic",))
AVERAGED = ("longdouble", "double", "single")  # number types whose runs continue for average_time
COMPARED = [name for name in TYPES if name != TRUTH]
GRAINS = dict(chaotic=36, regular=12)
# Particle-steps per second of one busy core, and the seconds that a program takes to start.
RATES = dict(mpfr150=4e4, float128=2e5, longdouble=7e5, yade_double=2e6, double=3e6, single=3e6)
BEGIN = 3.0


class RoundingParameters(StudyParameters):
    """The parameters of the rounding study; lengths in d, masses in m, times in t_0."""

    scene: Literal["chaotic", "regular"] = quantity("chaotic", "-", "disks that collide, or disks in separate wells")
    grains: Optional[int] = quantity(
        None, "-", "number of disks, a square number if chaotic; auto: 36 if chaotic, 12 if regular", ge=2, le=1024
    )
    time: float = quantity(40.0, "t_0", "time for which trajectories are compared", gt=0, le=1e5)
    average_time: float = quantity(
        300.0,
        "t_0",
        "further time of the runs with 64, 53 and 24 bits, for averages (chaotic scene); 0: no averages",
        only=CHAOTIC,
        ge=0,
        le=1e6,
    )
    relax_time: float = quantity(
        20.0, "t_0", "time at the start that averages leave out", ge=0, only=CHAOTIC & When("average_time")
    )

    def auto_values(self):
        """Return {key: value} for grains=auto."""
        return {"grains": self.grains or GRAINS[self.scene]}

    @property
    def averages(self):
        """True if averages are asked for."""
        return self.scene == "chaotic" and self.average_time > 0


PRESETS = {
    "smoke": dict(scene="regular", grains=2, time=1.0),
    "demo": {},
    "paper": dict(time=80.0, average_time=20_000.0),
}


def time_step(p):
    """Return the time step [t_0]."""
    return TIME_STEP * p.dt_factor


def every(p):
    """Return the steps between two rows."""
    return max(1, round(EVERY / time_step(p)))


def steps_of(p, name=TRUTH):
    """Return the steps of the run with the number type `name`: whole rows, and one step before the first row."""
    long = p.averages and name in AVERAGED
    return every(p) * max(1, round((max(p.time, p.average_time) if long else p.time) / (every(p) * time_step(p)))) + 1


def critical_step(p):
    """Return the largest stable time step of leapfrog with two contacts of stiffness k_n on a disk [t_0]."""
    return 2 / math.sqrt(2 * STIFFNESS)


def check(p):
    """Refuse values that allow no run, and missing programs; return the ratio of the time step to the critical one."""
    for kind in TYPES.values():
        number_types.modules_of(kind.build)
    if p.loop != "grain" or p.precision != "double":
        raise UsageError(
            f"loop={p.loop} precision={p.precision}: the rounding study runs both loops in every precision; leave these keys out"
        )
    grains, ratio = p.taken()["grains"], time_step(p) / critical_step(p)
    if p.scene == "chaotic" and math.isqrt(grains) ** 2 != grains:
        raise UsageError(
            f"the chaotic scene begins with grains on a square lattice: give a square number, got grains={grains}"
        )
    if p.scene == "chaotic" and grains < 9:
        raise UsageError(
            f"grains={grains} must be at least 9 in the chaotic scene, or disks would meet their own images"
        )
    if ratio >= 0.5:
        raise UsageError(
            f"dt_factor={p.dt_factor:g} gives a time step of {ratio:.2g} times the critical one; this ratio must stay below 0.5"
        )
    if p.averages and p.relax_time + 20 * EVERY > p.average_time:
        raise UsageError(
            f"average_time={p.average_time:g} must be longer than relax_time={p.relax_time:g} by 20 rows, 2.5 t_0"
        )
    return ratio


# Scenes ---------------------------------------------------------------------------------------------------------------


def short(number):
    """Return a number rounded to 20 binary digits after the point, which has the same value in all programs."""
    return round(number * 2**20) / 2**20


def scene(p):
    """Return the scene without loop and number of steps, in the form that `number_types.run` takes."""
    dt = time_step(p)
    made = dict(dt=dt, young=2 * STIFFNESS, every=every(p), exact_until=steps_of(p))
    return dict(made, **(colliding(p) if p.scene == "chaotic" else wells(p)))


def colliding(p):
    """Return disks on a square lattice in a periodic square, with velocities uniform in [-1, 1] along each axis.

    Velocities are opposite in pairs, so the momentum is exactly 0; if the number of disks is odd, the last one rests.
    """
    rng, columns = random.Random(p.seed), math.isqrt(p.taken()["grains"])
    places = [(short((k + 0.5) * SPACING), short((j + 0.5) * SPACING)) for k in range(columns) for j in range(columns)]
    given = [[short(rng.uniform(-SPEED, SPEED)) for _axis in "xy"] for _pair in range(len(places) // 2)]
    velocities = [(sign * vx, sign * vy) for vx, vy in given for sign in (1, -1)] + [(0.0, 0.0)]
    moving = [(*place, *velocity, 0) for place, velocity in zip(places, velocities)]
    return dict(side=side(p), gravity=0.0, disks=moving)


def side(p):
    """Return the period of the chaotic scene [d]."""
    return short(SPACING * math.isqrt(p.taken()["grains"]))


def wells(p):
    """Return disks, each of which stays between two held disks and starts a little off its position of rest."""
    rng, disks = random.Random(p.seed), []
    for k in range(p.taken()["grains"]):
        x = 4.0 * (k - p.taken()["grains"] // 2)
        disks += [(x - 0.5625, 0.0, 0.0, 0.0, 1), (x + 0.5625, 0.0, 0.0, 0.0, 1)]
        disks.append((short(x + rng.uniform(-0.008, 0.008)), short(0.8125 + rng.uniform(-0.005, 0.005)), 0.0, 0.0, 0))
    return dict(side=0.0, gravity=GRAVITY, disks=disks)


# Run ------------------------------------------------------------------------------------------------------------------


class Programs:
    """A march whose steps are programs: each program runs the scene with the next number type and writes its rows."""

    unit, size = "programs", 0

    def __init__(self, p, place):
        self.p, self.place, self.done = p, Path(place), 0

    @property
    def time(self):
        return float(self.done)

    def file(self, name):
        """Return the file with the rows of the number type `name`."""
        return self.place / f"{name}.rows"

    def advance(self, steps):
        for name in list(TYPES)[self.done : self.done + steps]:
            number_types.run(name, dict(scene(self.p), steps=steps_of(self.p, name)), self.file(name))
            self.done += 1

    def save(self, folder):
        for name in list(TYPES)[: self.done]:
            shutil.copy(self.file(name), folder)

    def load(self, folder):
        for name in list(TYPES):
            if (folder / self.file(name).name).exists():
                shutil.copy(folder / self.file(name).name, self.place)
                self.done += 1


def run(p, folder):
    """Run all programs, one after the other, and compare their results."""
    recording.announce(folder, grains=p.taken()["grains"], dt=time_step(p), ratio=check(p), unit="t_0")
    folder.declare_series(t="t_0", **{f"distance_{name}": "d" for name in COMPARED})
    with tempfile.TemporaryDirectory(prefix="graindrive-rounding-") as place:
        march = Programs(p, place)
        if folder.resumed:
            recording.load_stage(folder, march)
        label = f"{len(TYPES)} number types"
        recording.run_sampled(folder, march, len(TYPES), 1, lambda done: None, label=label)
        compare(p, folder, {name: number_types.read(march.file(name)) for name in TYPES})
    folder.note(steps=steps_of(p))


def compare(p, folder, rows):
    """Write the distances from the reference and the results derived from them; then write the averages."""
    exact = len(rows[TRUTH].steps)
    t, period = rows[TRUTH].steps * time_step(p), side(p) if p.scene == "chaotic" else 0.0
    apart = {name: distances.distances(rows[name].place[:exact], rows[TRUTH].place, period) for name in COMPARED}
    together = {name: distances.root_mean_square(apart[name]) for name in COMPARED}
    folder.append(t=t, **{f"distance_{name}": together[name] for name in COMPARED})
    for name in COMPARED:
        folder.summarize(**{f"drift_{name}": float(together[name][-1])})
        if p.scene == "regular":
            found = {"drift_order": distances.power_of_time(t, apart[name])}
        else:
            found = {"lyapunov_rate": distances.growth_rate(t, together[name])}
            folder.summarize(**{f"horizon_{name}": distances.horizon(t, together[name])})
        put(folder, {f"{key}_{name}": value for key, value in found.items()})
    if p.averages:
        average(p, folder, rows)


def put(folder, found):
    """Put {name: `Measured`} into the summary, with errors."""
    for name, number in found.items():
        folder.summarize(**{name: number.value, f"{name}_err": number.error})


def average(p, folder, rows):
    """Write the averages of `AVERAGED` over the long window, and the errors of those of double and single."""
    means, shapes = {}, {}
    for name in AVERAGED:
        late = rows[name].steps * time_step(p) > p.relax_time
        velocities = rows[name].velocities[late]
        means[name] = averages.averages(rows[name].places[late], velocities, side=side(p), stiffness=STIFFNESS)
        shapes[name], shapes[f"{name}_err"] = averages.distribution(velocities)
        put(folder, {f"{key}_{name}": value for key, value in means[name].items()})
    middles = (averages.EDGES[1:] + averages.EDGES[:-1]) / 2
    folder.write("velocities", dict(velocity=middles, **shapes))
    numbers = {f"{key}{error}": [] for key in averages.AVERAGED for error in ("", "_err")}
    for name in AVERAGED:
        for key, value in means[name].items():
            numbers[key].append(value.value)
            numbers[f"{key}_err"].append(value.error)
    folder.write("averages", {key: np.array(values) for key, values in numbers.items()})
    for name in ("double", "single"):
        folder.summarize(**{f"averages_apart_{name}": averages.apart(means[name], means["longdouble"])})


# Study ----------------------------------------------------------------------------------------------------------------


def particle_steps(p):
    """Return grains times steps of all programs."""
    return p.taken()["grains"] * sum(steps_of(p, name) for name in TYPES)


def rate(p):
    """Return the particle-steps per second of one core, over all programs."""
    grains = p.taken()["grains"] * (1 if p.scene == "chaotic" else 4)  # each has two contacts at all times
    return particle_steps(p) / sum(BEGIN + grains * steps_of(p, name) / RATES[name] for name in TYPES)


STUDY = Study(
    name="rounding",
    parameters=RoundingParameters,
    presets=PRESETS,
    observables=observables(
        "",
        "drift_double",
        "drift_double drift_single drift_longdouble lyapunov_rate_double lyapunov_rate_single lyapunov_rate_longdouble"
        " drift_order_double drift_order_single kinetic_energy_double kinetic_energy_single pressure_double pressure_single"
        " averages_apart_double averages_apart_single",
    ),
    cost=Cost(particle_steps, rate),
    check=check,
    run=run,
    keeps_frames=False,
    figure=Lazily("graindrive.postproc.rounding.figure", "draw"),
    report=Lazily("graindrive.postproc.rounding.campaign", "REPORT"),
    constants={
        "stiffness": Constant(STIFFNESS, "m/t_0^2", "k_n of two disks"),
        "time_step": Constant(TIME_STEP, "t_0", "at dt_factor=1"),
    },
)

if __name__ == "__main__":
    headless.main(STUDY)
