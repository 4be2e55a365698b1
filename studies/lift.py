"""Lift: a cylinder dragged sideways through a bed of spheres is pushed up by a force that saturates with depth.

System of Guillard, Forterre, Pouliquen, "Lift forces in granular media", Phys. Fluids 26, 043301 (2014). Spheres of d = 1.5 mm
lie in a box that is periodic in x and y, on a base of held spheres. The cylinder, of diameter D, lies along y; its contacts count
as contacts with a plane. SI units; lengths on the command line in d. z is up, and z = 0 at the centres of the base's spheres.

The paper holds the cylinder and moves the base with U_0. Here the base is at rest and the cylinder moves along +x with U_0.
The two are equivalent by Galilean invariance, and a bed at rest is cheaper because it needs fewer neighbour searches;
frame=cylinder does as the paper does (base, lid and bed move along -x from the start). Drag is the force along -x, lift the force
along +z; theta = 0 in front and > 0 below.

The paper has three kinds of runs: lid_density=0 and depth= (normal); lid_density=60 to 210 (lid); the same with bulk_gravity=0
(lid, and no weight in the bulk). The effective depth is h~ = h + (pi d/6) rho*/rho, or only its second term if the bulk has no
weight; rho is the bulk density phi rho_g of the bed at rest, also in the buoyancy rho g pi D^2 L/4, and h is the weight of bed
above the axis over rho g. We chose what the paper leaves open: grains of the lid, on a square lattice d apart, are held in x and
y and do not turn, so that the lid is rough (lid_turns=1 lets them turn); the base is a square lattice as well; all grains have
the diameter d (polydispersity= changes it); U_0 is 0.1 m/s.

First grains are poured up to the cylinder's lowest point, then the cylinder is put in, then the other grains are poured. The lid
is laid on the bed and both come to rest. A lid oscillates for long; therefore all motion is stopped whenever base and cylinder
carry exactly the weight. Averages begin when drag and lift pass a test of steadiness, after at least 2 D of travel, and end
before the cylinder meets its own wake, which comes back through the periodic side.

Cost: the paper's size is 190,000 spheres and 2e5 steps for 40 D, an hour or two on two cores; the demo has 17,000 spheres and 2e4
steps.

    scripts/run lift                                    the demo
    yade -n -x studies/lift.py lid_density=150 bulk_gravity=0 out=no-gradient
    scripts/run lift shape=wedge.csv                    an outline (x forward, y up, in d), swept along y
    scripts/run lift shape=ball.py                      a file that defines distance(points), low and high, in d
    scripts/run lift help                               all keys
"""

import functools
import os
import sys
from typing import ClassVar, Literal, Optional

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # `yade` runs scripts by exec: __file__ is YADE's own

import house  # noqa: E402, F401

import numpy as np  # noqa: E402

from graindrive.bodies import dragged_body, intruder  # noqa: E402
from graindrive.runs import driven, fields, progress  # noqa: E402
from graindrive.lazily import Lazily, engines  # noqa: E402
from graindrive.commands import headless  # noqa: E402
from graindrive.runs import recording  # noqa: E402
from graindrive.scenes import scene, space  # noqa: E402
from graindrive.beds import sphere_bed  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.scenes.material import HertzRestitutionSpheres  # noqa: E402
from graindrive.parameters import Lever, StudyParameters, When, quantity  # noqa: E402
from graindrive.postproc import quantities  # noqa: E402
from graindrive.postproc.lift import forces  # noqa: E402
from graindrive.study import Constant, Cost, Study, observables  # noqa: E402
from graindrive.scenes.yade_march import YadeMarch  # noqa: E402

# Parameters -----------------------------------------------------------------------------------------------------------

