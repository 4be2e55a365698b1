"""Wiggle: a body shaken sideways in a bed of disks rises or sinks.

System of Tripura, Kumar, Anyam, Reddy, "The rise and sink dependence on the shape of a horizontally wiggling intruder".
A clump of beads along the outline of a shape lies in a settled bed under gravity. Its x is imposed,
x = A sin(2 pi t/T); it does not turn and is free in y. Units: grain diameter d, density rho, gravity g.

Readings, each a parameter: A is the amplitude of displacement (drive=velocity takes the text's A sin(2 pi t/T) as
velocity); all shapes weigh what a disk of 7 d and density rho weighs; sizes are outer sizes, beads included.

Cost: the paper's size is 63,000 disks and 1e7 steps, hours on two cores; the demo is 11,500 disks and 1.2e5 steps, a minute or
two. The demo shows the motion, not the paper's rates: a shallower bed presses less, so it is fluidised farther.

    scripts/run wiggle_triangle                     the demo
    yade -n -x studies/wiggle.py shape=disk period=4 amplitude=3 out=disk-run
    scripts/run wiggle help                         all keys
"""

import functools
import hashlib
import os
import sys
from pathlib import Path
from typing import Literal

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # `yade` runs scripts by exec: __file__ is YADE's own

import house  # noqa: E402, F401

import numpy as np  # noqa: E402

from graindrive import engines, headless, packing, progress, scene  # noqa: E402
from graindrive.errors import UsageError, one_line  # noqa: E402
from graindrive.material import HertzHistoryMaterial  # noqa: E402
from graindrive.parameters import StudyParameters, quantity  # noqa: E402
from graindrive.postproc import wiggle as results  # noqa: E402
from graindrive.postproc.statistics import drift  # noqa: E402

# Parameters -----------------------------------------------------------------------------------------------------------

TIME_STEP = 1e-4  # the paper's [sqrt(d/g)]
SAMPLES_PER_PERIOD = 40
SMALLEST_DIAMETER, LARGEST_DIAMETER = 0.9, 1.1  # [d], uniform between
CHECKPOINT_SECONDS = 60
CHECKPOINT = "scene.checkpoint"


class WiggleParameters(StudyParameters):
    """What the wiggle study knows, in units of d, rho, g."""

    shape: str = quantity(
        "triangle", "-", "disk, square, tall, wide, triangle (OS1 to OS5), or a file of vertices: .wkt, .csv"
    )
    amplitude: float = quantity(
        3.0, "d", "A of the displacement; of the velocity [sqrt(d g)] with drive=velocity", ge=0
    )
    period: float = quantity(4.0, "sqrt(d/g)", "T of the oscillation", gt=0)
    drive: Literal["displacement", "velocity"] = quantity("displacement", "-", "which of the two is A sin(2 pi t/T)")
    mu: float = quantity(0.1, "-", "friction coefficient", ge=0)
    width: float = quantity(300.0, "d", "period of the bed in x", gt=0)
    height: float = quantity(195.0, "d", "height of the bed", gt=0)
    depth: float = quantity(105.0, "d", "depth of the body's centre below the surface", gt=0)
    time: float = quantity(1000.0, "sqrt(d/g)", "how long it is shaken", gt=0)
    frames: int = quantity(10, "-", "pictures of the bed that are kept", ge=1, le=9999)
    rest: float = quantity(1e-4, "m g d", "kinetic energy per grain at which the bed counts as settled", gt=0)
    largest_overlap: float = quantity(0.3, "R", "overlap of two grains at which the run is stopped", gt=0, le=1)
    bead_diameter: float = quantity(0.5, "d", "diameter of the body's beads", gt=0)
    intruder_mass: float = quantity(np.pi * 7**2 / 4, "rho d^2", "mass of the body: that of a 7 d disk", gt=0)

    def identity(self):
        """Return all that decides the result: for an outline from a file its contents too, not the name alone."""
        return {**super().identity(), **({"outline": contents_of(self.shape)} if names_a_file(self.shape) else {})}


def names_a_file(shape):
    """True for an outline's file, False for the name of a built-in shape."""
    return shape.lower().endswith((".wkt", ".csv"))


