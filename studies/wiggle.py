"""Wiggle: a body shaken sideways in a bed of disks rises or sinks.

System of Tripura, Kumar, Anyam, Reddy, "The rise and sink dependence on the shape of a horizontally wiggling intruder".
A clump of beads along the outline of a shape lies in a settled bed under gravity. Its x is imposed,
x = A sin(2 pi t/T); it does not turn and is free in y. Units: grain diameter d, density rho, gravity g.

The paper leaves some choices open; each of them is a parameter. A is the amplitude of displacement (drive=velocity takes the
text's A sin(2 pi t/T) as velocity); all shapes have the mass of a disk of diameter 7 d and density rho; sizes are outer sizes,
beads included.

Cost: the paper's size is 63,000 disks and 1e7 steps; for a disk with A = 3 this takes some 70 minutes on two cores at T = 4 and
100 at T = 1, estimated from the rates of its first 3 sqrt(d/g), without the making of the bed. The demo is 11,500 disks and 1.2e5
steps, a minute or two. Its bed is shallower than the paper's, and the weight of a lid replaces the missing part (0.84 rho g d for
each d of depth); lid_pressure=auto, the default, follows from depth. The smoke run has no lid, to be quick.

The end of help shows the effect of cheaper settings, measured by `scripts/tune wiggle`; studies/RESULTS.md (`wiggle_scene`) shows
the effect of cheaper scenes, for the disk at A = 3 and 5. In short: depth acts through the pressure, so a shallow scene needs the
lid (without it the disk sinks at T = 2, where it should rise). Under a rigid lid no scene at A = 3 differs from the full one by
two errors. At A = 5 the demo's scene is too small (at T = 2 the disk sinks in the full scene and rises under the lid). The
scatter between seeds is 1.5 times the error estimated from one run's cycles: average over three seeds or more. In the paper V_y
is an average over the whole way to the surface, 105 d; in 100 sqrt(d/g) a body rises by some 10 d, so our V_y holds at depth.

    scripts/run wiggle_triangle                     the demo
    yade -n -x studies/wiggle.py shape=disk period=4 amplitude=3 out=disk-run
    scripts/run wiggle help                         all keys
"""

import os
import sys
from typing import ClassVar, Literal, Optional

if __name__ == "__main__":  # `yade` runs scripts by exec: __file__ is YADE's own
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))

import house  # noqa: E402, F401

import numpy as np  # noqa: E402

from graindrive.runs import driven, fields, progress  # noqa: E402
from graindrive.lazily import Lazily, engines  # noqa: E402
from graindrive.commands import headless  # noqa: E402
from graindrive.bodies import intruder  # noqa: E402
from graindrive.beds import lid, packing  # noqa: E402
from graindrive.runs import recording  # noqa: E402
from graindrive.scenes import scene  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.scenes.material import HertzHistoryMaterial  # noqa: E402
from graindrive.parameters import Lever, When, quantity  # noqa: E402
from graindrive.postproc import quantities  # noqa: E402
from graindrive.postproc.drift import SKIPPED, drift, phase_rates  # noqa: E402
from graindrive.study import Constant, Cost, Study, observables  # noqa: E402
from graindrive.scenes.yade_march import YadeMarch  # noqa: E402

# Parameters -----------------------------------------------------------------------------------------------------------

TIME_STEP = 1e-4  # the paper's [sqrt(d/g)]
SAMPLES_PER_PERIOD = 40
SMALLEST_DIAMETER, LARGEST_DIAMETER = 0.9, 1.1  # [d], uniform between
PHASES = 20  # parts of the cycle
FIELD_REACH = (15, 5)  # d from the body's centre, and at least from its sides
PAPERS_DEPTH = 105  # d, of the body's centre
RATE = 45e6  # particle-steps per second of one core: the demo's 11,458 grains while the triangle is shaken
# Advice when the overlap guard stops the run: while the body moves, and while the bed settles.
OVERLAP_KEYS = "lower dt_factor or amplitude, raise period or largest_overlap"
BED_OVERLAP_KEYS = "lower dt_factor, height or lid_pressure"
SERIES = quantities.units("series", "t x y vx vy fx fy contacts work", quantities.GRAIN)


