"""Builds scenes of spheres in YADE: a box periodic in x and y, a base, a lid of heavy grains, a solid, and the time loop."""

from types import SimpleNamespace

import numpy as np

from ..loops import contact_springs, grain_loop
from ..lazily import engines
from . import scene
from ..solids import surfaces
from ..base.errors import UsageError


def start(width, breadth, height):
    """Empty YADE's scene and make it periodic in x and y; z is longer than `height` [m], so that no body reaches its image."""
    from yade import O

    O.reset()
    O.periodic = True
    O.cell.setBox(width, breadth, 4 * height)


def lattice(width, breadth, d, z):
    """Return centres (n, 3) of a square lattice of spheres about d apart at height z, continuous across periodic sides."""
    columns, rows = max(1, round(width / d)), max(1, round(breadth / d))
    i, j = (index.ravel() for index in np.mgrid[0:columns, 0:rows])
    return np.c_[(i + 0.5) * width / columns, (j + 0.5) * breadth / rows, np.full(i.size, float(z))]


def add_base(width, breadth, d, density):
    """Add a layer of spheres on a square lattice at z = 0, glued together and held, as one clump; return its id."""
    from yade import O

    layer = lattice(width, breadth, d, 0.0)
    clump, _ = O.bodies.appendClumped([scene.sphere(centre, d / 2, density) for centre in layer])
    O.bodies[clump].state.blockedDOFs = "xyzXYZ"
    return clump


def add_solid(surface, at):
    """Add a held solid at `at` (3,) [m]; return its id."""
    from yade import O, FrictMat

    if not O.materials:
        O.materials.append(FrictMat())
    return O.bodies.append(surfaces.body(surface, position=tuple(map(float, at))))


def yade_loop(material, gravity, between=()):
    """Put YADE's own loop for spheres and solids into O.engines; `between` are engines before the integrator."""
    from yade import O
    from yade import wrapper as w

    law = engines.Law2_ScGeom_ContactPhys_HertzRestitution(**material.given())
    phys = engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=material.friction)
    O.engines = [
        w.ForceResetter(),
        w.InsertionSortCollider(
            [w.Bo1_Sphere_Aabb(), engines.Bo1_Solid_Aabb()], allowBiggerThanPeriod=True
        ),  # endless solids
        w.InteractionLoop([w.Ig2_Sphere_Sphere_ScGeom(), engines.Ig2_Solid_Sphere_ScGeom()], [phys], [law]),
        *between,
        w.NewtonIntegrator(damping=0, gravity=tuple(gravity)),
    ]


def run_on_grain_loop(material, gravity, between=(), springs=((), ()), **settings):
    """Put GrainLoop into O.engines and return it; `springs` are the attributes springs and wallSprings of an earlier scene."""
    from yade import O

    require_one_image()
    yade_loop(material, gravity, between)
    remembered = dict(springs=[*map(float, springs[0])], wallSprings=[*map(float, springs[1])])
    periods = (O.cell.size[0], O.cell.size[1], 0)
    return grain_loop.use_grain_loop(periods=periods, dimensions=3, label="loop", **remembered, **settings)


def run_on_yade_loop(material, gravity, between=(), springs=((), ())):
    """Put YADE's own loop into O.engines with the springs of an earlier scene; a step with dt = 0 finds the contacts."""
    from yade import O

    require_one_image()
    yade_loop(material, gravity)
    contacts, dt, O.dt = O.engines[2], O.dt, 0
    O.run(1, True)
    O.dt = dt
    engines.set_clock(O._sceneObj, 0, 0.0)
    given = SimpleNamespace(dimensions=3, springs=[*map(float, springs[0])], wallSprings=[*map(float, springs[1])])
    contact_springs.give_springs(contacts, given)
    O.engines = [*O.engines[:-1], *between, O.engines[-1]]


def require_one_image():
    """Raise UsageError if the box is so short along x or y that two largest spheres could touch through two images at once."""
    from yade import O

    radius = engines.body_table(O._sceneObj)["radius"].max()
    for axis, length in zip("xy", O.cell.size):
        if 4 * radius > length:
            raise UsageError(
                f"the period in {axis} must be at least {4 * radius:g} m, got {length:g}: spheres of radius {radius:g} m could"
                " touch through two of their images; make it longer"
            )


def halt():
    """Set all velocities and spins to zero; contacts keep their tangential springs."""
    from yade import O
    from yade.minieigenHP import Vector3

    loop = scene.fast_loop()
    loop.sync()
    for body in O.bodies:
        body.state.vel = body.state.angVel = body.state.angMom = Vector3.Zero
    loop.read()


def set_velocity(ids, velocity):
    """Give all these bodies the same velocity (3,) [m/s], before the first step."""
    from yade import O
    from yade.minieigenHP import Vector3

    for id_ in ids:
        O.bodies[id_].state.vel = Vector3(*map(float, velocity))


def load_all(ids, force):
    """Apply a constant force (3,) [N] to each of these bodies, under either loop."""
    from yade import O
    from yade import wrapper as w

    loop = scene.fast_loop()
    if loop:
        for id_ in ids:
            loop.setLoad(id_, force)
    else:
        O.engines = [*O.engines[:-1], w.ForceEngine(ids=list(ids), force=force), O.engines[-1]]


def check_time_step(dt, material, smallest_radius, overlap):
    """Return dt/dt_crit for two smallest spheres that overlap by `overlap` radii; UsageError if it is over 1."""
    critical = material.critical_time_step(smallest_radius, overlap)
    if dt > critical:
        raise UsageError(
            f"time step {dt:.3g} s is over the critical {critical:.3g} s of two touching smallest grains;"
            f" lower dt_factor, to {0.9 * critical / dt:.2g} times its value or less"
        )
    return dt / critical
