"""A body with a user's outline moves like the solid: placed, turned and pushed about the solid's centroid, on both loops."""

import math

import numpy as np
import pytest
from graindrive import engines
from graindrive.bodies import intruder
from graindrive.scenes import scene
from graindrive.scenes.material import HertzHistoryMaterial

DT = 1e-4
EPS = np.finfo(float).eps
AT = (7.25, 10.0)
SHAPES = {  # unsymmetric, so that the mean of their beads is not their centroid
    "boot": [(0, 0), (9, 0), (9, 3), (4, 3), (4, 10), (0, 10)],
    "hammer": [(0, 0), (1.5, 0), (1.5, 6), (5, 6), (5, 9), (-2, 9), (-2, 6), (0, 6)],
    "arrow": [(0, 0), (6, 0), (3, 8)],
}
CENTROIDS = {  # from the sides of the rectangles and the corners of the triangle, by hand
    "boot": (35.5 * 5 / 55, 222.5 / 55),  # 9 x 3 at (4.5, 1.5), 4 x 7 at (2, 6.5)
    "hammer": ((9 * 0.75 + 21 * 1.5) / 30, (9 * 3 + 21 * 7.5) / 30),
    "arrow": (3, 8 / 3),
}
each_shape = pytest.mark.parametrize("shape", SHAPES)
each_loop = pytest.mark.parametrize("loop", ["yade", "grain"])


def body_of(shape, tmp_path):
    path = tmp_path / f"{shape}.csv"
    path.write_text("\n".join(f"{x}, {y}" for x, y in SHAPES[shape]))
    return intruder.make(str(path), bead_diameter=0.5, mass=20.0)


def put(body, loop, blocked="zXY", between=(), gravity=0.0, others=()):
    """Put the body and disks (x, y, radius) that are held into an empty scene; return the clump's id and the loop's engines."""
    from yade import O

    scene.start(60, 60)
    id_ = scene.add_intruder(body, *AT, blocked=blocked)
    for x, y, radius in others:
        scene.add_disks([x], [y], [radius], 1.0, "xyzXYZ")
    scene.add_disks([50.0], [-20.0], [0.25], 1.0, "xyzXYZ")
    O.dt = DT
    engines_between = [make(id_) for make in between]
    scene.run_on(loop, HertzHistoryMaterial(2e4, 2e4, 0.0, 0.0, 0.0, 1.0), gravity=gravity, between=engines_between)
    return id_, engines_between


def run(steps):
    from yade import O

    O.run(steps, True)


def beads_of(id_):
    from yade import O

    return np.array([O.bodies[m].state.pos for m in scene.members(id_)])[:, :2]


@each_loop
@each_shape
def test_the_position_is_the_centroid(shape, loop, tmp_path):
    from yade import O

    body = body_of(shape, tmp_path)
    id_, _ = put(body, loop, blocked="xyzXYZ")
    state = O.bodies[id_].state
    for _ in range(2):
        assert tuple(state.pos) == (*AT, 0) and tuple(state.ori) == (0, 0, 0, 1)
        # The beads reach the outline's extent, measured from the centroid, within half a bead.
        low = beads_of(id_).min(axis=0) - 0.25
        corner = np.min(SHAPES[shape], axis=0)
        blunt = (0, 0) if shape != "arrow" else (0.25 * (1 / math.tan(math.atan2(8, 3) / 2) - 1), 0)
        np.testing.assert_allclose(low - AT, corner - CENTROIDS[shape] + blunt, rtol=0, atol=1e-9)
        run(1)
    # At every step YADE places members by the clump's position and their positions in the clump.
    np.testing.assert_allclose(beads_of(id_), body.beads + AT, rtol=0, atol=16 * EPS * 10)
    assert state.mass == 20 and state.inertia[2] == body.inertia