D = 1.5e-3  # m, diameter of the grains
DENSITY = 2500.0  # kg/m^3
GRAVITY = 9.81  # m/s^2
YOUNG, POISSON, RESTITUTION = 5e6, 0.45, 0.6  # Pa, -, -: of grains and cylinder alike
TIME_STEP = 1e-5  # s, the paper's
POURING_FACTOR = 2.0  # time step of the pouring over the paper's
SAMPLE_EVERY = 10  # steps between two samples of the forces
BLOCK_TRAVEL = 0.25  # d of travel between two rows of the series
POINTS = 64  # of the stress by angle, with a Gaussian of 8 degrees (A4)
FIELD_REACH = 20  # d around the body, where the box is as large
LEAST_PERIOD = (
    4.1  # diameters of the largest grain that a period must hold: three, and the margin of the neighbour search
)
AWAY = (
    2.0  # least distance: in D between the body and its wake at the end, in d between the body and lid, surface or base
)
USUAL_DRAG = 10.0  # C_d of the paper, to estimate before a run whether base and lid can hold the bed
LEAST_WINDOW = 3.0  # d of travel after the paper's transient
MOST_TRAVEL = 40.0  # D, the paper's
RATE = (
    7e6  # particle-steps per second of one core: 26,000 stirred grains, 1.3e9 particle-steps in 180 s of processor time
)
OVERLAP_KEYS = (
    "lower dt_factor, speed or lid_density, or raise largest_overlap"  # advice when the overlap guard stops a run
)


class LiftParameters(StudyParameters):
    """The parameters of the lift study; lengths in d, all else in SI units."""

    unit_system: ClassVar[str] = quantities.SI

    shape: str = quantity(
        "cylinder", "-", "cylinder, or a file: outline swept along y (.csv, .wkt), distance function (.py)"
    )
    cylinder_diameter: float = quantity(
        3.3, "d", "D of the cylinder", ge=1, le=1000, only=When("shape", ("cylinder",)) | When("travel", (None,))
    )
    depth: float = quantity(52.8, "d", "depth of the axis below the surface of the bed, without the lid", gt=0)
    lid_density: float = quantity(
        100.0, "rho_g", "density of the lid's grains over that of the others; 0: no lid", ge=0
    )
    bulk_gravity: bool = quantity(True, "-", "gravity acts on all grains; 0: only on the lid")
    lid_turns: bool = quantity(False, "-", "grains of the lid may turn", only=When("lid_density"))
    speed: float = quantity(0.1, "m/s", "U_0", gt=0, le=20, lever=Lever(0.1, "higher"))
    frame: Literal["bed", "cylinder"] = quantity("bed", "-", "what rests: base and bed, or the cylinder")
    mu: float = quantity(0.5, "-", "friction coefficient", ge=0)
    polydispersity: float = quantity(
        0.0, "-", "half-width of the uniform distribution of diameters, over d", ge=0, lt=0.9
    )
    width: float = quantity(140.0, "d", "period of the box in x", gt=0, lever=Lever(140, "lower"))
    breadth: float = quantity(10.0, "d", "period of the box in y", gt=0, lever=Lever(10, "lower"))
    height: float = quantity(120.0, "d", "height of the bed", gt=0, lever=Lever(120, "lower"))
    travel: Optional[float] = quantity(
        None,
        "d",
        "distance over which the body is dragged; auto: 40 D, or less, to end 2 D before its wake",
        gt=0,
        lever=Lever(None, "lower"),
    )
    fields: bool = quantity(True, "-", "average velocity, fraction and stress around the body", watches=True)
    field_spacing: float = quantity(
        1.0,
        "d",
        "distance between the fields' grid points; it must divide 1 d",
        gt=0,
        le=1,
        watches=True,
        only=When("fields", (True,)),
    )
    field_samples: int = quantity(
        200,
        "-",
        "number of moments in the fields' averages",
        ge=1,
        le=10**6,
        watches=True,
        lever=Lever(200, "lower"),
        only=When("fields", (True,)),
    )
    frames: int = quantity(
        1, "-", "number of pictures of the bed, at equal intervals, the last at the end", ge=1, le=9999, watches=True
    )
    rest: float = quantity(1e-4, "m g d", "kinetic energy per grain at which the bed counts as at rest", gt=0)
    largest_overlap: float = quantity(
        0.3, "R", "largest allowed overlap of two grains; a larger one stops the run", gt=0, le=1, watches=True
    )
    threads: int = quantity(
        0,
        "-",
        "threads of GrainLoop; 0: the number that is fastest",
        ge=0,
        le=256,
        identity=False,
        only=When("loop", ("grain",)),
    )

    @property
    def way(self):
        """Distance over which the body is dragged [d]."""
        return self.furthest if self.travel is None else self.travel

    @property
    def furthest(self):
        """Distance for travel=auto [d]: the paper's 40 D, or as far as the box allows."""
        size = max(self.cylinder_diameter, height_in(self.shape, intruder.contents_of(self.shape)))
        return min(MOST_TRAVEL * self.cylinder_diameter, max(self.width - AWAY * size, 1.0))

    def auto_values(self):
        """Return {key: value} for travel=auto."""
        return {"travel": self.way}

    def identity(self):
        """Return all values that decide the result: for a shape from a file the file's contents too, not only its name."""
        told = {"outline": intruder.contents_of(self.shape)} if dragged_body.names_a_file(self.shape) else {}
        return {**super().identity(), **told}


