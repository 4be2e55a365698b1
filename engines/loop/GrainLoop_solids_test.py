"""Solids in GrainLoop against YADE's own loop, in space and for disks in the plane."""

import math

import disks
import numpy as np
import pytest
import spheres
from graindrive import engines
from graindrive.loops import grain_loop
from graindrive.solids import surfaces
from yade import O, Quaternion
from yade.minieigenHP import Vector3
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    ForceResetter,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    NewtonIntegrator,
)

LAW = disks.hertz(gamma_n=50, gamma_t=50)
FLOOR = surfaces.half_space((0, 0, 0), (0, 0, 1))


def yades(gravity=(0, 0, -10), before=()):
    """YADE's loop with the functors for solids."""
    O.engines = [
        ForceResetter(),
        InsertionSortCollider(
            [Bo1_Sphere_Aabb(), engines.Bo1_Solid_Aabb()], verletDist=0.1, allowBiggerThanPeriod=True
        ),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), engines.Ig2_Solid_Sphere_ScGeom()],
            [engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=0.3)],
            [LAW],
        ),
        *before,
        NewtonIntegrator(damping=0, gravity=gravity),
    ]


def ours(gravity=(0, 0, -10), before=(), **settings):
    return spheres.grain_loop(LAW, friction=0.3, gravity=gravity, before_newton=before, **settings)


def state():
    return np.array([[*b.state.pos, *b.state.vel, *b.state.angVel] for b in O.bodies])


def solid(surface, mass=0.0, inertia=(0, 0, 0), blocked="xyzXYZ", velocity=(0, 0, 0), spin=(0, 0, 0)):
    ident = O.bodies.append(surfaces.body(surface))
    body = O.bodies[ident].state
    body.mass, body.inertia = mass, Vector3(*inertia)
    body.blockedDOFs = blocked
    body.vel, body.angVel = Vector3(*velocity), Vector3(*spin)
    return ident


def heap(n=60, seed=2, over=(0, 0, 3), size=2):
    """Spheres above the origin, without overlap, falling and spinning."""
    rng = np.random.default_rng(seed)
    places = [(i, j, k) for k in range(9) for j in range(-size, size + 1) for i in range(-size, size + 1)]
    for place in places[:n]:
        at = np.array(over) + 1.02 * np.array(place) + rng.uniform(-0.01, 0.01, 3)
        spheres.sphere(at, rng.uniform(0.4, 0.5), rng.uniform(-0.3, 0.3, 3), rng.uniform(-1, 1, 3))


def dented():
    """A block with a cylindrical hole and a ball on top."""
    block = FLOOR - surfaces.cylinder((0, 0, 0.5), (0, 1, 0), 1.5)
    return block | surfaces.ball((1.5, 0.3, 0.2), 1)


SCENES = {
    "floor": lambda: solid(FLOOR),
    "tilted cylinder": lambda: solid(surfaces.cylinder((0, 0, 0), (1, 2, 0.3), 1.5)),
    "vessel": lambda: solid(~surfaces.cylinder((0, 0, 6), (0, 1, 0), 5.5)),
    "composed": lambda: solid(dented()),
    "spinning cylinder": lambda: solid(surfaces.cylinder((0, 0, 0), (0, 1, 0), 1.5), spin=(0, 2, 0)),
    "driven ball": lambda: solid(surfaces.ball((0, 0, 0), 1.2), velocity=(0, 0, 1), spin=(1, 0, 0)),
    "free ball": lambda: solid(
        surfaces.ball((0, 0, 0), 1.2), mass=5, inertia=(3, 3, 3), blocked="", velocity=(0, 0, 4)
    ),
    "free along z": lambda: solid(surfaces.ball((0, 0, 0), 1.2), mass=5, blocked="xyXYZ", velocity=(0, 0, 4)),
}


@pytest.mark.parametrize("scene", SCENES)
def test_spheres_meet_solids_as_on_yades_loop(scene):
    after, forces = [], []
    for loop in (yades, ours):
        disks.new_scene(dt=2e-4)
        ident = SCENES[scene]()
        heap(over=(0, 0, 1.2 if scene == "floor" else 2.3))
        binner = engines.ContactForceBinner(body=ident, planeNormal=(0, 1, 0))
        loop(before=[binner])
        disks.run(2200)
        after.append(state())
        forces.append(np.concatenate([binner.force, binner.torque, binner.normalForce]))
    assert np.abs(forces[0]).max() > 0.01  # grains and solid have collided
    # The loops turn springs by different formulas; collisions let the difference grow.
    assert np.abs(after[0] - after[1]).max() < 1e-5
    assert np.abs(forces[0] - forces[1]).max() < 1e-5 * np.abs(forces[0]).max()


def test_a_sampled_torus():
    """A user's function: the distance to a torus about z."""

    def torus(points):
        ring = np.hypot(points[:, 0], points[:, 1]) - 2
        return np.hypot(ring, points[:, 2]) - 0.7

    surface = surfaces.sampled(torus, (-4.5, -4.5, -2.5), (4.5, 4.5, 2.5), 0.15)
    after = []
    for loop in (yades, ours):
        disks.new_scene(dt=2e-4)
        solid(surface)
        heap(over=(0, 0, 1.6))
        loop()
        disks.run(1500)
        after.append(state())
    assert np.abs(after[0] - after[1]).max() < 1e-5
    assert after[0][1:, 2].min() < 1.2  # some are on the torus or in its hole


