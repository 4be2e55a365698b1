"""Contacts before a step are those that YADE's next step finds: the same pairs, forces, overlaps and springs."""

import disks
import numpy as np
import pytest
import spheres
from graindrive import engines
from graindrive.solids import surfaces
from yade import O
from yade import wrapper as w

LAWS = {
    "hertz_history": lambda lever: disks.hertz(2e5, 2.46e5, 250, 250, leverArm=lever),
    "hertz_restitution": lambda lever: engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=5e5, leverArm=lever),
    "spring_dashpot": lambda lever: engines.Law2_ScGeom_ContactPhys_SpringDashpot(leverArm=lever),
}


@pytest.fixture(autouse=True)
def after():
    yield
    O.reset()


def crowd(law, period=None):
    """Overlapping, spinning disks and a clump over a frozen row; in a periodic cell some pairs touch across its side."""
    disks.new_scene(dt=1e-4, period=period)
    rng = np.random.default_rng(3)
    for x in range(5):
        disks.disk(x + 0.5, 0.0, frozen=True)
        for y in range(1, 4):
            at = (x + 0.5 + rng.uniform(-0.02, 0.02), 0.97 * y)
            disks.disk(*at, rng.uniform(0.49, 0.52), rng.uniform(-1, 1, 2), rng.uniform(-2, 2))
    disks.clump([(-0.4, 0), (0.4, 0)], at=(2.5, 3.85), radius=0.5)
    disks.loop(law, friction=0.3)


def present():
    contacts = disks.engine("contacts")
    law, maker = contacts.lawDispatcher.functors[0], contacts.physDispatcher.functors[0]
    return engines.present_contacts(O._sceneObj, law, maker)


def by_pair(table, columns):
    """Return {(i, j): numbers}, of pairs that are not both frozen."""
    rows = zip(table["i"], table["j"], *(table[name] for name in columns))
    frozen = {b.id for b in O.bodies if b.state.blockedDOFs == "xyzXYZ"}
    return {(i, j): np.hstack(rest) for i, j, *rest in rows if not {i, j} <= frozen}


COLUMNS = ("overlap", "normal", "normal_force", "tangential_force", "slipping")


@pytest.mark.parametrize("period", [None, (5, 40, 5)])
@pytest.mark.parametrize("lever", ["radius", "contactPoint"])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("steps", [0, 30])
def test_the_next_step_finds_them(law, lever, period, steps):
    crowd(LAWS[law](lever), period)
    if steps:
        disks.run(steps)
    before, springs = by_pair(present(), COLUMNS), by_pair(present(), ["slip"])
    O.step()
    found = by_pair(engines.contact_table(O._sceneObj), COLUMNS)
    assert before.keys() == found.keys() and len(found) > 15
    # YADE computes positions of images in another order: round-off of positions of 5, times the stiffness of 2e5.
    for pair, numbers in found.items():
        np.testing.assert_allclose(before[pair], numbers, rtol=1e-9, atol=5 * disks.EPS * 2e5)
        phys, geom = O.interactions[pair[0], pair[1]].phys, O.interactions[pair[0], pair[1]].geom
        spring = np.dot(phys.slip, (-geom.normal[1], geom.normal[0], 0))
        np.testing.assert_allclose(springs[pair], spring, rtol=1e-9, atol=5 * disks.EPS)


def loop_with_solids(law):
    """YADE's loop for spheres and solids, an endless one among them."""
    makers = [w.Ig2_Sphere_Sphere_ScGeom(), engines.Ig2_Solid_Sphere_ScGeom()]
    phys = engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=0.3)
    collider = w.InsertionSortCollider([w.Bo1_Sphere_Aabb(), engines.Bo1_Solid_Aabb()], allowBiggerThanPeriod=True)
    contacts = w.InteractionLoop(makers, [phys], [law], label="contacts")
    O.engines = [w.ForceResetter(), collider, contacts, w.NewtonIntegrator(damping=0)]


