"""A drive that was `dead`, or whose body was moved otherwise, continues from the present position and phase, on both loops."""

import builtins
import math

import disks
import numpy as np
import pytest
from both_loops import each_loop, put_on, way_of
from disks import engines
from yade import O
from yade.wrapper import PyRunner

DT = 1e-3
ROUND_OFF = 1e-12  # as in drive_changes_test.py


@pytest.fixture(autouse=True)
def scene():
    disks.new_scene(dt=DT)
    yield
    O.reset()


def oscillation(body):
    return engines.OscillationDrive(body=body, amplitude=0.8, period=0.9, phase=0.3)


def translation(body):
    return engines.SpinTranslateDrive(body=body, velocity=(0.7, 0, 0), spin=(0, 0, 3))


def drum(body):
    return engines.DrumDrive(bodies=[body], axisPoint=(1, 5, 0), angularVelocity=(0, 0, 1.5))


def way(kind, begin, t0, t):
    """The body's position a time `t` after it was at `begin` and the drive had acted for `t0`; t of shape (n,)."""
    if kind is oscillation:
        omega = 2 * math.pi / 0.9
        return begin + np.c_[0.8 * (np.sin(omega * (t0 + t) + 0.3) - np.sin(omega * t0 + 0.3)), 0 * t, 0 * t]
    if kind is translation:
        return begin + np.c_[0.7 * t, 0 * t, 0 * t]
    x, y = begin[0] - 1, begin[1] - 5
    c, s = np.cos(1.5 * t), np.sin(1.5 * t)
    return np.c_[1 + c * x - s * y, 5 + s * x + c * y, begin[2] + 0 * t]


KINDS = pytest.mark.parametrize("kind", [oscillation, translation, drum])


def started(kind, loop, steps=130):
    body = disks.disk(1, 2)
    disks.disk(50, 50)
    drive = kind(body)
    put_on(loop, drive)
    disks.run(steps)
    return body, drive, O.bodies[body].state


@each_loop
@KINDS
def test_a_woken_drive_makes_up_for_nothing(kind, loop):
    body, drive, state = started(kind, loop)
    drive.dead = True
    velocity = np.array(state.vel)
    before = np.array(state.pos)
    disks.run(70)
    # Nothing acts on the body, so it keeps its velocity.
    np.testing.assert_allclose(state.pos, before + 70 * DT * velocity, rtol=0, atol=ROUND_OFF)
    asleep = np.array(state.pos)
    drive.dead = False
    k = np.arange(1, 201)
    np.testing.assert_allclose(way_of(body, 200), way(kind, asleep, 130 * DT, k * DT), rtol=0, atol=ROUND_OFF)
    assert drive.elapsed == pytest.approx(329 * DT, abs=ROUND_OFF)


@each_loop
@KINDS
@pytest.mark.parametrize("asleep", [True, False])
def test_a_body_that_was_moved_is_driven_from_there(kind, loop, asleep):
    body, drive, state = started(kind, loop)
    if asleep:
        drive.dead = True
        disks.run(10)
    state.pos += (0.4, -0.3, 0)
    begin = np.array(state.pos)
    drive.dead = False
    k = np.arange(1, 201)
    np.testing.assert_allclose(way_of(body, 200), way(kind, begin, 130 * DT, k * DT), rtol=0, atol=ROUND_OFF)


@each_loop
def test_a_rest_of_one_step_turns_the_body_no_further_than_its_spin(loop):
    body, drive, state = started(translation, loop)
    drive.dead = True
    disks.run(1)
    state.angVel = (0, 0, 0)  # held still
    disks.run(50)
    turned = 2 * math.atan2(state.ori[2], state.ori[3])
    drive.dead = False
    disks.run(100)
    assert 2 * math.atan2(state.ori[2], state.ori[3]) - turned == pytest.approx(3 * 100 * DT, abs=ROUND_OFF)


@each_loop
@KINDS
def test_time_does_not_jump_when_the_step_count_does(kind, loop):
    body, drive, state = started(kind, loop)
    begin = np.array(state.pos)
    O.resetTime()
    k = np.arange(1, 101)
    np.testing.assert_allclose(way_of(body, 100), way(kind, begin, 130 * DT, k * DT), rtol=0, atol=ROUND_OFF)
    O.dt = DT / 2
    begin = np.array(state.pos)
    np.testing.assert_allclose(way_of(body, 100), way(kind, begin, 230 * DT, k * DT / 2), rtol=0, atol=ROUND_OFF)


@each_loop
def test_a_free_disk_is_driven_from_where_it_is_when_the_drive_first_wakes(loop, monkeypatch):
    body = disks.disk(1, 2, velocity=(0.5, -0.25))
    disks.disk(50, 50)
    drive = oscillation(body)
    drive.dead = True
    monkeypatch.setattr(builtins, "sleeping_drive", drive, raising=False)  # where PyRunner's commands find it
    wake = PyRunner(command="sleeping_drive.dead = False", iterPeriod=1, firstIterRun=150, nDo=1)
    put_on(loop, wake, drive)
    disks.run(400)  # in one run, because GrainLoop does not write a free disk to YADE at every step
    acted = drive.elapsed + DT
    assert acted == pytest.approx(250 * DT, abs=1.5 * DT)  # the runner acts before the drive
    free = 400 * DT - acted
    expected = way(oscillation, np.array([1 + 0.5 * free, 2, 0]), 0.0, np.array([acted]))[0]
    assert O.bodies[body].state.pos[0] == pytest.approx(expected[0], abs=ROUND_OFF)
    assert O.bodies[body].state.pos[1] == pytest.approx(2 - 0.25 * 400 * DT, abs=ROUND_OFF)


@each_loop
def test_steps_asleep_do_no_work(loop):
    O.dt = 1e-5
    body = disks.disk(0, 0)
    disks.disk(1.001, 0)
    drive = engines.SpinTranslateDrive(body=body, velocity=(1, 0, 0))
    put_on(loop, drive, law=disks.hertz())
    disks.run(300)
    work = drive.work
    assert work > 0
    drive.dead = True
    disks.run(50)
    assert drive.work == work
    drive.dead = False
    disks.run(1)
    assert drive.force[0] < -10
    assert drive.work - work == pytest.approx(
        -drive.force[0] * 1.0 * O.dt, rel=1e-9
    )  # W is of order 1e-1 J, with a round-off of 1e-16 of it
