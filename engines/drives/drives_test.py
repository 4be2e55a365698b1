"""Prescribed motions follow their closed forms, leave other directions free, and do exactly the work that grains receive."""

import math

import numpy as np
import pytest
from disks import EPS, clump, disk, drives_only, engine, engines, hertz, loop, new_scene, run
from yade import O
from yade.minieigenHP import Quaternion, Vector3

# A closed form is evaluated once per step, so its error does not grow with steps: an argument 2 pi t/T of size a is known to
# a EPS, and so is A sin(a); the product and the sum with x0 add a few EPS of their size. The integrator's x + v dt, with
# v = (X - x)/dt, adds one more of |x|.


def angle_error(t, period):
    return 4 * EPS * (1 + 2 * math.pi * t / period)


@pytest.fixture(autouse=True)
def scene():
    new_scene(dt=1e-3)
    yield
    O.reset()


def displacement(t, amplitude, period, phase, form):
    angle = 2 * math.pi * t / period + phase
    if form == "displacement":
        return amplitude * (math.sin(angle) - math.sin(phase))
    return amplitude * period / (2 * math.pi) * (math.cos(phase) - math.cos(angle))


@pytest.mark.slow
def test_ten_million_steps_keep_to_the_formula():
    bodies = [disk(3.0 * i, 0.0) for i in range(4)]
    amplitude, period, phase, velocity, spin = 1.3, 0.7, 0.4, (0.3, -0.2, 0), 2.0
    drives_only(
        engines.OscillationDrive(body=bodies[0], amplitude=amplitude, period=period, phase=phase),
        engines.OscillationDrive(body=bodies[1], amplitude=amplitude, period=period, phase=phase, form="velocity"),
        engines.SpinTranslateDrive(body=bodies[2], velocity=velocity, spin=(0, 0, spin), dofs="xyzXYZ"),
        engines.DrumDrive(bodies=[bodies[3]], axisPoint=(8, 1, 0), angularVelocity=(0, 0, spin)),
    )
    # Two time steps that are not exact as binary numbers: their sum, as in O.time, would be wrong by 1e-7 in the end.
    t = 0.0
    for dt, steps in ((1e-3, 4_000_000), (0.7e-3, 5_999_000), (1e-3, 1_000)):
        O.dt = dt
        run(steps)
        t += dt * steps
    assert O.iter == 10_000_000
    states = [O.bodies[b].state for b in bodies]
    for state, form, x0 in ((states[0], "displacement", 0.0), (states[1], "velocity", 3.0)):
        expected = x0 + displacement(t, amplitude, period, phase, form)
        assert state.pos[0] == pytest.approx(expected, abs=amplitude * angle_error(t, period) + 4 * EPS * 4)
    assert states[2].pos[0] == pytest.approx(6 + 0.3 * t, rel=4 * EPS)
    assert states[2].pos[1] == pytest.approx(-0.2 * t, rel=4 * EPS)
    expected = Quaternion((0, 0, 1), spin * t)
    turned = abs(states[2].ori[3] * expected[3] + states[2].ori[2] * expected[2])
    assert 1 - turned < angle_error(t, 2 * math.pi / spin)
    error = angle_error(t, 2 * math.pi / spin)
    arm, at = (1.0, -1.0), spin * t
    x = 8 + arm[0] * math.cos(at) - arm[1] * math.sin(at)
    y = 1 + arm[0] * math.sin(at) + arm[1] * math.cos(at)
    assert states[3].pos[0] == pytest.approx(x, abs=2 * error + 32 * EPS)
    assert states[3].pos[1] == pytest.approx(y, abs=2 * error + 8 * EPS)
    assert math.hypot(states[3].pos[0] - 8, states[3].pos[1] - 1) == pytest.approx(math.sqrt(2), abs=32 * EPS)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("form", ["displacement", "velocity"])
