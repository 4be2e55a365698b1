"""Solids on YADE's own loop: Hertz's overlaps, impacts against the integrated equation, levers, friction, archives, refusals."""

import math
import subprocess
import sys

import numpy as np
import pytest
from graindrive import engines
from graindrive.solids import surfaces
from scipy.integrate import solve_ivp
from yade import O, Quaternion
from yade.utils import sphere
from yade.wrapper import (
    Body,
    Bo1_Sphere_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    Law2_ScGeom_MindlinPhys_Mindlin,
    NewtonIntegrator,
    PyRunner,
)

EPS = np.finfo(float).eps
R, YOUNG, NU, G = 0.01, 1e7, 0.3, 9.81
E_EFF = YOUNG / (2 * (1 - NU**2))
K = 4 / 3 * E_EFF * math.sqrt(R)  # effective radius of a sphere at a solid, which counts as flat
MASS = 2500 * 4 / 3 * math.pi * R**3
FLOOR = surfaces.half_space((0, 0, 0), (0, 0, 1))
LAWS = {
    "hertz_history": lambda **keys: engines.Law2_ScGeom_ContactPhys_HertzHistory(**keys),
    "hertz_restitution": lambda **keys: law(**keys),
    "spring_dashpot": lambda **keys: engines.Law2_ScGeom_ContactPhys_SpringDashpot(
        normalStiffness=1e4, tangentialStiffness=3e3, **keys
    ),
}


def law(**keys):
    return engines.Law2_ScGeom_ContactPhys_HertzRestitution(
        **{"young": YOUNG, "poisson": NU, "restitution": 0.5, **keys}
    )


def loop(contact_law=None, maker=None, gravity=(0, 0, 0), bigger=False, **geometry):
    O.engines = [
        ForceResetter(),
        InsertionSortCollider(
            [Bo1_Sphere_Aabb(), engines.Bo1_Solid_Aabb()], allowBiggerThanPeriod=bigger, label="collider"
        ),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), engines.Ig2_Solid_Sphere_ScGeom(**geometry)],
            [maker or engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=0.5)],
            [contact_law or law()],
        ),
        NewtonIntegrator(damping=0, gravity=gravity),
    ]


@pytest.fixture(autouse=True)
def scene():
    new_scene()
    yield
    O.reset()
    engines.take_complaint()


def new_scene():
    O.reset()
    O.dt = 1e-5
    O.materials.append(FrictMat(young=YOUNG, poisson=NU, density=2500, frictionAngle=0.5))


def add_solid(surface, **keys):
    return O.bodies[O.bodies.append(surfaces.body(surface, **keys))]


def add_sphere(at, velocity=(0, 0, 0), spin=(0, 0, 0), radius=R):
    made = O.bodies[O.bodies.append(sphere(at, radius))]
    made.state.vel, made.state.angVel = velocity, spin
    return made


def contact():
    (only,) = [i for i in O.interactions if i.isReal]
    return only


def weight_overlap(stiffness=K):
    return (MASS * G / stiffness) ** (2 / 3)


@pytest.mark.parametrize(
    "surface, direction, at",
    [
        (FLOOR, (0, 0, 1), (0.3, -0.2, R)),
        (
            surfaces.half_space((0.1, 0.2, 0.3), (1, 2, 2)),
            (1 / 3, 2 / 3, 2 / 3),
            (0.1 + R / 3, 0.2 + 2 * R / 3, 0.3 + 2 * R / 3),
        ),
        (surfaces.cylinder((0, 0, 0), (0, 1, 0), 0.05), (0, 0, 1), (0, 0.4, 0.05 + R)),
        (~surfaces.cylinder((0, 0, 0), (0, 1, 0), 0.05), (0, 0, 1), (0, 0.4, -0.05 + R)),
    ],
    ids=["floor", "slope", "outside a cylinder", "inside a cylinder"],
)
def test_a_sphere_at_rest_sinks_by_the_overlap_of_hertz(surface, direction, at):
    add_solid(surface)
    add_sphere(at)
    loop(gravity=tuple(-G * np.array(direction)))
    O.run(60000, True)  # forty decay times of the damped contact
    assert contact().geom.penetrationDepth == pytest.approx(weight_overlap(), rel=1e-9)
    np.testing.assert_allclose(contact().geom.normal, direction, atol=1e-9)
    np.testing.assert_allclose(O.forces.f(0), -MASS * G * np.array(direction), rtol=1e-9, atol=1e-9 * MASS * G)