class WiggleParameters(intruder.BodyParameters):
    """The parameters of the wiggle study, in units of d, rho, g."""

    unit_system: ClassVar[str] = quantities.GRAIN

    shape: str = quantity(
        "triangle", "-", "disk, square, tall, wide, triangle (OS1 to OS5), or a file of vertices: .wkt, .csv"
    )
    amplitude: float = quantity(
        3.0, "d", "A of the displacement; of the velocity [sqrt(g d)] with drive=velocity", ge=0
    )
    period: float = quantity(4.0, "sqrt(d/g)", "T of the oscillation", gt=0)
    drive: Literal["displacement", "velocity"] = quantity("displacement", "-", "quantity that is A sin(2 pi t/T)")
    mu: float = quantity(0.1, "-", "friction coefficient", ge=0)
    width: float = quantity(300.0, "d", "period of the bed in x", gt=0, lever=Lever(300, "lower"))
    height: float = quantity(195.0, "d", "height of the bed", gt=0, lever=Lever(195, "lower"))
    depth: float = quantity(
        105.0, "d", "depth of the body's centre below the surface", gt=0, lever=Lever(PAPERS_DEPTH, "lower")
    )
    time: float = quantity(1000.0, "sqrt(d/g)", "how long it is shaken", gt=0, lever=Lever(1000, "lower"))
    frames: int = quantity(
        10, "-", "number of pictures of the bed, at equal intervals from start to end", ge=1, le=9999, watches=True
    )
    rest: float = quantity(
        1e-4, "m g d", "kinetic energy per grain at which the bed counts as settled", gt=0, lever=Lever(1e-4, "higher")
    )
    largest_overlap: float = quantity(
        0.3, "R", "largest allowed overlap of two grains; a larger one stops the run", gt=0, le=1, watches=True
    )
    orientation_deg: float = quantity(
        0.0, "degrees", "counter-clockwise rotation of the shape about its centroid", ge=-360, le=360
    )
    bead_diameter: float = quantity(0.5, "d", "diameter of the body's beads", gt=0)
    bead_spacing: float = quantity(
        1.0,
        "bead diameters",
        "largest distance between beads along the outline",
        gt=0,
        le=1,
        lever=Lever(0.5, "higher"),
    )
    intruder_mass: float = quantity(
        np.pi * 7**2 / 4, "rho d^2", "mass of the body, by default that of a 7 d disk", gt=0
    )
    fields: bool = quantity(
        False, "-", "also average area fraction, velocity and pressure around the body, by phase", watches=True
    )
    field_samples: int = quantity(
        100,
        "-",
        "number of moments of each period in the fields' averages",
        ge=PHASES,
        le=10**4,
        watches=True,
        lever=Lever(100, "lower"),
        only=When("fields", (True,)),
    )
    lid_pressure: Optional[float] = quantity(
        None,
        "rho d g",
        f"weight over width of a lid; auto: {lid.BED_FRACTION:g} for each d that depth is less than the paper's {PAPERS_DEPTH}",
        ge=0,
    )
    lid: Literal["rigid", "grains"] = quantity(
        "rigid", "-", "a row of glued disks on top, or heavy uppermost grains", only=When("lid_pressure")
    )

    @property
    def lid_load(self):
        """Weight over width of the lid [rho d g]."""
        return lid.weight_of_bed(PAPERS_DEPTH - self.depth) if self.lid_pressure is None else self.lid_pressure

    def auto_values(self):
        """Return {key: value} for lid_pressure=auto."""
        return {"lid_pressure": self.lid_load}


PRESETS = {
    "smoke": dict(
        width=26, height=18, depth=8, lid_pressure=0, time=4, amplitude=1.5, period=2, frames=2, dt_factor=5, rest=0.05
    ),
    "demo": dict(width=120, height=90, depth=50, time=60, period=4, dt_factor=5, rest=1e-3),
    "paper": {},
}


def time_step(p):
    """Return the time step [sqrt(d/g)]."""
    return TIME_STEP * p.dt_factor


# Scene ----------------------------------------------------------------------------------------------------------------


def material(p):
    """The paper's grains, Table of section 2: K_n, K_t in rho d g, gamma in sqrt(g/d^3)."""
    return HertzHistoryMaterial(2e6, 2.46e6, 2500, 2500, p.mu, 1.0)


def body_of(p):
    """Return the body, after checking that the bed has room for its motion."""
    body = intruder.make(
        p.shape,
        orientation_deg=p.orientation_deg,
        bead_diameter=p.bead_diameter,
        bead_spacing=p.bead_spacing,
        mass=p.intruder_mass,
    )
    swing = p.amplitude if p.drive == "displacement" else p.amplitude * p.period / (2 * np.pi)
    roof = lid.room(p.lid, p.lid_load)
    intruder.check_room(body, swing=swing, width=p.width, height=p.height, depth=p.depth, lid=roof)
    return body