@pytest.mark.parametrize("lever", ["radius", "contactPoint"])
@pytest.mark.parametrize("steps", [0, 20])
def test_the_next_step_finds_contacts_with_solids(lever, steps):
    """An endless cylinder in a periodic cell, which spheres touch through its side too, and a ball that is free to recoil."""
    disks.new_scene(dt=1e-4, period=(8, 8, 40))
    cylinder = surfaces.body(surfaces.cylinder((0, 0, 0), (0, 1, 0), 1.5), position=(7.5, 3, 0))
    cylinder.state.vel, cylinder.state.angVel = (0.3, 0, 0), (0, 0.5, 0)
    ball = surfaces.ball((0, 0, 0), 1.0)
    O.bodies.append(cylinder)
    O.bodies.append(surfaces.body(ball, position=(3.5, 3, 0), mass=5.0, inertia=(2, 2, 2), held=False))
    rng = np.random.default_rng(4)
    for a in (0.4, 1.7, 2.9, 4.5):
        reach = 1.99 + rng.uniform(-0.01, 0.005)
        at = (7.5 + reach * np.cos(a), rng.uniform(0, 8), reach * np.sin(a))
        spheres.sphere(at, velocity=rng.uniform(-1, 1, 3), spin=rng.uniform(-2, 2, 3))
        at = (3.5 + 1.49 * np.cos(a), 3, 1.49 * np.sin(a))
        spheres.sphere(at, velocity=rng.uniform(-1, 1, 3), spin=rng.uniform(-2, 2, 3))
    loop_with_solids(engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=5e5, leverArm=lever))
    if steps:
        disks.run(steps)
    columns = ("overlap", "normal", "normal_force", "tangential_force", "slipping")
    table = present()
    before, slips = by_pair(table, columns), by_pair(table, ["slip_vector"])
    O.step()
    found = by_pair(engines.contact_table(O._sceneObj), columns)
    assert before.keys() == found.keys() and len(found) >= 6 and all(min(pair) < 2 for pair in found)
    for pair, numbers in found.items():  # tolerances as above
        np.testing.assert_allclose(before[pair], numbers, rtol=1e-9, atol=10 * disks.EPS * 5e5)
        np.testing.assert_allclose(slips[pair], O.interactions[pair].phys.slip, rtol=1e-9, atol=10 * disks.EPS)


def test_looking_changes_no_bit():
    def everything(*, looking):
        crowd(LAWS["hertz_history"]("radius"))
        for _ in range(200):
            if looking:
                present()
            O.step()
        return disks.everything()

    assert np.array_equal(everything(looking=False), everything(looking=True))


def test_a_damped_contact_that_separates_pulls():
    """K_n delta < m_eff gamma_n v_n: the force on j points back to i."""
    disks.new_scene()
    disks.disk(0, 0, velocity=(-1, 0))
    disks.disk(0.999, 0, velocity=(1, 0))
    disks.loop(disks.hertz(gamma_n=2500))
    table = present()
    mass = np.pi / 8  # reduced, of two disks of pi/4
    expected = np.sqrt(0.25 * 0.001) * (2e5 * 0.001 - mass * 2500 * 2)
    assert expected < 0 and table["normal_force"][0] @ table["normal"][0] == pytest.approx(expected, rel=1e-9)


def test_each_pair_of_a_narrow_periodic_box_stands_once():
    disks.new_scene(period=(2, 10, 10))
    disks.disk(0.0, 0.0, radius=0.52)
    disks.disk(1.0, 0.0, radius=0.52)
    disks.disk(3.5, 0.8, radius=0.5)
    disks.loop()
    table = present()
    assert sorted(zip(table["i"], table["j"])) == [(0, 1), (0, 2), (1, 2)]


def test_another_law_is_refused_by_name():
    disks.new_scene()
    disks.loop()
    maker = disks.engine("contacts").physDispatcher.functors[0]
    with pytest.raises(ValueError, match="needs one of Graindrive's laws, .* got Law2_ScGeom_FrictPhys_CundallStrack"):
        engines.present_contacts(O._sceneObj, w.Law2_ScGeom_FrictPhys_CundallStrack(), maker)
