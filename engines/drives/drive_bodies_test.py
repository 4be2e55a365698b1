"""Bodies that a drive refuses on both loops, and bodies that it accepts only after a change during the run."""

import disks
import numpy as np
import pytest
from both_loops import each_loop, put_on, way_of
from disks import engines
from yade import O

DT = 1e-3

DRIVES = {
    "oscillation": lambda body: engines.OscillationDrive(body=body, amplitude=1),
    "spin": lambda body: engines.SpinTranslateDrive(body=body, velocity=(1, 0, 0)),
    "drum": lambda body: engines.DrumDrive(bodies=[body], angularVelocity=(0, 0, 1)),
}
each_drive = pytest.mark.parametrize("kind", DRIVES)


@pytest.fixture(autouse=True)
def scene():
    disks.new_scene(dt=DT)
    yield
    O.reset()


@each_loop
@each_drive
def test_a_member_of_a_clump_is_moved_by_its_clump(loop, kind):
    ident, members = disks.clump([(-0.3, 0), (0.3, 0)])
    disks.disk(9, 9)
    put_on(loop, DRIVES[kind](members[0]))
    with pytest.raises(
        RuntimeError, match=f"body {members[0]} is a member of clump {ident}, which moves it; drive the clump"
    ):
        O.step()


@each_loop
@each_drive
def test_a_body_that_is_not_there_is_refused(loop, kind):
    disks.disk(9, 9)
    put_on(loop, DRIVES[kind](7))
    with pytest.raises(RuntimeError, match="body 7 does not exist in this scene"):
        O.step()


@each_loop
@each_drive
def test_an_erased_body_is_refused(loop, kind):
    body = disks.disk(0, 0)
    disks.disk(9, 9)
    put_on(loop, DRIVES[kind](body))
    disks.run(5)
    O.bodies.erase(body)
    with pytest.raises(RuntimeError, match=f"body {body} (does not exist in this scene|was erased)"):
        O.step()


@each_loop
def test_a_refused_body_does_not_spoil_the_motion_of_the_one_before(loop):
    body = disks.disk(1, 2)
    _, members = disks.clump([(-0.3, 0), (0.3, 0)], at=(20, 20))
    drive = DRIVES["spin"](body)
    put_on(loop, drive)
    disks.run(20)
    drive.body = members[0]
    with pytest.raises(RuntimeError, match="is a member of clump"):
        O.step()
    drive.body = body
    way = way_of(body, 20)
    np.testing.assert_allclose(way[:, 0], 1 + DT * np.arange(21, 41), rtol=0, atol=1e-13)
    assert drive.legTime == 0  # the leg goes on


@each_loop
def test_a_member_that_was_released_is_driven_from_where_it_is(loop):
    ident, members = disks.clump([(-0.3, 0), (0.3, 0), (0, 0.5)], at=(5, 5))
    O.bodies[ident].state.vel = (1, 0, 0)
    disks.disk(20, 20)
    put_on(loop)
    disks.run(50)
    O.bodies.releaseFromClump(members[1], ident)
    begin = np.array(O.bodies[members[1]].state.pos)
    assert begin[0] > 5.3
    drive = engines.SpinTranslateDrive(body=members[1], velocity=(0, 2, 0))
    O.engines = [*O.engines[:-1], drive, O.engines[-1]]
    if loop == "grain":
        O.engines[-1].read()
    way = way_of(members[1], 30)
    expected = begin + np.outer(DT * np.arange(1, 31), (0, 2, 0))
    np.testing.assert_allclose(way, expected, rtol=0, atol=1e-13)
