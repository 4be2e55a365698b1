"""ContactForceBinner: which contacts count in which bins, sums against the body's force, and statistics against NumPy."""

import math

import numpy as np
import pytest
from disks import EPS, clump, disk, engine, engines, hertz, loop, new_scene, run, shaken_bed
from yade import O

KERNELS = ["bins", "gaussian"]


@pytest.fixture(autouse=True)
def scene():
    new_scene(dt=1e-4)
    yield
    O.reset()


def touch(body_at, angle, overlap=0.02, radius=0.5, other=0.4):
    """A frozen disk that touches the disk at `body_at` from the direction `angle`."""
    reach = radius + other - overlap
    return disk(body_at[0] + reach * math.cos(angle), body_at[1] + reach * math.sin(angle), other, frozen=True)


def binner_on(body, **options):
    return engines.ContactForceBinner(body=body, label="binner", **options)


def expected_normal(overlap=0.02, k_n=2e5):
    return k_n * math.sqrt(0.5 * 0.4 / 0.9 * overlap) * overlap


def measured(binner, friction=0.0, steps=1, law=None):
    loop(law or hertz(), friction=friction, before_newton=[binner])
    run(steps)


def container_force(ids, centre):
    """YADE's own sum of forces and torques on the bodies, about `centre`."""
    force, torque = np.zeros(3), np.zeros(3)
    for i in ids:
        f = np.array(O.forces.f(i))
        force += f
        torque += np.array(O.forces.t(i)) + np.cross(np.array(O.bodies[i].state.pos) - centre, f)
    return force, torque


# ---- one contact ----


@pytest.mark.parametrize("angle", np.radians([-179, -100, -37, -1, 3, 50, 90.5, 178]))
def test_one_contact_stands_in_its_bin(angle):
    body = disk(1, 2, frozen=True)
    touch((1, 2), angle)
    binner = binner_on(body)
    measured(binner)
    assert len(binner.angles) == 24
    bin_ = int((angle + math.pi) / (math.pi / 12))
    assert abs(binner.angles[bin_] - angle) <= math.pi / 24
    alone = np.zeros(24)
    alone[bin_] = 1
    np.testing.assert_array_equal(binner.contacts, alone)
    # The overlap, 0.02, is a difference of numbers of order 2: a relative error of 1e-14.
    np.testing.assert_allclose(binner.normalForce, alone * expected_normal(), rtol=1e-13)
    np.testing.assert_array_equal(binner.tangentialForce, 0)
    np.testing.assert_array_equal(binner.slippingContacts, 0)
    inward = -expected_normal() * np.array([math.cos(angle), math.sin(angle), 0])
    np.testing.assert_allclose(binner.forceVectors[bin_], inward, atol=1e-12 * expected_normal())
    np.testing.assert_allclose(binner.force, inward, atol=1e-12 * expected_normal())
    assert binner.contactNumber == 1


@pytest.mark.parametrize("angle", np.radians([-120, 0.0, 61.7, 180]))
def test_gaussian_weights_are_those_of_guillard_and_sum_to_one(angle):
    body = disk(0, 0, frozen=True)
    touch((0, 0), angle)
    binner = binner_on(body, kernel="gaussian")
    measured(binner)
    assert len(binner.angles) == 64
    zeta = math.radians(8)
    away = (binner.angles - angle + math.pi) % (2 * math.pi) - math.pi
    weights = math.sqrt(2 * math.pi) / (64 * zeta) * np.exp(-(away**2) / (2 * zeta**2))
    np.testing.assert_allclose(binner.contacts, weights, rtol=0, atol=64 * EPS)
    # The sum over points differs from the integral by 2 exp(-M^2 zeta^2/2) = 4e-18; the rest is the round-off of 64 additions.
    assert binner.contacts.sum() == pytest.approx(1, abs=64 * EPS)
    np.testing.assert_allclose(binner.normalForce, weights * expected_normal(), rtol=0, atol=64 * EPS * 400)


