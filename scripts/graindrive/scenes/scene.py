"""Builds scenes in YADE: disks in a plane, a frozen base, a clump of beads, the time loop; spheres in space."""

import math
import os
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from ..loops import dimensions as dimension_rule
from ..lazily import engines
from ..loops import grain_loop
from ..base.errors import UsageError

YADES_FILE = "scene.yade.gz"  # YADE chooses the format by the ending
GRAINS_PER_THREAD = 5000  # with fewer, two threads wait for each other as long as they work
IN_PLANE = "zXY"  # degrees of freedom that a two-dimensional scene blocks


def start(width, height):
    """Empty YADE's scene and make it periodic in x with period `width`; y has room for `height` and a margin.

    YADE only has cells that are periodic in all directions, so y is made so long that no body reaches its own image.
    """
    from yade import O

    O.reset()
    O.periodic = True
    O.cell.setBox(width, 2 * height + 20, 10)


def disk(x, y, radius, density, blocked=IN_PLANE):
    """Return a YADE body for a disk: mass rho pi r^2, inertia m r^2/2 (YADE's own would be a sphere's)."""
    from yade import utils
    from yade.minieigenHP import Vector3

    body = utils.sphere((float(x), float(y), 0), float(radius))
    body.state.mass = density * math.pi * radius**2
    body.state.inertia = Vector3(1, 1, 1) * (body.state.mass * radius**2 / 2)
    body.state.blockedDOFs = blocked
    return body


def add_disks(x, y, radii, density, blocked=IN_PLANE):
    """Add disks and return their ids; arrays of shape (n,) in length, density, one or (n,), in mass/length^2."""
    from yade import O

    densities = np.broadcast_to(density, np.shape(x))
    return O.bodies.append([disk(*row, blocked) for row in zip(x, y, radii, densities)])


def row(width, diameter):
    """Return x of a row of touching disks that is continuous across the periodic side, shape (n,)."""
    count = max(1, round(width / diameter))
    return (np.arange(count) + 0.5) * width / count


def add_base(width, diameter, density, y=0.0):
    """Add a row of frozen disks at height `y` that is continuous across the periodic side; return their ids."""
    x = row(width, diameter)
    return add_disks(x, np.full(len(x), y), np.full(len(x), diameter / 2), density, "xyzXYZ")


def add_wall_clump(width, diameter, density, y, blocked="xyzXYZ"):
    """Add the same row as one clump, a rough wall that a drive or a load moves as a whole; return the clump's id."""
    x = row(width, diameter)
    mass = len(x) * density * math.pi * diameter**2 / 4
    beads = np.c_[x - width / 2, np.zeros(len(x))]
    inertia = mass * (np.mean(beads[:, 0] ** 2) + diameter**2 / 8)
    wall = SimpleNamespace(beads=beads, bead_radius=diameter / 2, mass=mass, inertia=inertia)
    return add_intruder(wall, width / 2, y, blocked)


def add_intruder(clump, x, y, blocked="xyzXYZ"):
    """Add a clump of beads (from `engines.clump_of`) with its solid's centroid at (x, y); return the clump's id.

    It gets the mass and inertia of `clump`, whatever the mass of its beads is.
    """
    from yade import O
    from yade.minieigenHP import Vector3

    beads = [disk(x + bx, y + by, clump.bead_radius, 1.0) for bx, by in clump.beads]
    id_, _ = O.bodies.appendClumped(beads)
    engines.centre_clump(O._sceneObj, id_, Vector3(float(x), float(y), 0))  # YADE takes the mean of the beads
    O.bodies[id_].aspherical = False  # YADE computed this from the beads; one moment of inertia is enough here
    state = O.bodies[id_].state
    state.mass = clump.mass
    state.inertia = Vector3(1, 1, 1) * clump.inertia
    state.blockedDOFs = blocked
    return id_


def set_motion(ids, vy):
    """Give free disks the velocities vy along y, one or (n,), and no other motion."""
    from yade import O
    from yade.minieigenHP import Vector3

    loop = fast_loop()
    if loop:
        loop.sync()
    for id_, speed in zip(ids, np.broadcast_to(vy, len(ids))):
        state = O.bodies[id_].state
        state.vel, state.angVel = Vector3(0, float(speed), 0), Vector3.Zero
    if loop:
        loop.read()


