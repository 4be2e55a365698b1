"""A drive whose settings change during a run continues from the present position and phase, on both loops."""

import math

import disks
import numpy as np
import pytest
from both_loops import each_loop, put_on, way_of
from disks import EPS, engines
from graindrive.scenes import scene as whole_scene
from yade import O

DT = 1e-3
# A leg begins at the body's position, known to EPS of its size; the closed form adds a few EPS of an angle of some 10 rad, the
# integrator one EPS of the place at every step.
ROUND_OFF = 1e-12


@pytest.fixture(autouse=True)
def scene():
    disks.new_scene(dt=DT)
    yield
    O.reset()


def far_disk():
    """Return the id of a disk at (1, 2); GrainLoop measures sizes by disks, so there is another, far away."""
    body = disks.disk(1, 2)
    disks.disk(50, 50)
    return body


# ---- oscillation ----

BEFORE = dict(amplitude=0.8, period=0.9, phase=0.3)
CHANGES = [
    dict(amplitude=0.3),
    dict(amplitude=2.0),
    dict(period=0.4),
    dict(amplitude=0.3, period=2.0),
    dict(form="velocity"),
    dict(form="velocity", period=0.4),
    dict(direction=(-1, 0, 0)),
    dict(direction=(0, 1, 0)),
    dict(phase=1.1),
    dict(phase=0.3),  # the same value as before, but a new motion starts from it
    dict(phase=-2.0, amplitude=0.1, period=0.7),
]


def displacement(t, amplitude, period, phase, form="displacement", direction=(1, 0, 0)):
    angle = 2 * math.pi * t / period + phase
    if form == "displacement":
        way = amplitude * (math.sin(angle) - math.sin(phase))
    else:
        way = amplitude * period / (2 * math.pi) * (math.cos(phase) - math.cos(angle))
    return way * np.array(direction)


@each_loop
@pytest.mark.parametrize("how", ["properties", "updateAttrs"])
@pytest.mark.parametrize("change", CHANGES)
def test_an_oscillation_goes_on_from_its_place_and_phase(loop, how, change):
    body = far_disk()
    drive = engines.OscillationDrive(body=body, label="drive", **BEFORE)
    put_on(loop, drive)
    before = way_of(body, 130)
    velocity = np.array(O.bodies[body].state.vel)
    if how == "updateAttrs":
        drive.updateAttrs(change)
    else:
        for name, value in change.items():
            setattr(drive, name, value)
    after = way_of(body, 300)
    settings = {**BEFORE, **change}
    if "phase" not in change:
        settings["phase"] = 2 * math.pi * 130 * DT / BEFORE["period"] + BEFORE["phase"]
    expected = np.array([before[-1] + displacement((k + 1) * DT, **settings) for k in range(300)])
    if settings.get("direction") == (0, 1, 0):  # x is free again: it keeps its velocity
        expected[:, 0] += velocity[0] * DT * np.arange(1, 301)
    np.testing.assert_allclose(after, expected, rtol=0, atol=ROUND_OFF)
    # No displacement in a step exceeds that of the largest speed, also not in the first step after the change.
    speed = settings["amplitude"] * (1 if settings.get("form") else 2 * math.pi / settings["period"])
    axis = int(np.argmax(np.abs(settings.get("direction", (1, 0, 0)))))
    steps = np.abs(np.diff(np.r_[before[-1, axis], after[:, axis]]))
    assert steps.max() <= speed * DT * (1 + 1e-9)


@each_loop
def test_the_angle_runs_on_through_many_changes(loop):
    body = far_disk()
    drive = engines.OscillationDrive(body=body, amplitude=0.8, period=1.0)
    put_on(loop, drive)
    x, angle = 1.0, 0.0
    for k in range(60):
        drive.amplitude, drive.period = 0.1 + 0.01 * k, 1.0 - 0.01 * k
        disks.run(7)
        further = angle + 2 * math.pi * 7 * DT / drive.period
        x += drive.amplitude * (math.sin(further) - math.sin(angle))
        angle = further
    # 60 legs add 60 round-offs of position and angle.
    assert O.bodies[body].state.pos[0] == pytest.approx(x, abs=60 * 16 * EPS)


