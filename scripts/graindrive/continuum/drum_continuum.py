"""The continuum in a drum, model=continuum of the drum study: the flow, its steady state, and the fields that it leaves.

The scene of Oba, Otsuki, "Scaling laws for velocity profile of granular flow in rotating drums" (2025), section II.3, in d,
rho, g. It differs from the paper in three points. Within the wall's transition the phases are those beside it (in the paper this
layer turns with the wall, which carries grains through the gas and gas under the bed). eta_max is ten times the paper's, with
which the bed would differ by 5 % from rigid rotation; results still depend on it (drum_levers.yaml). Averages begin when the
centre of mass is at rest, after at least START_TURN.

`run` stores the group `fields/continuum` under the names of `fields.write_fields`: x (nx,), y (ny,) [d], the drum's axis at 0;
samples (blocks,); area_fraction (blocks, ny, nx), the solid fraction, that of the bed times alpha; velocity (blocks, ny, nx, 2)
[sqrt(g d)]; pressure (blocks, ny, nx) [rho g d]; ill_posed (blocks, ny, nx), the share of the time in which the equations
were ill-posed.

It also keeps `frames` pictures of the flow, the groups `flow_frames/NNNN`: x, y as above, area_fraction (ny, nx),
velocity (ny, nx, 2), pressure (ny, nx), in single precision. Their frame of reference is that of the grains' pictures: at
rest, the drum's axis at the origin. With model=both they are taken at the times of the grains' pictures, as far as the
continuum's run goes, and one at its end.
"""

import sys

import h5py
import numpy as np

from ..runs import checkpoint, progress, recording
from ..beds import drum
from ..solids import surfaces
from .continuum import FieldMeans, FlowMarch, centres
from ..lazily import engines
from ..base.errors import UsageError, one_line
from ..postproc.drum import blocks
from ..postproc.drum.flow import BED_FRACTION, SURFACE_LEVEL
from ..postproc.measured import Measured
from ..postproc.drum.steady import FEWEST_ROWS, STRETCHES, centre_angle, is_steady
from ..postproc.statistics import block_mean

GRAIN_MASS = np.pi / 4  # m [rho d^2]: the paper's viscosities and pressures are in m, g, d
GAS_DENSITY, GAS_VISCOSITY = 1e-3, 1e-6  # of those of the bed, the viscosity of the largest
LEAST_PRESSURE = 1e-5  # m g/d
SHELL = 16  # cells around the drum
TRANSITION = 2  # half width of the wall's transition, in cells
START_TURN, MOST_TURN, WINDOW = 45.0, 180.0, 30.0  # degrees: before averages at least, at most, and their length
BLOCKS = 8
FEWEST_CELLS = 20
MOST_FILLING, LEAST_DEPTH = 0.9, 6  # of the drum; of the bed, in cells
MOST_CROSSED = (
    0.5  # cells that may be crossed in a step, those of the grid's corners that turn with the wall among them
)
STIFFEST = 1e8  # largest eta dt/(rho cell^2): from ten times this value on round-off is visible in the velocities
# Cell-steps per second of one core at continuum_dt=0.02, by cells across: on finer grids the viscosity's solver works more.
RATES = ((75, 150, 300), (3e6, 2.2e6, 1.3e6))
PART = "continuum"  # of a run with both models, in its checkpoints
NOTES = ("dt", "dt_over_critical", "n_grains", "steps", "particle_steps_per_second")


def check_words(p):
    """Raise UsageError for an unknown pressure solver, also in runs without a continuum."""
    if p.pressure_solver and p.pressure_solver not in (known := engines.pressure_solvers()):
        raise UsageError(
            f"pressure_solver={one_line(p.pressure_solver)} is not known; leave it empty or take one of {', '.join(known)}"
        )