@pytest.mark.parametrize("phase", [0.0, 0.5, math.pi / 2, -2.0])
def test_oscillation_follows_its_form(axis, sign, form, phase):
    body = disk(0.25, -0.5)
    state = O.bodies[body].state
    start = np.array(state.pos)
    direction = np.zeros(3)
    direction[axis] = 3.0 * sign  # its length does not matter
    drives_only(
        engines.OscillationDrive(
            body=body, amplitude=0.8, period=0.9, phase=phase, form=form, direction=Vector3(*direction)
        )
    )
    for step in range(1, 2001):
        O.step()
        expected = start.copy()
        expected[axis] += sign * displacement(step * 1e-3, 0.8, 0.9, phase, form)
        np.testing.assert_allclose(state.pos, expected, rtol=0, atol=0.8 * angle_error(2, 0.9) + 4 * EPS)


@pytest.mark.parametrize("form", ["displacement", "velocity"])
def test_velocity_is_the_mid_step_one(form):
    body = disk(0, 0)
    drives_only(engines.OscillationDrive(body=body, amplitude=0.8, period=0.9, phase=0.3, form=form))
    state, dt = O.bodies[body].state, O.dt
    for step in range(500):
        O.step()
        chord = (displacement((step + 1) * dt, 0.8, 0.9, 0.3, form) - displacement(step * dt, 0.8, 0.9, 0.3, form)) / dt
        # A difference of numbers of order 1 over dt: a few EPS/dt.
        assert state.vel[0] == pytest.approx(chord, abs=16 * EPS / dt)
        # As the slope of a chord it is the velocity at the middle of the step, to (omega dt)^2/24.
        angle, omega = 2 * math.pi * (step + 0.5) * dt / 0.9 + 0.3, 2 * math.pi / 0.9
        rate = 0.8 * omega * math.cos(angle) if form == "displacement" else 0.8 * math.sin(angle)
        assert state.vel[0] == pytest.approx(rate, abs=0.8 * omega * (omega * dt) ** 2 / 20)


def test_a_change_of_time_step_neither_stops_nor_jumps():
    body = disk(0, 0)
    drives_only(engines.OscillationDrive(body=body, amplitude=1, period=1, label="drive"))
    t, rng = 0.0, np.random.default_rng(1)
    for _ in range(400):
        O.dt = float(rng.choice([1e-3, 2e-3, 1.7e-4]))
        steps = int(rng.integers(1, 5))
        run(steps) if steps > 3 else [O.step() for _ in range(steps)]
        t += steps * O.dt
        # 400 changes add 400 round-offs of t, each below EPS.
        assert O.bodies[body].state.pos[0] == pytest.approx(math.sin(2 * math.pi * t), abs=8 * 400 * EPS)


def test_what_is_not_driven_falls_as_leapfrog_says():
    bodies = [disk(0, 0, spin=1.5), disk(5, 0, spin=1.5), disk(10, 0, spin=1.5)]
    g, dt, steps = 9.0, O.dt, 700
    drives_only(
        engines.OscillationDrive(body=bodies[0], amplitude=1, period=0.7),
        engines.SpinTranslateDrive(body=bodies[1], velocity=(2, 99, 99), spin=(9, 9, 9), dofs="x"),
        engines.SpinTranslateDrive(body=bodies[2], velocity=(2, 99, 99), spin=(0, 0, 4), dofs="Z"),
        gravity=(0, -g, 0),
    )
    run(steps)
    fall = -g * dt**2 * steps * (steps + 1) / 2
    for body in bodies:
        state = O.bodies[body].state
        # `steps` additions of numbers below |fall| have a round-off of at most EPS |fall| each.
        assert state.pos[1] == pytest.approx(fall, rel=steps * EPS)
        assert state.vel[1] == pytest.approx(-g * steps * dt, rel=steps * EPS)
        assert state.pos[2] == 0
    assert [O.bodies[b].state.angVel[2] for b in bodies] == [1.5, 1.5, 4]
    assert O.bodies[bodies[1]].state.pos[0] == pytest.approx(5 + 2 * steps * dt, rel=4 * EPS)
    assert O.bodies[bodies[2]].state.pos[0] == 10
    assert O.bodies[bodies[2]].state.blockedDOFs == "zXYZ"


