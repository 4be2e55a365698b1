"""Spheres from YADE's loop to GrainLoop and back: which scenes count as spheres, what is kept, what is refused."""

import disks
import numpy as np
import pytest
import spheres
from graindrive.loops import grain_loop, take_over_spheres
from graindrive.base.errors import UsageError
from yade import O, wrapper
from yade.minieigenHP import Vector3

DAMPED = {"law": dict(gamma_n=50, gamma_t=50), "friction": 0.3}


def loop(gravity=(0.3, 0, -1), **others):
    spheres.loop(spheres.hertz(**DAMPED["law"]), DAMPED["friction"], gravity=gravity, **others)


def state():
    return np.array([[*b.state.pos, *b.state.vel, *b.state.angVel] for b in O.bodies])


def bed(**changes):
    spheres.bed(layers=3, side=4, **changes)
    loop()


# ---- the run ---------------------------------------------------------------------------------------------------------


def test_a_bed_moves_as_on_yades_loop():
    after = []
    for taken in (False, True):
        bed()
        if taken:
            made = grain_loop.use_grain_loop()
            assert made.dimensions == 3 and tuple(made.periods) == tuple(O.cell.size)
        disks.run(600)
        after.append(state())
    assert (
        np.abs(after[0] - after[1]).max() < 1e-6
    )  # the loops turn springs by formulas that differ in third order of a step
    assert np.abs(after[0][:, 3:6]).max() > 0.1


@pytest.mark.parametrize("other_way_round", [False, True], ids=["as_found", "ids_exchanged"])
def test_springs_go_along_both_ways(other_way_round):
    """A sphere that is pressed on another and slides across it in y and z: pulled back by its spring on either loop."""

    def build():
        disks.new_scene(dt=1e-4)
        places = [((0, 0, 0), "xyzXYZ", (0, 0, 0)), ((0.9982, 0.0, 0.0), "", (0, 0.2, -0.1))]
        for at, blocked, velocity in places[:: -1 if other_way_round else 1]:
            spheres.sphere(at, velocity=velocity, blocked=blocked)
        spheres.loop(disks.hertz(gamma_n=50, gamma_t=50), 0.5, gravity=(-10, 0, 0))

    build()
    disks.run(300)
    expected = state()
    build()
    disks.run(100)
    grain_loop.use_grain_loop()
    disks.run(100)
    grain_loop.use_yade_loop()
    disks.run(100)
    # Only the formulas of the rotation differ; without the springs the difference would be of their size, 1e-3.
    assert np.abs(state() - expected)[:, :6].max() < 1e-9
    slip = next(iter(O.interactions)).phys.slip
    assert abs(slip[1]) > 1e-4 and abs(slip[2]) > 5e-5


def slips():
    """The springs of all real contacts in YADE, seen from the smaller id: {(id, id): (3,)}."""
    found = [c for c in O.interactions if c.isReal]
    return {tuple(sorted((c.id1, c.id2))): np.array(c.phys.slip) * (1 if c.id1 < c.id2 else -1) for c in found}


def test_springs_of_a_bed_are_the_same_before_and_behind():
    bed()
    spheres.loop(spheres.hertz(gamma_n=2000, gamma_t=2000), 0.3, gravity=(0.3, 0, -1))
    disks.run(10000)
    before = slips()
    made = grain_loop.use_grain_loop()
    assert len(made.springs) == 5 * len(before)
    made.contacts()  # it finds the pairs, in its own order
    grain_loop.use_yade_loop()
    after = slips()
    shared = before.keys() & after.keys()  # YADE's contacts are those of a step earlier, some of which have ended
    assert len(shared) > 20 and max(np.abs(before[key]).max() for key in shared) > 1e-4
    assert all((before[key] == after[key]).all() for key in shared)


def test_the_way_back_goes_on_as_yades_loop():
    after = []
    for exchanged in (False, True):
        bed()
        disks.run(200)
        if exchanged:
            grain_loop.use_grain_loop()
        disks.run(200)
        if exchanged:
            grain_loop.use_yade_loop()
        disks.run(200)
        after.append(state())
    assert [type(e).__name__ for e in O.engines][-1] == "NewtonIntegrator"
    assert np.abs(after[0] - after[1]).max() < 1e-6


def test_a_clump_in_space_keeps_its_turn_on_both_ways():
    """Euler's equations by two integrators whose error is of the order of the time step, 1e-4 of a rotation by 1 rad."""
    after = []
    for exchanged in (False, True):
        disks.new_scene(dt=1e-4)
        ident, _ = spheres.free_clump([(0, 0, 0), (0.4, 0, 0), (0.4, 0.4, 0.1)])
        spheres.spin_up(ident, (1, 2, -1))
        loop(gravity=(0, 0, 0))
        for way in (None, grain_loop.use_grain_loop, grain_loop.use_yade_loop):
            if exchanged and way:
                way()
            disks.run(2000)
        after.append(state())
    assert np.abs(after[0] - after[1]).max() < 1e-3
    assert np.abs(after[0][-1, 6:] - (1, 2, -1)).max() > 0.05  # the clump tumbles


def test_changed_settings_go_back_too():
    bed()
    made = grain_loop.use_grain_loop()
    made.gravity, made.friction, made.normalStiffness = Vector3(0, -3, 0.5), 0.7, 3e5
    disks.run(1)
    grain_loop.use_yade_loop()
    assert disks.engine("newton").gravity == Vector3(0, -3, 0.5)
    assert disks.engine("contacts").physDispatcher.functors[0].friction == 0.7