@functools.lru_cache(maxsize=None)
def height_in(shape, _contents):
    """Return the height [d] of the body that a file describes; 0 for the cylinder and for a file that describes no body."""
    if not dragged_body.names_a_file(shape):
        return 0.0
    try:
        return dragged_body.of_shape(shape, 0.0, D, D).height / D
    except UsageError:  # `check` reports the error later
        return 0.0


PRESETS = {
    "smoke": dict(
        width=24, breadth=5, height=22, depth=12, speed=0.4, dt_factor=2, lid_density=60, rest=1e-3, fields=False
    ),
    "demo": dict(width=60, breadth=5, height=52, depth=30, lid_density=40, speed=0.2, dt_factor=2, rest=1e-3),
    "paper": {},
}


def time_step(p):
    """Return the time step [s]."""
    return TIME_STEP * p.dt_factor


# Scene ----------------------------------------------------------------------------------------------------------------


def material(p):
    """The paper's grains, Table I."""
    return HertzRestitutionSpheres(YOUNG, POISSON, RESTITUTION, p.mu, DENSITY)


def body_of(p):
    """Return the body that is dragged, a `DraggedBody`."""
    return dragged_body.of_shape(p.shape, p.cylinder_diameter * D, p.breadth * D, D)


def check_room(p, body):
    """Raise UsageError if the body does not fit into the box, or comes too near to lid, surface, base or itself."""
    low, high = body.low / D, body.high / D
    intruder.require_length(p.shape, max(high[0] - low[0], high[2] - low[2]))
    least = LEAST_PERIOD * (1 + p.polydispersity)
    for key in ("width", "breadth"):
        if getattr(p, key) < least:
            raise UsageError(
                f"{key}={getattr(p, key):g} d must be at least {least:.3g} d, or a grain would touch another through two sides of"
                " the periodic box at once; raise it"
            )
    if p.depth < high[2] + AWAY:
        raise UsageError(
            f"depth={p.depth:g} d brings the body, which reaches {high[2]:.3g} d above its axis, within {AWAY:g} d of the"
            f" surface or lid; raise depth to {high[2] + AWAY:.3g} or more"
        )
    if p.height - p.depth + low[2] < AWAY:
        raise UsageError(
            f"height={p.height:g} d and depth={p.depth:g} d bring the body within {AWAY:g} d of the base; raise height"
            f" to {p.depth - low[2] + AWAY:.3g} or more, or lower depth"
        )
    if not body.endless and 2 * (high[1] - low[1]) > p.breadth:
        raise UsageError(
            f"breadth={p.breadth:g} d must be at least twice the body's extent of {high[1] - low[1]:.3g} d along y; raise it"
        )
    free = p.width - (high[0] - low[0]) - AWAY
    if free <= 0:
        raise UsageError(
            f"width={p.width:g} d is too small for a body {high[0] - low[0]:.3g} d long, which needs {p.width - free:.3g} d;"
            " raise it"
        )


def check_travel(p, body):
    """Raise UsageError for a travel that reaches the body's own wake, or one that is too short for averages."""
    size = body.height / D
    most, least = p.width - AWAY * size, forces.PAPERS_TRANSIENT * size + LEAST_WINDOW
    if p.way > most + 1e-9:
        raise UsageError(
            f"travel={p.way:g} d ends less than {AWAY:g} D before the body's own wake, which comes back after"
            f" width={p.width:g} d; lower travel to {most:.4g} or raise width"
        )
    if p.way < least:
        raise UsageError(
            f"travel={p.way:g} d leaves too little after the transient of {forces.PAPERS_TRANSIENT:g} D; give at least"
            f" {least:.3g} d, and width at least {least + AWAY * size:.3g}"
        )