def test_in_a_periodic_cell_the_nearest_image_is_met():
    """The same scene across the cell's side and in its middle."""
    after = []
    for shift in (0, 3):
        disks.new_scene(dt=2e-4, period=(6, 6, 60))
        solid(surfaces.cylinder((5.8 - shift, 0, 10), (0, 1, 0), 1.2))
        heap(n=50, over=(5.8 - shift, 3, 12))
        ours()
        disks.run(1500)
        after.append(state())
    difference = after[0] - after[1]
    difference[:, 0] -= 3
    difference[0] = 0  # the solid, whose position is the origin of its surface's coordinates
    difference[:, :2] -= 6 * np.round(difference[:, :2] / 6)
    assert np.abs(difference).max() < 1e-9
    assert np.abs(after[0][1:, 3]).max() > 0.5  # the solid has pushed the grains aside


def test_disks_meet_the_section_of_a_swept_outline():
    """An outline swept along z that turns about z is accepted; a solid whose section changes along z is refused."""
    star = [(2, 0), (0.5, 0.5), (0, 2), (-0.5, 0.5), (-2, 0), (-0.5, -0.5), (0, -2), (0.5, -0.5)]
    after = []
    for loop in (yades, ours):
        disks.new_scene(dt=2e-4)
        ident = solid(surfaces.swept_outline(star), spin=(0, 0, 1.5))
        O.bodies[ident].state.ori = Quaternion(Vector3(0, 0, 1), 0.3)
        rng = np.random.default_rng(4)
        for k in range(40):
            disks.disk(-4 + 1.1 * (k % 8), 2.6 + 1.05 * (k // 8), rng.uniform(0.4, 0.5))
        loop(gravity=(0, -1, 0), **({} if loop is yades else {"dimensions": 2}))
        disks.run(6000)
        after.append(state())
    assert np.abs(after[0] - after[1]).max() < 1e-5
    assert np.abs(after[0][1:, 3]).max() > 0.5
    disks.new_scene(dt=2e-4)
    solid(surfaces.ball((0, 0, 0.2), 2))
    disks.disk(0, 2.4)
    ours(gravity=(0, -1, 0), dimensions=2)
    with pytest.raises(RuntimeError, match="must be uniform along z"):
        disks.run(10)


def drum_scene(**settings):
    disks.new_scene(dt=2e-4)
    vessel = ~surfaces.cylinder((0, 0, 0), (0, 1, 0), 4, length=4)
    solid(vessel | surfaces.cylinder((0, 0, 0), (1, 0, 0), 0.6), spin=(0, 1, 0))
    heap(n=18, over=(0, 0, 1.3), size=1)
    heap(n=18, over=(0, 0, -2.4), size=1)
    return ours(**settings)


def test_same_bits_on_threads_after_looking_and_from_a_checkpoint(tmp_path):
    drum_scene()
    disks.run(1500)
    straight = disks.everything()
    loop = drum_scene(threads=2)
    for _ in range(3):
        disks.run(300)
        loop.presentContacts(), loop.kineticEnergyOnStep(), loop.sync()
    loop.checkpoint(str(tmp_path / "half"))
    disks.run(600)
    assert (disks.everything() == straight).all()
    loop = drum_scene()
    loop.restore(str(tmp_path / "half"))
    disks.run(600)
    assert (disks.everything() == straight).all()


def test_saved_and_loaded_it_goes_on_with_its_springs_at_solids(tmp_path):
    loop = drum_scene()
    disks.run(3000)
    assert len(loop.wallSprings) >= 5 and set(loop.wallSprings[::5]) == {0.0}  # the solid is body 0
    O.save(str(tmp_path / "scene.yade"))
    disks.run(100)
    straight = state()
    O.reset()
    O.load(str(tmp_path / "scene.yade"))
    disks.run(100)
    # The spring is projected on the tangent plane again, from which it differs by round-off.
    assert np.abs(straight - state()).max() < 1e-9


def test_contacts_with_a_solid_carry_the_weight():
    disks.new_scene(dt=5e-4)
    ident = solid(FLOOR)
    for x in range(3):
        spheres.sphere((2 * x, 0, 0.499))
    loop = spheres.grain_loop(disks.hertz(gamma_n=2000, gamma_t=2000), friction=0.3, gravity=(0, 0, -1))
    disks.run(20000)
    table = loop.presentContacts()
    weight = 4 / 3 * math.pi / 8
    assert list(table["j"]) == [ident] * 3
    assert table["normal_force"][:, 2] == pytest.approx(-weight, rel=1e-9)
    assert table["point"][:, 2] == pytest.approx(-table["overlap"] / 2, abs=1e-12)
    # k = K_n sqrt(R) of a plane: R_eff = R
    assert table["overlap"] == pytest.approx((weight / (2e5 * math.sqrt(0.5))) ** (2 / 3), rel=1e-9)


@pytest.mark.parametrize("period", [None, (20, 6, 40)])
def test_a_scene_with_an_endless_solid_is_taken_over_and_given_back_with_its_springs(period):
    """Springs between spheres and at the solid are kept in both exchanges, also in a periodic cell, where YADE sorts bounds."""
    after = []
    for exchanged in (False, True):
        disks.new_scene(dt=2e-4, period=period)
        solid(surfaces.cylinder((0, 0, 0), (0, 1, 0), 1.5), spin=(0, 2, 0))
        heap(over=(0, 0, 2.1))
        yades()
        disks.run(1100)
        if exchanged:
            loop = grain_loop.use_grain_loop()
            assert loop.dimensions == 3 and len(loop.wallSprings) >= 5
        disks.run(100)
        if exchanged:
            grain_loop.use_yade_loop()
        disks.run(100)
        after.append(state())
    assert np.abs(after[0] - after[1]).max() < 1e-6
    springs = [i.phys.slip.norm() for i in O.interactions if i.isReal and i.id1 == 0]
    assert max(springs) > 0


def test_energy_closes_with_a_driven_solid():
    disks.new_scene(dt=2e-4)
    solid(surfaces.cylinder((0, 0, 0), (0, 1, 0), 3), spin=(0, 2, 0))
    heap(n=18, over=(0, 0, 3.6), size=1)
    loop = ours(trackEnergy=True)
    disks.run(3000)
    assert abs(loop.energy["workByBody"][0]) > 0.1
    assert loop.energy["closure"] < 1e-11  # round-off of 3,000 steps


def test_another_surface_is_heard_at_once():
    disks.new_scene(dt=2e-4)
    ident = solid(FLOOR)
    spheres.sphere((0, 0, 0.499))
    ours(gravity=(0, 0, 0))
    disks.run(10)
    assert O.bodies[1].state.vel[2] > 0
    O.bodies[ident].shape.recipe = surfaces.half_space((0, 0, -5), (0, 0, 1)).recipe
    O.bodies[1].state.vel = Vector3(0, 0, 0)
    disks.run(10)
    assert O.bodies[1].state.vel[2] == 0


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: O.bodies.clump([solid(FLOOR), spheres.sphere((0, 0, 0.6))]), "member of a clump"),
        (lambda: O.bodies.append(surfaces.body(surfaces.ball((0, 0, 0), 2.9))), "must fit into the period"),
        (lambda: solid(FLOOR, mass=1e-9, blocked=""), "critical one of the lightest body"),
    ],
)
def test_solids_that_cannot_be_are_refused(make, words):
    disks.new_scene(dt=2e-4, period=(6, 6, 60))
    spheres.sphere((3, 3, 3))
    make()
    with pytest.raises((ValueError, RuntimeError), match=words):
        ours()
        disks.run(1)


