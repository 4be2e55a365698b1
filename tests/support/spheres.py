"""Small scenes of spheres on YADE's own loop, built the same way for every engine test; scenes begin with `disks.new_scene`."""

import math

import numpy as np
from disks import engines, hertz, new_scene
from yade import O, utils
from yade.minieigenHP import Vector3
from yade.wrapper import (
    Bo1_Box_Aabb,
    Bo1_Sphere_Aabb,
    Bo1_Wall_Aabb,
    ForceResetter,
    Ig2_Box_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    NewtonIntegrator,
)


def sphere(at, radius=0.5, velocity=(0, 0, 0), spin=(0, 0, 0), density=1.0, blocked=""):
    """A sphere of mass 4/3 pi rho R^3 and moment of inertia 2/5 m R^2; `blocked` as in YADE's blockedDOFs."""
    body = utils.sphere(tuple(map(float, at)), radius, color=(1, 1, 1))
    mass = density * 4 / 3 * math.pi * radius**3
    body.state.mass, body.state.inertia = mass, Vector3(1, 1, 1) * (0.4 * mass * radius**2)
    body.state.blockedDOFs = blocked
    body.state.vel, body.state.angVel = Vector3(*velocity), Vector3(*spin)
    body.state.angMom = body.state.angVel * body.state.inertia[0]
    return O.bodies.append(body)


def free_clump(places, radius=0.3):
    """Spheres glued at `places`, free to move, with the mass and principal moments of all; returns (clump id, member ids)."""
    members = [sphere(place, radius) for place in places]
    return O.bodies.clump(members), members


def spin_up(ident, spin):
    """Give a clump or an aspherical body a spin, with the angular momentum that belongs to it."""
    state = O.bodies[ident].state
    state.angVel = Vector3(*spin)
    in_frame = state.ori.conjugate() * state.angVel
    state.angMom = state.ori * Vector3(*(state.inertia[k] * in_frame[k] for k in range(3)))


def frozen(at, radius=0.5, velocity=(0, 0, 0)):
    """A sphere that keeps its velocity."""
    return sphere(at, radius, velocity, blocked="xyzXYZ")


def clump(offsets, at=(0, 0, 0), radius=0.3):
    """Spheres glued at `offsets` from the clump's centre `at`, which keeps its motion; returns (clump id, member ids)."""
    members = [sphere(np.add(at, offset), radius) for offset in offsets]
    ident = O.bodies.clump(members)
    O.bodies[ident].state.blockedDOFs = "xyzXYZ"
    return ident, members


def loop(law=None, friction=0.0, before_newton=(), gravity=(0, 0, 0), damping=0.0):
    """YADE's loop with one of Graindrive's laws for spheres, walls and boxes; drives and measures stand before the integrator."""
    contacts = InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()],
        [engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=friction)],
        [law or hertz()],
        label="contacts",
    )
    collider = InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Box_Aabb()], verletDist=0.1)
    newton = NewtonIntegrator(damping=damping, gravity=gravity, label="newton")
    O.engines = [ForceResetter(), collider, contacts, *before_newton, newton]


def grain_loop(law=None, friction=0.0, before_newton=(), gravity=(0, 0, 0), **settings):
    """The same on GrainLoop; return it. `settings` go to GrainLoop."""
    law = law or hertz()
    known = engines.GrainLoop().dict()
    given = {name: value for name, value in law.dict().items() if name in known and name not in ("label", "friction")}
    name = type(law).__name__.rsplit("_", 1)[-1]
    given["law"] = name[0].lower() + name[1:]
    given["periods"] = (O.cell.size[0], O.cell.size[1], 0) if O.periodic else (0, 0, 0)
    made = {"dimensions": 3, "friction": friction, "gravity": gravity, **given, **settings}
    O.engines = [*before_newton, engines.GrainLoop(label="newton", **made)]
    return O.engines[-1]


def bed(layers=4, side=5, seed=3, speed=0.2, periodic=True, base=True):
    """A jittered lattice of spheres that falls and shears above a held base; periodic in x and y."""
    new_scene(dt=2e-4, period=(side, side, 100) if periodic else None)
    rng = np.random.default_rng(seed)
    for k in range(layers + 1):
        for j in range(side):
            for i in range(side):
                place = np.array([i + 0.5, j + 0.5, k + 1.0]) + rng.uniform(-0.02, 0.02, 3)
                radius = rng.uniform(0.46, 0.5)
                if k == 0 and base:
                    frozen(place, radius)
                else:
                    sphere(place, radius, rng.uniform(-speed, speed, 3), rng.uniform(-speed, speed, 3))