def members(clump):
    """Return the ids of a clump's disks."""
    from yade import O

    return sorted(O.bodies[clump].shape.members)


def load_on(body, force):
    """Apply a constant force (x, y, z) to a body that is free to move, under either loop."""
    from yade import O
    from yade import wrapper as w

    loop = fast_loop()
    if loop:
        loop.setLoad(body, force)
    else:
        O.engines = [*O.engines[:-1], w.ForceEngine(ids=[body], force=force), O.engines[-1]]


def yade_loop(material, gravity, between=(), damping=0.0):
    """Put YADE's own loop with our law into O.engines; `between` are engines between the contacts and the integrator."""
    from yade import O
    from yade import wrapper as w

    functors = {law: name for name, law in engines.law_functors().items()}
    law = getattr(engines, functors[material.LAW])(**material.given())
    phys = engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=material.friction)
    O.engines = [
        w.ForceResetter(),
        w.InsertionSortCollider([w.Bo1_Sphere_Aabb()]),
        w.InteractionLoop([w.Ig2_Sphere_Sphere_ScGeom()], [phys], [law]),
        *between,
        w.NewtonIntegrator(damping=damping, gravity=(0, -gravity, 0)),
    ]


def height_of(id_):
    """Return y of a disk, or of its clump if it belongs to one, because the clump's position is up to date at every step."""
    from yade import O

    clump = O.bodies[id_].clumpId
    return O.bodies[clump if clump >= 0 else id_].state.pos[1]