def test_a_sphere_that_begins_inside_a_solid_stops_the_run():
    disks.new_scene(dt=2e-4)
    solid(surfaces.ball((0, 0, 0), 2))
    spheres.sphere((1.5, 0, 0))
    ours()
    with pytest.raises(RuntimeError, match="overlaps the solid of body 0 by"):
        disks.run(1)


def test_what_is_put_into_a_solid_or_under_one_stops_the_run_at_once():
    for into in (0, 1):
        disks.new_scene(dt=2e-4)
        ident = solid(surfaces.ball((0, 0, 0), 2))
        sphere = spheres.sphere((5, 0, 0))
        ours(gravity=(0, 0, 0))
        disks.run(5)
        if into == 0:
            O.bodies[sphere].state.pos = Vector3(1, 0, 0)
        else:
            O.bodies[ident].state.pos = Vector3(4, 0, 0)
        with pytest.raises(RuntimeError, match="overlaps the solid of body 0"):
            disks.run(2)  # a step uses the solids' positions at the end of the step before


def test_another_surface_is_refused_by_a_checkpoint(tmp_path):
    loop = drum_scene()
    disks.run(10)
    loop.checkpoint(str(tmp_path / "file"))
    O.bodies[0].shape.recipe = surfaces.ball((0, 0, 0), 0.1).recipe
    with pytest.raises(RuntimeError, match="body 0 has another surface"):
        loop.restore(str(tmp_path / "file"))
    with pytest.raises(RuntimeError, match="checkpoint .*"):
        loop.restore(str(tmp_path))


def test_a_solid_floor_is_a_base_though_a_sphere_is_held_above_it():
    disks.new_scene(dt=2e-4)
    solid(FLOOR)
    spheres.sphere((0, 0, 0.6)), spheres.frozen((3, 0, 20))
    ours()
    disks.run(300)


def test_a_solid_without_mass_may_not_be_freed():
    disks.new_scene(dt=2e-4)
    ident = solid(surfaces.ball((0, 0, 0), 2))
    spheres.sphere((5, 0, 0))
    ours()
    disks.run(5)
    O.bodies[ident].state.blockedDOFs = ""
    with pytest.raises((ValueError, RuntimeError), match="may move and has no mass"):
        disks.run(1)