def check(p):
    """Raise UsageError for parameters that allow no continuum."""
    if p.model == "continuum" and (texts := [name for name in p.exports if name != "vtk"]):
        raise UsageError(
            f"export={','.join(texts)} needs grains, and model=continuum has none; give export=vtk, which writes fields"
        )
    if p.cells < FEWEST_CELLS:
        raise UsageError(
            f"cells={p.cells} across the drum do not resolve its flow; give {FEWEST_CELLS} or more (the paper has 75)"
        )
    if p.filling > MOST_FILLING:
        raise UsageError(
            f"filling={p.filling:g} gives the continuum no free surface; it must be at most {MOST_FILLING:g}"
        )
    deep = (level_of(p) / p.drum_diameter + 0.5) * p.cells
    if deep < LEAST_DEPTH:
        raise UsageError(
            f"filling={p.filling:g} makes a bed {deep:.2g} cells deep, of which the wall's transition takes {TRANSITION}; it must"
            f" be at least {LEAST_DEPTH} cells deep; raise filling or cells"
        )
    if (crossed := p.omega * p.continuum_dt * (p.cells / 2 + SHELL)) >= MOST_CROSSED:
        raise UsageError(
            f"continuum_dt={p.continuum_dt:g} lets the wall cross {crossed:.2g} cells in a step, and this must be less than"
            f" {MOST_CROSSED:g}; at this speed take less than {p.continuum_dt * MOST_CROSSED / crossed:.3g}"
        )
    stiff = p.largest_viscosity * GRAIN_MASS / BED_FRACTION * p.continuum_dt / (p.drum_diameter / p.cells) ** 2
    if stiff > STIFFEST:
        raise UsageError(
            f"largest_viscosity={p.largest_viscosity:g} makes round-off larger than the flow: eta dt/(rho cell^2) is {stiff:.2g},"
            f" over {STIFFEST:g}; lower it to {p.largest_viscosity * STIFFEST / stiff:.2g} or less, or lower continuum_dt"
        )
    if p.dynamic_friction < p.static_friction:
        raise UsageError(
            f"dynamic_friction={p.dynamic_friction:g} must not be below static_friction={p.static_friction:g}; exchange them"
        )
    steps = np.radians(MOST_TURN + WINDOW) / (p.omega * p.continuum_dt)
    progress.require_feasible(steps, "raise continuum_dt or the drum's speed")
    try:
        flow_of(p)
    except ValueError as error:
        told = str(error)
        if p.viscosity == "split" and "time step" in told:  # the solver's ways out are no keys of the study
            told = told.partition("; ")[0] + "; lower continuum_dt or largest_viscosity, or take viscosity=full"
        raise UsageError(f"these keys give no continuum: {told}") from None
    except RuntimeError as error:  # the pressure of the start is solved for at once
        raise UsageError(f"the initial pressure does not reach tolerance={p.tolerance:g}: {error}") from None


def level_of(p):
    """Return the height [d] below which the open part of the drum is filled at the start."""
    return float(p.drum_diameter * (np.interp(p.filling, *drum.filling_by_level()) - 0.5))


def flow_of(p):
    """Return the `TwoPhaseFlow` of the drum, at rest with a level surface; ValueError where the solver refuses it."""
    spacing = p.drum_diameter / p.cells
    count = p.cells + 2 * SHELL
    low = -count * spacing / 2
    x = centres(low, spacing, count)
    level = level_of(p)
    below = np.clip((level - x[:, None]) / spacing + 0.5, 0, 1)  # the part of a cell that lies below the level
    fraction = np.repeat(below, count, axis=1)
    density, largest = BED_FRACTION, p.largest_viscosity * GRAIN_MASS
    return engines.TwoPhaseFlow(
        fraction,
        ~surfaces.cylinder((0, 0, 0), axis=(0, 0, 1), radius=p.drum_diameter / 2),
        **dict(
            cells_x=count,
            cells_y=count,
            spacing=spacing,
            low_x=low,
            low_y=low,
            transition=TRANSITION,
            wall_spin=p.omega,
        ),
        **dict(rheology=p.rheology, static_friction=p.static_friction, dynamic_friction=p.dynamic_friction),
        **dict(inertial_scale=p.inertial_scale, grain_diameter=1.0, grain_density=1.0, density=density),
        **dict(largest_viscosity=largest, least_pressure=LEAST_PRESSURE * GRAIN_MASS),
        **dict(gas_density=GAS_DENSITY * density, gas_viscosity=GAS_VISCOSITY * largest, gravity_y=-1.0),
        **dict(
            time_step=p.continuum_dt, viscosity=p.viscosity, tolerance=p.tolerance, pressure_solver=p.pressure_solver
        ),
    )


def block_steps(p):
    """Return the steps between two rows: one degree of turn, or less if the start would have too few rows."""
    degrees = min(1.0, START_TURN / (STRETCHES * 2 * FEWEST_ROWS), WINDOW / (4 * BLOCKS))
    return max(1, round(np.radians(degrees) / (p.omega * p.continuum_dt)))


def rows_of(p, degrees):
    """Return how many rows a turn takes."""
    return max(1, round(np.radians(degrees) / (p.omega * p.continuum_dt * block_steps(p))))


def cell_steps(p):
    """Return cells times steps of a run whose averages begin as early as allowed."""
    steps = np.radians(START_TURN + WINDOW) / (p.omega * p.continuum_dt)
    return steps * (p.cells + 2 * SHELL) ** 2


def seconds(p):
    """Return the seconds that `run` takes on one core."""
    return cell_steps(p) / float(np.interp(p.cells, *RATES))


