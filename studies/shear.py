"""Shear: a cell of disks under homogeneous shear measures the stress of a granular flow: mu(I) and phi(I).

Homogeneous shear in two dimensions without gravity and without walls: v_x = shear_rate y in a cell whose periodic images slide
past each other (Lees, Edwards 1972). Oba, Otsuki 2025 (appendix B) found in this way the constants of
mu(I) = mu_s + (mu_2 - mu_s)/(I_0/I + 1), I = shear_rate d sqrt(rho/p), for their drum. Disks and law are the drum's:
diameters uniform in d to 1.2 d, linear spring and dashpot with k_n = 2e5 m g/d, k_t = 2/7 k_n, friction 0.5, restitution
0.92, where m is the mass of a disk of diameter d. Units are d, rho, g although there is no gravity, so that numbers can be
compared with the drum's.

There are two kinds of runs. In the first the cell's height adapts to a pressure, dL/dt = (p - P) L/g_p with
p = (s_xx + s_yy)/2 and g_p = sqrt(m k_n) (after da Cruz et al., PRE 72, 021309 (2005)), and one run has one I. In the second the
area fraction is constant, as in the drum paper, and shear_rate is given; p and I are then results.

The law holds up to I = 0.2; at larger I grains collide in pairs, and mu stops growing. At the drum paper's area fraction the
disks are jammed: they flow only because they are soft, and their mu is lower (studies/RESULTS.md).

The pressure is our choice: grains behave as stiff ones if k_n/P is large. At 25 rho g d, the pressure in a drum 38 d deep, k_n/P
is 6,280; runs at a quarter and four times the pressure, at equal I, show the effect of this choice (studies/RESULTS.md).

The study measures tau, p, their parts by contacts and motion, mu = tau/p, phi, I, the difference of the normal stresses and the
contacts per grain, each with the error of a correlated series, and the deviation of the velocity profile from a straight line.

Cost on one core: the number of steps is proportional to strain/I. With 400 disks a step takes some 50 us at small I, and 100 us
and more at I > 0.1, where the periodic images slide fast and neighbour lists are rebuilt every few steps; the demo at I = 0.1
takes seconds, I = 1e-3 some minutes.

    scripts/run shear                                          the demo, I = 0.1
    scripts/run shear inertial_number=0.001 out=slow
    yade -n -x studies/shear.py area_fraction=0.825 shear_rate=0.5
    scripts/campaign studies/campaigns/shear.yaml              mu(I), phi(I) and the fit
"""

import os
import sys
from typing import ClassVar, Optional

if __name__ == "__main__":  # `yade` runs scripts by exec: __file__ is YADE's own
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))

import house  # noqa: E402, F401

import numpy as np  # noqa: E402

from graindrive.commands import headless  # noqa: E402
from graindrive.runs import progress, recording  # noqa: E402
from graindrive.beds import shear_cell  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.parameters import Lever, StudyParameters, When, quantity  # noqa: E402
from graindrive.lazily import Lazily  # noqa: E402
from graindrive.postproc import quantities  # noqa: E402
from graindrive.postproc.shear.flow import UNITS, steady_flow  # noqa: E402
from graindrive.study import Constant, Cost, Study, observables  # noqa: E402
from graindrive.scenes.yade_march import YadeMarch  # noqa: E402

# Parameters -----------------------------------------------------------------------------------------------------------

TIME_STEP = 1e-4  # sqrt(d/g), the drum paper's: 50 steps a contact
STRAIN_OF_ROW = 0.02  # between two rows of the series
MEASURE_EVERY = 5  # steps; the height adapts as often
FEWEST_GRAINS = 60  # with fewer the cell is too short for the search
FEWEST_ROWS = 4  # least number of rows for the averages
MOST_STRAIN_OF_ROW = 0.05  # largest strain of a row; a row has at least MEASURE_EVERY steps
HELD_WITHIN = 0.1  # relative tolerance of the mean pressure, or 3 of its errors if they are larger
# Particle-steps per second of one busy core with 400 disks by I: at large I neighbour lists are rebuilt every few steps.
RATES = ((0.001, 0.01, 0.1, 0.5), (9e6, 7e6, 3.5e6, 1.4e6))


