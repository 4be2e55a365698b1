"""Small scenes of disks on YADE's own loop, built the same way for every engine test."""

import math

import numpy as np
from graindrive import engines  # first: it finds YADE
from yade import O, utils
from yade.minieigenHP import Vector3
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    NewtonIntegrator,
)

IN_PLANE = "zXY"  # degrees of freedom that a two-dimensional scene blocks
EPS = np.finfo(float).eps


def new_scene(dt=1e-4, period=None):
    """Begin a new empty scene; `period`: edge lengths of a periodic cell."""
    O.reset()
    O.dt = dt
    if period is not None:
        O.periodic = True
        O.cell.setBox(*period)
    O.materials.append(FrictMat(density=1, young=1e7, poisson=0.3, frictionAngle=0.5))


def disk(x, y, radius=0.5, velocity=(0, 0), spin=0.0, density=1.0, frozen=False):
    """A disk of unit thickness: mass rho pi R^2, moment of inertia m R^2/2.

    It has a colour because YADE's random one reseeds `random` from the clock.
    """
    body = utils.sphere((x, y, 0), radius, color=(1, 1, 1))
    mass = density * math.pi * radius**2
    body.state.mass = mass
    body.state.inertia = Vector3(1, 1, 1) * (mass * radius**2 / 2)
    body.state.blockedDOFs = "xyzXYZ" if frozen else IN_PLANE
    body.state.vel = Vector3(velocity[0], velocity[1], 0)
    body.state.angVel = Vector3(0, 0, spin)
    body.state.angMom = body.state.angVel * body.state.inertia[2]
    return O.bodies.append(body)


def clump(offsets, at=(0.0, 0.0), radius=0.3, mass=2.0, inertia=0.5):
    """Disks glued at `offsets` from the clump's centre `at`; returns (clump id, member ids)."""
    members = [disk(at[0] + dx, at[1] + dy, radius) for dx, dy in offsets]
    ident = O.bodies.clump(members)
    state = O.bodies[ident].state
    state.mass, state.inertia = (
        mass,
        Vector3(1, 1, 1) * inertia,
    )  # keep the orientation, because members' positions refer to it
    state.blockedDOFs = IN_PLANE
    return ident, members


def hertz(k_n=2e5, k_t=2.46e5, gamma_n=0.0, gamma_t=0.0, **others):
    return engines.Law2_ScGeom_ContactPhys_HertzHistory(
        normalStiffness=k_n, tangentialStiffness=k_t, normalDamping=gamma_n, tangentialDamping=gamma_t, **others
    )


def loop(law=None, friction=0.0, before_newton=(), gravity=(0, 0), skin=0.1):
    """YADE's loop with one of Graindrive's laws; drives and measures are placed between contacts and integrator."""
    contacts = InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()],
        [engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=friction)],
        [law or hertz()],
        label="contacts",
    )
    collider = InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=skin, label="collider")
    newton = NewtonIntegrator(damping=0, gravity=(gravity[0], gravity[1], 0), label="newton")
    O.engines = [ForceResetter(), collider, contacts, *before_newton, newton]


def drives_only(*drives, gravity=(0, 0, 0)):
    """No contacts: only drives and the integrator."""
    O.engines = [ForceResetter(), *drives, NewtonIntegrator(damping=0, gravity=gravity, label="newton")]


def run(steps):
    """Run, and fail if the steps were not made: O.run(..., True) loses the exception of an engine that fails at once."""
    target = O.iter + steps
    O.run(steps, True)
    assert O.iter == target, f"the loop stopped at step {O.iter} of {target}"


def engine(label):
    return next(e for e in O.engines if getattr(e, "label", "") == label)


def positions():
    return np.array([b.state.pos for b in O.bodies])


def everything():
    """The state of all bodies, for comparisons to the last bit."""
    return np.array([[*b.state.pos, *b.state.vel, *b.state.ori, *b.state.angVel, *b.state.angMom] for b in O.bodies])


def shaken_bed(skin=0.1):
    """50 disks fall around a shaken clump: contacts, slip, history, every drive, both kernels."""
    new_scene(dt=2e-4)
    rng = np.random.default_rng(5)
    base = [disk(x, 0.0, frozen=True) for x in np.arange(-1.0, 9.0)]
    intruder, _ = clump([(-0.3, 0), (0.3, 0)], at=(3.6, 3.2))
    for row in range(8):
        for column in range(7):
            x, y = 1.1 * column + 0.5 * (row % 2) + rng.uniform(-0.03, 0.03), 1.0 + rng.uniform(0, 0.03) + row
            if math.hypot(x - 3.6, y - 3.2) > 1.2:
                disk(x, y, rng.uniform(0.45, 0.5))
    for y in np.arange(1.0, 9.0):
        disk(-1.2, y, frozen=True)
        disk(8.3, y, frozen=True)
    spinner = disk(1.5, 9.2)
    loop(
        hertz(gamma_n=250, gamma_t=250),
        friction=0.4,
        gravity=(0, -10),
        skin=skin,
        before_newton=[
            engines.OscillationDrive(body=intruder, amplitude=0.1, period=0.5, label="shake"),
            engines.SpinTranslateDrive(body=spinner, velocity=(0, -2.5, 0), spin=(0, 0, 2), label="spin"),
            engines.DrumDrive(bodies=base, axisPoint=(3.5, 20, 0), angularVelocity=(0, 0, 0.05), label="drum"),
            engines.ContactForceBinner(body=intruder, kernel="bins", label="bins"),
            engines.ContactForceBinner(body=base[4], kernel="gaussian", reference="motion", every=3, label="gauss"),
        ],
    )