def check_lid(p):
    """Raise UsageError for a bed without any weight, and for bed and lid that are too heavy for the grains of the base."""
    if not p.bulk_gravity and p.lid_density == 0:
        raise UsageError("bulk_gravity=0 needs a lid to press on the bed; give lid_density, 60 to 210 in the paper")
    grains = material(p)
    at_base = (
        p.lid_density * grains.mass(D / 2) * GRAVITY + sphere_bed.BED_FRACTION * DENSITY * GRAVITY * p.height * D**3
    )
    most = grains.terms(D / 2, min(p.largest_overlap, sphere_bed.LARGEST_OVERLAP))["elastic"]
    if at_base > most:
        raise UsageError(
            f"bed and lid load a grain of the base with {at_base:.3g} N, but at largest_overlap={p.largest_overlap:g} R it can"
            f" carry only {most:.3g} N; lower lid_density={p.lid_density:g} or height={p.height:g}, or raise largest_overlap"
        )


def recipes(p, body):
    """Return the recipes for the bed around the body and for its lid."""
    bed = sphere_bed.SphereBed(
        width=p.width * D,
        breadth=p.breadth * D,
        height=p.height * D,
        d=D,
        d_min=(1 - p.polydispersity) * D,
        d_max=(1 + p.polydispersity) * D,
        surface=body.surface.recipe,
        axis=(p.height - p.depth) * D,
        bottom=float(-body.low[2]),
        volume=body.volume,
        material=material(p),
        gravity=GRAVITY,
        dt=POURING_FACTOR * TIME_STEP,
        rest=p.rest,
        seed=p.seed,
    )
    return bed, sphere_bed.Lid(p.lid_density * DENSITY, p.lid_turns, p.bulk_gravity)


def build(p, body, dt, change=None):
    """Put the bed at rest, its lid, the body, drives and measures into YADE; return ids and the weight of the bed.

    `change(bed, found)`, if given, returns the bed to use in place of the bed at rest `found` (`sphere_bed.at_rest`).
    """
    from yade import O

    bed, lid = recipes(p, body)
    found = sphere_bed.at_rest(bed, lid)
    found = change(bed, found) if change else found
    made = sphere_bed.build(bed, lid, found["x"], found["r"], found["lid"])
    O.dt = dt
    gravity = (0, 0, -GRAVITY if p.bulk_gravity else 0)
    if p.frame == "cylinder":
        space.set_velocity([*made["grains"], *made["lid"], made["base"]], (-p.speed, 0, 0))
    else:
        space.set_velocity([made["body"]], (p.speed, 0, 0))
    between, springs = [*measures(p, body, made), *drives(p, made)], (found["springs"], found["wall_springs"])
    if p.loop == "yade":
        space.run_on_yade_loop(material(p), gravity, between, springs)
    else:
        settings = dict(largestOverlap=p.largest_overlap, threads=p.threads or sphere_bed.scene_threads())
        space.run_on_grain_loop(material(p), gravity, between, springs, precision=p.precision, **settings)
    if not p.bulk_gravity:
        space.load_all(made["lid"], sphere_bed.weight_on_lid(bed, lid))
    ends = {name: [int(made[name][0]), int(made[name][-1]) + 1] if made[name] else [0, 0] for name in ("grains", "lid")}
    facts = sphere_bed.facts(bed, lid, found)
    told = dict(load_error=float(found["load_error"]), fraction=profile(p, made["grains"])[1].tolist())
    return dict(base=int(made["base"]), body=int(made["body"]), **ends, **facts, **told)


# Drive ----------------------------------------------------------------------------------------------------------------


def drives(p, made):
    """Return the drives of body and base: one of them moves with U_0, the other one is held at velocity 0."""
    if p.frame == "bed":
        return [engines.SpinTranslateDrive(body=made["body"], velocity=(p.speed, 0, 0), label="drive")]
    return [engines.SpinTranslateDrive(body=made["base"], velocity=(-p.speed, 0, 0), label="drive")]


# Measure --------------------------------------------------------------------------------------------------------------


def measures(p, body, made):
    """Return the binners of the forces on body and base and, if asked for, the averager of fields, which is off at first."""
    about = dict(planeNormal=(0, 1, 0), every=SAMPLE_EVERY)
    binners = [
        engines.ContactForceBinner(body=made["body"], kernel="gaussian", count=POINTS, label="binner", **about),
        engines.ContactForceBinner(body=made["base"], count=4, label="base_binner", **about),
    ]
    return [*binners, field_averager(p, body, made["body"])] if p.fields else binners


