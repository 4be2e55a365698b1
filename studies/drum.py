"""Drum: a half full drum turns slowly; a layer flows down the surface, and below it the bed turns with the drum.

System of Oba, Otsuki, "Scaling laws for velocity profile of granular flow in rotating drums" (2025): disks of d to 1.2 d in a
drum of D = 150, 300, 450 d with a rough wall, under gravity, at Fr = Omega^2 D/2g from 1e-4 to 1e-2. Linear spring and dashpot,
k_n = 2e5 m g/d, where m is the mass of a disk of diameter d, k_t = 2/7 k_n, the same dashpot in the normal and the tangential
direction, mu = 0.5, e = 0.92. model=continuum solves the same drum as a fluid of rheology mu(I); model=both runs one model after
the other and compares them. Units: grain diameter d, density rho, gravity g; so m = pi/4 rho d^2.

The paper leaves some choices open. Each of them is a parameter or is stated here. A grain has the mass of its own diameter, as
section II.2.2 says. The wall's disks, of diameter d, lie on the circle of diameter D itself: 475 at D = 150 (pi D = 471, so
neighbours overlap by 0.008 d, but they exert no forces on each other), 632 and 946 at D = 300 and 450 (a gap of 0.49 d, which
lets no grain through). At other diameters, there are as many wall disks as fit side by side. The wall counts as infinitely heavy
in its contacts. N is the paper's, 7700, 30600 and 69200, which fill half of the circle at a solid fraction of 0.825 to 0.83; at
other diameters and fillings, N follows from a solid fraction of 0.828. The surface lies where the solid fraction is 0.7; its
angle is that of a straight line fitted to it within D/8 of the axis. u is averaged in squares of 1.2 d on the line through the
axis normal to the surface. h is the distance from the axis to the place where u = 0, because the paper assumes that the surface
passes through the axis; layer_over_diameter is measured from the surface that was found.

The grains are poured with a restitution of 0.5; their surface is then level to within 3 degrees. Averages begin when the drum has
turned by start_turn and the angle of the grains' centre of mass has drifted by less than 0.5 degrees over the last third of it;
they cover a rotation by `turn`. In half a turn each grain passes once through the layer. Errors come from eight blocks in time.

Cost: a whole turn takes 2 pi/Omega, which is 1e7 steps at the paper's time step and Omega = 6.28e-3. At the rates of one core
(85 M particle-steps/s at D = 150, an estimated 70 M at 450) that takes 15 minutes at D = 150, 1.1 h at 300 and 2.7 h at 450, and
a fifth of it with dt_factor=5, which is still a sixth of the critical step. The demo turns the drum of 150 d by half a turn and
takes a minute and a half.

    scripts/run drum                                              the demo
    yade -n -x studies/drum.py drum_diameter=300 froude=3e-3 scale=paper out=drum-300
    scripts/run drum help                                         all keys
"""

import os
import sys
from typing import ClassVar, Literal, Optional

if __name__ == "__main__":  # `yade` runs scripts by exec: __file__ is YADE's own
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))

import house  # noqa: E402, F401

import numpy as np  # noqa: E402

from graindrive.beds import drum, lid  # noqa: E402
from graindrive.continuum import drum_continuum  # noqa: E402
from graindrive.lazily import Lazily, engines  # noqa: E402
from graindrive.runs import fields, picture, progress  # noqa: E402
from graindrive.commands import headless  # noqa: E402
from graindrive.runs import recording  # noqa: E402
from graindrive.scenes import scene  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.scenes.material import SpringDashpotMaterial  # noqa: E402
from graindrive.parameters import Lever, StudyParameters, When, quantity  # noqa: E402
from graindrive.postproc import quantities  # noqa: E402
from graindrive.postproc.drum import blocks  # noqa: E402
from graindrive.postproc.drum.flow import SURFACE_LEVEL, SURFACE_REACH  # noqa: E402
from graindrive.postproc.drum.steady import FEWEST_ROWS, STRETCHES, centre_angle, is_steady  # noqa: E402
from graindrive.postproc.statistics import block_mean  # noqa: E402
from graindrive.study import Constant, Cost, Study, observables  # noqa: E402
from graindrive.scenes.yade_march import YadeMarch  # noqa: E402

# Parameters -----------------------------------------------------------------------------------------------------------