@each_loop
@each_shape
def test_a_thrown_body_turns_about_its_centroid_and_falls_with_it(shape, loop, tmp_path):
    from yade import O

    body = body_of(shape, tmp_path)
    id_, _ = put(body, loop, gravity=1.0)
    state = O.bodies[id_].state
    state.vel, state.angVel = (0.3, 0.5, 0), (0, 0, 0.7)
    for turn in range(1, 6):
        run(2000)
        n = 2000 * turn
        t = n * DT
        # Leapfrog's free fall is n (n + 1) dt^2/2, with the round-off of n additions.
        centre = np.array([AT[0] + 0.3 * t, AT[1] + 0.5 * t - n * (n + 1) * DT**2 / 2])
        np.testing.assert_allclose(np.array(state.pos)[:2], centre, rtol=0, atol=n * EPS * 20)
        c, s = math.cos(0.7 * t), math.sin(0.7 * t)
        expected = centre + body.beads @ np.array([[c, s], [-s, c]])
        np.testing.assert_allclose(beads_of(id_), expected, rtol=0, atol=n * EPS * 40)
    assert 2 * math.atan2(state.ori[2], state.ori[3]) == pytest.approx(0.7, abs=1e-10)


@each_loop
@each_shape
def test_a_push_turns_the_body_by_its_torque_about_the_centroid(shape, loop, tmp_path):
    from yade import O

    body = body_of(shape, tmp_path)
    bead = body.beads[np.argmax(body.beads[:, 0])] + AT  # a held disk touches the rightmost bead from the right
    id_, (binner, drive) = put(
        body,
        loop,
        others=[(bead[0] + 0.72, bead[1] + 0.1, 0.5)],
        between=[
            lambda id_: engines.ContactForceBinner(body=id_),
            lambda id_: engines.SpinTranslateDrive(body=id_, dofs=""),
        ],
    )
    run(1)
    force = np.array(binner.lastForce)
    normal = np.array([0.72, 0.1]) / math.hypot(0.72, 0.1)
    np.testing.assert_allclose(force[:2], -np.linalg.norm(force) * normal, rtol=1e-9)
    arm = bead - AT
    torque = arm[0] * force[1] - arm[1] * force[0]
    assert abs(torque) > 1
    assert binner.lastTorque[2] == pytest.approx(torque, rel=1e-9) and drive.torque[2] == pytest.approx(
        torque, rel=1e-9
    )
    state = O.bodies[id_].state
    assert state.angVel[2] == pytest.approx(torque / body.inertia * DT, rel=1e-9)
    np.testing.assert_allclose(np.array(state.vel), force / 20 * DT, rtol=1e-9)


@each_shape
def test_a_turned_clump_of_yades_own_is_set_right(shape, tmp_path):
    """YADE turns a clump to its principal axes, here out of the plane; its members must not follow."""
    from yade import O

    body = body_of(shape, tmp_path)
    scene.start(60, 60)
    id_, members = O.bodies.appendClumped([scene.disk(x, y, 0.25, 1.0) for x, y in body.beads + AT])
    clump = O.bodies[id_]
    assert tuple(clump.state.ori) != (0, 0, 0, 1) and math.dist(clump.state.pos, (*AT, 0)) > 0.1
    engines.centre_clump(O._sceneObj, id_, (*AT, 0))
    assert tuple(clump.state.pos) == (*AT, 0) == tuple(clump.state.refPos)
    for member, bead in zip(sorted(members), body.beads):
        place, orientation = clump.shape.members[member]
        np.testing.assert_allclose(np.array(place)[:2], bead, rtol=0, atol=16 * EPS * 10)
        assert tuple(orientation) == (0, 0, 0, 1)


def test_only_a_clump_that_exists_has_a_centre_to_set():
    from yade import O

    scene.start(60, 60)
    (lonely,) = scene.add_disks([1.0], [1.0], [0.5], 1.0)
    with pytest.raises(ValueError, match="takes the id of a clump, .*, got 0"):
        engines.centre_clump(O._sceneObj, lonely, (0, 0, 0))
    with pytest.raises(RuntimeError, match="body 7 does not exist"):
        engines.centre_clump(O._sceneObj, 7, (0, 0, 0))
    id_, _ = O.bodies.appendClumped([scene.disk(x, 0.0, 0.5, 1.0) for x in (4.0, 5.0)])
    with pytest.raises(ValueError, match="the centre must be finite"):
        engines.centre_clump(O._sceneObj, id_, (math.nan, 0, 0))
    assert tuple(O.bodies[id_].state.pos) == (4.5, 0, 0)