def test_force_reduced_radius_and_mass_are_those_of_a_sphere_against_a_flat_wall():
    add_solid(FLOOR)
    add_sphere((0, 0, R - 1e-4))
    loop()
    O.step()
    made = contact()
    overlap = made.geom.penetrationDepth
    assert (made.id1, made.id2) == (0, 1)
    assert overlap == pytest.approx(1e-4, rel=1e-12) and made.geom.contactPoint[2] == pytest.approx(
        -overlap / 2, rel=1e-10
    )
    assert made.phys.effectiveRadius == R and made.phys.effectiveMass == pytest.approx(MASS, rel=4 * EPS)
    assert made.phys.normalForce[2] == pytest.approx(K * overlap**1.5, rel=8 * EPS)  # at rest: no dashpot


def test_the_order_of_ids_does_not_matter():
    add_sphere((0, 0, R - 1e-4))
    add_solid(FLOOR)
    loop()
    O.step()
    made = contact()
    assert (made.id1, made.id2) == (1, 0) and tuple(made.geom.normal) == (0, 0, 1)
    assert made.phys.normalForce[2] > 0 and O.bodies[0].state.vel[2] > 0


@pytest.mark.parametrize(
    "free, blocked, spin, expected",
    [
        (False, "xyzXYZ", 0, 1),
        (False, "xyzXYZ", 5, 1),  # driven: it rotates, but does not recoil
        (False, "xyz", 5, 1),  # on an axle
        (True, "", 0, 3 / 4),
    ],
)
def test_the_reduced_mass_is_that_of_the_pair_if_the_solid_can_recoil(free, blocked, spin, expected):
    solid = add_solid(FLOOR, mass=3 * MASS, inertia=(1, 1, 1), held=not free)
    solid.state.blockedDOFs = blocked
    solid.state.angVel = (0, 0, spin)
    add_sphere((0, 0, R - 1e-4))
    loop()
    O.step()
    assert contact().phys.effectiveMass == pytest.approx(expected * MASS, rel=8 * EPS)


def test_a_solid_may_be_a_member_of_a_clump():
    tip = surfaces.body(
        surfaces.ball((0, 0, 0), 0.02), position=(0.1, 0, 0), mass=0.02, inertia=(1e-5,) * 3, held=False
    )
    clump, (member, _) = O.bodies.appendClumped([tip, sphere((0, 0, 0), 0.02)])
    ball = add_sphere((0.1, 0, 0.02 + R - 1e-4))
    whole = O.bodies[clump].state
    loop()
    O.step()
    made = contact()
    assert (made.id1, made.id2) == (member, ball.id)
    assert made.phys.effectiveMass == pytest.approx(MASS * whole.mass / (MASS + whole.mass), rel=8 * EPS)
    force = np.array(made.phys.normalForce)  # on the ball
    np.testing.assert_allclose(whole.mass * np.array(whole.vel), -force * O.dt, rtol=1e-12, atol=1e-20)
    assert whole.angVel[1] > 0  # pressed down beyond its centre


