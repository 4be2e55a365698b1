"""A scene that fails under an engine gives one clear error; the process and the next scene work."""

import threading

import pytest
from disks import clump, disk, drives_only, engines, hertz, loop, new_scene, run
from yade import O
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    ForceResetter,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    NewtonIntegrator,
    PyRunner,
)


@pytest.fixture(autouse=True)
def scene():
    new_scene()
    yield
    O.reset()


def engine_on(kind, body):
    if kind == "drum":
        return engines.DrumDrive(bodies=[body], angularVelocity=(0, 0, 1))
    if kind == "binner":
        return engines.ContactForceBinner(body=body)
    if kind == "spin":
        return engines.SpinTranslateDrive(body=body, velocity=(1, 0, 0))
    return engines.OscillationDrive(body=body, amplitude=1)


KINDS = ["drum", "binner", "spin", "oscillation"]


def a_new_scene_runs():
    new_scene()
    body = disk(0, 0)
    drives_only(engine_on("spin", body))
    run(100)
    return O.bodies[body].state.pos[0] == pytest.approx(0.01, rel=1e-13)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("body", [-1, 1, 1000])
def test_a_body_that_never_was(kind, body):
    disk(0, 0)
    drives_only(engine_on(kind, body))
    for _ in range(2):
        with pytest.raises(RuntimeError, match=f"body {body} does not exist in this scene"):
            O.step()
    assert a_new_scene_runs()


@pytest.mark.parametrize("kind", KINDS)
def test_the_driven_body_is_erased(kind):
    body = disk(0, 0)
    disk(0.9, 0)
    loop(before_newton=[engine_on(kind, body)])
    run(5)
    O.bodies.erase(body)
    with pytest.raises(RuntimeError, match=f"body {body} does not exist in this scene"):
        O.step()
    assert a_new_scene_runs()


@pytest.mark.parametrize("kind", KINDS)
def test_a_member_of_the_driven_clump_is_erased(kind):
    ident, members = clump([(-0.3, 0), (0.3, 0), (0, 0.5)])
    disk(0, 1.2)
    loop(before_newton=[engine_on(kind, ident)])
    run(5)
    O.bodies.erase(members[1])
    run(5)
    assert a_new_scene_runs()


@pytest.mark.parametrize("kind", KINDS)
def test_the_driven_clump_is_erased(kind):
    ident, members = clump([(-0.3, 0), (0.3, 0)])
    disk(0, 1.2)
    loop(before_newton=[engine_on(kind, ident)])
    run(5)
    O.bodies.erase(ident)
    with pytest.raises(RuntimeError, match=f"body {ident} does not exist in this scene"):
        O.step()
    assert a_new_scene_runs()


def test_a_released_member_counts_no_more():
    ident, members = clump([(-1, 0), (1, 0), (0, 0)], radius=0.5)
    for x in (-1, 1):
        disk(x, 0.9, frozen=True)
    O.bodies[ident].state.blockedDOFs = "xyzXYZ"
    binner = engines.ContactForceBinner(body=ident)
    loop(before_newton=[binner])
    run(1)
    assert binner.lastContactNumber == 2
    O.bodies.releaseFromClump(members[1], ident)
    run(1)
    assert binner.lastContactNumber == 1


def test_a_failing_run_in_the_background_reaches_the_one_who_waits():
    body = disk(0, 0)
    erase = PyRunner(command=f"O.bodies.erase({body})", iterPeriod=1, firstIterRun=200000)
    drives_only(erase, engine_on("oscillation", body))
    caught = []

    def wait():
        try:
            O.wait()
        except RuntimeError as error:
            caught.append(str(error))

    O.run(400000)
    waiting = threading.Thread(target=wait)
    waiting.start()
    waiting.join(60)
    assert caught == [
        f"OscillationDrive: body {body} does not exist in this scene; give the id that O.bodies.append returned"
    ]
    assert O.iter <= 200000
    assert a_new_scene_runs()


def test_a_law_behind_yades_contact_maker_gives_the_same_forces():
    # The functor runs in an OpenMP loop, where an error would end the process; all that it needs is in the two bodies.
    forces = []
    for maker in (engines.Ip2_FrictMat_FrictMat_ContactPhys(), Ip2_FrictMat_FrictMat_FrictPhys()):
        new_scene()
        disk(0, 0, velocity=(1, 0.3))
        disk(0.95, 0, radius=0.6)
        O.engines = [
            ForceResetter(),
            InsertionSortCollider([Bo1_Sphere_Aabb()]),
            InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [maker], [hertz(gamma_n=250, gamma_t=250)]),
            NewtonIntegrator(damping=0),
        ]
        run(3)
        forces.append([*O.forces.f(0), *O.forces.f(1), *O.forces.t(0), *O.forces.t(1)])
    assert forces[0] == forces[1] and forces[0][0] < 0 and forces[0][1] < 0


def test_the_drum_cannot_get_new_bodies_while_it_turns():
    first, second = disk(0, 0), disk(3, 0)
    drum = engines.DrumDrive(bodies=[first], angularVelocity=(0, 0, 1))
    drives_only(drum)
    run(1)
    with pytest.raises(ValueError, match="bodies cannot change once the drum turns"):
        drum.bodies = [first, second]
    assert drum.bodies == [first]
    run(1)


def test_an_engine_called_by_hand_without_a_body_raises():
    with pytest.raises(RuntimeError, match="body 0 does not exist"):
        engines.OscillationDrive(body=0)()