TIME_STEP = 1e-4  # the paper's [sqrt(d/g)]
SMALLEST_DIAMETER, LARGEST_DIAMETER = 1.0, 1.2  # [d], uniform between
GRAIN_MASS = np.pi / 4  # m, of a disk of d [rho d^2]
TANGENTIAL_RATIO = 2 / 7  # k_t/k_n
PAPERS_GRAINS = {150.0: 7700, 300.0: 30600, 450.0: 69200}  # D: N, at half filling
PAPERS_WALL = {150.0: 475, 300.0: 632, 450.0: 946}  # D: N_w
PAPERS_DRUM, PAPERS_OMEGA = 150.0, 6.28e-3  # d, sqrt(g/d), of its Figs. 2 and 8
BED_FRACTION = 0.828  # solid fraction at which the paper's grains fill half of the drum, mean over its three D
WIDEST_GAP = 0.8  # [d] largest gap between disks of the wall; a grain of 1 d must not pass through it
SHALLOWEST = 3  # [d] least depth of the grains' bed; a shallower bed has no flowing layer on a resting part
MOST_ROWS = 50_000  # largest number of rows of the series; a row costs some 0.2 ms
SAME_FILLING = 0.05  # largest relative difference between the fillings of the two models of one run
SMALLEST_DRUM = 20  # d
CENTRIFUGES = 1.0  # Fr at which grains at the wall begin to be centrifuged
POURING_RESTITUTION, POURING_STEP, REST = 0.5, 5e-4, 1e-3  # [-]; [sqrt(d/g)] at k_n = 2e5 m g/d; [m g d]
BLOCKS = 8  # in time, of the averages
MOST_STARTS = 2  # after so many times start_turn averages begin even if the flow still drifts
MOST_BINS = 4e7  # of the fields: 1.6 GB of sums
RATES = ((7700, 69200), (85e6, 70e6))  # grains, particle-steps per second of one core
OVERLAP_KEYS = "lower dt_factor, or raise stiffness or largest_overlap"  # advice when the overlap guard stops a run
GRAINS, CONTINUUM = When("model", ("dem", "both")), When("model", ("continuum", "both"))
SERIES = quantities.units("series", "t turn centre_angle centre_x work torque", quantities.GRAIN)