class Record(recording.Track):
    """Rows and means of the steady flow, both kept in checkpoints."""

    def __init__(self, folder, means):
        super().__init__(folder)
        self.means = means
        if folder.resumed:
            means.load(folder.resumed["folder"])

    def save(self, folder):
        super().save(folder)
        self.means.save(folder)


def grains_before(folder):
    """Return the `Blocks` of the grains in a resumed run of both models, or None if that part has not ended."""
    if not (folder.resumed and folder.resumed.get("part") == PART and "grains_summary" in folder.resumed):
        return None
    folder.summary.update(folder.resumed["grains_summary"])
    folder.units.update(folder.resumed["grains_units"])
    folder.note(**folder.resumed["grains_notes"])
    with h5py.File(folder.path / checkpoint.DATA) as file:
        found = {name: data[()] for name, data in file["fields/dem"].items()}
    return blocks.blocks_of(
        *(found[name] for name in ("x", "y", "area_fraction", "velocity", "samples")), SURFACE_LEVEL["dem"]
    )


def run(p, folder, times=None):
    """Solve the flow with the parameters `p` of the drum study in an open RunFolder, or resume it; return its `Blocks`.

    Pictures are taken at `times` [sqrt(d/g)]; without them at equal intervals, the last at the end.
    """
    flow = flow_of(p)
    march, area = FlowMarch(flow, "lower continuum_dt"), flow.area  # that of the start, of a resumed run too
    going_on = folder.resumed and folder.resumed.get("part") == PART
    before = 0 if p.model == "continuum" else int(folder.provenance["steps"])
    stage = dict(part=PART, average_row=-1)
    if p.model == "both":
        stage.update(grains_summary=dict(folder.summary), grains_units=dict(folder.units))
        stage.update(grains_notes={name: folder.provenance[name] for name in NOTES if name in folder.provenance})
    if going_on:
        stage.update(recording.load_stage(folder, march, ("average_row",)))
    announce(p, march)
    return record(p, folder, march, stage, before, going_on, area, times)


def announce(p, march):
    """Print grid and time step of a run on stderr, and warn if its bed would flow like a liquid."""
    print(
        f"{march.size} cells of {p.drum_diameter / p.cells:.3g} d, dt = {p.continuum_dt:.3g} sqrt(d/g),"
        f" a turn in {2 * np.pi / p.omega:.4g} sqrt(d/g)",
        file=sys.stderr,
    )
    if (creep := creep_over_turning(p)) > 1:
        print(
            f"largest_viscosity={p.largest_viscosity:g} lets the bed creep under its weight {creep:.2g} times as fast as the drum"
            " turns, so the bed flows like a liquid; raise largest_viscosity",
            file=sys.stderr,
        )


def creep_over_turning(p):
    """Return the shear rate over Omega [-] at which eta_max gives the stress mu_s p at the bottom of a half full drum."""
    pressure = BED_FRACTION * p.drum_diameter / 2
    return p.static_friction * pressure / (p.largest_viscosity * GRAIN_MASS) / p.omega


def frame_steps(p, times):
    """Return the steps at which pictures are due, (n,) whole numbers."""
    if times is None:
        last = (rows_of(p, START_TURN) + rows_of(p, WINDOW)) * block_steps(p)
        return np.linspace(last, 0, p.frames, endpoint=False).round()[::-1]
    return np.round(np.asarray(times) / p.continuum_dt)


def picture(p, flow):
    """Return the flow's fields at this moment, in single precision: x, y (n,), area_fraction, pressure (ny, nx), velocity."""
    x, y = grid_of(p)
    fraction = solid_fraction(flow.fraction, flow)
    fields = dict(area_fraction=fraction, velocity=flow.velocity, pressure=flow.pressure)
    return dict(x=x, y=y, **{name: np.asarray(values, dtype="f4") for name, values in fields.items()})


def solid_fraction(alpha, flow):
    """Return the solid fraction (…, ny, nx) of volume fractions of the granular phase; the wall's transition counts as wall."""
    return BED_FRACTION * np.clip(alpha, 0, 1) * (flow.openness >= 1)


