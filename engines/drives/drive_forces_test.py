"""The force, torque and work of a drive are those of the grains, whatever else acts on the driven body."""

import disks
import numpy as np
import pytest
from both_loops import each_loop, put_on
from disks import engines
from yade import O
from yade.minieigenHP import Vector3
from yade.wrapper import (
    Bo1_Box_Aabb,
    Bo1_Sphere_Aabb,
    ForceEngine,
    ForceResetter,
    FrictMat,
    Ig2_Box_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    NewtonIntegrator,
    TorqueEngine,
)


@pytest.fixture(autouse=True)
def scene():
    disks.new_scene(dt=1e-4)
    yield
    O.reset()


def pressed_clump():
    """A driven clump between two frozen disks that press on it with different forces; return its id."""
    ident, _ = disks.clump([(-0.3, 0), (0.3, 0)], at=(0, 0))
    disks.disk(-0.45, 0.77, frozen=True)
    disks.disk(1.07, 0.12, frozen=True)
    disks.disk(9, 9)
    return ident


def pressed_disk():
    """A driven disk between the same; return its id."""
    body = disks.disk(0, 0, 0.3)
    disks.disk(-0.45, 0.63, frozen=True)
    disks.disk(0.77, 0.12, frozen=True)
    disks.disk(9, 9)
    return body


def felt(loop, build=pressed_clump, outside=()):
    """Force, torque and work that a drive reports after some steps while forces from outside act on its body."""
    disks.new_scene(dt=1e-4)
    body = build()
    drive = engines.SpinTranslateDrive(body=body, velocity=(0.2, 0.1, 0), spin=(0, 0, 0.5))
    pushed = [body, *(O.bodies[body].shape.members if O.bodies[body].isClump else [])]
    others = []
    if "force" in outside:
        others.append(ForceEngine(ids=pushed, force=(50, -20, 0)))
    if "torque" in outside:
        others.append(TorqueEngine(ids=pushed, moment=(0, 0, 7)))
    put_on(loop, *others, drive, friction=0.5)
    if "permanent" in outside:
        for id_ in pushed:
            O.forces.setPermF(id_, (50, -20, 0))
            O.forces.setPermT(id_, (0, 0, 3))
    disks.run(50)
    return [*drive.force, *drive.torque, drive.work]


@each_loop
@pytest.mark.parametrize("build", [pressed_disk, pressed_clump])
@pytest.mark.parametrize("outside", ["force", "torque", "permanent"])
def test_outside_forces_are_not_the_grains(loop, build, outside):
    alone = felt(loop, build)
    assert abs(alone[0]) > 0.1 and abs(alone[5]) > 1e-4 and abs(alone[6]) > 1e-6
    assert felt(loop, build, [outside]) == alone


@pytest.mark.parametrize("build", [pressed_disk, pressed_clump])
def test_both_loops_feel_the_same(build):
    # The same contacts, forces added in another order.
    np.testing.assert_allclose(felt("grain", build), felt("yade", build), rtol=1e-12, atol=1e-12)


def test_a_sleeping_interaction_loop_exerts_no_force():
    ident = pressed_clump()
    drive = engines.SpinTranslateDrive(body=ident)
    disks.loop(before_newton=[drive])
    disks.run(5)
    assert drive.force.norm() > 1
    disks.engine("contacts").dead = True
    disks.run(1)
    assert drive.force.norm() == 0


def test_a_driven_box_feels_its_contacts_about_its_centre():
    # YADE's own law on a box: force at the contact point, torque about the box's centre.
    from yade import utils

    box = utils.box(center=(0, 0, 0), extents=(2, 0.5, 0.5), fixed=True, color=(1, 1, 1))
    paddle = O.bodies.append(box)
    disks.disk(1.2, 0.95, velocity=(1, 0))
    drive = engines.SpinTranslateDrive(body=paddle)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_FrictPhys()],
            [Law2_ScGeom_FrictPhys_CundallStrack(sphericalBodies=False)],
        ),
        drive,
        NewtonIntegrator(damping=0),
    ]
    disks.run(5)
    assert drive.force.norm() > 1 and abs(drive.torque[2]) > 1
    np.testing.assert_allclose(drive.force, O.forces.f(paddle), rtol=1e-13)
    np.testing.assert_allclose(drive.torque, O.forces.t(paddle), rtol=1e-12, atol=1e-12 * drive.torque.norm())


def test_a_contact_that_cannot_be_read_is_refused():
    from yade.wrapper import Ig2_Sphere_Sphere_L3Geom, Law2_L3Geom_FrictPhys_ElPerfPl

    body = disks.disk(0, 0)
    disks.disk(0.9, 0)
    for make in (
        lambda: engines.SpinTranslateDrive(body=body),
        lambda: engines.ContactForceBinner(body=body),
    ):
        O.engines = [
            ForceResetter(),
            InsertionSortCollider([Bo1_Sphere_Aabb()]),
            InteractionLoop(
                [Ig2_Sphere_Sphere_L3Geom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_L3Geom_FrictPhys_ElPerfPl()]
            ),
            make(),
            NewtonIntegrator(damping=0),
        ]
        with pytest.raises(
            RuntimeError, match="force of a contact on body 0 is not known: it is a L3Geom with FrictPhys"
        ):
            O.step()
    assert isinstance(O.materials[0], FrictMat) and Vector3(0, 0, 0) == O.bodies[body].state.vel