@pytest.mark.parametrize("count, width", [(64, 0.15), (16, 0.6), (24, 0.3), (360, 0.05)])
def test_gaussian_weights_sum_to_one_for_other_choices(count, width):
    body = disk(0, 0, frozen=True)
    for angle in np.linspace(-3, 3, 5):
        touch((0, 0), angle, other=0.2, overlap=0.01)
    binner = binner_on(body, kernel="gaussian", count=count, width=width)
    measured(binner)
    # By Poisson summation the sum over points differs by 2 exp(-M^2 zeta^2/2) for each contact, apart from round-off.
    missing = 2 * math.exp(-((count * width) ** 2) / 2)
    assert binner.contacts.sum() == pytest.approx(5, abs=5 * (missing + count * EPS))


@pytest.mark.parametrize("reference, turned", [("motion", math.radians(130)), ("fixed", math.radians(40))])
def test_angles_count_from_the_reference(reference, turned):
    body = disk(0, 0)
    angle = 0.3
    touch((0, 0), angle + turned)
    O.bodies[body].state.vel = (1e-9 * math.cos(math.radians(130)), 1e-9 * math.sin(math.radians(130)), 0)
    binner = binner_on(body, reference=reference, direction=(math.cos(turned), math.sin(turned), 0))
    measured(binner)
    assert np.flatnonzero(binner.contacts).tolist() == [int((angle + math.pi) / (math.pi / 12))]


def test_a_body_at_rest_keeps_the_direction_it_moved_in():
    body = disk(0, 0, velocity=(0, 1e-9))
    touch((0, 0), math.pi / 2 + 0.1)
    binner = binner_on(body, reference="motion")
    O.bodies[body].state.blockedDOFs = "xyzXYZ"  # keeps its velocity
    measured(binner)
    O.bodies[body].state.vel = (0, 0, 0)
    binner.clear()
    run(1)
    assert np.flatnonzero(binner.contacts).tolist() == [12]


def test_plane_normal_turns_the_sense_of_the_angle():
    body = disk(0, 0, frozen=True)
    touch((0, 0), 1.0)
    binner = binner_on(body, planeNormal=(0, 0, -2))
    measured(binner)
    assert np.flatnonzero(binner.contacts).tolist() == [int((-1.0 + math.pi) / (math.pi / 12))]


def test_the_other_body_of_the_pair_sees_the_opposite_force():
    first, second = disk(0, 0, frozen=True), disk(0.95, 0, frozen=True)
    one, two = binner_on(first), engines.ContactForceBinner(body=second)
    loop(hertz(), before_newton=[one, two])
    run(1)
    np.testing.assert_allclose(one.force, -np.array(two.force), rtol=EPS)
    assert one.force[0] < 0
    assert one.normalForce.max() == two.normalForce.max() > 0
    assert np.argmax(one.normalForce) == 12 and np.argmax(two.normalForce) in (0, 23)


@pytest.mark.parametrize("friction, slips", [(0.0, 1), (1e-3, 1), (100.0, 0)])
def test_slipping_and_the_sign_of_the_tangential_force(friction, slips):
    # A wall disk on the right moves up, so its friction on the body acts counter-clockwise.
    body = disk(0, 0, frozen=True)
    wall = touch((0, 0), 0.1)
    O.bodies[wall].state.vel = (0, 1.0, 0)
    binner = binner_on(body)
    measured(binner, friction=friction, law=hertz(gamma_t=250))
    assert binner.slippingNumber == slips and binner.slippingContacts.sum() == slips
    if friction:
        assert binner.tangentialForce[12] > 0
        assert binner.torque[2] > 0
    if friction == 1e-3:
        assert binner.tangentialForce[12] == pytest.approx(1e-3 * expected_normal(), rel=1e-12)


# ---- many contacts ----


def surround(body_at, count):
    for angle in 2 * math.pi * (np.arange(count) + 0.3) / count:
        i = touch(body_at, angle, overlap=0.01 + 0.002 * math.sin(angle), other=0.2)
        O.bodies[i].state.vel = (0.3 * math.sin(5 * angle), 0.2, 0)


