"""ContactForceBinner about an axis in three dimensions: angles, the parts of forces in the plane and along the axis, sums."""

import math

import numpy as np
import pytest
from disks import EPS, engines, hertz, new_scene, run
from spheres import clump, frozen, loop, sphere
from yade import O, utils
from yade.minieigenHP import Vector3

RADIUS, OTHER, OVERLAP, FRICTION = 0.5, 0.4, 0.02, 1e-3
NORMAL = 2e5 * math.sqrt(RADIUS * OTHER / (RADIUS + OTHER) * OVERLAP) * OVERLAP  # of Hertz' law without damping
CENTRE = np.array([1.0, 2.0, 3.0])
ABOUT_Y = dict(planeNormal=(0, -1, 0), direction=(1, 0, 0))  # the angle from x up to z


@pytest.fixture(autouse=True)
def scene():
    new_scene(dt=1e-6)
    yield
    O.reset()


def frame_at(angle, latitude):
    """Return outward normal, direction of growing angle and direction along the meridian, for angles from x up to z about y."""
    outward = np.array([math.cos(angle), 0, math.sin(angle)])
    axis = np.array([0.0, 1.0, 0.0])
    normal = math.cos(latitude) * outward + math.sin(latitude) * axis
    return (
        normal,
        np.array([-math.sin(angle), 0, math.cos(angle)]),
        math.cos(latitude) * axis - math.sin(latitude) * outward,
    )


def touch(angle, latitude=0.0, east=0.0, north=0.0, centre=CENTRE):
    """A sphere that touches the one at `centre` and moves along its surface, with growing angle and along the meridian [m/s]."""
    normal, along, meridian = frame_at(angle, latitude)
    return frozen(centre + (RADIUS + OTHER - OVERLAP) * normal, OTHER, east * along + north * meridian)


def measured(binner, steps=1):
    loop(hertz(), friction=FRICTION, before_newton=[binner])
    run(steps)
    return binner


def container_force(ids, centre):
    """YADE's own sum of forces and torques on the bodies, about `centre`."""
    centre = Vector3(*map(float, centre))
    force = sum((O.forces.f(i) for i in ids), Vector3.Zero)
    torque = sum((O.forces.t(i) + (O.bodies[i].state.pos - centre).cross(O.forces.f(i)) for i in ids), Vector3.Zero)
    return np.array(force), np.array(torque)


@pytest.mark.parametrize("latitude", [0.0, 0.3, -1.2])
@pytest.mark.parametrize("angle", np.radians([-179, -37, 3, 90.5]))
def test_one_contact_stands_at_its_angle_about_the_axis(angle, latitude):
    body = frozen(CENTRE)
    touch(angle, latitude)
    binner = measured(engines.ContactForceBinner(body=body, **ABOUT_Y))
    at = int((angle + math.pi) / (math.pi / 12))
    alone = np.eye(24)[at]
    np.testing.assert_array_equal(binner.contacts, alone)
    small = 1e-12 * NORMAL  # the overlap is a difference of positions of order 4: a relative error of 1e-14
    np.testing.assert_allclose(binner.normalForce, alone * NORMAL * math.cos(latitude), rtol=0, atol=small)
    np.testing.assert_allclose(binner.axialForce, alone * NORMAL * math.sin(latitude), rtol=0, atol=small)
    np.testing.assert_allclose(binner.tangentialForce, 0, atol=small)
    np.testing.assert_allclose(binner.forceVectors[at], -NORMAL * frame_at(angle, latitude)[0], rtol=0, atol=small)


@pytest.mark.parametrize("sense", [-1, 1])
@pytest.mark.parametrize(
    "latitude, east, north", [(0, 1, 0), (0, -3, 4), (0, 0, -1), (0.7, 1, 0), (0.7, 0, 1), (-0.4, -3, 4)]
)
def test_friction_counts_in_the_plane_with_its_sign_and_along_the_axis(latitude, east, north, sense):
    """The partner's friction on the body is mu F_n along its velocity; the part along the angle is the tangential force."""
    angle = 0.4
    body = frozen(CENTRE)
    touch(angle, latitude, east, north)
    law = hertz(k_t=1e-9, gamma_t=1e9)  # the contact slips at once, along the velocity
    binner = engines.ContactForceBinner(body=body, planeNormal=(0, sense, 0), direction=(1, 0, 0))
    loop(law, friction=FRICTION, before_newton=[binner])
    run(1)
    assert binner.slippingNumber == 1
    friction, speed = FRICTION * NORMAL, math.hypot(east, north)
    at = int((-sense * angle + math.pi) / (math.pi / 12))
    small = 1e-9 * NORMAL  # after the sample, in a step of 1e-6, displacements are at most 4e-6; the overlap is 0.02
    assert binner.tangentialForce[at] == pytest.approx(-sense * friction * east / speed, abs=small)
    along_axis = -NORMAL * math.sin(latitude) + friction * north / speed * math.cos(latitude)
    assert binner.axialForce[at] == pytest.approx(sense * along_axis, abs=small)
    assert binner.normalForce[at] == pytest.approx(NORMAL * math.cos(latitude), abs=small)
    force, torque = container_force([body], CENTRE)
    np.testing.assert_allclose(binner.forceVectors[at], force, atol=8 * EPS * NORMAL)
    np.testing.assert_allclose(binner.torque, torque, atol=8 * EPS * NORMAL)