@functools.lru_cache(maxsize=None)
def contents_of(path):
    """Return what stands for a file's contents, as they are when the program first asks; "" if it cannot be read."""
    try:
        return hashlib.sha256(Path(path).expanduser().read_bytes()).hexdigest()[:12]
    except (OSError, RuntimeError):
        return ""


PRESETS = {
    "smoke": dict(width=26, height=18, depth=8, time=4, amplitude=1.5, period=2, frames=2, dt_factor=5, rest=0.05),
    "demo": dict(width=120, height=90, depth=50, time=60, period=4, dt_factor=5, rest=1e-3),
    "paper": {},
}

# Scene ----------------------------------------------------------------------------------------------------------------


def material(p):
    """The paper's grains, Table of section 2: K_n, K_t in rho d g, gamma in sqrt(g/d^3)."""
    return HertzHistoryMaterial(2e6, 2.46e6, 2500, 2500, p.mu, 1.0)


def intruder(p):
    """Return the outline about its centroid, shape (m, 2), and the clump of beads inside it."""
    try:
        is_file = names_a_file(p.shape)
        outline = engines.read_outline(os.path.expanduser(p.shape)) if is_file else engines.outline_of(p.shape)
        clump = engines.clump_of(outline, p.bead_diameter, p.intruder_mass)
    except ValueError as error:  # without words where the file holds no text
        reason = one_line(error, 400) or "it must be a text file of vertices in WKT or CSV"
        raise UsageError(f"shape={one_line(p.shape)}: {reason}") from None
    return outline, clump


def check_room(p, outline):
    """The body must fit into the bed with its whole motion."""
    centred = outline.vertices - np.array(outline.centroid)
    (left, bottom), (right, top) = centred.min(axis=0), centred.max(axis=0)
    swing = p.amplitude if p.drive == "displacement" else p.amplitude * p.period / (2 * np.pi)
    needed = right - left + 2 * swing + 4
    if needed > p.width:
        raise UsageError(
            f"width={p.width:g} d is too small for the body and its motion, which need {needed:g} d;"
            " raise width or lower amplitude"
        )
    if p.height - p.depth + bottom < 1:
        raise UsageError(
            f"height={p.height:g} d and depth={p.depth:g} d put the body into the base; raise height or lower depth"
        )
    if p.depth < top:
        raise UsageError(f"depth={p.depth:g} d lets the body stick out of the bed by {top - p.depth:g} d; raise depth")
    return centred


def check_period(p, dt):
    """A sample of the motion is at least one time step."""
    if p.amplitude and p.period < SAMPLES_PER_PERIOD * dt:
        raise UsageError(
            f"period={p.period:g} sqrt(d/g) must be at least {SAMPLES_PER_PERIOD} time steps, {SAMPLES_PER_PERIOD * dt:.3g};"
            " raise it or lower dt_factor"
        )


def make_bed(p, vertices, area, clump, at, dt, grains):
    """Return the settled bed around the held body, from the cache or by pouring it."""
    return packing.settled_bed(
        packing.BedRecipe(
            width=p.width,
            height=p.height,
            d_min=SMALLEST_DIAMETER,
            d_max=LARGEST_DIAMETER,
            material=grains,
            beads=tuple(map(tuple, clump.beads + at)),
            bead_radius=clump.bead_radius,
            outline=tuple(map(tuple, vertices + at)),
            outline_area=area,
            dt=dt,
            rest=p.rest,
            seed=p.seed,
        )
    )


# Drive, Measure, Run --------------------------------------------------------------------------------------------------


def run(p, folder):
    """Make the bed, shake the body, record its way; or go on where an interrupted run left off."""
    grains, dt = material(p), TIME_STEP * p.dt_factor
    outline, clump = intruder(p)
    vertices = check_room(p, outline)
    ratio = scene.check_time_step(dt, grains, SMALLEST_DIAMETER / 2, p.largest_overlap, lightest=p.intruder_mass)
    check_period(p, dt)
    progress.require_feasible(p.time / dt)
    if folder.resumed:
        stage = {name: folder.resumed[name] for name in ("base", "grains", "body")}
        scene.load(folder.resumed["folder"] / CHECKPOINT)
    else:
        stage = build(p, grains, dt, clump, vertices, outline.area)
    folder.note(dt=dt, dt_over_critical=ratio, n_grains=stage["grains"])
    folder.write(
        "intruder", dict(beads=(clump.beads, "d"), outline=(vertices, "d"), bead_radius=(clump.bead_radius, "d"))
    )
    print(f"{stage['grains']} grains, dt = {dt:.3g} sqrt(d/g), dt/dt_crit = {ratio:.3g}", file=sys.stderr)
    record(p, folder, stage)