class ShearParameters(StudyParameters):
    """The parameters of the shear study; lengths in d, densities in rho, times in sqrt(d/g)."""

    unit_system: ClassVar[str] = quantities.GRAIN

    inertial_number: float = quantity(
        0.1, "-", "I = shear_rate d sqrt(rho/pressure)", gt=0, le=10, only=When("shear_rate", (None,))
    )
    shear_rate: Optional[float] = quantity(None, "sqrt(g/d)", "dv_x/dy; auto: from inertial_number and pressure", gt=0)
    pressure: float = quantity(
        25.0,
        "rho g d",
        "P, the pressure that the height adapts to",
        gt=0,
        only=When("area_fraction", (0.0,)) | When("shear_rate", (None,)),
    )
    area_fraction: float = quantity(
        0.0, "-", "keep this area fraction constant; 0: keep the pressure constant", ge=0, le=0.9
    )
    settle_strain: float = quantity(2.0, "-", "least strain before the averages begin", ge=0)
    strain: float = quantity(8.0, "-", "strain of the whole run", gt=0, lever=Lever(20, "lower"))
    grains: int = quantity(600, "-", "number of disks", ge=FEWEST_GRAINS, le=1_000_000, lever=Lever(4000, "lower"))
    friction: float = quantity(0.5, "-", "friction coefficient", ge=0)
    restitution: float = quantity(0.92, "-", "coefficient of restitution", gt=0, le=1)
    stiffness: float = quantity(2e5, "m g/d", "k_n of the spring; k_t is 2/7 of it", gt=0, lever=Lever(2e5, "lower"))
    largest_overlap: float = quantity(
        0.1, "R", "largest allowed overlap of two grains; a larger one stops the run", gt=0, le=1, watches=True
    )

    @property
    def rate(self):
        """The shear rate [sqrt(g/d)]."""
        return self.inertial_number * np.sqrt(self.pressure) if self.shear_rate is None else self.shear_rate

    def auto_values(self):
        """Return {key: value} for shear_rate=auto."""
        return {"shear_rate": float(self.rate)}


PRESETS = {
    "smoke": dict(grains=100, settle_strain=3, strain=6, dt_factor=2),
    "demo": dict(grains=800, strain=12, dt_factor=4),
    "paper": dict(grains=4000, strain=20),
}


def time_step(p):
    """Return the time step [sqrt(d/g)]."""
    return TIME_STEP * p.dt_factor


def block_of(p):
    """Return the steps between two rows, a multiple of those between two measures."""
    return MEASURE_EVERY * max(1, round(STRAIN_OF_ROW / (p.rate * time_step(p) * MEASURE_EVERY)))


def steps_of(p):
    """Return the steps of a run, whole blocks."""
    return block_of(p) * max(1, round(p.strain / (p.rate * time_step(p) * block_of(p))))


# Scene ----------------------------------------------------------------------------------------------------------------


def cell(p):
    """Return the recipe for the sheared cell."""
    return shear_cell.ShearCell(
        grains=p.grains,
        stiffness=p.stiffness,
        friction=p.friction,
        restitution=p.restitution,
        shear_rate=float(p.rate),
        pressure=0.0 if p.area_fraction else p.pressure,
        area_fraction=p.area_fraction,
        every=MEASURE_EVERY,
        seed=p.seed,
    )


def check(p):
    """Refuse values that allow no run; return the ratio of the time step to the critical one."""
    if p.shear_rate is not None and not p.area_fraction:
        raise UsageError(
            f"shear_rate={p.shear_rate:g} needs a constant area_fraction; at constant pressure give inertial_number instead"
        )
    progress.require_feasible(p.strain / (p.rate * time_step(p)), "raise dt_factor or the shear, or lower strain")
    ratio = cell(p).check(time_step(p), p.largest_overlap)
    check_rows(p)
    check_closing(p)
    return ratio


def check_rows(p):
    """Raise UsageError if the rows of the series are too long, or too few for averages."""
    row = p.rate * time_step(p) * block_of(p)
    if row > MOST_STRAIN_OF_ROW * (1 + 1e-9):
        raise UsageError(
            f"at shear_rate={p.rate:.3g} the shortest row of the series, {MEASURE_EVERY} steps, has a strain of {row:.3g}, more"
            f" than {MOST_STRAIN_OF_ROW:g}; lower dt_factor or the shear"
        )
    if p.settle_strain > p.strain - FEWEST_ROWS * row * (1 - 1e-9):
        raise UsageError(
            f"settle_strain={p.settle_strain:g} leaves too little of strain={p.strain:g} to average, which takes at least"
            f" {FEWEST_ROWS} rows of {row:.3g}; raise strain or lower settle_strain"
        )