@pytest.mark.parametrize("restitution", [0.3, 0.8])
def test_a_head_on_impact_is_the_integrated_equation(restitution):
    solid = add_solid(FLOOR)
    ball = add_sphere((0, 0, R), velocity=(0, 0, -0.5))
    loop(law(restitution=restitution))
    O.dt = 2e-7  # 1/5000 of the impact: leapfrog's error and the dashpot's half step are below 1e-3
    b = -math.log(restitution) / math.hypot(math.log(restitution), math.pi)
    damping = math.sqrt(5) * b * math.sqrt(MASS * K)

    def motion(_, y):
        overlap = max(y[0], 0)
        return [y[1], -(K * overlap**1.5 + damping * overlap**0.25 * y[1]) / MASS]

    def apart(_, y):
        return y[0]

    apart.terminal, apart.direction = True, -1
    end = solve_ivp(motion, (0, 1), [1e-12, 0.5], events=apart, rtol=1e-10, atol=1e-14).y[1, -1]
    while ball.state.vel[2] < 0 or any(i.isReal for i in O.interactions):
        O.run(500, True)
    assert ball.state.vel[2] == pytest.approx(-end, rel=1e-3)
    assert ball.state.vel[2] / 0.5 == pytest.approx(restitution, rel=5e-3)  # the law determines the restitution
    assert tuple(solid.state.vel) == (0, 0, 0) and tuple(solid.state.pos) == (0, 0, 0)


def lever_scene(contact_law):
    """A free solid whose surface is not about its centre of mass, rotated and spinning, hit by a spinning sphere."""
    surface = surfaces.ball((0.03, 0, 0), 0.01)
    keys = dict(position=(0.1, -0.2, 0.3), mass=0.05, inertia=(2e-5, 2e-5, 2e-5), held=False)
    solid = add_solid(surface, **keys)
    solid.state.vel, solid.state.angVel = (0.1, 0, 0.2), (3, -2, 5)
    ball = add_sphere((0.1 + 0.03 + 0.012, -0.2 + 0.012, 0.3 + 0.0105), velocity=(-0.8, -0.5, -0.3), spin=(20, 10, -30))
    loop(contact_law)
    return solid, ball


def momentum():
    return sum(b.state.mass * np.array(b.state.vel) for b in O.bodies)


def angular_momentum():
    states = [b.state for b in O.bodies]
    return sum(s.mass * np.cross(s.pos, s.vel) + s.inertia[0] * np.array(s.angVel) for s in states)


@pytest.mark.parametrize("name", LAWS)
def test_an_oblique_impact_on_a_free_solid_conserves_both_momenta(name):
    solid, ball = lever_scene(LAWS[name](leverArm="contactPoint"))
    before, turning, spin = momentum(), angular_momentum(), np.array(ball.state.angVel)
    touched = 0
    for _ in range(600):
        O.step()
        touched += any(i.isReal for i in O.interactions)
    assert 30 < touched < 500 and np.linalg.norm(np.array(ball.state.angVel) - spin) > 0.1  # there was friction
    # 600 steps with a round-off of EPS in momenta of 0.02 kg m/s and 0.01 kg m^2/s
    np.testing.assert_allclose(momentum(), before, rtol=0, atol=600 * 0.02 * EPS)
    np.testing.assert_allclose(angular_momentum(), turning, rtol=0, atol=600 * 0.01 * EPS)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("lever", ["radius", "contactPoint"])
def test_force_and_torque_on_the_solid_balance_those_on_the_sphere(name, lever):
    solid, ball = lever_scene(LAWS[name](leverArm=lever))
    ball.state.pos = np.array(ball.state.pos) - 0.002 * np.array((1, 1, 1)) / math.sqrt(3)
    x1, x2 = np.array(solid.state.pos), np.array(ball.state.pos)
    O.step()
    made = contact()
    c, n, overlap = np.array(made.geom.contactPoint), np.array(made.geom.normal), made.geom.penetrationDepth
    shear = np.array(made.phys.shearForce)
    f1, f2 = np.array(O.forces.f(0)), np.array(O.forces.f(1))
    size = np.linalg.norm(f2)
    assert np.linalg.norm(shear) > 1e-3 * size and overlap > 1e-4
    np.testing.assert_allclose(f1, -f2, rtol=0, atol=4 * EPS * size)
    np.testing.assert_allclose(O.forces.t(0), np.cross(c - x1, f1), rtol=0, atol=8 * EPS * size * 0.1)
    # If the sphere's force acts at its radius, half an overlap beyond c, a torque about c remains.
    about_c = np.array(O.forces.t(1)) + np.cross(x2 - c, f2)
    left = np.cross(-overlap / 2 * n, shear) if lever == "radius" else 0
    np.testing.assert_allclose(about_c, left, rtol=0, atol=16 * EPS * size * 0.1)