# ---- translation and spin ----


def turned_by(state):
    """Angle of the body about z [rad]."""
    return 2 * math.atan2(state.ori[2], state.ori[3])


@each_loop
def test_a_translation_goes_on_with_another_velocity_and_spin(loop):
    body = far_disk()
    drive = engines.SpinTranslateDrive(body=body, velocity=(1, 0.5, 0), spin=(0, 0, 2))
    put_on(loop, drive)
    before = way_of(body, 100)
    drive.velocity = (2, -1, 0)
    drive.spin = (0, 0, -3)
    after = way_of(body, 100)
    t = DT * np.arange(1, 101)
    expected = before[-1] + np.c_[2 * t, -t, 0 * t]
    np.testing.assert_allclose(after, expected, rtol=0, atol=ROUND_OFF)
    assert turned_by(O.bodies[body].state) == pytest.approx(2 * 0.1 - 3 * 0.1, abs=ROUND_OFF)


@each_loop
def test_a_direction_that_is_no_longer_driven_is_free_again(loop):
    body = far_disk()
    drive = engines.SpinTranslateDrive(body=body, velocity=(1, 0.5, 0), spin=(0, 0, 2))
    put_on(loop, drive, gravity=(0, -10))
    before = way_of(body, 100)
    drive.dofs = "xZ"
    after = way_of(body, 100)
    k = np.arange(1, 101)
    np.testing.assert_allclose(after[:, 0], before[-1, 0] + k * DT, rtol=0, atol=ROUND_OFF)
    # Leapfrog under gravity from the velocity that was imposed: v_k = v - g k dt.
    fall = before[-1, 1] + 0.5 * k * DT - 10 * DT**2 * k * (k + 1) / 2
    np.testing.assert_allclose(after[:, 1], fall, rtol=0, atol=ROUND_OFF)
    drive.dofs = "xyZ"
    caught = way_of(body, 50)
    k = np.arange(1, 51)
    np.testing.assert_allclose(caught[:, 1], after[-1, 1] + 0.5 * k * DT, rtol=0, atol=ROUND_OFF)
    assert O.bodies[body].state.blockedDOFs == "xyzXYZ"  # z, X and Y were blocked before


@each_loop
def test_another_body_is_driven_from_its_own_place_and_the_first_is_free_again(loop):
    first, second = disks.disk(1, 2), disks.disk(20, 5)
    drive = engines.OscillationDrive(body=first, amplitude=0.8, period=0.9)
    put_on(loop, drive)
    disks.run(130)
    place, velocity = np.array(O.bodies[first].state.pos), np.array(O.bodies[first].state.vel)
    drive.body = second
    way = way_of(second, 100)
    angle = 2 * math.pi * 130 * DT / 0.9
    expected = [20 + displacement((k + 1) * DT, 0.8, 0.9, angle)[0] for k in range(100)]
    np.testing.assert_allclose(way[:, 0], expected, rtol=0, atol=10 * ROUND_OFF)
    assert O.bodies[first].state.blockedDOFs == "zXY"
    np.testing.assert_allclose(O.bodies[first].state.pos, place + 100 * DT * velocity, rtol=0, atol=ROUND_OFF)


# ---- drums ----


def rotated(points, centre, angle):
    turn = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
    return centre + (points - centre) @ turn.T


@each_loop
@pytest.mark.parametrize(
    "change, centre, rate",
    [
        (dict(angularVelocity=(0, 0, -5)), (2, -1, 0), -5),
        (dict(axisPoint=(0, 3, 0)), (0, 3, 0), 2),
        (dict(axisPoint=(0, 3, 0), angularVelocity=(0, 0, 1)), (0, 3, 0), 1),
    ],
)
def test_a_drum_goes_on_from_the_places_of_its_bodies(loop, change, centre, rate):
    wall = [disks.disk(2 + 3 * math.cos(a), -1 + 3 * math.sin(a)) for a in (0.0, 1.0, 2.5, 4.0)]
    drum = engines.DrumDrive(bodies=wall, axisPoint=(2, -1, 0), angularVelocity=(0, 0, 2))
    put_on(loop, drum)
    disks.run(150)
    before = np.array([O.bodies[b].state.pos for b in wall])
    drum.updateAttrs(change)
    for k in range(1, 101):
        O.step()
        expected = rotated(before, np.array(centre, float), rate * k * DT)
        now = np.array([O.bodies[b].state.pos for b in wall])
        np.testing.assert_allclose(now, expected, rtol=0, atol=ROUND_OFF)