def check_closing(p):
    """Raise UsageError if the cell reaches its area fraction only after its averages begin."""
    if not p.area_fraction:
        return
    first = cell(p).area_fraction_at_first
    strain = p.rate * abs(np.log(p.area_fraction / first)) / shear_cell.CLOSING_RATE
    if strain > p.settle_strain:
        raise UsageError(
            f"the cell needs a strain of {strain:.3g} from its first area fraction, {first:.3g}, to"
            f" area_fraction={p.area_fraction:g}, but averages begin after settle_strain={p.settle_strain:g}; raise settle_strain"
            " and strain, or lower shear_rate"
        )


# Run ------------------------------------------------------------------------------------------------------------------


def run(p, folder):
    """Make the cell, shear it and record stresses; or continue an interrupted run."""
    ratio, march = check(p), YadeMarch()
    if folder.resumed:
        recording.load_stage(folder, march)
    else:
        cell(p).build(time_step(p), p.loop, precision=p.precision, largest_overlap=p.largest_overlap)
    march.grains = p.grains
    also = f" k_n/P = {p.stiffness * shear_cell.MASS / p.pressure:.3g}," if not p.area_fraction else ""
    recording.announce(folder, grains=p.grains, dt=time_step(p), ratio=ratio, unit="sqrt(d/g)", also=also)
    record(p, folder, march)


def record(p, folder, march):
    """Run in blocks of 0.02 of strain; record block means of the stresses and checkpoints, then means over the steady flow."""
    folder.declare_series(**UNITS)
    track, block = recording.Track(folder), block_of(p)

    def sample(done):
        if done == 0:
            return
        row = dict(t=march.time, strain=done * time_step(p) * p.rate, **shear_cell.means())
        shear_cell.keep_upright()
        folder.append(**{name: row[name] for name in UNITS})
        track.append(row)

    held = "shear_rate, area_fraction" if p.area_fraction else "inertial_number, pressure"
    with recording.overlap_advice(f"lower {held} or dt_factor, or raise stiffness or largest_overlap"):
        recording.run_sampled(folder, march, steps_of(p), block, sample, track=track, label=f"shearing by {p.strain:g}")
    found = steady_flow(track.arrays(), p.settle_strain, float(p.rate))
    folder.write("flow", found.profile)
    folder.summarize(**found.summary)
    if words := complaint(p, found.summary):
        folder.summarize(steady=0)
        print(f"{words}; raise settle_strain and strain", file=sys.stderr)


def complaint(p, found):
    """Return a sentence on why the averages do not describe the steady flow that was asked for; "" if they do."""
    pressure, error = found["mean_pressure"], found["mean_pressure_err"]
    if not p.area_fraction and not abs(pressure - p.pressure) <= max(HELD_WITHIN * p.pressure, 3 * error):
        return f"the cell did not reach its pressure: mean_pressure={pressure:.3g} differs from pressure={p.pressure:g}"
    return "" if found["steady"] else "the test finds tau or phi unsteady up to the end of the run"


# Study ----------------------------------------------------------------------------------------------------------------


def particle_steps(p):
    """Return grains times steps of a run."""
    return p.grains * steps_of(p)


def rate(p):
    """Return the particle-steps per second of one core: `RATES`, interpolated in log I, constant outside their range."""
    return float(np.interp(np.log(p.inertial_number), np.log(RATES[0]), RATES[1]))


STUDY = Study(
    name="shear",
    parameters=ShearParameters,
    presets=PRESETS,
    observables=observables(
        quantities.GRAIN,
        "stress_ratio",
        "stress_ratio shear_stress mean_pressure phi flow_inertial_number normal_stress_difference coordination"
        " kinetic_pressure_share kinetic_shear_share profile_deviation",
        phi="mean area fraction of the cell",
    ),
    cost=Cost(particle_steps, rate),
    check=check,
    run=run,
    keeps_frames=False,
    figure=Lazily("graindrive.postproc.shear.figure", "draw"),
    report=Lazily("graindrive.postproc.shear.campaign", "REPORT"),
    constants={
        "d_largest": Constant(shear_cell.LARGEST, "d", "largest diameter; the smallest is d"),
        "time_step": Constant(TIME_STEP, "sqrt(d/g)", "at dt_factor=1"),
    },
)

if __name__ == "__main__":
    headless.main(STUDY)
