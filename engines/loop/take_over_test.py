"""Taking a scene over from YADE's loop, and giving it back: what is kept, and what is refused by name."""

import math

import disks
import numpy as np
import pytest
from graindrive.loops import grain_loop
from graindrive.base.errors import UsageError
from yade import O, utils
from yade.minieigenHP import Matrix3, Vector3


def pair(period=None, dt=1e-3):
    """Two free disks that overlap by a tenth of a radius."""
    disks.new_scene(dt=dt, period=period)
    ids = disks.disk(1, 1), disks.disk(1.95, 1)
    disks.loop(disks.hertz(gamma_n=50, gamma_t=50), friction=0.3)
    return ids


def loop_engine(kind):
    return next(e for e in O.engines if type(e).__name__ == kind)


def unbounded(body):
    body.bounded = False


def in_another_group(body):
    body.groupMask = 2


def out_of_the_plane(body):
    body.state.vel = (0, 0, 1)


def turning_out_of_the_plane(body):
    body.state.angVel = (1, 0, 0)


@pytest.mark.parametrize(
    "change, words",
    [
        (unbounded, "body 1 is not bounded"),
        (in_another_group, "masks of bodies 0 and 1, 1 and 2, share no bit"),
        (out_of_the_plane, "body 1 moves along z"),
        (turning_out_of_the_plane, "body 1 moves along z or turns about x or y"),
    ],
)
@pytest.mark.parametrize("when", ["before", "later"])
def test_what_yade_heeds_in_a_body_is_refused_by_name(change, words, when):
    ids = pair()
    if when == "before":
        change(O.bodies[ids[1]])
        with pytest.raises(ValueError, match=words):
            grain_loop.use_grain_loop()
        return
    grain_loop.use_grain_loop()
    disks.run(2)
    change(O.bodies[ids[1]])
    with pytest.raises(ValueError, match=words):
        O.engines[-1]()


def test_masks_with_a_common_bit_meet():
    ids = pair()
    O.bodies[ids[0]].groupMask, O.bodies[ids[1]].groupMask = 3, 6
    grain_loop.use_grain_loop()
    disks.run(50)
    assert O.bodies[ids[0]].state.vel[0] < 0


@pytest.mark.parametrize("when", ["before", "later"])
@pytest.mark.parametrize("what", ["velGrad", "tilted"])
def test_a_cell_that_deforms_or_is_tilted_otherwise_than_by_shear_is_refused(what, when):
    pair(period=(5, 5, 5))

    def change():
        if what == "velGrad":
            O.cell.velGrad = Matrix3(-0.1, 0, 0, 0, -0.1, 0, 0, 0, 0)
        else:
            O.cell.hSize = Matrix3(5, 0, 1, 0, 5, 0, 0, 0, 5)

    words = "velGrad deforms the cell" if what == "velGrad" else "O.cell is tilted"
    if when == "before":
        change()
        with pytest.raises(ValueError, match=words):
            grain_loop.use_grain_loop()
        return
    grain_loop.use_grain_loop()
    disks.run(2)
    change()
    with pytest.raises(ValueError, match=words):
        O.engines[-1]()


def across_y():
    """Two disks that overlap across the y side of a periodic cell."""
    disks.new_scene(dt=1e-3, period=(5, 5, 5))
    disks.disk(2, 0.2)
    disks.disk(2, 4.24)
    disks.loop()


def test_contacts_across_y_are_kept_because_periods_are_the_cells():
    speeds = []
    for loop in ("yade", "grain"):
        across_y()
        disks.run(1)  # YADE makes the contact
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(500)
        speeds.append(abs(O.bodies[0].state.vel[1]))
    assert speeds[1] == pytest.approx(speeds[0], rel=1e-9) and speeds[0] > 0.1


def test_an_axis_left_free_where_disks_reach_across_it_is_refused():
    across_y()
    grain_loop.use_grain_loop(periods=(5, 0))
    O.bodies[0].state.pos = (2, -0.3, 0)
    with pytest.raises(ValueError, match="along y, where O.cell has the period 5"):
        O.engines[-1]()


def test_the_frictional_springs_of_present_contacts_go_along():
    """A spring stretched on YADE's loop pulls on GrainLoop, and back again on YADE's: the run is that of one loop."""

    def build():
        disks.new_scene(dt=1e-4)
        disks.disk(0, 0, frozen=True)
        disks.disk(0.9982, 0.0, velocity=(0, 0.2))  # pressed on the base by its weight
        disks.loop(disks.hertz(gamma_n=50, gamma_t=50), friction=0.5, gravity=(-10, 0))

    build()
    disks.run(300)
    expected = disks.everything()
    build()
    disks.run(100)
    grain_loop.use_grain_loop()
    disks.run(100)
    grain_loop.use_yade_loop()
    disks.run(100)
    np.testing.assert_allclose(disks.everything()[:, 0:6], expected[:, 0:6], rtol=0, atol=1e-12)
    slip = next(iter(O.interactions)).phys.slip
    assert abs(slip[1]) > 1e-4  # a force of the order of the weight