def test_the_material_moves_as_a_rigid_body_however_long_the_lever():
    solid, ball = lever_scene(LAWS["hertz_history"](leverArm="contactPoint"))
    ball.state.pos = np.array(ball.state.pos) - 0.002 * np.array((1, 1, 1)) / math.sqrt(3)
    x1, v1, w1 = (np.array(v) for v in (solid.state.pos, solid.state.vel, solid.state.angVel))
    x2, v2, w2 = (np.array(v) for v in (ball.state.pos, ball.state.vel, ball.state.angVel))
    O.step()
    c, n = np.array(contact().geom.contactPoint), np.array(contact().geom.normal)
    between = v1 + np.cross(w1, c - x1) - v2 - np.cross(w2, c - x2)
    tangential = between - between.dot(n) * n
    np.testing.assert_allclose(contact().geom.shearInc, -tangential * O.dt, rtol=0, atol=8 * EPS * O.dt)


@pytest.mark.parametrize("name", LAWS)
def test_a_cylinder_that_spins_drags_a_sphere_that_rests_on_it(name):
    drum = add_solid(surfaces.cylinder((0, 0, 0), (0, 1, 0), 0.05))
    ball = add_sphere((0, 0, 0.05 + R - 1e-4))
    loop(LAWS[name]())
    drum.state.angVel = (0, 40, 0)  # its top moves along x
    O.run(2, True)
    made = contact()
    pressure = made.phys.normalForce.norm()
    assert made.phys.slipping
    np.testing.assert_allclose(
        made.phys.shearForce, (0.5 * pressure, 0, 0), rtol=0, atol=1e-4 * pressure
    )  # mu F_n along x
    assert ball.state.vel[0] > 0 and abs(ball.state.vel[1]) < 1e-12
    assert ball.state.angVel[1] < 0  # rolls on it
    torque = np.array(O.forces.t(0))
    np.testing.assert_allclose(
        torque, (0, -0.5 * pressure * 0.05, 0), rtol=0, atol=3e-3 * abs(torque[1])
    )  # friction brakes it; the lever is R - delta/2
    np.testing.assert_allclose(drum.state.ori.toAngleAxis()[0], 40 * 2 * O.dt, rtol=1e-9)


def torus(points):
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - 0.1, points[:, 2]) - 0.03


def test_a_sphere_touches_a_sampled_torus_where_the_closed_form_says():
    spacing = 0.004
    add_solid(surfaces.sampled(torus, (-0.16, -0.16, -0.06), (0.16, 0.16, 0.06), spacing), position=(1, 0, 0))
    rng = np.random.default_rng(1)
    for _ in range(50):
        around, about = rng.uniform(0, 2 * math.pi, 2)
        ring = np.array((math.cos(around), math.sin(around), 0))
        at = 0.1 * ring + (0.03 + 0.9 * R) * (math.cos(about) * ring + math.sin(about) * np.array((0, 0, 1)))
        add_sphere(at + (1, 0, 0)).groupMask = 3
    loop()
    O.engines[1].avoidSelfInteractionMask = 2
    O.step()
    made = [i for i in O.interactions if i.isReal]
    assert len(made) == 50
    # cubic interpolation: spacing^3/R^2 with radii of curvature of 0.03 and more
    np.testing.assert_allclose([i.geom.penetrationDepth for i in made], 0.1 * R, rtol=0, atol=spacing**3 / 0.03**2)


def test_spheres_larger_than_the_margin_of_a_sampled_solid_are_refused():
    sampled = surfaces.sampled(torus, (-0.14, -0.14, -0.04), (0.14, 0.14, 0.04), 0.004)
    add_solid(sampled.placed((0, 0, 1)) | FLOOR)
    add_sphere((0, 0, R), radius=0.0099)
    loop()
    O.run(2, True)
    add_sphere((0, 0.5, R), radius=0.0101)
    refused(ValueError, "spheres of radii up to 0.01, the distance that its grid keeps around it, got 0.0101 of body 2")