def run_on(loop, material, gravity, between=(), precision="double", largest_overlap=0.1, threads=None):
    """Put the named loop into O.engines: "yade" (the reference) or "grain" (fast, the same physics).

    GrainLoop stops a run in which grains overlap by more than `largest_overlap` of the smaller radius. It uses `threads`, or
    by default as many as YADE was started with, but no more than useful: about one per 5,000 grains. Results have the same
    bits for any number of threads. Raises UsageError if two disks could touch through two periodic images.
    """
    from yade import O

    require_one_image()
    yade_loop(material, gravity, between)
    if loop == "grain":
        grain_loop.use_grain_loop(
            periods=(O.cell.size[0], 0) if O.periodic else None,  # y of the cell is long on purpose, see `start`
            precision=precision,
            threads=threads or min(O.numThreads, 1 + len(O.bodies) // GRAINS_PER_THREAD),
            largestOverlap=largest_overlap,
            label="loop",
        )


def require_one_image():
    """Raise UsageError if the cell is so short that its two largest disks could touch through two images at once.

    Both loops consider only the nearest image of a pair, so the second contact would be lost.
    """
    from yade import O

    radii = np.sort(engines.body_table(O._sceneObj)["radius"])
    if O.periodic and len(radii) > 1 and 2 * (radii[-1] + radii[-2]) > O.cell.size[0]:
        raise UsageError(
            f"the period in x must be at least {2 * (radii[-1] + radii[-2]):g}, got {O.cell.size[0]:g}: disks of radius"
            f" {radii[-1]:g} and {radii[-2]:g} could touch through two of their images; make it longer or the disks smaller"
        )


def run_as_asked(p, material, gravity, between=()):
    """Put the loop that the parameters of a study ask for into O.engines."""
    run_on(p.loop, material, gravity, between, p.precision, p.largest_overlap)


def fast_loop():
    """Return the GrainLoop that runs this scene, None under YADE's own loop."""
    from yade import O

    return next((engine for engine in O.engines if isinstance(engine, engines.GrainLoop)), None)


def check_time_step(dt, material, smallest_radius, overlap, lightest=math.inf):
    """Return dt/dt_crit for two smallest grains that overlap by `overlap` radii; UsageError if it is over 1.

    A body whose mass `lightest` is below that of a grain needs a smaller step: frequencies grow as 1/sqrt(mass). So does a
    grain with several contacts: above `material.bed_time_step` a bed would gain energy without any error, so this is refused too.
    """
    grain = material.density * math.pi * smallest_radius**2
    critical = material.critical_time_step(smallest_radius, overlap) * math.sqrt(min(1, lightest / grain))
    if dt > critical:
        pair = "of two touching smallest grains" if lightest >= grain else f"of a body of mass {lightest:.3g}"
        raise UsageError(
            f"time step {dt:.3g} is over the critical {critical:.3g} {pair};"
            f" lower dt_factor, to {0.9 * critical / dt:.2g} times its value or less"
        )
    require_bed_bears(dt, material.bed_time_step(smallest_radius))
    return dt / critical


def require_bed_bears(dt, most):
    """Raise UsageError for a time step above the stable one of a grain with several contacts."""
    if dt > most:
        raise UsageError(
            f"time step {dt:.3g} is over {most:.3g}, above which a grain with six contacts may be unstable: the bed would gain"
            f" energy by itself; lower dt_factor, to {0.99 * most / dt:.2g} times its value or less"
        )


def save(path):
    """Write the whole scene with engines and springs into one file for `load`, in one step, with checksum and version.

    RuntimeError with the system's reason if it cannot be written; an older file is then kept.
    """
    loop = fast_loop()
    if loop:
        loop.sync()
    saved = saved_by_yade()
    if loop:
        loop.checkpoint(str(path), saved)
    else:
        engines.seal_scene(str(path), saved)


def load(path):
    """Continue from a scene that `save` wrote: GrainLoop with the same bits, YADE's loop to round-off.

    RuntimeError with the reason for a file that is damaged, truncated, of another program or of another version.
    """
    from yade import O

    saved = engines.saved_scene(str(path))
    if not saved:
        raise RuntimeError(f"checkpoint {path} holds no YADE scene; build the scene, then use GrainLoop.restore")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / YADES_FILE
        file.write_bytes(saved)
        O.load(str(file))
    loop = fast_loop()
    if loop:
        loop.restore(str(path))


def saved_by_yade():
    """Return the bytes that O.save writes; it writes to memory here, because on a full disk it never returns."""
    from yade import O

    with tempfile.TemporaryDirectory() as folder, os.fdopen(os.memfd_create(YADES_FILE), "rb") as memory:
        file = Path(folder) / YADES_FILE
        file.symlink_to(f"/proc/self/fd/{memory.fileno()}")
        O.save(str(file), True)
        return memory.read()


def rows_of(ids):
    """Return x, y, radius, vx, vy, spin of the bodies `ids`, a dict of arrays of shape (n,).

    In a scene of spheres x, y, z, radius, vx, vy, vz, spin_x, spin_y, spin_z.
    """
    from yade import O

    loop = fast_loop()
    if loop:
        loop.sync()
    table = engines.body_table(O._sceneObj)
    rows = np.searchsorted(table["id"], ids)
    axes = "xyz"[: dimensions()]
    columns = {axis: table["position"][rows, k] for k, axis in enumerate(axes)}
    columns["r"] = table["radius"][rows]
    columns.update({f"v{axis}": table["velocity"][rows, k] for k, axis in enumerate(axes)})
    if len(axes) == 2:
        return {**columns, "spin": table["spin"][rows, 2]}
    return {**columns, **{f"spin_{axis}": table["spin"][rows, k] for k, axis in enumerate(axes)}}


def dimensions():
    """Return 2 for a scene of disks, 3 for spheres: from GrainLoop, else as in `use_grain_loop`; 2 without a loop."""
    from yade import O

    loop = fast_loop()
    if loop:
        return loop.dimensions
    newton = next((engine for engine in O.engines if type(engine).__name__ == "NewtonIntegrator"), None)
    return 2 if newton is None else dimension_rule.of_scene(newton)


def sphere(at, radius, density, blocked=""):
    """Return a YADE body for a sphere at (x, y, z): mass 4/3 pi rho r^3, inertia 2/5 m r^2 about each axis."""
    from yade import utils
    from yade.minieigenHP import Vector3

    body = utils.sphere(tuple(map(float, at)), float(radius))
    body.state.mass = density * 4 / 3 * math.pi * radius**3
    body.state.inertia = Vector3(1, 1, 1) * (0.4 * body.state.mass * radius**2)
    body.state.blockedDOFs = blocked
    return body


def add_spheres(centres, radii, density, blocked=""):
    """Add spheres and return their ids; centres (n, 3) and radii (n,) in length, density, one or (n,), in mass/length^3."""
    from yade import O

    densities = np.broadcast_to(density, len(centres))
    return O.bodies.append([sphere(*row, blocked) for row in zip(centres, radii, densities)])
