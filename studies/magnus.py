"""Magnus: a disk that spins and moves through a granular gas or liquid is pushed sideways, opposite to the force in a fluid.

System of Kumar, Dhiman, Reddy, "Magnus effect in granular media", Phys. Rev. E 99, 012902 (2019): two dimensions, no
gravity, a channel of disks periodic in x between two rough walls. The body moves along x with V0 and turns with
omega_0 = Omega V0/R for all time. SI units: d = 0.02 m, 20 kg/m^2; lengths on the command line in d.

The paper leaves some choices open. Each of them is a parameter or is stated here. Diameters are uniform within 10 %. The area
fraction refers to the area free to grains (between the walls' centre lines, without wall disks and body), which gives the
paper's 26,000 to 62,000 grains. A packing is compressed without friction, since grains of mu = 0.5 jam at 0.81, and with five
times the damping, so that it comes to rest. Lift is positive along -omega x V, drag along -V. Theta is counter-clockwise from V.

Drag grows as V0^2 and L/D does not depend on V0 (phi = 0.352, Omega = 5, box 150 d x 100 d: D = 0.040 and 4.28 N, L/D = 0.33
and 0.34, both +- 0.04, at 0.25 and 2.5 m/s), while the number of steps is proportional to 1/V0. At 2.5 m/s a grain that the body
hits overlaps it by 1.5 % of a radius. The effect of the demo's longer time step was measured: see the end of help.

Cost on one core: the paper's size is 26,500 to 61,700 disks and 1.2e7 steps at 0.25 m/s, a quarter of an hour (phi = 0.352)
to an hour and a half (0.818); the demo is 6,600 disks and 2.4e6 steps, a minute or two. A shorter channel allows only a shorter
travel: after one channel length the body meets its own wake, which never refills.

    scripts/run magnus                                  the demo
    yade -n -x studies/magnus.py phi=0.818 spin_ratio=10 scale=paper out=dense
    scripts/run magnus help                             all keys
"""

import os
import sys
from typing import ClassVar, Optional

if __name__ == "__main__":  # `yade` runs scripts by exec: __file__ is YADE's own
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))

import house  # noqa: E402, F401

import numpy as np  # noqa: E402

from graindrive.beds import channel  # noqa: E402
from graindrive.runs import driven, fields, progress, recording  # noqa: E402
from graindrive.lazily import Lazily, engines  # noqa: E402
from graindrive.commands import headless  # noqa: E402
from graindrive.bodies import intruder  # noqa: E402
from graindrive.scenes import scene  # noqa: E402
from graindrive.runs.block_means import block_means  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.scenes.material import HertzHistoryMaterial  # noqa: E402
from graindrive.parameters import Lever, When, quantity  # noqa: E402
from graindrive.postproc import quantities  # noqa: E402
from graindrive.postproc.magnus.forces import UNITS, steady_state  # noqa: E402
from graindrive.study import Constant, Cost, Study, observables  # noqa: E402
from graindrive.scenes.yade_march import YadeMarch  # noqa: E402

# Parameters -----------------------------------------------------------------------------------------------------------

D = 0.02  # m, mean diameter of the grains
DENSITY = 20.0  # kg/m^2
TIME_STEP = 2e-6  # s, the paper's
SAMPLE_EVERY = 10  # steps; a contact at 5 m/s lasts 60
BLOCK_TRAVEL = 0.1  # d of travel between two rows of the series
LOOK_EVERY = 50  # blocks between two estimates of the error
CLOSING_SPEED, REST_SPEED = 1.0, 5e-3  # m/s, of the walls that compress a packing, and of grains that count as at rest
PREPARATION_DAMPING = 5  # times gamma while a packing is made, so that grains without friction come to rest
FIELD_REACH = (
    10,
    2,
)  # reach around the body: d, or diameters of a large body; behind it the fields reach 1.5 times as far
FEWEST_BLOCKS = 200  # in the steady window before its error can stop the run
LEAST_WINDOW = 0.5  # d of travel to average; with less no error can be estimated
OVERLAP_KEYS = (
    "lower dt_factor, v0, spin_ratio or wall_pressure, or raise largest_overlap"  # advice of the overlap guard
)
MOST_BINS = 4e7  # of the fields: 1.6 GB of sums
RATES = ((0.352, 0.818), (313e6, 88e6))  # area fraction, particle-steps per second of one core (README)