class DrumParameters(StudyParameters):
    """The parameters of the drum study, in units of d, rho, g."""

    unit_system: ClassVar[str] = quantities.GRAIN
    only: ClassVar[dict] = dict(seed=GRAINS, loop=GRAINS, precision=GRAINS, dt_factor=GRAINS)

    model: Literal["dem", "continuum", "both"] = quantity(
        "dem", "-", "what to simulate: grains, a continuum, or both and their difference"
    )
    drum_diameter: float = quantity(150.0, "d", "D, diameter of the circle on which the wall's disks lie", gt=0)
    angular_velocity: Optional[float] = quantity(
        None,
        "sqrt(g/d)",
        f"Omega, counter-clockwise; auto: from froude if given, else {PAPERS_OMEGA:g} sqrt({PAPERS_DRUM:g} d/D)",
        gt=0,
    )
    froude: Optional[float] = quantity(None, "-", "Fr = Omega^2 D/2g; auto: from angular_velocity", gt=0)
    filling: float = quantity(
        0.5, "-", "share of the drum that the bed fills", gt=0, only=CONTINUUM | When("grains", (None,))
    )
    grains: Optional[int] = quantity(
        None, "-", "number of grains; auto: the paper's, or from filling", ge=1, le=10**7, only=GRAINS
    )
    wall_disks: Optional[int] = quantity(
        None,
        "-",
        "number of the wall's disks; auto: the paper's, or as many as fit side by side",
        ge=1,
        le=10**6,
        only=GRAINS,
    )
    friction: float = quantity(0.5, "-", "friction coefficient", ge=0, only=GRAINS)
    restitution: float = quantity(0.92, "-", "coefficient of restitution", gt=0, le=1, only=GRAINS)
    stiffness: float = quantity(2e5, "m g/d", "k_n; k_t is 2/7 of it", gt=0, lever=Lever(2e5, "lower"), only=GRAINS)
    start_turn: float = quantity(
        180.0, "degrees", "least rotation of the drum before averages begin", gt=0, only=GRAINS
    )
    turn: float = quantity(
        360.0, "degrees", "rotation of the drum during the averages", gt=0, lever=Lever(360, "lower"), only=GRAINS
    )
    field_spacing: Optional[float] = quantity(
        None, "d", "side of the fields' square bins; auto: 0.6, or 1.2 for drums over 200 d", gt=0, le=5, only=GRAINS
    )
    field_samples: int = quantity(
        1000,
        "-",
        "number of moments in the fields' averages",
        ge=8,
        le=10**6,
        lever=Lever(1000, "lower", 4),
        only=GRAINS,
    )
    frames: int = quantity(
        1,
        "-",
        "number of pictures of grains and continuum to keep, at equal intervals, the last at the end",
        ge=1,
        le=9999,
        watches=True,
    )
    largest_overlap: float = quantity(
        0.1,
        "R",
        "largest allowed overlap of two grains; a larger one stops the run",
        gt=0,
        le=1,
        watches=True,
        only=GRAINS,
    )
    cells: int = quantity(75, "-", "cells across the drum", ge=1, le=2000, lever=Lever(300, "lower"), only=CONTINUUM)
    continuum_dt: float = quantity(
        0.02, "sqrt(d/g)", "time step; the paper's is 1e-4", gt=0, lever=Lever(1e-3, "higher"), only=CONTINUUM
    )
    viscosity: Literal["full", "split"] = quantity(
        "full", "-", "viscosity all implicit, or, as in the paper, only a constant part implicit", only=CONTINUUM
    )
    rheology: Literal["mu_i", "regularised"] = quantity(
        "mu_i", "-", "mu(I), or the well-posed variant of Barker, Gray (2017)", only=CONTINUUM
    )
    static_friction: float = quantity(0.246, "-", "mu_s, friction of slow flow", gt=0, only=CONTINUUM)
    dynamic_friction: float = quantity(0.401, "-", "mu_2, friction of fast flow", gt=0, only=CONTINUUM)
    inertial_scale: float = quantity(0.133, "-", "I_0 of mu(I)", gt=0, only=CONTINUUM)
    largest_viscosity: float = quantity(
        8e4,
        "m sqrt(g/d)",
        "eta_max, viscosity of material at rest; the paper's is 8000",
        gt=0,
        lever=Lever(8e5, "lower"),
        only=CONTINUUM,
    )
    tolerance: float = quantity(
        1e-5,
        "-",
        "residual at which the pressure solver stops",
        gt=0,
        lt=1,
        lever=Lever(1e-8, "higher", factor=10),
        only=CONTINUUM,
    )
    pressure_solver: str = quantity("", "-", "name of the pressure solver; empty: the fastest", only=CONTINUUM)

    @property
    def omega(self):
        """Angular velocity of the drum [sqrt(g/d)]."""
        if self.angular_velocity is not None:
            return self.angular_velocity
        if self.froude is not None:
            return float(np.sqrt(2 * self.froude / self.drum_diameter))
        return PAPERS_OMEGA * float(np.sqrt(PAPERS_DRUM / self.drum_diameter))

    @property
    def half(self):
        """Number of grains, not rounded, that fill half of the drum: the paper's own, or by `BED_FRACTION`."""
        mean_square = (SMALLEST_DIAMETER**2 + SMALLEST_DIAMETER * LARGEST_DIAMETER + LARGEST_DIAMETER**2) / 3
        return PAPERS_GRAINS.get(self.drum_diameter, BED_FRACTION * self.drum_diameter**2 / 2 / mean_square)

    @property
    def count(self):
        """Number of grains."""
        return round(2 * self.filling * self.half) if self.grains is None else self.grains

    @property
    def wall_count(self):
        """Number of the wall's disks."""
        touching = round(np.pi * self.drum_diameter)
        return PAPERS_WALL.get(self.drum_diameter, touching) if self.wall_disks is None else self.wall_disks

    @property
    def spacing(self):
        """Edge of the fields' bins [d]."""
        return (0.6 if self.drum_diameter <= 200 else 1.2) if self.field_spacing is None else self.field_spacing

    @property
    def froude_number(self):
        """Omega^2 D/2g [-]."""
        return self.omega**2 * self.drum_diameter / 2 if self.froude is None else self.froude

    def auto_values(self):
        """Return {key: value} for the keys that are auto."""
        return dict(
            angular_velocity=self.omega,
            froude=self.froude_number,
            grains=self.count,
            wall_disks=self.wall_count,
            field_spacing=self.spacing,
        )