def test_spin_and_translation_keep_the_orientation_of_the_closed_form():
    body = disk(1, 2)
    state = O.bodies[body].state
    begin = Quaternion((1, 2, 3), 0.7)
    state.ori = begin
    spin = Vector3(0.3, -1.1, 2.0)
    drives_only(engines.SpinTranslateDrive(body=body, velocity=(1, -2, 3), spin=spin))
    for turn in range(20):
        run(500)
        t = O.iter * O.dt
        expected = Quaternion(spin / spin.norm(), spin.norm() * t) * begin
        # The integrator makes the last step: one rotation by omega dt, which for a constant axis is exact within round-off.
        close = [abs(state.ori[i] - expected[i]) for i in range(4)]
        opposite = [abs(state.ori[i] + expected[i]) for i in range(4)]
        assert min(max(close), max(opposite)) < 8 * EPS * (1 + spin.norm() * t)
        np.testing.assert_allclose(state.pos, [1 + t, 2 - 2 * t, 3 * t], rtol=4 * EPS)
        assert tuple(state.angVel) == tuple(spin)


def relative_places(ident, members):
    centre, ori = O.bodies[ident].state.pos, O.bodies[ident].state.ori
    return np.array([ori.conjugate() * (O.bodies[m].state.pos - centre) for m in members])


@pytest.mark.parametrize("dofs", ["xyzXYZ", "xyZ", "Z", "x"])
def test_a_clump_moves_rigidly(dofs):
    ident, members = clump([(-0.5, 0.2), (0.5, -0.2), (0.3, 0.7), (-0.3, -0.7)], at=(1, 1))
    before, begin = relative_places(ident, members), Quaternion(O.bodies[ident].state.ori)
    drives_only(engines.SpinTranslateDrive(body=ident, velocity=(0.5, -0.25, 0), spin=(0, 0, 3), dofs=dofs))
    run(2000)
    state, t = O.bodies[ident].state, 2.0
    assert state.pos[0] == pytest.approx(1 + 0.5 * t * ("x" in dofs), rel=4 * EPS)
    assert state.pos[1] == pytest.approx(1 - 0.25 * t * ("y" in dofs), rel=4 * EPS)
    turned = 3 * t * ("Z" in dofs)
    # Only a body whose three rotations are all driven is set to the closed form; YADE turns the others step by step.
    tolerance = 32 * EPS if dofs == "xyzXYZ" else 2000 * 4 * EPS
    expected = Quaternion((0, 0, 1), turned) * begin
    assert abs(sum(expected[i] * state.ori[i] for i in range(4))) == pytest.approx(1, abs=tolerance)
    np.testing.assert_allclose(relative_places(ident, members), before, rtol=0, atol=4 * tolerance)
    for m in members:
        arm = O.bodies[m].state.pos - state.pos
        np.testing.assert_allclose(O.bodies[m].state.vel, state.vel + state.angVel.cross(arm), rtol=0, atol=3e-2)


def test_an_oscillating_clump_falls_and_keeps_its_shape():
    ident, members = clump([(-0.5, 0.2), (0.5, -0.2)])
    before = relative_places(ident, members)
    drives_only(engines.OscillationDrive(body=ident, amplitude=1, period=1), gravity=(0, -2, 0))
    run(250)
    state = O.bodies[ident].state
    assert state.pos[0] == pytest.approx(1, abs=8 * EPS)
    assert state.pos[1] == pytest.approx(-2 * O.dt**2 * 250 * 251 / 2, rel=250 * EPS)
    np.testing.assert_allclose(relative_places(ident, members), before, rtol=0, atol=1000 * EPS)


# ---- work ----


def kinetic(body):
    state = O.bodies[body].state
    return 0.5 * state.mass * state.vel.squaredNorm() + 0.5 * state.inertia[2] * state.angVel[2] ** 2


def elastic(k_n, radius_eff):
    """Hertz: integral of K_n sqrt(R) delta^(3/2) over delta."""
    return sum(
        0.4 * k_n * math.sqrt(radius_eff) * i.geom.penetrationDepth**2.5
        for i in O.interactions
        if i.isReal and i.geom.penetrationDepth > 0
    )