def test_normal_forces_on_the_body_are_all_of_the_force_without_friction_and_across_the_slip_with_it():
    for friction in (0.0, 0.5):
        body = disk(0, 0, frozen=True)
        wall = disk(0.9, 0, frozen=True)
        O.bodies[wall].state.vel = (0, 0.3, 0)  # slides along y, so only friction acts along y
        binner = binner_on(body)
        measured(binner, friction=friction, law=hertz(leverArm="contactPoint"), steps=1)
        normal, force = np.array(binner.normalForceOnBody), np.array(binner.force)
        assert normal[0] < 0 and normal[1] == 0 and normal[0] == force[0]
        assert (force[1] > 0) == (friction > 0)
        O.reset()


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("count", [1, 3, 8, 11])
def test_bins_sum_to_the_force_that_yade_holds(kernel, count):
    body = disk(1, -1, frozen=True)
    surround((1, -1), count)
    binner = binner_on(body, kernel=kernel)
    measured(binner, friction=0.3, law=hertz(gamma_n=250, gamma_t=250, leverArm="contactPoint"), steps=5)
    force, torque = container_force([body], np.array([1, -1, 0]))
    assert binner.lastContactNumber == count
    scale = count * expected_normal()
    np.testing.assert_allclose(binner.lastForce, force, rtol=0, atol=16 * EPS * scale)
    np.testing.assert_allclose(binner.lastTorque, torque, rtol=0, atol=16 * EPS * scale)
    np.testing.assert_allclose(binner.forceVectors.sum(axis=0), binner.force, rtol=0, atol=64 * EPS * scale)
    assert binner.contacts.sum() == pytest.approx(count, abs=count * 64 * EPS)


def outer_shape(radius=0.5):
    return [(-0.6, 0.0), (0.6, 0.0), (0.0, 0.6), (0.0, -0.6)]


@pytest.mark.parametrize("kernel", KERNELS)
def test_forces_on_a_clump_are_those_on_its_members(kernel):
    ident, members = clump(outer_shape(), at=(1, 1), radius=0.4)
    O.bodies[ident].state.blockedDOFs = "xyzXYZ"
    walls = [disk(1 + 1.28, 1.1, frozen=True), disk(1.1, 1 + 1.3 + 0.15, frozen=True), disk(0.2, 0.1, frozen=True)]
    for wall in walls:
        O.bodies[wall].state.vel = (0.1, 0.2, 0)
    binner = binner_on(ident, kernel=kernel)
    measured(binner, friction=0.4, law=hertz(gamma_n=250, gamma_t=250, leverArm="contactPoint"), steps=3)
    assert binner.lastContactNumber >= 3
    # Reads forces just before the integrator, which adds the members' forces to the clump.
    force, torque = container_force(members, np.array(O.bodies[ident].state.pos))
    scale = np.abs(binner.forceVectors).sum()
    np.testing.assert_allclose(binner.lastForce, force, rtol=0, atol=64 * EPS * scale)
    np.testing.assert_allclose(binner.lastTorque, torque, rtol=0, atol=128 * EPS * scale)
    np.testing.assert_allclose(binner.forceVectors.sum(axis=0), binner.force, rtol=0, atol=64 * EPS * scale)


def test_in_a_moving_bed_sums_hold_at_every_step():
    shaken_bed()
    run(3000)
    bins, clump_id = engine("bins"), engine("shake").body
    members = list(O.bodies[clump_id].shape.members)
    seen = 0
    for _ in range(300):
        centre = np.array(O.bodies[clump_id].state.pos)
        bins.clear()
        places = {i: np.array(O.bodies[i].state.pos) for i in members}
        O.step()
        forces = {i: np.array(O.forces.f(i)) for i in members}
        total = sum(forces.values())
        scale = sum(np.abs(f).max() for f in forces.values()) + 1e-3
        np.testing.assert_allclose(bins.forceVectors.sum(axis=0), total, rtol=0, atol=64 * EPS * scale)
        np.testing.assert_allclose(bins.force, total, rtol=0, atol=64 * EPS * scale)
        assert len(places) == 2 and np.isfinite(centre).all()
        seen += bins.lastContactNumber
    assert seen > 100


# ---- statistics ----


def recorded(binner, steps):
    """Run step by step and keep the sample of each, from a second binner that is reset at every step."""
    rows = []
    fresh = engines.ContactForceBinner(body=binner.body, kernel=binner.kernel)
    O.engines = O.engines[:-1] + [fresh] + O.engines[-1:]
    for _ in range(steps):
        fresh.clear()
        O.step()
        rows.append(
            np.concatenate(
                [fresh.normalForce, fresh.tangentialForce, fresh.contacts, fresh.forceVectors.ravel(), fresh.force]
                + [fresh.torque, [fresh.contactNumber]]
            )
        )
    return np.array(rows)