def bed_recipe(p, body, at, dt, grains):
    """Return the recipe for the bed around the held body."""
    return packing.BedRecipe(
        width=p.width,
        height=p.height,
        d_min=SMALLEST_DIAMETER,
        d_max=LARGEST_DIAMETER,
        material=grains,
        **body.placed(at),
        outline_area=body.area,
        dt=dt,
        rest=p.rest,
        seed=p.seed,
        lid=p.lid,
        lid_pressure=p.lid_load,
    )


def make_bed(p, body, at, dt, grains):
    """Return the settled bed around the held body, from the cache or newly poured."""
    with recording.overlap_advice(BED_OVERLAP_KEYS):
        return packing.settled_bed(bed_recipe(p, body, at, dt, grains))


def build(p, body, at, bed, dt, grains):
    """Put bed, lid, body, drive and measures into YADE; return counts of base and grains, ids of body and lid."""
    from yade import O

    scene.start(p.width, float(np.max(bed["y"], initial=p.height)) + 2 * p.amplitude + 10)
    base = scene.add_base(p.width, 1.0, grains.density)
    ids = scene.add_disks(bed["x"], bed["y"], bed["r"], bed["density"])
    held = scene.add_intruder(body, *at, blocked="xzXYZ")
    roof = scene.members(lid.add_rigid(p.width, float(bed["lid_y"]), p.lid_load)) if "lid_y" in bed else []
    O.dt = dt
    scene.run_as_asked(p, grains, gravity=1.0, between=[*measures(p, held, dt), imposed_motion(p, held)])
    return dict(base=len(base), grains=len(ids), body=held, lid=roof)


# Drive ----------------------------------------------------------------------------------------------------------------


def imposed_motion(p, held):
    """Return the drive that imposes x of the body."""
    return engines.OscillationDrive(body=held, amplitude=p.amplitude, period=p.period, form=p.drive, label="drive")


def check_period(p, dt):
    """Raise UsageError if a sample of the motion is shorter than a time step or longer than the run."""
    if p.period > SAMPLES_PER_PERIOD * p.time:
        raise UsageError(
            f"period={p.period:g} sqrt(d/g) must be at most {SAMPLES_PER_PERIOD} times time={p.time:g}, or the run shows too"
            " little of the motion; raise time or lower period"
        )
    if p.period < SAMPLES_PER_PERIOD * dt:
        raise UsageError(
            f"period={p.period:g} sqrt(d/g) must be at least {SAMPLES_PER_PERIOD} time steps, {SAMPLES_PER_PERIOD * dt:.3g};"
            " raise it or lower dt_factor"
        )


# Measure --------------------------------------------------------------------------------------------------------------


def measures(p, held, dt):
    """Return the binner of the forces on the body and, if asked for, the averager of fields, off until the averages begin."""
    binner = engines.ContactForceBinner(body=held, label="binner")
    return [binner, field_averager(p, held, dt)] if p.fields else [binner]


def field_averager(p, held, dt):
    """Return the averager of Eqs 3.1-3.5 around the body, by phase."""
    around, beside = FIELD_REACH
    reach = min(max(around, int(np.abs(body_of(p).outline).max()) + beside), 2 * int(p.width / 4))
    corners = dict(low=(-reach, -reach, 0), high=(reach, reach, 0), spacing=0.5)
    phases = dict(phases=PHASES, period=p.period, every=max(1, round(min(p.period, p.time) / p.field_samples / dt)))
    smooth = dict(kernel="gaussian", width=1, cutoff=3)
    return engines.FieldAverager(body=held, dead=True, label="around", **smooth, **corners, **phases)


def motion(state, drive):
    """Return position, velocity and the force on the body as columns of the series."""
    columns = dict(x=state.pos[0], y=state.pos[1], vx=state.vel[0], vy=state.vel[1])
    return dict(**columns, fx=drive.force[0], fy=drive.force[1])


def keep_rates(p, folder, t, y):
    """Store V_y by the paper's rule, from a tenth of the run until the body stops, with its error, and V_y by phase."""
    rise = drift(t, y, p.period, skip=SKIPPED)
    amplitude_unit = "d" if p.drive == "displacement" else "sqrt(g d)"
    folder.summarize(shape=p.shape, amplitude=(p.amplitude, amplitude_unit), period=p.period)
    folder.summarize(rise_rate=rise.rate, rise_rate_err=rise.error, rise_until=rise.end, y_final=y[-1] - y[0])
    folder.summarize(rise_resolved=int(rise.resolved))
    if not rise.resolved:
        print("the run is too short for the error of rise_rate, which is likely too small; raise time", file=sys.stderr)
    phases, rates, errors = phase_rates(t, y, p.period, rise.start, rise.end, PHASES)
    folder.write("phase", dict(phase=phases, vy=rates, vy_err=errors))


