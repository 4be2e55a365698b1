"""Small scenes of spheres on YADE's own loop, built the same way for every engine test; scenes begin with `disks.new_scene`."""

import math

import numpy as np
from disks import engines, hertz
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
