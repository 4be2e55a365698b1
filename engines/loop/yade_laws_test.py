"""YADE's own laws and damping on GrainLoop against YADE's own loop: pairs, settling beds, clumps, threads, restarts, take-over.

YADE turns the remembered tangential force to first order, F -= F x (n_old x n_new), which lengthens it by s^2/2 in a step that turns the
contact by s; GrainLoop turns it exactly. `step_exactly` gives YADE a force that its own rule turns into the exact one, so that all else
can be compared to round-off; other tests say how far plain YADE is off.
"""

import math

import disks
import numpy as np
import pytest
from graindrive import grain_loop
from yade import O, utils
from yade.minieigenHP import Vector3
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    Law2_ScGeom_MindlinPhys_Mindlin,
    MatchMaker,
    NewtonIntegrator,
)

PAIR = dict(young=1e6, dt=2e-5)


def constant(value):
    return MatchMaker(algo="val", val=value)


LAWS = {
    "cundallStrack": lambda: (Ip2_FrictMat_FrictMat_FrictPhys(), Law2_ScGeom_FrictPhys_CundallStrack()),
    "hertzMindlin": lambda: (Ip2_FrictMat_FrictMat_MindlinPhys(), Law2_ScGeom_MindlinPhys_Mindlin()),
    "hertzMindlin, damped": lambda: (
        Ip2_FrictMat_FrictMat_MindlinPhys(en=constant(0.6), es=constant(0.8)),
        Law2_ScGeom_MindlinPhys_Mindlin(),
    ),
}
ELASTIC = {"cundallStrack": "shearForce", "hertzMindlin": "shearElastic", "hertzMindlin, damped": "shearElastic"}


def new_scene(young=1e6, dt=2e-5, angle=0.5, period=None):
    disks.new_scene(dt=dt, period=period)
    O.materials.clear() if hasattr(O.materials, "clear") else None
    return O.materials.append(FrictMat(density=1, young=young, poisson=0.3, frictionAngle=angle))


def sphere(x, y, radius=0.5, velocity=(0, 0), spin=0.0, frozen=False):
    """A sphere as utils.sphere makes it, with a sphere's mass and inertia, kept in the plane."""
    body = utils.sphere((x, y, 0), radius, color=(1, 1, 1), material=O.materials[len(O.materials) - 1])
    body.state.vel, body.state.angVel = Vector3(*velocity, 0), Vector3(0, 0, spin)
    body.state.blockedDOFs = "xyzXYZ" if frozen else "zXY"
    return O.bodies.append(body)


def engines_of(law, damping=0.0, gravity=0.0, **newton):
    ip2, law2 = LAWS[law]()
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.1),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [ip2], [law2]),
        NewtonIntegrator(damping=damping, gravity=(0, gravity, 0), **newton),
    ]


def step_exactly(steps, law):
    """YADE's loop with the remembered force turned exactly: F is set so that YADE's first-order rule makes of it F_t t_new."""
    name = ELASTIC[law]
    for _ in range(steps):
        for contact in O.interactions:
            if not contact.isReal:
                continue
            old = contact.geom.normal
            branch = O.bodies[contact.id2].state.pos - O.bodies[contact.id1].state.pos
            new = branch / branch.norm()
            force = getattr(contact.phys, name).dot(Vector3(-old[1], old[0], 0))
            s = old[0] * new[1] - old[1] * new[0]
            x, y = -new[1] * force, new[0] * force
            setattr(contact.phys, name, Vector3((x + s * y), (y - s * x), 0) / (1 + s * s))
        O.step()


def moving_parts():
    return np.array([[*b.state.pos, *b.state.vel, b.state.angVel[2]] for b in O.bodies])


# Equal and unequal disks; what they do while they touch.
IMPACTS = {
    "sticking": dict(radii=(0.5, 0.5), velocities=((1, 0.05), (-1, -0.05)), spins=(0.1, 0.1)),
    "sliding": dict(radii=(0.5, 0.5), velocities=((1, 2), (-1, -1)), spins=(3, -1)),
    "rotating": dict(radii=(0.5, 0.5), velocities=((1, 0), (-1, 0)), spins=(8, 8)),
    "unequal": dict(radii=(0.5, 0.2), velocities=((1, 0.3), (-1, -0.2)), spins=(3, -7)),
    "unequal, sliding": dict(radii=(0.2, 0.6), velocities=((1, 2), (-1, -1)), spins=(9, 2)),
    "head-on": dict(radii=(0.5, 0.4), velocities=((1, 0), (-1, 0)), spins=(0, 0)),
}


def impact(law, radii, velocities, spins, frozen=None, damping=0.0):
    new_scene(**PAIR)
    reach = sum(radii)
    for k in range(2):
        at = (0, 0) if k == 0 else (reach * math.cos(0.3), reach * math.sin(0.3))
        held = k == frozen
        sphere(*at, radii[k], (0, 0) if held else velocities[k], 0 if held else spins[k], frozen=held)
    engines_of(law, damping=damping)


def contact_steps(law, **case):
    """How many steps the impact lasts."""
    impact(law, **case)
    for step in range(1, 2000):
        O.step()
        if step > 2 and not any(i.isReal for i in O.interactions):
            return step
    raise AssertionError("the disks do not part")


@pytest.mark.parametrize("frozen", [None, 0])
@pytest.mark.parametrize("case", IMPACTS)
@pytest.mark.parametrize("law", LAWS)
def test_an_impact_is_yades_to_round_off_where_yade_turns_forces_exactly(law, case, frozen):
    steps = contact_steps(law, **IMPACTS[case], frozen=frozen) + 5
    assert steps > 20
    impact(law, **IMPACTS[case], frozen=frozen)
    step_exactly(steps, law)
    expected = moving_parts()
    impact(law, **IMPACTS[case], frozen=frozen)
    grain_loop.use_grain_loop()
    disks.run(steps)
    # Overlaps of 1e-3 are differences of numbers of 1, so forces are known to 1e-13 of themselves; velocities are of the order of 10.
    np.testing.assert_allclose(moving_parts(), expected, rtol=0, atol=1e-12)