class MagnusParameters(intruder.BodyParameters):
    """The parameters of the Magnus study; lengths in d, all else in SI units."""

    unit_system: ClassVar[str] = quantities.SI

    phi: float = quantity(0.352, "-", "area fraction of the grains", ge=0.05, le=0.9)
    v0: float = quantity(0.25, "m/s", "speed of the body along x", gt=0, le=20)
    spin_ratio: float = quantity(5.0, "-", "Omega = omega_0 R/V0, positive counter-clockwise", ge=-1000, le=1000)
    mu: float = quantity(0.5, "-", "friction coefficient", ge=0)
    width: float = quantity(
        300.0, "d", "length of the channel along x, a whole number", gt=0, lever=Lever(300, "lower")
    )
    height: float = quantity(200.0, "d", "height of the channel, including the walls", gt=0, lever=Lever(200, "lower"))
    travel: Optional[float] = quantity(
        None,
        "d",
        "distance that the body travels, at most (auto) the channel's length",
        gt=0,
        lever=Lever(None, "lower"),
    )
    settle_travel: float = quantity(30.0, "d", "least travel before the averages begin", ge=0)
    until_error: float = quantity(
        0.0,
        "-",
        "end the run once the estimated standard error of L/D, itself uncertain, is below this; 0: never",
        ge=0,
    )
    intruder_diameter: float = quantity(5.0, "d", "diameter of the disk, or longer side of another shape", ge=1)
    shape: str = quantity("disk", "-", "disk, or another shape made of beads: square, tall, wide, triangle, or a file")
    bead_diameter: float = quantity(
        0.5, "d", "bead diameter of a shape other than the disk", gt=0, only=When("shape", never=("disk",))
    )
    polydispersity: float = quantity(
        0.1, "-", "half-width of the uniform distribution of diameters, over d", ge=0, lt=0.9
    )
    wall_pressure: float = quantity(
        0.0, "N/m", "force per length that pushes the walls inwards; 0: the walls are fixed", ge=0
    )
    fields: bool = quantity(True, "-", "average the fields around the body in bins of field_spacing", watches=True)
    field_spacing: float = quantity(
        0.05,
        "d",
        "side of the fields' square bins; it must divide 1 d",
        gt=0,
        le=1,
        watches=True,
        only=When("fields", (True,)),
    )
    field_samples: int = quantity(
        1000,
        "-",
        "number of moments in the fields' averages",
        ge=1,
        le=10**6,
        watches=True,
        lever=Lever(1000, "lower", 4),
        only=When("fields", (True,)),
    )
    frames: int = quantity(
        1,
        "-",
        "number of pictures of the channel to keep, at equal intervals, the last at the end",
        ge=1,
        le=9999,
        watches=True,
    )
    largest_overlap: float = quantity(
        0.1, "R", "largest allowed overlap of two grains; a larger one stops the run", gt=0, le=1, watches=True
    )

    @property
    def way(self):
        """Distance that the body travels [d]."""
        return self.width if self.travel is None else self.travel

    def auto_values(self):
        """Return {key: value} for travel=auto."""
        return {"travel": self.way}

    def identity(self):
        """Return all values that decide the result; travel=auto stays "auto" there, so that older runs are found again."""
        return {**super().identity(), "travel": self.travel}

    @property
    def spin(self):
        """omega_0 [rad/s] = Omega V0/R (Eq. 4)."""
        return self.spin_ratio * self.v0 / (self.intruder_diameter * D / 2)


PRESETS = {
    "smoke": dict(width=60, height=40, v0=2.5, dt_factor=2, field_spacing=0.25),
    "demo": dict(width=150, height=100, dt_factor=2),
    "paper": {},
}


def time_step(p):
    """Return the time step [s]."""
    return TIME_STEP * p.dt_factor


# Scene ----------------------------------------------------------------------------------------------------------------


def material(mu, damping=1):
    """The paper's grains, Table I, with friction `mu` and `damping` times the paper's damping."""
    return HertzHistoryMaterial(2e9, 2.45e9, damping * 8e6, damping * 8e6, mu, DENSITY)


def check_room(p):
    """Raise UsageError if the body does not fit between the walls, meets its own wake or travels too little for averages."""
    if p.way > p.width:
        raise UsageError(
            f"travel={p.way:g} d is longer than the channel: the body would meet its wake; raise width={p.width:g}"
        )
    if p.way - p.settle_travel < LEAST_WINDOW:
        raise UsageError(
            f"travel={p.way:g} d leaves too little to average after settle_travel={p.settle_travel:g} d, where at least"
            f" {LEAST_WINDOW} d are needed; raise travel and width"
        )
    fields.check_spacing(p.field_spacing)
    channel.check_room(p.width, p.height, p.intruder_diameter)
    if p.fields and 5 * (field_reach(p) / p.field_spacing) ** 2 > MOST_BINS:
        raise UsageError(
            f"field_spacing={p.field_spacing:g} d makes over {MOST_BINS:.0e} bins; raise it, or leave the fields out, fields=0"
        )