@pytest.mark.parametrize("kernel", KERNELS)
def test_means_and_variances_are_those_of_numpy(kernel):
    shaken_bed()
    run(3000)
    binner = engines.ContactForceBinner(body=engine("shake").body, kernel=kernel)
    O.engines = O.engines[:-1] + [binner] + O.engines[-1:]
    rows = recorded(binner, 400)
    assert binner.samples == 400
    means = [binner.normalForce, binner.tangentialForce, binner.contacts, binner.forceVectors.ravel(), binner.force]
    means = np.concatenate(means + [binner.torque, [binner.contactNumber]])
    variances = [binner.normalForceVariance, binner.tangentialForceVariance, binner.contactsVariance]
    variances += [binner.forceVectorsVariance.ravel(), binner.forceVariance, binner.torqueVariance]
    variances = np.concatenate(variances + [[binner.contactNumberVariance]])
    scale = np.abs(rows).max(axis=0)
    assert (rows.std(axis=0) > 0).sum() > 10
    # 400 additions, each with a round-off of EPS of the largest value.
    assert np.all(np.abs(means - rows.mean(axis=0)) <= 400 * EPS * scale)
    assert np.all(np.abs(variances - rows.var(axis=0, ddof=1)) <= 400 * 4 * EPS * scale**2)


def test_clear_forgets():
    body = disk(0, 0, frozen=True)
    touch((0, 0), 0.3)
    binner = binner_on(body)
    measured(binner, steps=7)
    assert binner.samples == 7
    O.bodies.erase(1)
    binner.clear()
    assert binner.samples == 0 and not binner.normalForce.any() and binner.contactNumber == 0
    run(3)
    assert binner.samples == 3 and not binner.normalForce.any() and not binner.normalForceVariance.any()


@pytest.mark.parametrize("every, expected", [(1, 20), (3, 7), (20, 1), (7, 3)])
def test_every_so_many_steps(every, expected):
    binner = binner_on(disk(0, 0), every=every)
    measured(binner, steps=20)
    assert binner.samples == expected  # steps 0, every, 2 every, ... below 20


def test_no_contact_is_a_sample_of_zeros():
    binner = binner_on(disk(0, 0))
    measured(binner, steps=4)
    assert binner.samples == 4 and not binner.contacts.any() and tuple(binner.force) == (0, 0, 0)


@pytest.mark.parametrize("kernel", KERNELS)
def test_save_and_load_go_on_counting(kernel, tmp_path):
    body = disk(0, 0, frozen=True)
    for angle in (0.3, 2.0, -2.5):
        touch((0, 0), angle)
    binner = binner_on(body, kernel=kernel, width=0.2)
    measured(binner, steps=5)
    before = binner.normalForce
    O.save(str(tmp_path / "binner.xml"), quiet=True)
    O.load(str(tmp_path / "binner.xml"), quiet=True)
    loaded = engine("binner")
    np.testing.assert_array_equal(loaded.normalForce, before)
    run(5)
    assert loaded.samples == 10 and loaded.width == 0.2 and loaded.kernel == kernel
    np.testing.assert_allclose(loaded.normalForce, before, rtol=1e-14)


def test_changing_the_bins_begins_anew():
    body = disk(0, 0, frozen=True)
    touch((0, 0), 0.3)
    binner = binner_on(body)
    measured(binner, steps=5)
    binner.count = 8
    assert len(binner.angles) == len(binner.normalForce) == 8
    run(2)
    assert binner.samples == 2 and binner.contactNumber == 1


def test_yades_own_law_is_measured_too():
    from yade.wrapper import (
        Bo1_Sphere_Aabb,
        ForceResetter,
        Ig2_Sphere_Sphere_ScGeom,
        InsertionSortCollider,
        InteractionLoop,
        Ip2_FrictMat_FrictMat_FrictPhys,
        Law2_ScGeom_FrictPhys_CundallStrack,
        NewtonIntegrator,
    )

    body = disk(0, 0, frozen=True)
    wall = touch((0, 0), 0.1)
    O.bodies[wall].state.vel = (0, 5.0, 0)
    binner = binner_on(body)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]
        ),
        binner,
        NewtonIntegrator(damping=0),
    ]
    run(200)
    np.testing.assert_allclose(binner.lastForce, O.forces.f(body), rtol=4 * EPS)
    assert binner.lastContactNumber == 1
    assert binner.slippingNumber > 0