def build(p, grains, dt, clump, vertices, area):
    """Put bed, body, drive and measure into YADE; return the counts of base and grains and the body's id."""
    from yade import O

    at = np.array([p.width / 2, p.height - p.depth])
    bed = make_bed(p, vertices, area, clump, at, dt, grains)
    scene.start(p.width, float(bed["y"].max()) + 2 * p.amplitude + 10)
    base = scene.add_base(p.width, 1.0, grains.density)
    ids = scene.add_disks(bed["x"], bed["y"], bed["r"], grains.density)
    body = scene.add_intruder(clump, *at, blocked="xzXYZ")
    drive = engines.OscillationDrive(body=body, amplitude=p.amplitude, period=p.period, form=p.drive, label="drive")
    binner = engines.ContactForceBinner(body=body, label="binner")
    O.dt = dt
    scene.run_on(
        p.loop, grains, gravity=1.0, between=[binner, drive], precision=p.precision, largest_overlap=p.largest_overlap
    )
    return dict(base=len(base), grains=len(ids), body=body)


def record(p, folder, stage):
    """Run in blocks, a fortieth of a period each, and keep series, frames and checkpoints."""
    from yade import O

    folder.declare_series(
        t="sqrt(d/g)",
        x="d",
        y="d",
        vx="sqrt(d g)",
        vy="sqrt(d g)",
        fx="rho d^2 g",
        fy="rho d^2 g",
        contacts="-",
        work="rho g d^3",
    )
    base, ids = range(stage["base"]), range(stage["base"], stage["base"] + stage["grains"])
    state, drive, binner = O.bodies[stage["body"]].state, O.labeledEngine("drive"), O.labeledEngine("binner")
    steps, block = max(1, round(p.time / O.dt)), max(1, round(p.period / SAMPLES_PER_PERIOD / O.dt))
    first = folder.resumed["step"] if folder.resumed else 0
    track = list(np.load(folder.resumed["folder"] / "track.npy")) if folder.resumed else []
    frames_due = list(np.linspace(0, steps, p.frames).round()[folder.frames :])
    checkpoints = progress.Every(CHECKPOINT_SECONDS)

    def sample(done):
        t, position, velocity = done * O.dt, state.pos, state.vel
        if not position[1] > 0:
            raise RuntimeError(f"step {done}: the body fell through the base, to y = {position[1]:.3g} d")
        track.append((t, position[1]))
        folder.append(
            t=t,
            x=position[0],
            y=position[1],
            vx=velocity[0],
            vy=velocity[1],
            fx=drive.force[0],
            fy=drive.force[1],
            contacts=binner.lastContactNumber,
            work=drive.work,
        )
        if frames_due and done >= frames_due[0]:
            frames_due.pop(0)
            folder.frame(t, *scene.picture(ids, base, stage["body"]))

    def save(place):
        scene.save(place / CHECKPOINT)
        np.save(place / "track.npy", track)

    def after_block(done):
        sample(first + done)
        if checkpoints.due():
            folder.checkpoint(save, first + done, **stage)

    if not folder.resumed:
        sample(0)
    timing = progress.run_blocks(steps - first, block, after_block, grains=len(ids), label="shaking")
    folder.note(steps=first + timing.steps, particle_steps_per_second=timing.particle_steps_per_second)
    t, y = np.array(track).T
    rise = drift(t, y, p.period)
    folder.summarize(shape=p.shape, amplitude=p.amplitude, period=p.period)
    folder.summarize(rise_rate=rise.rate, rise_rate_err=rise.error, y_final=y[-1] - y[0])


def main(**defaults):
    """Entry of this study and of its presets, which give `defaults`."""
    headless.main(run, WiggleParameters, PRESETS, defaults=defaults, figure=results.draw)


if __name__ == "__main__":
    main()