@pytest.mark.parametrize("ending", ["yade", "yade.gz", "xml", "xml.bz2"])
def test_a_saved_scene_goes_on_to_the_last_bit(ending, tmp_path):
    shape = surfaces.half_space((0, 0, -0.1), (0, 0.1, 1)) | surfaces.swept_outline(
        [(0, 0), (0.02, 0), (0, 1 / 30)], -0.1, 0.1
    )
    solid = add_solid(shape | surfaces.sampled(torus, (-0.16, -0.16, -0.06), (0.16, 0.16, 0.06), 0.01))
    solid.shape.color, solid.shape.wire = (0.1, 0.2, 0.3), True
    solid.state.angVel = (0, 0, 2)
    for k in range(4):
        add_sphere((0.06 + 0.021 * k, 0.03, 0.05), velocity=(0.2, 0.1, -1))
    loop(gravity=(0, 0, -G))
    O.run(800, True)
    for _ in range(1000):
        O.step()
        if any(i.isReal and i.phys.slip.norm() > 0 for i in O.interactions):
            break
    assert any(i.isReal and i.id1 == 0 and i.phys.slip.norm() > 0 for i in O.interactions)
    O.save(str(tmp_path / f"solid.{ending}"), quiet=True)

    def state():
        return [[*b.state.pos, *b.state.vel, *b.state.angVel, *b.state.ori] for b in O.bodies]

    def go_on():
        O.run(20, True)
        return state()

    recipe, saved, later = solid.shape.recipe, state(), go_on()
    O.reset()
    O.load(str(tmp_path / f"solid.{ending}"), quiet=True)
    loaded = O.bodies[0].shape
    assert type(loaded) is engines.Solid and loaded.recipe == recipe
    assert tuple(loaded.color) == (0.1, 0.2, 0.3) and loaded.wire
    assert state() == saved and go_on() == later


def test_a_solid_is_made_from_a_surface_or_a_recipe():
    ball = surfaces.ball((0, 0, 0), 1)
    for made in (engines.Solid(ball), engines.Solid(recipe=ball.recipe), engines.Solid(surface=ball, wire=True)):
        assert made.surface == ball and made.recipe == ball.recipe == made.dict()["recipe"]
    assert engines.Solid().surface is None
    made.surface = FLOOR
    assert made.recipe == FLOOR.recipe
    made.recipe = ball.recipe
    assert made.surface == ball
    with pytest.raises(ValueError, match="got 'bal' as word 1 of the recipe"):
        made.recipe = "bal 0 0 0 1"
    assert made.recipe == ball.recipe and made.surface == ball
    with pytest.raises(ValueError, match="ends after word 4"):
        engines.Solid(recipe="ball 0 0 0")


def test_a_damaged_archive_is_refused(tmp_path):
    add_solid(surfaces.ball((0, 0, 0), 0.25))
    O.save(str(tmp_path / "solid.xml"), quiet=True)
    text = (tmp_path / "solid.xml").read_text()
    assert text.count("ball 0.0 0.0 0.0 0.25") == 1
    (tmp_path / "solid.xml").write_text(text.replace("ball 0.0 0.0 0.0 0.25", "ball 0.0 0.0 0.0 0.2S"))
    with pytest.raises(Exception, match="got '0.2S' as word 5"):
        O.load(str(tmp_path / "solid.xml"), quiet=True)


def test_bounds_hold_a_solid_however_it_turns():
    rod = surfaces.cylinder((0, 0, 0), (1, 0, 0), 0.1, 2)
    held, spinning, floor = add_solid(rod), add_solid(rod, position=(0, 5, 0)), add_solid(FLOOR)
    free = add_solid(rod, position=(0, -5, 0), mass=1, inertia=(1, 1, 1), held=False)
    spinning.state.angVel = (0, 0, 1)
    loop()
    O.engines[1].verletDist = 0
    O.step()
    np.testing.assert_allclose([held.bound.min, held.bound.max], [(-1, -0.1, -0.1), (1, 0.1, 0.1)], atol=1e-12)
    reach = math.sqrt(1 + 2 * 0.1**2)  # distance of the box's corners
    for turning in (spinning, free):
        y = turning.state.pos[1]
        np.testing.assert_allclose(
            [turning.bound.min, turning.bound.max], [(-reach, y - reach, -reach), (reach, y + reach, reach)], atol=1e-12
        )
    assert floor.bound.max[2] == pytest.approx(0, abs=1e-12) and floor.bound.max[0] == 1e100 == -floor.bound.min[2]