def check_load(p, grains):
    """Raise UsageError for a pressure whose overlap of walls and grains exceeds the largest one allowed, whatever mu is."""
    if p.wall_pressure * D > (most := grains.force_between(D / 2, p.largest_overlap)):
        raise UsageError(
            f"wall_pressure={p.wall_pressure:g} N/m makes grains overlap by more than largest_overlap="
            f"{p.largest_overlap:g} R; give at most {most / D:.3g} N/m"
        )


def recipe(p, body):
    """Return the recipe for the channel around the held body."""
    return channel.ChannelRecipe(
        width=p.width * D,
        height=p.height * D,
        d=D,
        d_min=(1 - p.polydispersity) * D,
        d_max=(1 + p.polydispersity) * D,
        phi=p.phi,
        material=material(0.0, PREPARATION_DAMPING),
        **body.placed((p.width * D / 2, 0.0)),
        body_area=body.area,
        closing_speed=CLOSING_SPEED,
        rest_speed=REST_SPEED,
        seed=p.seed,
    )


def packing(p, body):
    """Return the channel's grains around the held body, from the cache or newly made."""
    return channel.channel(recipe(p, body))


def add_walls(p):
    """Add the rough walls; return the ids of their disks, and the ids of the clumps that a pressure moves."""
    heights = [side * (p.height - 1) * D / 2 for side in (-1, 1)]
    if p.wall_pressure == 0:
        return [id_ for y in heights for id_ in scene.add_base(p.width * D, D, DENSITY, y)], []
    clumps = [scene.add_wall_clump(p.width * D, D, DENSITY, y, blocked="xzXYZ") for y in heights]
    return [id_ for clump in clumps for id_ in scene.members(clump)], clumps


def build(p, grains, dt, body):
    """Put walls, grains, body, drive and measures into YADE; return ids (first, last + 1), phi, grains' area."""
    from yade import O

    packed = packing(p, body)
    scene.start(p.width * D, p.height * D)
    walls, clumps = add_walls(p)
    ids = scene.add_disks(packed["x"], packed["y"], packed["r"], DENSITY)
    held = intruder.add_held(body, p.width * D / 2, 0.0, DENSITY)
    O.dt = dt
    scene.run_as_asked(p, grains, gravity=0.0, between=[*measures(p, held, dt), imposed_motion(p, held)])
    for wall, side in zip(clumps, (1, -1)):
        scene.load_on(wall, (0, side * p.wall_pressure * p.width * D, 0))
    ends = dict(walls=list(map(int, walls)), grains=[int(ids[0]), int(ids[-1]) + 1], body=held)
    return dict(ends, phi=float(packed["phi"]), grain_area=float(np.pi * np.sum(packed["r"] ** 2)))


def area_fraction(p, stage):
    """Return the area fraction for the present positions of the walls, which a pressure may have moved."""
    apart = scene.height_of(stage["walls"][-1]) - scene.height_of(stage["walls"][0])
    return channel.fraction_after(stage["phi"], stage["grain_area"], p.width * D * (apart - (p.height - 1) * D))


# Drive ----------------------------------------------------------------------------------------------------------------


def imposed_motion(p, held):
    """Return the drive that imposes the body's whole motion."""
    return engines.SpinTranslateDrive(body=held, velocity=(p.v0, 0, 0), spin=(0, 0, p.spin), label="drive")


# Measure --------------------------------------------------------------------------------------------------------------


def measures(p, held, dt):
    """Return the binner of the forces on the body and, if asked for, the averager of fields, off until the steady state."""
    binner = engines.ContactForceBinner(body=held, reference="motion", every=SAMPLE_EVERY, label="binner")
    return [binner, field_averager(p, held, dt)] if p.fields else [binner]


def field_reach(p):
    """Return the distance to which the fields reach around the body [d], a whole number."""
    least, diameters = FIELD_REACH
    return min(max(least, int(diameters * p.intruder_diameter)), int(p.width / 2.5), int(p.height / 2))


