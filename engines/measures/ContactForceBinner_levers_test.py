"""The torque that ContactForceBinner sums is the one that YADE's loop integrates, for laws with either lever of friction."""

import builtins
import math

import disks
import numpy as np
import pytest
from disks import EPS, engines
from yade import O
from yade.minieigenHP import Vector3
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    ForceResetter,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    Law2_ScGeom_MindlinPhys_Mindlin,
    NewtonIntegrator,
    PyRunner,
)


def ours(law):
    return engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=0.5), law


LAWS = {
    "radius": lambda: ours(disks.hertz(leverArm="radius")),
    "contact point": lambda: ours(disks.hertz(leverArm="contactPoint")),
    "restitution": lambda: ours(engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=5e5)),
    "spring at the contact point": lambda: ours(engines.Law2_ScGeom_ContactPhys_SpringDashpot(leverArm="contactPoint")),
    "Cundall": lambda: (Ip2_FrictMat_FrictMat_FrictPhys(), Law2_ScGeom_FrictPhys_CundallStrack()),
    "Mindlin": lambda: (Ip2_FrictMat_FrictMat_MindlinPhys(), Law2_ScGeom_MindlinPhys_Mindlin()),
}


@pytest.fixture(autouse=True)
def scene():
    disks.new_scene(dt=1e-5)
    yield
    O.reset()


def rubbed_disk():
    """A spinning disk among others that overlap it deeply, with smaller and larger ids, so that it is body 1 or 2 of pairs."""
    for angle in (0.4, 2.0):
        disks.disk(0.8 * math.cos(angle), 0.8 * math.sin(angle), 0.4)
    body = disks.disk(0, 0, spin=3)
    for angle in (3.5, 5.0):
        disks.disk(0.85 * math.cos(angle), 0.85 * math.sin(angle), 0.45)
    return body


def rubbed_clump():
    ident, _ = disks.clump([(-0.3, 0), (0.3, 0.1)], radius=0.4)
    O.bodies[ident].state.angVel = (0, 0, 3)
    O.bodies[ident].state.angMom = (0, 0, 3 * 0.5)
    for x, y in ((-0.9, 0.3), (0.9, 0.4), (0.2, -0.75)):
        disks.disk(x, y, 0.45)
    return ident


def in_the_container(body):
    """Torque about the body's centre in YADE's force container, forces of a clump's members carried over [N m]."""
    centre = O.bodies[body].state.pos
    members = O.bodies[body].shape.members if O.bodies[body].isClump else [body]
    return sum((O.forces.t(m) + (O.bodies[m].state.pos - centre).cross(O.forces.f(m)) for m in members), Vector3.Zero)


@pytest.mark.parametrize("build", [rubbed_disk, rubbed_clump])
@pytest.mark.parametrize("law", LAWS)
def test_the_torque_of_the_contacts_is_what_the_loop_integrates(law, build, monkeypatch):
    body, (maker, law), seen = build(), LAWS[law](), []
    binner = engines.ContactForceBinner(body=body)
    drive = engines.SpinTranslateDrive(body=body, dofs="")  # it prescribes no motion, and only reports

    def look():
        scale = np.abs(binner.forceVectors).sum()
        seen.append((binner.lastTorque[2], drive.torque[2], in_the_container(body)[2], scale))

    monkeypatch.setattr(builtins, "look_at_torques", look, raising=False)  # where PyRunner's command finds it
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()]),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [maker], [law]),
        binner,
        drive,
        PyRunner(command="look_at_torques()", iterPeriod=1),
        NewtonIntegrator(damping=0),
    ]
    disks.run(20)
    bins, drives, container, scale = np.array(seen).T
    assert len(seen) > 15 and np.abs(container).max() > 1e-3
    # Sums of some ten products of forces with arms below 1.
    np.testing.assert_array_less(np.abs(bins - container), 64 * EPS * scale)
    np.testing.assert_array_less(np.abs(drives - container), 64 * EPS * scale)