def test_bounds_turn_with_a_held_solid():
    held = add_solid(surfaces.cylinder((0, 0, 0), (1, 0, 0), 0.1, 2).placed((1, 0, 0)), position=(3, 4, 5))
    held.state.ori = Quaternion((0.6, 0, 0.8), 0.7)
    loop()
    O.engines[1].verletDist = 0
    O.step()
    turn = np.array(held.state.ori.toRotationMatrix())
    middle, half = turn @ (1, 0, 0), np.abs(turn) @ (1, 0.1, 0.1)
    np.testing.assert_allclose(held.bound.min, np.array((3, 4, 5)) + middle - half, atol=1e-12)
    np.testing.assert_allclose(held.bound.max, np.array((3, 4, 5)) + middle + half, atol=1e-12)


def test_endless_solids_fit_a_periodic_cell_and_short_ones_have_images():
    rng = np.random.default_rng(2)
    for surface, place in (
        (FLOOR, lambda a: (0, 0, 0.9 * R)),
        (
            ~surfaces.cylinder((0, 0, 0), (0, 1, 0), 0.4),
            lambda a: ((0.4 - 0.9 * R) * math.cos(a), 0, (0.4 - 0.9 * R) * math.sin(a)),
        ),
        (
            surfaces.cylinder((0, 0, 0), (0, 1, 0), 0.1),
            lambda a: ((0.1 + 0.9 * R) * math.cos(a) + 1, 0, (0.1 + 0.9 * R) * math.sin(a) - 2),
        ),
    ):
        new_scene()
        O.periodic = True
        O.cell.setBox(1, 1, 1)
        add_solid(surface)
        for angle in rng.uniform(0, 2 * math.pi, 100):
            add_sphere(np.array(place(angle)) + (0, rng.uniform(-3, 3), 0)).groupMask = 3
        loop(bigger=True)
        O.engines[1].avoidSelfInteractionMask = 2
        O.dt = 1e-7
        O.run(3, True)
        depths = [i.geom.penetrationDepth for i in O.interactions if i.isReal]
        assert len(depths) == 100
        np.testing.assert_allclose(depths, 0.1 * R, rtol=1e-5)  # spheres move by 1e-7 of it


SORTED_AGAIN = """
import sys
import numpy as np
from graindrive import engines
from graindrive.solids import surfaces
from yade import O, utils
from yade.wrapper import Bo1_Sphere_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom
from yade.wrapper import InsertionSortCollider, InteractionLoop, NewtonIntegrator

O.periodic, O.dt = True, 1e-3
O.cell.setBox(1, 1, 1)
O.materials.append(FrictMat(young=1e3, density=1))
cylinder, plane = surfaces.cylinder((0, 0, 0), (0, 1, 0), 0.1), surfaces.half_space((0, 0, 0), (0, 0, 1))
surface = dict(cylinder=cylinder, plane=plane)[sys.argv[1]]
O.bodies.append(surfaces.body(surface, position=(0.5, 0.5, 0.3)))
for place in np.random.default_rng(1).uniform(0, 1, (200, 3)):
    sphere = O.bodies[O.bodies.append(utils.sphere(place, 0.02))]
    sphere.groupMask, sphere.state.vel, sphere.state.blockedDOFs = 3, np.array((0.5, 0.5, 0.5)) - place, "xyzXYZ"
O.engines = [
    ForceResetter(),
    InsertionSortCollider(
        [Bo1_Sphere_Aabb(), engines.Bo1_Solid_Aabb()], allowBiggerThanPeriod=True, avoidSelfInteractionMask=2, verletDist=0.002
    ),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), engines.Ig2_Solid_Sphere_ScGeom()],
        [engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=0.5)],
        [engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=1e3, poisson=0.3, restitution=0.5)],
    ),
    NewtonIntegrator(damping=0),
]
for _ in range(3):
    O.run(100, True)
    O.engines[1]()
O.dt = 0
O.run(1, True)
places = np.array([b.state.pos for b in O.bodies])[1:] - (0.5, 0.5, 0.3)
near = 1 + np.flatnonzero(surface.distance(places) < 0.02)
found = sorted(max(i.id1, i.id2) for i in O.interactions if i.isReal)
print(O.engines[1].numAction, "sorts", found == sorted(near), len(near))
"""


