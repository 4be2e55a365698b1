"""The laws in YADE's InteractionLoop: momentum, angular momentum, and the effective masses of contacts."""

import math

import numpy as np
import pytest
from disks import EPS, clump, disk, engines, hertz, loop, new_scene, run
from yade import O

LAWS = {
    "hertz_history": lambda lever: hertz(2e5, 2.46e5, 250, 250, leverArm=lever),
    "hertz_restitution": lambda lever: engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=5e5, leverArm=lever),
    "spring_dashpot": lambda lever: engines.Law2_ScGeom_ContactPhys_SpringDashpot(leverArm=lever),
}


@pytest.fixture(autouse=True)
def scene():
    new_scene(dt=1e-4)
    yield
    O.reset()


def total_momentum():
    return sum((b.state.mass * np.array(b.state.vel) for b in O.bodies), np.zeros(3))


def total_angular_momentum():
    """About the origin, with positions at n and velocities at n-1/2: conserved by leapfrog when pair torques cancel."""
    total = 0.0
    for b in O.bodies:
        s = b.state
        total += s.mass * (s.pos[0] * s.vel[1] - s.pos[1] * s.vel[0]) + s.inertia[2] * s.angVel[2]
    return total


def cloud(seed):
    rng = np.random.default_rng(seed)
    for i in range(5):
        for j in range(5):
            x, y = 0.96 * np.array([i, j]) + rng.uniform(-0.02, 0.02, 2)
            disk(x, y, rng.uniform(0.45, 0.52), rng.uniform(-1, 1, 2), rng.uniform(-2, 2))


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("lever", ["radius", "contactPoint"])
def test_momentum_is_conserved_to_round_off(law, lever):
    cloud(1)
    loop(LAWS[law](lever), friction=0.3)
    before = total_momentum()
    run(500)
    # 25 disks of momentum 1, with a round-off of EPS in each velocity in each of 500 steps.
    np.testing.assert_allclose(total_momentum(), before, rtol=0, atol=25 * 500 * EPS)


@pytest.mark.parametrize("law", LAWS)
def test_angular_momentum_is_conserved_when_forces_act_at_the_contact_point(law):
    cloud(2)
    loop(LAWS[law]("contactPoint"), friction=0.3)
    O.step()
    before, spins = total_angular_momentum(), [b.state.angVel[2] for b in O.bodies]
    run(500)
    assert max(abs(b.state.angVel[2] - s) for b, s in zip(O.bodies, spins)) > 0.1  # there was friction
    # 25 disks with lever arms of up to 6: that of the momentum times 6.
    assert total_angular_momentum() == pytest.approx(before, abs=6 * 25 * 500 * EPS)


@pytest.mark.parametrize("law", LAWS)
def test_radius_as_lever_arm_adds_exactly_the_torque_of_the_overlap(law):
    # The levers sum to R1 + R2 instead of the distance R1 + R2 - delta, so the pair gains delta F_t dt each step.
    disk(0, 0, 0.5, (1, 0.4), 3.0)
    disk(0.99, 0.1, 0.55, (-0.5, 0), -1.0)
    loop(LAWS[law]("radius"), friction=0.3)
    O.step()
    checked = 0
    for _ in range(400):
        before = total_angular_momentum()
        O.step()
        contact = next((i for i in O.interactions if i.isReal), None)
        if contact is None:
            break
        normal = contact.geom.normal
        shear = contact.phys.shearForce  # on body 2
        # Torques R n x F on both, forces shear on 2 and -shear on 1 a distance R1 + R2 - delta apart.
        gain = -contact.geom.penetrationDepth * (normal[0] * shear[1] - normal[1] * shear[0]) * O.dt
        assert total_angular_momentum() - before == pytest.approx(gain, abs=64 * EPS)
        checked += abs(gain) > 1e-9
    assert checked > 20


def first_contact():
    run(1)
    contacts = [i for i in O.interactions if i.isReal]
    assert len(contacts) == 1
    return contacts[0].phys


def test_a_pair_has_its_reduced_radius_and_mass():
    disk(0, 0, 0.5)
    disk(0.85, 0, 0.4)
    loop()
    phys = first_contact()
    m1, m2 = math.pi * 0.25, math.pi * 0.16
    assert phys.effectiveRadius == pytest.approx(0.5 * 0.4 / 0.9, rel=4 * EPS)
    assert phys.effectiveMass == pytest.approx(m1 * m2 / (m1 + m2), rel=4 * EPS)


@pytest.mark.parametrize("frozen_first", [True, False])
def test_a_frozen_partner_is_infinitely_heavy(frozen_first):
    disk(0, 0, 0.5, frozen=frozen_first)
    disk(0.95, 0, 0.5, frozen=not frozen_first)
    loop()
    assert first_contact().effectiveMass == pytest.approx(math.pi / 4, rel=4 * EPS)


def test_a_member_counts_with_the_mass_of_its_clump():
    clump([(-0.5, 0), (0.5, 0)], radius=0.3, mass=7.0)
    disk(0.5, 0.55, 0.3)
    loop()
    m2 = math.pi * 0.09
    assert first_contact().effectiveMass == pytest.approx(7 * m2 / (7 + m2), rel=4 * EPS)


def test_members_of_one_clump_do_not_touch_each_other():
    clump([(-0.2, 0), (0.2, 0)], radius=0.3)
    loop()
    run(5)
    assert not any(i.isReal for i in O.interactions)


def test_friction_comes_from_the_functor_or_else_from_the_materials():
    for given, expected in ((0.7, 0.7), (0.0, 0.0), (-1, math.tan(0.5))):
        new_scene()
        disk(0, 0)
        disk(0.95, 0)
        loop(friction=given)
        assert first_contact().tangensOfFrictionAngle == pytest.approx(expected, rel=EPS)


def test_a_contact_forgets_its_spring_when_it_ends():
    disk(0, 0, spin=5)
    disk(0.99, 0)
    loop(hertz(), friction=0.5)
    run(5)
    assert any(i.isReal and i.phys.slip.norm() > 0 for i in O.interactions)
    run(3000)
    assert not any(i.isReal for i in O.interactions)
    for body, x in ((0, 0.0), (1, 1.0 + 1e-6)):
        state = O.bodies[body].state
        state.pos = (x, 0, 0)
        state.vel, state.angVel = (0, 0, 0), (0, 0, 0)
    O.bodies[1].state.vel = (-1, 0, 0)
    run(100)
    contact = next(i for i in O.interactions if i.isReal)
    assert contact.phys.slip.norm() == 0