def record(p, folder, march, stage, before, going_on, area, times):
    """Run until the flow is steady and over the averages, then store rows, pictures and fields; return the `Blocks`."""
    flow = march.flow
    means = FieldMeans(BLOCKS, flow.fraction.shape)
    track = Record(folder if going_on else NotResumed, means)
    window, first_possible, last_possible = (rows_of(p, turn) for turn in (WINDOW, START_TURN, MOST_TURN))

    def sample(_done):
        track.append(row_of(p, march))
        number = len(track) - 1
        columns = track.columns
        if stage["average_row"] < 0 and number >= first_possible:
            if is_steady(columns["turn"], columns["centre_angle"], START_TURN) or number >= last_possible:
                stage["average_row"] = number
        if stage["average_row"] >= 0:
            means.add(min(BLOCKS - 1, (number - stage["average_row"]) * BLOCKS // (window + 1)), flow)
        return 0 <= stage["average_row"] <= number - window

    block = block_steps(p)
    steps = (last_possible + window) * block
    label = f"a continuum turns by {START_TURN + WINDOW:g} degrees or more"
    frames = recording.FieldFrames(folder, frame_steps(p, times), lambda: picture(p, flow))
    about = dict(track=track, frames=frames, stage=stage, label=label, before=before)
    recording.run_sampled(folder, march, steps, block, sample, **about)
    if before:
        folder.note(steps=before)  # those of the grains, whose rate stands beside them
    return keep(p, folder, march, track, means, area, stage)


class NotResumed:
    """Replaces a run folder if a part of a resumed run starts from its beginning."""

    resumed = None


def row_of(p, march):
    """Return the present state: time, turn [degrees], angle of the bed's centre of mass [degrees], its speed."""
    flow = march.flow
    x, y = grid_of(p)
    weight = flow.fraction * (flow.openness >= 1)
    speed = np.sqrt((weight[..., None] * flow.velocity**2).sum() / weight.sum())
    angle = centre_angle(np.broadcast_to(x, weight.shape), np.broadcast_to(y[:, None], weight.shape), weight)
    return dict(t=march.time, turn=float(np.degrees(p.omega * march.time)), centre_angle=angle, speed=float(speed))


def grid_of(p):
    """Return centres of cells (x, y), each (n,) [d]."""
    spacing, count = p.drum_diameter / p.cells, p.cells + 2 * SHELL
    x = centres(-count * spacing / 2, spacing, count)
    return x, x


def torque_of(x, fraction):
    """Return the bed's torque on the drum as `Measured` [rho g d^3], from the solid fractions (blocks, ny, nx) of a steady flow.

    Its weight turns the bed about the axis; in a steady flow the drum holds it. Fractions are those of the cells as a whole:
    in the layer in which fluid becomes wall the bed's times the openness, which together make up the bed of the drum itself.
    """
    of_blocks = -(fraction * x).sum(axis=(1, 2)) * (x[1] - x[0]) ** 2
    error = of_blocks.std(ddof=1) / np.sqrt(len(of_blocks)) if len(of_blocks) > 1 else float("nan")
    return Measured(float(of_blocks.mean()), float(error))


def keep(p, folder, march, track, means, area, stage):
    """Store the rows as `continuum`, the means as `fields/continuum`; return the `Blocks` of the steady flow."""
    x, y = grid_of(p)
    flow, columns = march.flow, track.arrays()
    folder.write("continuum", columns)
    inside = flow.openness >= 1  # the layer in which fluid becomes wall counts as wall
    bed = BED_FRACTION * np.clip(means.mean("fraction"), 0, 1)
    fraction = solid_fraction(means.mean("fraction"), flow)
    ill_posed = means.sums["ill_posed"].sum(axis=0) / means.samples.sum()
    seen = columns["t"][stage["average_row"] :]
    settings = dict(spacing=p.drum_diameter / p.cells, phases=BLOCKS, phaseStart=seen[0], period=seen[-1] - seen[0])
    fields = dict(
        x=x,
        y=y,
        samples=means.samples,
        area_fraction=fraction,
        velocity=means.velocity,
        pressure=means.mean("pressure"),
        ill_posed=means.mean("ill_posed"),
    )
    folder.write("fields/continuum", fields, part_of_the_bed=BED_FRACTION, **settings)
    summarize(p, folder, march, stage, columns, torque_of(x, bed * flow.openness))
    last = np.clip(flow.fraction, 0, 1) * inside
    folder.summarize(
        ill_posed_share=float((ill_posed * last).sum() / last.sum()),
        continuum_area_drift=float(flow.area / area - 1),
    )
    return blocks.blocks_of(x, y, fraction, means.velocity, means.samples, SURFACE_LEVEL["continuum"])


def summarize(p, folder, march, stage, columns, torque):
    """Summarize the rows and the march, and warn on stderr if the flow still drifted."""
    beside = "" if p.model == "continuum" else "continuum_"
    start = stage["average_row"]
    angle = block_mean(columns["centre_angle"][start:])
    for name, mean in dict(torque=torque, centre_angle=angle).items():
        folder.summarize(**{f"{beside}{name}": mean.value, f"{beside}{name}_err": mean.error})
    steady = is_steady(columns["turn"][: start + 1], columns["centre_angle"][: start + 1], START_TURN)
    if not steady:
        print(
            f"the continuum still drifted after {columns['turn'][start]:.3g} degrees, when its averages began",
            file=sys.stderr,
        )
    folder.summarize(
        continuum_steps=march.flow.steps, continuum_core_seconds=march.seconds, continuum_steady=int(steady)
    )