@pytest.mark.parametrize("kind, least", [("cylinder", 5), ("plane", 20)])
def test_an_endless_solid_in_a_periodic_cell_meets_what_comes_near_later(kind, least):
    """Runs in a separate process, because a collider that does not end cannot be stopped in this one; takes a few seconds."""
    code = [sys.executable, "-c", SORTED_AGAIN, kind]
    said = subprocess.run(code, capture_output=True, text=True, timeout=120, check=True).stdout.split("\n")[-2]
    sorts, _, right, number = said.split()
    assert int(sorts) > 10 and right == "True" and int(number) > least


def refused(error, *words):
    with pytest.raises(error) as refusal:
        O.run(2, True)
    for word in words:
        assert word in str(refusal.value)


def test_scenes_that_the_collider_cannot_handle_are_refused_before_the_run():
    add_solid(FLOOR)
    add_sphere((0, 0, R))
    loop()
    O.bodies[0].shape = engines.Solid()
    refused(ValueError, "the Solid of body 0 needs a surface, got none; give Solid(surface)")
    O.bodies[0].shape = engines.Solid(FLOOR)
    O.periodic = True
    O.cell.setBox(1, 1, 1)
    refused(ValueError, "needs InsertionSortCollider.allowBiggerThanPeriod=True, got False")
    O.engines[1].allowBiggerThanPeriod = True
    O.run(2, True)
    O.bodies[0].shape = engines.Solid(surfaces.ball((0, 0, 0), 0.3))
    refused(ValueError, "no longer than half of the periodic cell along x, 0.5, got 0.6")
    O.bodies[0].shape = engines.Solid(FLOOR)
    O.engines[1].verletDist = -1
    refused(ValueError, "verletDist must be at most 0.9 smallest radii, 0.009, or -0.9, got -1; lower it")
    O.engines[1].verletDist = -0.5
    O.bodies[0].shape = engines.Solid(surfaces.ball((0, 0, 0), 0.1))
    O.cell.hSize = ((1, 0.1, 0), (0, 1, 0), (0, 0, 1))
    refused(ValueError, "must have perpendicular edges, got a sheared one")


def test_what_goes_wrong_in_a_step_stops_the_run_and_is_raised():
    add_solid(surfaces.ball((0, 0, 0), 0.2))
    add_sphere((0, 0, 0.5))
    loop()
    O.periodic = True
    O.cell.setBox(1, 1, 1)
    O.engines = O.engines + [PyRunner(command="grow()", iterPeriod=1, firstIterRun=5)]
    import builtins

    builtins.grow = lambda: setattr(O.bodies[0].shape, "recipe", "ball 0 0 0 0.4")
    O.engines[1].verletDist = 0  # the collider works at each step
    with pytest.raises(RuntimeError, match="no longer than half of the periodic cell"):
        O.run(100, True)
    assert O.iter < 20
    del builtins.grow


def test_a_question_that_the_surface_refuses_is_raised():
    # Distances below a plane that reaches the grid's sides: beyond these the solid is unknown.
    values = " ".join(str(z / 10 - 0.15) for z in range(4) for _ in range(16))
    add_solid(surfaces.Surface("sampled 4 4 4 0 0 0 0.1 0.1 0.1 " + values))
    add_sphere((0.32, 0.1, 0.15 + R))
    loop()
    with pytest.raises(RuntimeError, match="cannot give its distance at the centre of body 1: .*inside its grid"):
        O.run(100, True)
    assert O.iter < 5
    O.bodies[1].state.pos = (0.1, 0.1, 0.15 + R - 1e-4)
    O.run(2, True)
    assert contact().geom.penetrationDepth == pytest.approx(1e-4, rel=1e-3)