@each_loop
def test_a_drum_keeps_its_bodies(loop):
    wall = [disks.disk(2, 0), disks.disk(-2, 0)]
    other = disks.disk(7, 7)
    drum = engines.DrumDrive(bodies=wall, angularVelocity=(0, 0, 2))
    put_on(loop, drum)
    disks.run(3)
    with pytest.raises(ValueError, match="bodies cannot change once the drum turns; make a new DrumDrive, got 0, 2"):
        drum.bodies = [wall[0], other]
    assert drum.bodies == wall
    disks.run(3)


# ---- work ----


@each_loop
def test_work_stays_the_energy_of_the_grain_through_a_change(loop):
    # No friction and damping. The sum is exact for each step; the contact's potential is given back to (dt/t_c)^2 (see
    # drives_test.py).
    O.dt = 1e-5
    body, grain = disks.disk(0, 0), disks.disk(1.001, 0)
    drive = engines.SpinTranslateDrive(body=body, velocity=(1, 0, 0))
    put_on(loop, drive, law=disks.hertz())
    state = O.bodies[grain].state
    disks.run(300)
    drive.velocity = (2, 0.3, 0)  # in mid-contact
    disks.run(200)
    pushed = drive.force[0]
    disks.run(9500)
    assert pushed < -1 and drive.force[0] == 0
    assert state.vel[0] > 2
    energy = 0.5 * state.mass * state.vel.squaredNorm()
    assert drive.work == pytest.approx(energy, rel=1e-6)


# ---- restarts ----


def changed_drives():
    ident, _ = disks.clump([(-0.3, 0.1), (0.3, -0.1)], at=(0, 5))
    spinner, turning = disks.disk(8, 0), disks.disk(16, 0)
    disks.disk(1.2, 5)  # a grain hits it
    drives = [
        engines.OscillationDrive(body=ident, label="shake", **BEFORE),
        engines.SpinTranslateDrive(body=spinner, velocity=(1, 0, 0), spin=(0, 0, 2), label="spin"),
        engines.DrumDrive(bodies=[turning], axisPoint=(18, 0, 0), angularVelocity=(0, 0, 1), label="drum"),
    ]
    return drives


def change_all(drives):
    shake, spin, drum = drives
    shake.amplitude, shake.period, shake.phase = 0.5, 0.7, 0.3
    spin.velocity, spin.spin, spin.dofs = (-1, 1, 0), (0, 0, 7), "xyZ"
    drum.angularVelocity = (0, 0, -2)
    drum.dead = True


@each_loop
@pytest.mark.parametrize("where", ["between change and step", "after it", "asleep"])
def test_a_restart_around_a_change_leads_to_the_same_bits(loop, where, tmp_path):
    O.dt = 2e-4
    drives = changed_drives()
    put_on(loop, *drives, law=disks.hertz(), friction=0.3)
    disks.run(600)
    change_all(drives)
    for _ in range({"between change and step": 0, "after it": 1, "asleep": 40}[where]):
        O.step()

    def end():
        disks.engine("drum").dead = False
        disks.run(150)
        kept = [{k: list(v) if hasattr(v, "__len__") else v for k, v in e.dict().items()} for e in O.engines[:-1]]
        return disks.everything().tolist(), [row for row in kept if "leg" in row]

    whole_scene.save(tmp_path / "checkpoint")
    expected = end()
    O.reset()
    whole_scene.load(tmp_path / "checkpoint")
    assert end() == expected
    assert abs(disks.engine("shake").work) > 0