PRESETS = {
    "smoke": dict(drum_diameter=40, start_turn=60, turn=90, dt_factor=5),
    "demo": dict(start_turn=90, turn=90, dt_factor=5),
    "paper": {},
}


def time_step(p):
    """Return the time step [sqrt(d/g)]."""
    return TIME_STEP * p.dt_factor


def radians_per_step(p):
    """Return the angle by which the drum turns in a step [rad]."""
    return p.omega * time_step(p)


# Scene ----------------------------------------------------------------------------------------------------------------


def material(p, restitution=None):
    """The paper's grains, section II.2.2, or with another restitution."""
    stiffness = p.stiffness * GRAIN_MASS
    e = p.restitution if restitution is None else restitution
    return SpringDashpotMaterial(stiffness, TANGENTIAL_RATIO * stiffness, e, p.friction, 1.0)


def recipe(p):
    """Return the recipe for the drum and its grains at rest."""
    return drum.DrumRecipe(
        diameter=p.drum_diameter,
        wall_disks=p.wall_count,
        grains=p.count,
        d_min=SMALLEST_DIAMETER,
        d_max=LARGEST_DIAMETER,
        material=material(p, min(p.restitution, POURING_RESTITUTION)),
        dt=POURING_STEP * float(np.sqrt(2e5 / p.stiffness)),
        rest=REST,
        seed=p.seed,
    )


def build(p, grains, dt):
    """Put wall, grains, drive and measures into YADE; return ids of the grains (first, last + 1) and of the wall."""
    from yade import O

    with recording.overlap_advice(OVERLAP_KEYS):
        packed = drum.settled(recipe(p))
    drum.start()
    wall = drum.add_wall(p.drum_diameter, p.wall_count)
    ids = scene.add_disks(packed["x"], packed["y"], packed["r"], grains.density)
    O.dt = dt
    scene.run_as_asked(p, grains, gravity=1.0, between=[field_averager(p, dt), imposed_turn(p, wall)])
    return dict(grains=[int(ids[0]), int(ids[-1]) + 1], wall=int(wall), average_row=-1, steady=0)


# Drive ----------------------------------------------------------------------------------------------------------------


def imposed_turn(p, wall):
    """Return the drive that turns the wall about the drum's axis."""
    return engines.DrumDrive(bodies=[wall], angularVelocity=(0, 0, p.omega), label="drive")


# Measure --------------------------------------------------------------------------------------------------------------