def test_gaussian_weights_about_the_axis_sum_to_one():
    body = frozen(CENTRE)
    contacts = [(-2.9, 0.0), (-1.0, 0.5), (0.2, -0.6), (1.7, 0.2)]
    for angle, latitude in contacts:
        touch(angle, latitude)
    binner = measured(engines.ContactForceBinner(body=body, kernel="gaussian", **ABOUT_Y))
    assert len(binner.angles) == 64 and binner.width == pytest.approx(math.radians(8))
    zeta, expected = math.radians(8), np.zeros(64)
    for angle, latitude in contacts:
        away = (binner.angles - angle + math.pi) % (2 * math.pi) - math.pi
        expected += (
            NORMAL * math.cos(latitude) * math.sqrt(2 * math.pi) / (64 * zeta) * np.exp(-(away**2) / (2 * zeta**2))
        )
    np.testing.assert_allclose(binner.normalForce, expected, rtol=0, atol=1e-12 * NORMAL)
    assert binner.contacts.sum() == pytest.approx(len(contacts), abs=4 * 64 * EPS)
    force, _ = container_force([body], CENTRE)
    np.testing.assert_allclose(binner.forceVectors.sum(axis=0), force, atol=4 * 64 * EPS * NORMAL)
    assert binner.axialForce.sum() == pytest.approx(-force[1], abs=4 * 64 * EPS * NORMAL)


def test_a_row_of_beads_is_a_cylinder():
    """A row of beads along y with normal and tangential contacts: angles are those about the row, and sums are YADE's own."""
    places = [(-0.6, 0.35), (0.0, -2.0), (0.6, 1.2)]
    row, members = clump([(0, y, 0) for y, _ in places], at=CENTRE, radius=RADIUS)
    for y, angle in places:
        touch(angle, 0.0, east=1.0, north=0.5, centre=CENTRE + (0, y, 0))
    binner = measured(
        engines.ContactForceBinner(body=row, kernel="gaussian", count=360, width=0.05, **ABOUT_Y), steps=3
    )
    assert binner.contactNumber == 3
    for _, angle in places:
        near = np.abs((binner.angles - angle + math.pi) % (2 * math.pi) - math.pi) < 0.4
        # Moves of 3e-6 change an overlap of 0.02 by less than 1e-3 of it.
        assert binner.normalForce[near].sum() == pytest.approx(NORMAL, rel=1e-3)
    assert binner.tangentialForce.min() >= 0 and binner.tangentialForce.sum() > 0
    force, torque = container_force(members, CENTRE)
    np.testing.assert_allclose(np.array(binner.lastForce), force, atol=64 * EPS * NORMAL)
    np.testing.assert_allclose(np.array(binner.lastTorque), torque, atol=64 * EPS * NORMAL)


def test_a_box_takes_its_angles_from_the_contact_points():
    body = O.bodies.append(utils.box(tuple(map(float, CENTRE)), (1, 3, 1), fixed=True))
    sphere(CENTRE + (0.4, 2, 1 + OTHER - OVERLAP), OTHER)
    binner = measured(engines.ContactForceBinner(body=body, count=360, **ABOUT_Y))
    at = np.flatnonzero(binner.contacts)
    assert len(at) == 1 and binner.normalForce[at] > 0
    # Somewhere in the overlap under the sphere's centre.
    assert math.atan2(1 - OVERLAP, 0.4) - 0.01 < binner.angles[at] < math.atan2(1, 0.4) + 0.01
    force, _ = container_force([body], CENTRE)
    assert force[2] < 0 and force[:2] == pytest.approx(0, abs=EPS)
    np.testing.assert_allclose(binner.forceVectors[at[0]], force, rtol=0, atol=8 * EPS * abs(force[2]))