@pytest.mark.parametrize("kind", ["disk", "clump"])
def test_work_on_a_struck_grain_becomes_kinetic_energy(kind):
    # No friction and damping: after the contact all the work is in the motion of the grain and of the driven body in
    # its free directions. By the definition of the work the sum of
    # grain and drive is exact for every step except for the contact's potential, which leapfrog gives back to (dt/t_c)^2
    # in the middle of the collision, and far more accurately at its end, where the force is 0: 3e-9 here.
    O.dt = 1e-5
    body = disk(0, 0) if kind == "disk" else clump([(0.2, 0), (-0.2, 0)], radius=0.3)[0]
    grain = disk(1.001, 0.3)
    drive = engines.OscillationDrive(body=body, amplitude=1.0, period=2.0, label="drive")
    loop(hertz(), before_newton=[drive])
    while not any(i.isReal for i in O.interactions):
        run(100)
    while any(i.isReal for i in O.interactions):
        run(100)
    free = O.bodies[body].state
    recoil = 0.5 * free.mass * free.vel[1] ** 2 + 0.5 * free.inertia[2] * free.angVel[2] ** 2
    assert kinetic(grain) > 0.1 and recoil > 0.1
    assert drive.work == pytest.approx(kinetic(grain) + recoil, rel=1e-6)


def test_work_while_in_contact_is_kinetic_plus_elastic_energy():
    # In mid-contact energies at step n need the velocity at n: the mean of the two mid-step ones around it.
    O.dt = 1e-5
    body, grain = disk(0, 0), disk(1.0, 0.0)
    drive = engines.SpinTranslateDrive(body=body, velocity=(1, 0, 0), label="drive")
    loop(hertz(k_n=2e3), before_newton=[drive])
    checked = 0
    run(1000)
    for _ in range(30):
        run(99)
        before, work, potential = O.bodies[grain].state.vel[0], drive.work, elastic(2e3, 0.25)
        # `work` after step n contains the step from n-1/2 to n+1/2; half of this step's work belongs to time n.
        O.step()
        after = O.bodies[grain].state.vel[0]
        contact = [i for i in O.interactions if i.isReal]
        if not contact:
            break
        mass = O.bodies[grain].state.mass
        mean_velocity = 0.5 * (before + after)
        half_way = 0.5 * (work + drive.work)
        # The overlap is that at the start of this step, for which `force` was computed.
        energy = 0.5 * mass * mean_velocity**2 + elastic(2e3, 0.25)
        assert half_way == pytest.approx(energy, rel=1e-4, abs=1e-9)
        checked += potential > 0
    assert checked > 5


def test_spin_does_work_through_friction():
    # A spinning disk sets a grain, which is free to turn only, into rotation by an elastic tangential spring that never
    # slips: work = rotational energy + spring energies. Normal energy is constant as the grain cannot move away.
    O.dt = 1e-5
    spinner, grain = disk(0, 0), disk(0.98, 0)
    O.bodies[grain].state.blockedDOFs = "xyzXY"
    drive = engines.SpinTranslateDrive(body=spinner, spin=(0, 0, 0.5), label="drive")
    k_t = 2.46e5
    loop(hertz(k_t=k_t), friction=100.0, before_newton=[drive])
    root = math.sqrt(0.25 * 0.02)
    for _ in range(10):
        run(37)
        before, work = O.bodies[grain].state.angVel[2], drive.work
        O.step()
        spin = 0.5 * (before + O.bodies[grain].state.angVel[2])
        contact = next(i for i in O.interactions if i.isReal)
        assert not contact.phys.slipping
        # The spring holds s at n+1/2 (s is advanced with the mid-step velocity before the force): an error of order dt/t_c.
        energy = 0.5 * O.bodies[grain].state.inertia[2] * spin**2 + 0.5 * k_t * root * contact.phys.slip.squaredNorm()
        assert 0.5 * (work + drive.work) == pytest.approx(energy, rel=1e-2)
    assert drive.work > 1e-3