def field_averager(p, held, dt):
    """Return the engine that averages the fields in the body's frame."""
    reach = field_reach(p)
    corners = dict(low=(-(reach + reach // 2) * D, -reach * D, 0), high=(reach * D, reach * D, 0))
    every = max(1, int((p.way - p.settle_travel) * D / (p.v0 * dt) / p.field_samples))
    bins = dict(kernel="diskBin", spacing=p.field_spacing * D, relative=True, stress=False)
    return engines.FieldAverager(body=held, every=every, dead=True, label="around", **bins, **corners)


def say_if_not_resolved(p, found):
    """Warn if the channel was too short for the error of L/D that was asked for."""
    if p.until_error and not found.is_good_to(p.until_error, FEWEST_BLOCKS):
        print(
            f"one channel length was too short for a standard error of L/D of {p.until_error:g}: it is"
            f" {found.summary['lift_to_drag_err']:.2g}; average over seeds, or give a longer channel",
            file=sys.stderr,
        )


# Run ------------------------------------------------------------------------------------------------------------------


def check(p):
    """Refuse values that allow no run; return the body and the ratio of the time step to the critical one."""
    check_room(p)
    dt, grains = time_step(p), material(p.mu)
    check_load(p, grains)
    progress.require_feasible(p.way * D / (p.v0 * dt))
    body = intruder.of_size(p.shape, p.intruder_diameter * D, p.bead_diameter * D, DENSITY)
    channel.check(recipe(p, body))
    smallest = (1 - p.polydispersity) * D / 2
    return body, scene.check_time_step(dt, grains, smallest, p.largest_overlap, lightest=body.mass)


def run(p, folder):
    """Make the channel, drive the body through it and record the forces; or continue an interrupted run."""
    (body, ratio), dt, grains, march = check(p), time_step(p), material(p.mu), YadeMarch()
    if folder.resumed:
        stage = recording.load_stage(folder, march, ("walls", "grains", "body", "phi", "grain_area"))
    else:
        stage = build(p, grains, dt, body)
    folder.write("intruder", body.as_arrays("m"))
    march.grains, also = stage["grains"][1] - stage["grains"][0], f" phi = {stage['phi']:.4f},"
    recording.announce(folder, grains=march.grains, dt=dt, ratio=ratio, unit="s", also=also)
    record(p, folder, march, stage)


def record(p, folder, march, stage):
    """Run in blocks of d/10 of travel; record block means of the forces, frames and checkpoints, then fields and means."""
    from yade import O

    folder.declare_series(**UNITS)
    state, binner = O.bodies[stage["body"]].state, O.labeledEngine("binner")
    samples = max(1, round(BLOCK_TRAVEL * D / (p.v0 * O.dt) / SAMPLE_EVERY))
    block = samples * SAMPLE_EVERY
    steps = int(p.way * D / (p.v0 * O.dt) / block) * block

    def steady(rows):
        return steady_state(rows, p.settle_travel, p.mu, p.spin_ratio)

    def sample(done, track):
        if done == 0:
            return False
        t = march.time
        row = dict(t=t, travel=p.v0 * t / D, x=state.pos[0], phi=area_fraction(p, stage), **block_means(binner))
        folder.append(**{name: row[name] for name in UNITS})
        track.append(row)
        looks = p.until_error and len(track) % LOOK_EVERY == 0
        return looks and steady(track.arrays()).is_good_to(p.until_error, FEWEST_BLOCKS)

    rows = driven.record(
        p,
        folder,
        march,
        steps,
        block,
        sample,
        stage=stage,
        ids=range(*stage["grains"]),
        due=np.linspace(steps, 0, p.frames, endpoint=False).round()[::-1],
        shown=stage["walls"],
        settled=lambda t: p.v0 * t / D >= p.settle_travel,
        advice=OVERLAP_KEYS,
        label=f"driving {p.way:g} d",
    )
    found = steady(rows)
    say_if_not_resolved(p, found)
    folder.write("angular", found.angular, first_travel=found.start)
    folder.summarize(v0=p.v0, spin_ratio=p.spin_ratio, mu=p.mu, travel=p.way, **found.summary)


# Study ----------------------------------------------------------------------------------------------------------------


def particle_steps(p):
    """Return grains times steps of a run; the walls' frozen disks are not counted."""
    return p.phi * p.width * p.height / (np.pi / 4) * p.way * D / (p.v0 * time_step(p))


def rate(p):
    """Return the particle-steps per second of one core: `RATES`, interpolated, and constant outside their range."""
    return float(np.interp(p.phi, *RATES))


STUDY = Study(
    name="magnus",
    parameters=MagnusParameters,
    presets=PRESETS,
    observables=observables(
        quantities.SI,
        "lift_to_drag",
        "lift_to_drag drag lift torque contacts phi slipping_share kappa front_share",
        drag="mean force on the body along -V",
        lift="mean force on the body along -omega x V",
        torque="mean torque on the body, counter-clockwise",
        phi="mean area fraction between the walls, without the body",
    ),
    cost=Cost(particle_steps, rate),
    check=check,
    run=run,
    figure=Lazily("graindrive.postproc.magnus.figure", "draw"),
    film=Lazily("graindrive.postproc.magnus.animation", "film"),
    report=Lazily("graindrive.postproc.magnus.campaign", "REPORT"),
    constants={
        "d": Constant(D, "m", "mean diameter of the grains"),
        "density": Constant(DENSITY, "kg/m^2", "mass of a grain over its area"),
        "time_step": Constant(TIME_STEP, "s", "at dt_factor=1"),
    },
)

if __name__ == "__main__":
    headless.main(STUDY)