def test_yades_own_laws_stand_on_a_solid():
    # YADE's Mindlin law treats the solid as a sphere of radius refR1: half of R by default, as for YADE's walls.
    for factor, radius in ((1, R / 2), (1e12, R)):
        new_scene()
        add_solid(FLOOR)
        add_sphere((0, 0, R - 1e-4))
        loop(
            Law2_ScGeom_MindlinPhys_Mindlin(preventGranularRatcheting=False),
            Ip2_FrictMat_FrictMat_MindlinPhys(),
            solidRadius=factor,
        )
        O.step()
        expected = 4 / 3 * E_EFF * math.sqrt(radius) * 1e-4**1.5
        assert contact().phys.normalForce[2] == pytest.approx(expected, rel=1e-10)  # R - 1e-4 rounds the overlap


@pytest.mark.parametrize(
    "maker, stock",
    [
        (Ip2_FrictMat_FrictMat_FrictPhys, lambda: Law2_ScGeom_FrictPhys_CundallStrack(sphericalBodies=False)),
        (Ip2_FrictMat_FrictMat_MindlinPhys, lambda: Law2_ScGeom_MindlinPhys_Mindlin(preventGranularRatcheting=False)),
    ],
)
def test_yades_own_laws_balance_forces_and_torques_on_a_free_solid(maker, stock):
    solid, ball = lever_scene(None)
    loop(stock(), maker())
    ball.state.pos = np.array(ball.state.pos) - 0.002 * np.array((1, 1, 1)) / math.sqrt(3)
    x1, x2 = np.array(solid.state.pos), np.array(ball.state.pos)
    O.step()
    f1, f2, c = np.array(O.forces.f(0)), np.array(O.forces.f(1)), np.array(contact().geom.contactPoint)
    assert contact().phys.shearForce.norm() > 0
    size = np.linalg.norm(f2)
    np.testing.assert_allclose(f1, -f2, rtol=0, atol=4 * EPS * size)
    np.testing.assert_allclose(O.forces.t(0), np.cross(c - x1, f1), rtol=0, atol=8 * EPS * size * 0.1)
    np.testing.assert_allclose(O.forces.t(1), np.cross(c - x2, f2), rtol=0, atol=8 * EPS * size * 0.1)


def test_our_laws_take_contacts_of_other_makers():
    add_solid(FLOOR)
    add_sphere((0, 0, R - 1e-4))
    loop(maker=Ip2_FrictMat_FrictMat_FrictPhys())
    O.step()
    assert type(contact().phys) is engines.ContactPhys and contact().phys.effectiveRadius == R


def test_a_drive_measures_the_wrench_on_a_solid():
    """The binner finds the force in YADE's force container from contacts."""
    solid, ball = lever_scene(LAWS["hertz_history"](leverArm="radius"))
    ball.state.pos = np.array(ball.state.pos) - 0.002 * np.array((1, 1, 1)) / math.sqrt(3)
    binner = engines.ContactForceBinner(body=0)
    O.engines = O.engines[:3] + [binner] + O.engines[3:]
    O.step()
    size = np.linalg.norm(O.forces.f(0))
    np.testing.assert_allclose(binner.force, O.forces.f(0), rtol=0, atol=4 * EPS * size)
    np.testing.assert_allclose(binner.torque, O.forces.t(0), rtol=0, atol=8 * EPS * size * 0.1)


def test_a_free_solid_needs_mass_and_inertia():
    with pytest.raises(
        ValueError, match="needs mass and inertia > 0 and finite, got 0.0 and \\(0, 0, 0\\); give them or"
    ):
        surfaces.body(FLOOR, held=False)
    assert isinstance(surfaces.body(FLOOR), Body)
    with pytest.raises(ValueError, match="solidRadius must be a number >= 1, got 0.5"):
        engines.Ig2_Solid_Sphere_ScGeom(solidRadius=0.5)