@pytest.mark.parametrize(
    "offsets", [[(0, -0.3), (0, 0.3)], [(-0.3, -0.3), (0.3, 0.3)], [(0, 0), (0.4, 0.1), (0.1, 0.5)]]
)
def test_a_clump_keeps_its_members_places_on_the_way_back(offsets):
    disks.new_scene(dt=1e-3)
    clump, members = disks.clump(offsets, at=(5, 5))
    O.bodies[clump].state.angVel = Vector3(0, 0, 2)
    O.bodies[clump].state.angMom = Vector3(0, 0, 2) * O.bodies[clump].state.inertia[2]
    disks.disk(20, 20)
    disks.loop()
    places = []
    for loop in ("yade", "grain", "yade again"):
        if loop == "grain":
            grain_loop.use_grain_loop()
        if loop == "yade again":
            grain_loop.use_yade_loop()
        disks.run(200)
        centre, angle = O.bodies[clump].state.pos, 2 * 0.2 * (len(places) + 1)
        turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        places.append([turn @ np.array(O.bodies[m].state.pos - centre)[:2] for m in members])
    np.testing.assert_allclose(places[1], places[0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(places[2], places[0], rtol=0, atol=1e-9)


def test_walls_of_grain_loop_keep_a_scene_from_going_back():
    pair()
    loop = grain_loop.use_grain_loop()
    loop.setWall("y_low", position=-3)
    disks.run(1)
    with pytest.raises(UsageError, match="does not have GrainLoop's flat walls"):
        grain_loop.use_yade_loop()


def test_changed_gravity_and_friction_go_back_too():
    pair()
    loop = grain_loop.use_grain_loop()
    loop.gravity, loop.friction, loop.normalStiffness = Vector3(0, -3, 0), 0.7, 3e5
    disks.run(1)
    grain_loop.use_yade_loop()
    assert disks.engine("newton").gravity == Vector3(0, -3, 0)
    assert disks.engine("contacts").physDispatcher.functors[0].friction == 0.7
    assert disks.engine("contacts").lawDispatcher.functors[0].normalStiffness == 3e5


def test_a_body_so_wide_that_a_disk_meets_two_of_its_images_is_refused():
    disks.new_scene(period=(4, 40, 4))
    disks.disk(2, 1, 1.5)
    disks.disk(0, 1, 0.51)
    disks.disk(1, 20, 0.51)
    disks.loop()
    grain_loop.use_grain_loop()
    with pytest.raises(ValueError, match="two of its images: the period in x must be at least 4.02 m, got 4"):
        O.engines[-1]()


def test_a_body_that_just_fits_between_its_images_is_taken():
    disks.new_scene(period=(4.1, 40, 4))
    disks.disk(2, 1, 1.5)
    disks.disk(0, 1, 0.51)
    disks.disk(1, 20, 0.51)
    disks.loop()
    loop = grain_loop.use_grain_loop()
    disks.run(2)
    assert sorted(map(int, loop.ids)) == [0, 1, 2]
    # The first two overlap by 0.01 on one side, and are 0.09 apart across the period's: they part along x.
    vx = disks.everything()[:, 3]
    mass = [b.state.mass for b in O.bodies]
    assert vx[0] > 0 > vx[1] and vx[2] == 0
    assert mass[0] * vx[0] == pytest.approx(-mass[1] * vx[1], rel=1e-9)


@pytest.mark.parametrize("what", ["clump", "watched"])
def test_a_body_too_light_for_the_time_step_is_refused_with_its_critical_step(what):
    disks.new_scene(dt=2e-4)
    grain = math.pi / 4
    if what == "clump":
        light, _ = disks.clump([(-0.3, 0), (0.3, 0)], at=(0, 0.7), mass=1e-6 * grain, inertia=1e-7 * grain)
    else:
        light = disks.disk(0, 0.99)
        O.bodies[light].state.mass, O.bodies[light].state.inertia = 1e-6 * grain, Vector3(1, 1, 1) * 1.25e-7 * grain
    disks.disk(0, 0, frozen=True)
    disks.disk(5, 0)
    disks.loop(gravity=(0, -1))
    grain_loop.use_grain_loop(watched=[light])
    with pytest.raises(ValueError, match="critical one of the lightest body"):
        O.engines[-1]()


def test_spheres_as_yade_makes_them_are_taken_over():
    disks.new_scene()
    for x in (0, 0.97, 3):
        ball = utils.sphere((x, 0, 0), 0.5, color=(1, 1, 1))
        ball.state.blockedDOFs = "zXY"
        O.bodies.append(ball)
    disks.loop(disks.hertz())
    grain_loop.use_grain_loop()
    disks.run(20)
    assert O.bodies[0].state.vel[0] < 0