def test_only_driven_directions_do_work():
    # A grain falls on a body held in x alone: forces along y move the body, no work is done.
    body = disk(0, 0)
    disk(0, 1.05, velocity=(0, -1))
    O.dt = 1e-5
    drive = engines.OscillationDrive(body=body, amplitude=0, period=1, label="drive")
    loop(before_newton=[drive])
    run(20000)
    assert O.bodies[body].state.vel[1] < -0.5
    assert drive.work == 0


# ---- drums ----


def ring(count, radius):
    angles = 2 * math.pi * np.arange(count) / count
    return [disk(radius * math.cos(a) + 2, radius * math.sin(a) - 1, 0.5, frozen=True) for a in angles]


def test_drum_radii_stay_constant_over_many_turns():
    O.dt = 1e-3
    bodies = ring(12, 2.0)
    drives_only(engines.DrumDrive(bodies=bodies, axisPoint=(2, -1, 0), angularVelocity=(0, 0, 2 * math.pi)))
    start = np.array([O.bodies[b].state.pos for b in bodies]) - [2, -1, 0]
    for _ in range(10):
        run(10_010)  # ten turns and a hundredth
        t = O.iter * O.dt
        angle = 2 * math.pi * t
        turn = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
        now = np.array([O.bodies[b].state.pos for b in bodies]) - [2, -1, 0]
        np.testing.assert_allclose(np.linalg.norm(now, axis=1), 2.0, rtol=0, atol=16 * EPS)
        np.testing.assert_allclose(now, start @ turn.T, rtol=0, atol=2 * angle_error(t, 1.0) + 16 * EPS)
        assert all(tuple(O.bodies[b].state.angVel) == (0, 0, 2 * math.pi) for b in bodies)


def test_drum_work_is_torque_times_angle():
    # Grains tumble in the drum; power is torque x Omega. The chord is shorter than the arc, and the work's force-times-mean
    # velocity differs from torque x Omega dt by (Omega dt)^2, far below 1e-6 here.
    O.dt = 2e-4
    bodies = ring(30, 4.5)
    omega = 0.5
    rng = np.random.default_rng(2)
    for i in range(4):
        for j in range(3):
            disk(0.2 + 1.05 * i + rng.uniform(0, 0.02), -2.2 + 1.05 * j, 0.5)
    drum = engines.DrumDrive(bodies=bodies, axisPoint=(2, -1, 0), angularVelocity=(0, 0, omega), label="drum")
    loop(hertz(gamma_n=250, gamma_t=250), friction=0.5, gravity=(0, -10), before_newton=[drum])
    power = 0.0
    O.step()
    work = drum.work
    for _ in range(3000):
        O.step()
        power -= drum.torque[2] * omega * O.dt
    assert abs(power) > 1
    assert drum.work - work == pytest.approx(power, rel=1e-6)


# ---- periodic cells ----


def test_a_driven_body_crosses_the_period_and_meets_images():
    new_scene(dt=1e-4, period=(10, 10, 10))
    body = disk(1, 5)
    grain = disk(9.8, 5)  # touches the body's image at x = 11 when the body has gone backwards
    drive = engines.SpinTranslateDrive(body=body, velocity=(-2, 0, 0), label="drive")
    binner = engines.ContactForceBinner(body=body, label="binner")
    loop(hertz(), before_newton=[drive, binner])
    touched = 0
    for _ in range(2000):
        O.step()
        if binner.lastContactNumber:
            touched += 1
            assert binner.lastForce[0] >= 0  # pushed back
            # The lever arm points to the image at the left, not across the cell.
            np.testing.assert_allclose(binner.lastTorque, 0, atol=1e-9)
    assert touched > 20
    run(30000)
    t = O.iter * O.dt
    # YADE's positions are not wrapped: several periods away.
    assert O.bodies[body].state.pos[0] == pytest.approx(1 - 2 * t, rel=4 * EPS)
    assert drive.work == pytest.approx(kinetic(grain), rel=1e-5)


def test_the_label_finds_the_drive():
    body = disk(0, 0)
    drives_only(engines.OscillationDrive(body=body, amplitude=1, period=1, label="drive"))
    assert engine("drive").body == body