def field_averager(p, dt):
    """Return the averager of fields around the axis, one average per block in time; it is off until the flow is steady."""
    reach = float(np.ceil(p.drum_diameter / 2 / p.spacing)) * p.spacing
    corners = dict(low=(-reach, -reach, 0), high=(reach, reach, 0), spacing=p.spacing, kernel="diskBin", stress=False)
    steps = rows_of_window(p) * block_steps(p)
    timing = dict(
        every=max(1, steps // p.field_samples), phases=BLOCKS, period=(steps + 0.5) * dt
    )  # its end is in the last block
    return engines.FieldAverager(dead=True, label="dem", **timing, **corners)


def block_steps(p):
    """Return the steps between two rows of the series: those of one degree, or fewer if a degree is a large part of a block."""
    degrees = min(1.0, p.start_turn / (STRETCHES * 2 * FEWEST_ROWS), p.turn / (4 * BLOCKS))
    return max(1, int(np.radians(degrees) / radians_per_step(p)))


def rows_of_start(p):
    """Return the least number of rows before the averages begin."""
    return int(np.ceil(np.radians(p.start_turn) / (radians_per_step(p) * block_steps(p)) - 1e-9))


def rows_of_window(p):
    """Return the number of rows that the averages cover."""
    return max(1, round(np.radians(p.turn) / (radians_per_step(p) * block_steps(p))))


def most_rows(p):
    """Return the number of rows of the longest possible run, whose averages begin as late as allowed."""
    return MOST_STARTS * rows_of_start(p) + rows_of_window(p)


# Run ------------------------------------------------------------------------------------------------------------------


def check(p):
    """Refuse values that allow no run; return the ratio of the grains' time step to the critical one, nan without grains."""
    check_speed(p)
    check_diameter(p)
    drum_continuum.check_words(p)
    if p.model != "continuum":
        check_room(p)
    if p.model != "dem":
        drum_continuum.check(p)
    if p.model == "continuum":
        return float("nan")
    dt, grains = time_step(p), material(p)
    ratio = scene.check_time_step(dt, grains, SMALLEST_DIAMETER / 2, p.largest_overlap)
    most, weight = grains.force_between(0.5, p.largest_overlap), lid.weight_of_bed(p.drum_diameter)
    if weight > most:
        raise UsageError(
            f"in a drum of {p.drum_diameter:g} d the lowest grains carry a load of up to {weight:.3g} rho g d, but they can carry"
            f" only {most:.3g} at largest_overlap={p.largest_overlap:g} R; raise stiffness"
        )
    progress.require_feasible(np.radians(MOST_STARTS * p.start_turn + p.turn) / radians_per_step(p))
    if np.radians(min(p.turn / BLOCKS, p.start_turn)) < 4 * radians_per_step(p):
        raise UsageError(
            f"the drum turns by {np.degrees(radians_per_step(p)):.3g} degrees per step: turn={p.turn:g} must last at least four"
            f" steps in each of {BLOCKS} blocks, and start_turn={p.start_turn:g} four steps; raise them or lower dt_factor"
        )
    if (rows := most_rows(p)) > MOST_ROWS:
        raise UsageError(
            f"start_turn={p.start_turn:g} and turn={p.turn:g} degrees differ too much: rows that are short enough for the smaller"
            f" make {rows} rows in all, more than {MOST_ROWS}; raise the smaller or lower the larger"
        )
    return ratio


def check_speed(p):
    """Raise UsageError if angular_velocity and froude are both given, or if the drum is so fast that it centrifuges grains."""
    if p.angular_velocity is not None and p.froude is not None:
        raise UsageError(
            f"angular_velocity={p.angular_velocity:g} and froude={p.froude:g} both say how fast the drum turns; give one"
        )
    if p.froude_number >= CENTRIFUGES:
        raise UsageError(
            f"Omega={p.omega:.3g} sqrt(g/d) is Fr={p.froude_number:.3g} at D={p.drum_diameter:g} d: from Fr={CENTRIFUGES:g} on"
            " the grains are centrifuged; lower angular_velocity or froude"
        )


def check_diameter(p):
    """Raise UsageError for a drum that is too small for grains, and so also too small for a continuum."""
    if p.drum_diameter < SMALLEST_DRUM:
        raise UsageError(
            f"drum_diameter={p.drum_diameter:g} d has no room for a flow of grains of up to {LARGEST_DIAMETER:g} d; it must be at"
            f" least {SMALLEST_DRUM} d"
        )


def check_room(p):
    """Raise UsageError if the wall leaks, if the drum is too full, or if the fields' bins are too large or too many."""
    if p.filling > drum.MOST_FILLING:
        raise UsageError(
            f"filling={p.filling:g} leaves no room for pouring the grains or for their flow; it must be at most"
            f" {drum.MOST_FILLING:g}"
        )
    gap = p.drum_diameter * np.sin(np.pi / max(p.wall_count, 2)) - 1
    if p.wall_count > (most := 2 * round(np.pi * p.drum_diameter)):
        raise UsageError(
            f"wall_disks={p.wall_count} is more than twice the number that fits side by side; give at most {most}"
        )
    if gap > WIDEST_GAP:
        raise UsageError(
            f"wall_disks={p.wall_count} leaves gaps of {gap:.3g} d, through which grains escape; give at least"
            f" {int(np.ceil(np.pi * p.drum_diameter / (1 + WIDEST_GAP)))}"
        )
    if p.spacing > p.drum_diameter * SURFACE_REACH / 1.5 * (1 + 1e-9):
        raise UsageError(
            f"field_spacing={p.spacing:g} d gives fewer than four columns of bins within D/8 of the axis, where the surface is"
            f" fitted; give {p.drum_diameter * SURFACE_REACH / 1.5:.3g} d or less"
        )
    if (bins := (p.drum_diameter / p.spacing) ** 2 * BLOCKS) > MOST_BINS:
        raise UsageError(f"field_spacing={p.spacing:g} d makes {bins:.2g} bins, more than {MOST_BINS:.0e}; raise it")
    drum.check(recipe(p))
    check_bed(p)


def check_bed(p):
    """Raise UsageError if the grains make too shallow a bed, or if the two models of one run have different fillings."""
    filled = p.count / (2 * p.half)
    if (deep := p.drum_diameter * np.interp(filled, *drum.filling_by_level())) < SHALLOWEST:
        raise UsageError(
            f"{p.count} grains make a bed {deep:.2g} d deep in a drum of {p.drum_diameter:g} d, but a flow on a bed needs at"
            f" least {SHALLOWEST} d; raise filling, grains or drum_diameter"
        )
    if p.model == "both" and p.grains is not None and abs(filled - p.filling) > SAME_FILLING * p.filling:
        raise UsageError(
            f"grains={p.count} fills {filled:.3g} of the drum, but the continuum has filling={p.filling:g}: model=both compares"
            f" equal fillings; leave grains at auto or give filling={filled:.3g}"
        )


def run(p, folder):
    """Run the model or models, then find surface, profile and thickness in the fields, and compare the two models."""
    ratio, flows = check(p), {}
    if p.model != "continuum":
        before = drum_continuum.grains_before(folder)
        flows["dem"] = run_grains(p, folder, ratio) if before is None else before
    if p.model != "dem":
        flows["continuum"] = drum_continuum.run(p, folder, frame_times(p))
    flows = {model: blocks.steady_flow(seen, p.drum_diameter, p.omega) for model, seen in flows.items()}
    keep(p, folder, flows)


def keep(p, folder, flows):
    """Store the results of the models' `Steady` flows; if there are two, the continuum's names tell that they are its own."""
    folder.summarize(froude=p.froude_number)
    for model, flow in flows.items():
        beside = "continuum_" if model != next(iter(flows)) else ""
        folder.summarize(**{f"{beside}{name}": value for name, value in flow.summary.items()})
        folder.write(f"depth/{model}", flow.profile)
    if len(flows) > 1:
        value, error = blocks.dem_continuum_difference(flows["dem"], flows["continuum"], p.drum_diameter)
        folder.summarize(dem_continuum_difference=value, dem_continuum_difference_err=error)


def frame_steps(p):
    """Return the grains' steps at which pictures are taken, (frames,): at equal intervals, the last at the end."""
    last = (rows_of_start(p) + rows_of_window(p)) * block_steps(p)
    return np.linspace(last, 0, p.frames, endpoint=False).round()[::-1]


def frame_times(p):
    """Return the times of the grains' pictures [sqrt(d/g)], which the continuum's pictures share; None without grains."""
    return None if p.model == "continuum" else frame_steps(p) * time_step(p)


def run_grains(p, folder, ratio):
    """Pour the grains, turn the drum and average the steady flow, or continue an interrupted run; return `Blocks`."""
    dt, grains, march = time_step(p), material(p), YadeMarch()
    if folder.resumed:
        stage = recording.load_stage(folder, march, ("grains", "wall", "average_row", "steady"))
    else:
        stage = build(p, grains, dt)
    beads = np.column_stack(drum.wall_places(p.drum_diameter, p.wall_count))
    folder.write("intruder", dict(beads=(beads, "d"), bead_radius=(0.5, "d")))
    march.grains = stage["grains"][1] - stage["grains"][0]
    also = f" Fr = {p.froude_number:.3g}, a turn in {2 * np.pi / p.omega:.4g} sqrt(d/g),"
    recording.announce(folder, grains=march.grains, dt=dt, ratio=ratio, unit="sqrt(d/g)", also=also)
    return record(p, folder, march, stage)


def record(p, folder, march, stage):
    """Run in blocks of a degree or less; record series, frames, checkpoints and the steady flow; return `Blocks`."""
    from yade import O

    folder.declare_series(**SERIES)
    drive, around, ids = O.labeledEngine("drive"), O.labeledEngine("dem"), range(*stage["grains"])
    block, track = block_steps(p), recording.Track(folder)
    frames = recording.Frames(folder, frame_steps(p), lambda: picture.taken(ids, [], stage["wall"]))

    def sample(done):
        track.append(row_of(p, march, drive, ids))
        if done == 0:
            return False
        folder.append(**series_row(p, track.columns))
        number = len(track) - 1
        if stage["average_row"] < 0 and number >= rows_of_start(p):
            drifts = not is_steady(*(track.columns[name] for name in ("turn", "centre_angle")), p.start_turn)
            if not drifts or number >= MOST_STARTS * rows_of_start(p):
                stage.update(average_row=number, steady=int(not drifts))
                around.phaseStart, around.dead = march.time, False
        return 0 <= stage["average_row"] <= number - rows_of_window(p)

    with recording.overlap_advice(OVERLAP_KEYS):
        recording.run_sampled(
            folder,
            march,
            int(most_rows(p) * block),
            block,
            sample,
            track=track,
            frames=frames,
            stage=stage,
            label=f"turning by {p.start_turn + p.turn:g} degrees",
        )
    fields.write_fields(folder, "dem", around, fields.GRAIN)
    keep_means(p, folder, track.arrays(), stage)
    fraction, velocity, samples = around.areaFraction, around.velocity, around.samples
    return blocks.blocks_of(around.x, around.y, fraction, velocity, samples, SURFACE_LEVEL["dem"])


def row_of(p, march, drive, ids):
    """Return the present state of the drum: time, turn [degrees], work done on the grains, angle of their centre of mass."""
    grains = scene.rows_of(ids)
    drum.require_inside(p.drum_diameter, grains)
    mass = grains["r"] ** 2
    centre = dict(
        centre_angle=centre_angle(grains["x"], grains["y"], mass),
        centre_x=float(np.average(grains["x"], weights=mass)),
    )
    return dict(t=march.time, turn=float(np.degrees(p.omega * march.time)), work=float(drive.work), **centre)


def series_row(p, columns):
    """Return the last row of the series; its torque of the grains on the drum is the mean since the previous row."""
    row = {name: column[-1] for name, column in columns.items()}
    given, took = (columns[name][-1] - columns[name][-2] for name in ("work", "t"))
    return dict(row, torque=-given / (p.omega * took))


def keep_means(p, folder, columns, stage):
    """Store the means of the series over the averages' window."""
    first, series = stage["average_row"], columns
    torque = -np.diff(series["work"]) / (p.omega * np.diff(series["t"]))
    for name, values in dict(torque=torque[first:], centre_angle=series["centre_angle"][first + 1 :]).items():
        mean = block_mean(values)
        folder.summarize(**{name: mean.value, f"{name}_err": mean.error})
    if not stage["steady"]:
        print(
            f"the flow still drifted after {MOST_STARTS * p.start_turn:g} degrees, when its averages began; raise start_turn",
            file=sys.stderr,
        )
    start = series["turn"][first]
    folder.summarize(steady=stage["steady"], averaged_from=start, averaged_turn=series["turn"][-1] - start)


# Study ----------------------------------------------------------------------------------------------------------------


def particle_steps(p):
    """Return grains times steps of a run whose averages begin as early as allowed."""
    return p.count * np.radians(p.start_turn + p.turn) / radians_per_step(p)


def work(p):
    """Return the sum of particle-steps and cell-steps over the models of a run."""
    grains = particle_steps(p) if p.model != "continuum" else 0.0
    return grains + (drum_continuum.cell_steps(p) if p.model != "dem" else 0.0)


def core_seconds(p):
    """Return the seconds that a run takes on one core, grains and continuum together."""
    grains = particle_steps(p) / np.interp(p.count, *RATES) if p.model != "continuum" else 0.0
    return grains + (drum_continuum.seconds(p) if p.model != "dem" else 0.0)


STUDY = Study(
    name="drum",
    parameters=DrumParameters,
    presets=PRESETS,
    observables=observables(
        quantities.GRAIN,
        "thickness_over_diameter",
        "thickness_over_diameter froude surface_angle_deg packing_fraction layer_over_diameter surface_over_diameter"
        " surface_speed flow_down flow_up flow_balance rigid_deviation torque centre_angle",
        torque="drum: mean torque of the grains on the drum, counter-clockwise",
    ),
    cost=Cost(work, lambda p: work(p) / core_seconds(p), unit="grain- or cell-steps"),
    check=check,
    run=run,
    figure=Lazily("graindrive.postproc.drum.figure", "draw"),
    film=Lazily("graindrive.postproc.drum.animation", "film"),
    report=Lazily("graindrive.postproc.drum.campaign", "REPORT"),
    constants={
        "time_step": Constant(TIME_STEP, "sqrt(d/g)", "at dt_factor=1"),
        "grain_mass": Constant(GRAIN_MASS, "rho d^2", "m, of a disk of d"),
        "smallest_diameter": Constant(SMALLEST_DIAMETER, "d", "of the grains"),
        "largest_diameter": Constant(LARGEST_DIAMETER, "d", "of the grains, which are uniform between both"),
    },
)

if __name__ == "__main__":
    headless.main(STUDY)