# ---- which scenes are of spheres -------------------------------------------------------------------------------------


def row(blocked="", z=0.0):
    """Three spheres in a row, the last one at another height on demand."""
    disks.new_scene(dt=1e-4)
    for k in range(3):
        spheres.sphere((1.2 * k, 0, z if k == 2 else 0), blocked=blocked)


def moving_along_z():
    row()
    O.bodies[1].state.vel = Vector3(0, 0, 0.1)


def turning_about_x():
    row()
    O.bodies[1].state.angVel = Vector3(0.1, 0, 0)


def driven_along_z():
    row()
    O.bodies[1].state.blockedDOFs, O.bodies[1].state.vel = "xyzXYZ", Vector3(0, 0, 0.1)


def clump_that_stands_upright():
    disks.new_scene(dt=1e-4)
    spheres.free_clump([(0, 0, 0), (0, 0, 0.4)])


IN_SPACE, IN_PLANE = 3, 2
SCENES = {
    "free, in one plane, at rest": (row, (0, -1, 0), IN_PLANE),
    "free, gravity along z": (row, (0, 0, -1), IN_SPACE),
    "free, at several heights": (lambda: row(z=0.3), (0, 0, 0), IN_SPACE),
    "free, one moves along z": (moving_along_z, (0, 0, 0), IN_SPACE),
    "free, one turns about x": (turning_about_x, (0, 0, 0), IN_SPACE),
    "free, one is driven along z": (driven_along_z, (0, 0, 0), IN_SPACE),
    "a clump with members at two heights": (clump_that_stands_upright, (0, 0, 0), IN_SPACE),
    "blocked in the plane": (lambda: row("zXY"), (0, -1, 0), IN_PLANE),
    "free to turn about x alone, at several heights": (lambda: row("xyzYZ", z=0.3), (0, 0, 0), IN_SPACE),
}


@pytest.mark.parametrize("name", SCENES)
def test_the_scene_says_whether_it_lies_in_a_plane(name):
    build, gravity, expected = SCENES[name]
    build()
    loop(gravity=gravity)
    assert grain_loop.use_grain_loop().dimensions == expected


def test_what_the_scene_says_can_be_overridden():
    row()
    loop(gravity=(0, -1, 0))
    made = grain_loop.use_grain_loop(dimensions=3)
    O.bodies[0].state.vel = Vector3(0, 0, 0.5)
    disks.run(10)
    assert made.dimensions == 3 and O.bodies[0].state.pos[2] == pytest.approx(10 * 1e-4 * 0.5, rel=1e-12)


def test_disks_blocked_in_several_planes_are_refused_with_the_way_out():
    row("zXY", z=0.3)
    loop(gravity=(0, -1, 0))
    with pytest.raises(ValueError, match="set GrainLoop.dimensions=3 for spheres"):
        grain_loop.use_grain_loop()


def test_periods_of_spheres_are_three_and_may_leave_an_axis_free():
    bed()
    with pytest.raises(UsageError, match=r"periods of a scene of spheres must be \(x, y, z\)"):
        grain_loop.use_grain_loop(periods=(4, 4))
    assert tuple(grain_loop.use_grain_loop(periods=(4, 4, 0)).periods) == (4, 4, 0)


# ---- what is refused -------------------------------------------------------------------------------------------------


def with_yades_law():
    contacts = wrapper.InteractionLoop(
        [wrapper.Ig2_Sphere_Sphere_ScGeom()],
        [wrapper.Ip2_FrictMat_FrictMat_FrictPhys()],
        [wrapper.Law2_ScGeom_FrictPhys_CundallStrack()],
    )
    O.engines = [contacts if type(e).__name__ == "InteractionLoop" else e for e in O.engines]


def with_a_clump_that_yade_turns_as_a_sphere():
    ident, _ = spheres.free_clump([(10, 0, 0), (10.4, 0, 0)])
    O.bodies[ident].aspherical = False


OBSTACLES = {
    "yades_own_law": (
        with_yades_law,
        "Law2_ScGeom_FrictPhys_CundallStrack for disks in a plane only; take one of Law2_",
    ),
    "damped": (lambda: setattr(disks.engine("newton"), "damping", 0.2), "NewtonIntegrator.damping=0.2.*disks only"),
    "turned_as_a_sphere": (with_a_clump_that_yade_turns_as_a_sphere, r"O.bodies\[5\].aspherical is False"),
}


@pytest.mark.parametrize("rule", [rule.name for rule in take_over_spheres.RULES])
def test_every_obstacle_is_named_and_nothing_is_changed(rule):
    row(z=0.3)
    loop()
    put, words = OBSTACLES[rule]
    put()
    before = [type(e).__name__ for e in O.engines]
    with pytest.raises(UsageError, match=words):
        grain_loop.use_grain_loop()
    assert [type(e).__name__ for e in O.engines] == before


def test_a_clump_without_exact_rotation_is_refused():
    disks.new_scene(dt=1e-4)
    spheres.free_clump([(0, 0, 0), (0, 0, 0.4)])
    loop()
    O.engines[-1].exactAsphericalRot = False
    with pytest.raises(UsageError, match="NewtonIntegrator.exactAsphericalRot is False"):
        grain_loop.use_grain_loop()


def test_yades_laws_for_disks_run_on_grain_loop_with_dimensions_2():
    row()
    for body in O.bodies:
        body.state.blockedDOFs = "zXY"
    loop(gravity=(0, -1, 0))
    with_yades_law()
    assert grain_loop.use_grain_loop().law == "cundallStrack"