# Run ------------------------------------------------------------------------------------------------------------------


def check(p):
    """Refuse values that allow no run; return the body and the ratio of the time step to the critical one."""
    body, dt, grains = body_of(p), time_step(p), material(p)
    lightest = (
        min(p.intruder_mass, p.lid_load or np.inf) if p.lid == "rigid" else p.intruder_mass
    )  # the lid's, on each d
    ratio = scene.check_time_step(dt, grains, SMALLEST_DIAMETER / 2, p.largest_overlap, lightest=lightest)
    check_period(p, dt)
    progress.require_feasible(p.time / dt)
    bed = bed_recipe(p, body, centre(p), dt, grains)
    packing.count_grains(bed)
    packing.check_load(bed, p.largest_overlap, p.intruder_mass / np.ptp(body.outline[:, 0]))
    return body, ratio


def centre(p):
    """Return the initial position of the body, (2,) [d]."""
    return np.array([p.width / 2, p.height - p.depth])


def run(p, folder):
    """Make the bed, shake the body and record its path; or continue an interrupted run."""
    (body, ratio), dt, grains, march = check(p), time_step(p), material(p), YadeMarch()
    print(lid.pressures_in_words(p.depth, PAPERS_DEPTH, p.lid_load, p.lid_pressure is None), file=sys.stderr)
    if folder.resumed:
        stage = recording.load_stage(folder, march, ("base", "grains", "body", "lid"))
    else:
        at = centre(p)
        stage = build(p, body, at, make_bed(p, body, at, dt, grains), dt, grains)
    folder.write("intruder", body.as_arrays("d"))
    folder.summarize(fall_height=body.fall_height, intruder_height=body.height)
    folder.summarize(lid_pressure=p.lid_load, pressure_at_body=lid.weight_of_bed(p.depth) + p.lid_load)
    march.grains = stage["grains"]
    recording.announce(folder, grains=march.grains, dt=dt, ratio=ratio, unit="sqrt(d/g)")
    record(p, folder, march, stage)


def record(p, folder, march, stage):
    """Run in blocks of a fortieth of a period; record series, frames and checkpoints, then rise rates and fields."""
    from yade import O

    folder.declare_series(**SERIES)
    state, drive, binner = O.bodies[stage["body"]].state, O.labeledEngine("drive"), O.labeledEngine("binner")
    steps, block = max(1, round(p.time / O.dt)), max(1, round(p.period / SAMPLES_PER_PERIOD / O.dt))

    def sample(done, track):
        t = march.time
        if not state.pos[1] > 0:
            raise RuntimeError(f"step {done}: the body fell through the base, to y = {state.pos[1]:.3g} d")
        track.append(dict(t=t, y=state.pos[1]))
        folder.append(t=t, contacts=binner.lastContactNumber, work=drive.work, **motion(state, drive))

    rows = driven.record(
        p,
        folder,
        march,
        steps,
        block,
        sample,
        stage=stage,
        ids=range(stage["base"], stage["base"] + stage["grains"]),
        due=np.linspace(0, steps, p.frames).round(),
        shown=[*range(stage["base"]), *stage["lid"]],
        settled=lambda t: t >= SKIPPED * p.time,
        advice=OVERLAP_KEYS,
        label="shaking",
        units=fields.GRAIN,
    )
    keep_rates(p, folder, **rows)


# Study ----------------------------------------------------------------------------------------------------------------


def particle_steps(p):
    """Return grains times steps of a run, with the number of grains estimated from the area fraction of a settled bed."""
    return lid.BED_FRACTION / (np.pi / 4) * p.width * p.height * p.time / time_step(p)


STUDY = Study(
    name="wiggle",
    parameters=WiggleParameters,
    presets=PRESETS,
    observables=observables(
        quantities.GRAIN, "rise_rate", "rise_rate rise_until y_final lid_pressure pressure_at_body"
    ),
    cost=Cost(particle_steps, RATE),
    check=check,
    run=run,
    figure=Lazily("graindrive.postproc.wiggle.figure", "draw"),
    film=Lazily("graindrive.postproc.wiggle.animation", "film"),
    report=Lazily("graindrive.postproc.wiggle.campaign", "REPORT"),
    constants={
        "time_step": Constant(TIME_STEP, "sqrt(d/g)", "at dt_factor=1"),
        "papers_depth": Constant(PAPERS_DEPTH, "d", "of the body's centre in the paper"),
        "bed_fraction": Constant(lid.BED_FRACTION, "-", "area fraction of a settled bed, which a lid replaces"),
    },
)

if __name__ == "__main__":
    headless.main(STUDY)