def field_averager(p, body, held):
    """Return the engine that averages fields in spheres of radius d around the body, and along y (A2, A3)."""
    along = min(FIELD_REACH, int(p.width / 2) - 2)
    below, above = min(FIELD_REACH, int(p.height - p.depth)), min(FIELD_REACH, int(p.depth) + 2)
    half = p.breadth * D / 2
    corners = dict(low=(-along * D, -half, -below * D), high=(along * D, half, above * D), spacing=p.field_spacing * D)
    every = max(1, int(p.way * D / (p.speed * time_step(p)) / p.field_samples))
    how = dict(dimensions=3, kernel="sphere", width=D, averageAlong="y", relative=True, dead=True, every=every)
    return engines.FieldAverager(body=held, label="around", **how, **corners)


def scene_of(p, body, stage):
    """Return the scales that the forces are compared with."""
    return forces.Scene(
        gravity=GRAVITY,
        d=D,
        height=body.height,
        breadth=body.breadth,
        volume=body.volume,
        bulk_density=stage["bulk_fraction"] * DENSITY,
        effective_depth=stage["effective_depth"],
        bed_weight=stage["bed_weight"],
        lid_weight=stage["lid_weight"],
        friction=p.mu,
        speed=p.speed,
        grain_density=DENSITY,
    )


def say_what_presses(seen):
    """Print the pressure at the axis, and warn if base and lid cannot hold the bed against the drag expected from the paper."""
    drag = USUAL_DRAG * seen.pressure * seen.area
    print(
        f"effective depth {seen.effective_depth / seen.height:.3g} D, P_0 = {seen.pressure:.4g} Pa, inertial number"
        f" {seen.inertial_number:.2g}",
        file=sys.stderr,
    )
    if drag > seen.grip:
        print(
            f"friction at base and lid holds at most {seen.grip:.3g} N, less than the drag of {drag:.3g} N at C_d ="
            f" {USUAL_DRAG:g}: the bed may slip as a whole, and the measured drag may be too small; raise width",
            file=sys.stderr,
        )


# Run ------------------------------------------------------------------------------------------------------------------


def check(p):
    """Refuse values that allow no run; return the body and the ratio of the time step to the critical one."""
    body = body_of(p)
    check_room(p, body)
    check_travel(p, body)
    check_lid(p)
    fields.check_spacing(p.field_spacing)
    progress.require_feasible(p.way * D / (p.speed * time_step(p)))
    sphere_bed.check(recipes(p, body)[0])
    return body, space.check_time_step(time_step(p), material(p), (1 - p.polydispersity) * D / 2, p.largest_overlap)


def run(p, folder):
    """Make the bed, drag the body through it and record the forces; or continue an interrupted run."""
    (body, ratio), march = check(p), YadeMarch()
    if folder.resumed:
        stage = recording.load_stage(folder, march, STAGE)
    else:
        stage = build(p, body, time_step(p))
    seen = scene_of(p, body, stage)
    say_what_presses(seen)
    march.grains = stage["grains"][1] - stage["grains"][0]
    also = f" phi = {stage['bulk_fraction']:.4f},"
    recording.announce(folder, grains=march.grains, dt=time_step(p), ratio=ratio, unit="s", also=also)
    folder.summarize(
        depth_over_d=seen.effective_depth / seen.height,
        effective_depth=seen.effective_depth / D,
        body_height=seen.height / D,
        grain_diameter=D,
        pressure=seen.pressure,
        bulk_density=seen.bulk_density,
        bulk_fraction=stage["bulk_fraction"],
        buoyancy=seen.buoyancy,
        weight=seen.bed_weight + seen.lid_weight,
        load_error=stage["load_error"],
        inertial_number=seen.inertial_number,
    )
    folder.write("intruder", body.described())
    record(p, folder, march, stage, seen)


STAGE = ("base", "body", "grains", "lid", "load_error", "fraction", *sphere_bed.FACTS)


def record(p, folder, march, stage, seen):
    """Run in blocks of d/4 of travel; record block means of the forces, frames and checkpoints, then fields and means."""
    from yade import O

    folder.declare_series(**forces.UNITS)
    binner, base = O.labeledEngine("binner"), O.labeledEngine("base_binner")
    ids, lids = range(*stage["grains"]), range(*stage["lid"])
    samples = max(1, round(BLOCK_TRAVEL * D / (p.speed * O.dt) / SAMPLE_EVERY))
    block = samples * SAMPLE_EVERY
    steps = int(p.way * D / (p.speed * O.dt) / block) * block
    transient = forces.PAPERS_TRANSIENT * seen.height / D

    def sample(done, track):
        if done == 0:
            return
        row = dict(t=march.time, travel=p.speed * march.time / D, lid_z=mean_height(lids), **force_means(binner, base))
        folder.append(**{name: row[name] for name in forces.UNITS})
        track.append(row)

    rows = driven.record(
        p,
        folder,
        march,
        steps,
        block,
        sample,
        stage=stage,
        ids=ids,
        due=np.linspace(steps, 0, p.frames, endpoint=False).round()[::-1],
        shown=[*scene.members(stage["base"]), *lids],
        settled=lambda t: p.speed * t / D >= transient,
        advice=OVERLAP_KEYS,
        label=f"dragging {p.way:g} d",
    )
    summary, angular = forces.steady_state(rows, seen)
    if not summary["steady"]:
        print("the test finds drag or lift unsteady up to the end of the run; give a longer travel", file=sys.stderr)
    folder.write("angular", angular, first_travel=summary["steady_from"])
    z, after = profile(p, ids)
    folder.write("profile", dict(z=z, fraction=np.array(stage["fraction"]), fraction_after=after))
    folder.summarize(**summary)


def mean_height(lids):
    """Return the mean height of the lid's centres [m], 0 without a lid."""
    return float(np.mean(scene.rows_of(lids)["z"])) if len(lids) else 0.0


def profile(p, ids):
    """Return the middles of slabs of thickness d/2 [m] and the volume fraction of the grains in each."""
    rows, edges = scene.rows_of(ids), np.arange(0, p.height + 10, 0.5) * D
    return (edges[1:] + edges[:-1]) / 2, sphere_bed.fraction_by_height(
        rows["z"], rows["r"], edges, p.width * p.breadth * D**2
    )


def force_means(binner, base):
    """Return the block means of the forces on body and base [N] as a row, and clear both binners."""
    (fx, _, fz), (base_fx, _, base_fz) = binner.force, base.force
    row = dict(fx=fx, fz=fz, contacts=binner.contactNumber, base_fx=base_fx, base_fz=base_fz)
    row.update(normal=binner.normalForce, tangential=binner.tangentialForce)
    binner.clear()
    base.clear()
    return row


# Study ----------------------------------------------------------------------------------------------------------------


def particle_steps(p):
    """Return grains times steps of a run, without the pouring."""
    grains = sphere_bed.BED_FRACTION * p.width * p.breadth * p.height / (np.pi / 6)
    return grains * p.way * D / (p.speed * time_step(p))


STUDY = Study(
    name="lift",
    parameters=LiftParameters,
    presets=PRESETS,
    observables=observables(
        quantities.SI,
        "lift_over_buoyancy",
        "lift_over_buoyancy drag_coefficient depth_over_d drag lift peak_stress_over_pressure tangential_share weight_on_base",
        drag="mean force on the body along -x",
        lift="mean force on the body, upwards",
    ),
    cost=Cost(particle_steps, RATE),
    check=check,
    run=run,
    figure=Lazily("graindrive.postproc.lift.figure", "draw"),
    film=Lazily("graindrive.postproc.lift.animation", "film"),
    report=Lazily("graindrive.postproc.lift.campaign", "REPORT"),
    constants={
        "d": Constant(D, "m", "diameter of the grains"),
        "density": Constant(DENSITY, "kg/m^3", "of the grains"),
        "gravity": Constant(GRAVITY, "m/s^2", "downwards"),
        "young": Constant(YOUNG, "Pa", "Young's modulus of grains and body"),
        "poisson": Constant(POISSON, "-", "Poisson's ratio"),
        "restitution": Constant(RESTITUTION, "-", "coefficient of restitution"),
        "time_step": Constant(TIME_STEP, "s", "at dt_factor=1"),
    },
)

if __name__ == "__main__":
    headless.main(STUDY)
