"""YADE's own laws and damping on GrainLoop against YADE's own loop: pairs, settling beds, clumps, threads, restarts, take-over.

YADE turns the remembered tangential force to first order, F -= F x (n_old x n_new), which lengthens it by s^2/2 in a step
that turns the contact by s; GrainLoop turns it exactly. `step_exactly` gives YADE a force that its own rule turns into the
exact one, so that all else can be compared to round-off; other tests say how far plain YADE is off.
"""

import math
import re

import disks
import numpy as np
import pytest
from graindrive.loops import grain_loop, loop_laws
from graindrive.base.errors import UsageError
from yade import O, utils
from yade.minieigenHP import Vector3
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Facet_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    Law2_ScGeom_MindlinPhys_HertzWithLinearShear,
    Law2_ScGeom_MindlinPhys_Mindlin,
    MatchMaker,
    NewtonIntegrator,
)

PAIR = dict(young=1e6, dt=2e-5)


def constant(value):
    return MatchMaker(algo="val", val=value)


LAWS = {
    "cundallStrack": lambda: (Ip2_FrictMat_FrictMat_FrictPhys(), Law2_ScGeom_FrictPhys_CundallStrack()),
    "hertzMindlin": lambda: (Ip2_FrictMat_FrictMat_MindlinPhys(), Law2_ScGeom_MindlinPhys_Mindlin()),
    "hertzMindlin, damped": lambda: (
        Ip2_FrictMat_FrictMat_MindlinPhys(en=constant(0.6), es=constant(0.8)),
        Law2_ScGeom_MindlinPhys_Mindlin(),
    ),
}
ELASTIC = {"cundallStrack": "shearForce", "hertzMindlin": "shearElastic", "hertzMindlin, damped": "shearElastic"}


def new_scene(young=1e6, dt=2e-5, angle=0.5, period=None):
    disks.new_scene(dt=dt, period=period)
    return O.materials.append(FrictMat(density=1, young=young, poisson=0.3, frictionAngle=angle))


def sphere(x, y, radius=0.5, velocity=(0, 0), spin=0.0, frozen=False):
    """A sphere as utils.sphere makes it, with a sphere's mass and inertia, kept in the plane."""
    body = utils.sphere((x, y, 0), radius, color=(1, 1, 1), material=O.materials[len(O.materials) - 1])
    body.state.vel, body.state.angVel = Vector3(*velocity, 0), Vector3(0, 0, spin)
    body.state.blockedDOFs = "xyzXYZ" if frozen else "zXY"
    return O.bodies.append(body)


def engines_of(law, damping=0.0, gravity=0.0, **newton):
    ip2, law2 = LAWS[law]()
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.1),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [ip2], [law2]),
        NewtonIntegrator(damping=damping, gravity=(0, gravity, 0), **newton),
    ]


def step_exactly(steps, law):
    """YADE's loop with the remembered force turned exactly: F is set so that YADE's first-order rule makes of it F_t t_new."""
    name = ELASTIC[law]
    for _ in range(steps):
        for contact in O.interactions:
            if not contact.isReal:
                continue
            old = contact.geom.normal
            branch = O.bodies[contact.id2].state.pos - O.bodies[contact.id1].state.pos
            new = branch / branch.norm()
            force = getattr(contact.phys, name).dot(Vector3(-old[1], old[0], 0))
            s = old[0] * new[1] - old[1] * new[0]
            x, y = -new[1] * force, new[0] * force
            setattr(contact.phys, name, Vector3((x + s * y), (y - s * x), 0) / (1 + s * s))
        O.step()


def moving_parts():
    return np.array([[*b.state.pos, *b.state.vel, b.state.angVel[2]] for b in O.bodies])


# Impacts of equal and unequal disks.
IMPACTS = {
    "sticking": dict(radii=(0.5, 0.5), velocities=((1, 0.05), (-1, -0.05)), spins=(0.1, 0.1)),
    "oblique": dict(radii=(0.5, 0.5), velocities=((1, 2), (-1, -1)), spins=(3, -1)),
    "sliding": dict(radii=(0.5, 0.5), velocities=((1, 0), (-1, 0)), spins=(8, 8)),
    "unequal": dict(radii=(0.5, 0.2), velocities=((1, 0.3), (-1, -0.2)), spins=(3, -7)),
    "unequal, oblique": dict(radii=(0.2, 0.6), velocities=((1, 2), (-1, -1)), spins=(9, 2)),
    "head-on": dict(radii=(0.5, 0.4), velocities=((1, 0), (-1, 0)), spins=(0, 0)),
}


def impact(law, radii, velocities, spins, frozen=None, damping=0.0):
    new_scene(**PAIR)
    reach = sum(radii) + 1.3e-5  # a small gap, because within round-off YADE and GrainLoop may disagree on what touches
    for k in range(2):
        at = (0, 0) if k == 0 else (reach * math.cos(0.3), reach * math.sin(0.3))
        held = k == frozen
        sphere(*at, radii[k], (0, 0) if held else velocities[k], 0 if held else spins[k], frozen=held)
    engines_of(law, damping=damping)


def contact_steps(law, **case):
    """The number of steps of the impact."""
    impact(law, **case)
    for step in range(1, 2000):
        O.step()
        if step > 2 and not any(i.isReal for i in O.interactions):
            return step
    raise AssertionError("the disks do not part")


@pytest.mark.parametrize("frozen", [None, 0])
@pytest.mark.parametrize("case", IMPACTS)
@pytest.mark.parametrize("law", LAWS)
def test_an_impact_is_yades_to_round_off_where_yade_turns_forces_exactly(law, case, frozen):
    steps = contact_steps(law, **IMPACTS[case], frozen=frozen) + 5
    assert steps > 20
    impact(law, **IMPACTS[case], frozen=frozen)
    step_exactly(steps, law)
    expected = moving_parts()
    impact(law, **IMPACTS[case], frozen=frozen)
    grain_loop.use_grain_loop()
    disks.run(steps)
    # Overlaps of 1e-3 are differences of numbers of order 1, so forces have a relative error of 1e-13; velocities are about 10.
    np.testing.assert_allclose(moving_parts(), expected, rtol=0, atol=1e-12)


def difference_from_plain_yade(law, case, dt, steps):
    impact(law, **IMPACTS[case])
    O.dt = dt
    disks.run(steps)
    expected = moving_parts()
    impact(law, **IMPACTS[case])
    O.dt = dt
    grain_loop.use_grain_loop()
    disks.run(steps)
    return np.abs(moving_parts() - expected).max()


@pytest.mark.parametrize("law", LAWS)
def test_plain_yade_is_off_by_its_first_order_turning(law):
    steps = contact_steps(law, **IMPACTS["oblique"]) + 5
    coarse = difference_from_plain_yade(law, "oblique", PAIR["dt"], steps)
    fine = difference_from_plain_yade(law, "oblique", PAIR["dt"] / 4, 4 * steps)
    # A step turns the contact by s = v_t dt/r <= 3 * 2e-5 and lengthens the force by s^2/2 < 2e-9: over 500 steps 1e-6 of a
    # velocity of about 1. With four times as many steps, each adding a sixteenth, the error is a quarter.
    assert 1e-9 < coarse < 1e-6
    assert coarse / fine == pytest.approx(4, rel=0.05)


@pytest.mark.parametrize("law", LAWS)
def test_damping_of_a_spinning_impact_is_yades(law):
    case = IMPACTS["unequal"]
    steps = contact_steps(law, **case, damping=0.3) + 5
    impact(law, **case, damping=0.3)
    step_exactly(steps, law)
    expected = moving_parts()
    impact(law, **case, damping=0.3)
    grain_loop.use_grain_loop()
    disks.run(steps)
    np.testing.assert_allclose(moving_parts(), expected, rtol=0, atol=1e-12)  # the same as without damping


@pytest.mark.parametrize("damps_gravity", [True, False])
@pytest.mark.parametrize("velocity", [0.0, 2e-5, 1e-4, -3.0])
def test_damping_slows_what_speeds_up_and_gravity_counts_if_asked(velocity, damps_gravity):
    def build():
        new_scene()
        sphere(0, 0, velocity=(0.5, velocity))
        sphere(5, 0)
        engines_of("cundallStrack", damping=0.2, gravity=-9.81, dampGravity=damps_gravity)

    build()
    disks.run(30)
    expected = moving_parts()
    build()
    grain_loop.use_grain_loop()
    disks.run(30)
    np.testing.assert_allclose(moving_parts(), expected, rtol=0, atol=1e-15)  # 30 sums of numbers of 1e-3
    assert (moving_parts()[1, 4] == pytest.approx(-9.81 * 30 * O.dt, rel=1e-12)) == (not damps_gravity)


BED_STEPS = 600


def bed(law, damping=0.2, **newton):
    """Spheres pressed together in a trough of frozen ones, which jump apart and settle, with a clump of two among them."""
    new_scene(young=2e5, dt=1e-4)
    rng = np.random.default_rng(8)
    for row in range(17):
        for column in range(20):
            at = 0.985 * (column + row % 2 / 2), 0.985 * math.sqrt(3) / 2 * row
            if (row, column) in ((8, 9), (8, 10)):
                continue
            held = row == 0 or column in (0, 19)
            velocity, spin = ((0, 0), 0) if held else (rng.uniform(-0.3, 0.3, 2), rng.uniform(-1, 1))
            sphere(*at, rng.uniform(0.488, 0.494), velocity, spin, frozen=held)
    members = [sphere(0.985 * (9 + k), 0.985 * math.sqrt(3) / 2 * 8, 0.48) for k in (0, 1)]
    O.bodies[O.bodies.clump(members)].state.blockedDOFs = "zXY"
    engines_of(law, damping=damping, gravity=-9.81, **newton)


@pytest.mark.parametrize("damps_gravity", [True, False])
@pytest.mark.parametrize("law", LAWS)
def test_a_damped_bed_with_a_clump_settles_as_on_yades_loop(law, damps_gravity):
    bed(law, dampGravity=damps_gravity)
    disks.run(BED_STEPS)
    expected = moving_parts()
    assert sum(i.isReal for i in O.interactions) > 150
    bed(law, dampGravity=damps_gravity)
    grain_loop.use_grain_loop()
    disks.run(BED_STEPS)
    # At 0.3 a contact turns by 3e-5 a step and YADE lengthens its force by 5e-10; over 600 steps that makes 3e-7 of velocities
    # and spins of 1, times the growth of a difference by collisions, about 10 without dashpots.
    found = moving_parts()
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-5)
    np.testing.assert_allclose(found[:, :3], expected[:, :3], rtol=0, atol=1e-7)


@pytest.mark.parametrize("law", LAWS)
def test_a_damped_bed_with_a_clump_is_yades_to_round_off_where_yade_turns_forces_exactly(law):
    bed(law)
    step_exactly(400, law)
    expected = moving_parts()
    bed(law)
    grain_loop.use_grain_loop()
    disks.run(400)
    # Forces have errors of 1e-13 (see impacts), which grow to 1e-10 in 400 steps without dashpots, and less with them.
    np.testing.assert_allclose(moving_parts(), expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_a_contact_keeps_what_it_remembers_when_the_scene_moves_over(law):
    case = IMPACTS["unequal"]
    steps = contact_steps(law, **case) + 5
    impact(law, **case)
    step_exactly(steps, law)
    expected = moving_parts()
    impact(law, **case)
    step_exactly(steps // 2, law)
    loop = grain_loop.use_grain_loop()
    assert len(loop.springs) == 3 and loop.springs[2] != 0
    disks.run(steps - steps // 2)
    np.testing.assert_allclose(moving_parts(), expected, rtol=0, atol=1e-12)  # as impacts


@pytest.mark.parametrize("law", LAWS)
def test_contacts_tell_yades_forces(law):
    bed(law)
    disks.run(BED_STEPS)
    expected = {}
    for i in O.interactions:
        held = [O.bodies[k].state.blockedDOFs == "xyzXYZ" for k in (i.id1, i.id2)]
        if i.isReal and i.phys.normalForce.norm() > 0 and not all(held):
            sign = 1 if i.id1 < i.id2 else -1
            key = min(i.id1, i.id2), max(i.id1, i.id2)
            elastic = getattr(i.phys, ELASTIC[law]).norm()
            bound = i.phys.normalForce.norm() * math.tan(0.5)
            forces = (*list(sign * i.phys.normalForce)[:2], *list(sign * i.phys.shearForce)[:2], elastic)
            expected[key] = np.array([*forces, *list(i.geom.contactPoint)[:2]]), elastic >= bound * (1 - 1e-9)
    bed(law)
    loop = grain_loop.use_grain_loop()
    disks.run(BED_STEPS)
    table, seen = loop.contacts(), 0
    for k, (i, j) in enumerate(zip(table["i"], table["j"])):
        sign = 1 if i < j else -1
        forces, slipping = expected[min(i, j), max(i, j)]
        found = [
            *(sign * table["normal_force"][k][:2]),
            *(sign * table["tangential_force"][k][:2]),
            abs(table["slip"][k]),
        ]
        # Positions agree to 1e-7 (see above), stiffnesses are 1e5, dashpots 1e2 times velocities that agree to 1e-5.
        np.testing.assert_allclose(found, forces[:5], rtol=0, atol=1e-2)
        np.testing.assert_allclose(
            table["point"][k][:2], forces[5:], rtol=0, atol=1e-3
        )  # the displacement in a step; the disk's radius is 0.45
        assert bool(table["slipping"][k]) == slipping
        seen += 1
    assert seen == len(expected) > 150
    assert 10 < sum(table["slipping"]) < seen - 10


@pytest.mark.parametrize("law", LAWS)
def test_a_driven_clump_feels_yades_force_and_torque(law):
    def build():
        bed(law)
        clump = next(b.id for b in O.bodies if b.isClump)
        drive = disks.engines.SpinTranslateDrive(body=clump, velocity=(0.5, 0, 0), spin=(0, 0, 3), label="drive")
        O.engines = [*O.engines[:-1], drive, O.engines[-1]]

    build()
    disks.run(300)
    drive = disks.engine("drive")
    expected = [*drive.force, drive.torque[2], drive.work]
    build()
    grain_loop.use_grain_loop()
    disks.run(300)
    drive = disks.engine("drive")
    assert abs(expected[3]) > 1e-2
    np.testing.assert_allclose([*drive.force, drive.torque[2], drive.work], expected, rtol=1e-4, atol=1e-3)


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("processor", ["portable", ""])
@pytest.mark.parametrize("law", LAWS)
def test_threads_and_a_restart_give_the_same_bits(law, processor, precision, monkeypatch, tmp_path):
    if processor:
        monkeypatch.setenv("GRAINDRIVE_PROCESSOR", processor)
    seen, path = [], str(tmp_path / "loop.checkpoint")
    for threads in (1, 2):
        bed(law)
        loop = grain_loop.use_grain_loop(threads=threads, precision=precision)
        disks.run(200)
        loop.checkpoint(path)
        disks.run(200)
        seen.append(moving_parts())
    loop.restore(path)
    disks.run(200)
    assert np.array_equal(seen[0], seen[1])
    assert np.array_equal(moving_parts(), seen[1])


@pytest.mark.parametrize("law", LAWS)
def test_every_processors_kernel_computes_the_same(law, monkeypatch):
    seen = []
    for processor in ("portable", ""):
        monkeypatch.setenv("GRAINDRIVE_PROCESSOR", processor)
        bed(law)
        grain_loop.use_grain_loop()
        disks.run(300)
        seen.append(moving_parts())
    np.testing.assert_allclose(
        seen[0], seen[1], rtol=0, atol=1e-9
    )  # fused multiply-adds have other round-off; it grows as that of ROUND_OFF elsewhere


def test_single_precision_stays_near_double():
    seen = []
    for precision in ("double", "single"):
        impact("hertzMindlin, damped", **IMPACTS["unequal"])
        grain_loop.use_grain_loop(precision=precision)
        disks.run(300)
        seen.append(moving_parts())
    np.testing.assert_allclose(
        seen[1], seen[0], rtol=0, atol=1e-3
    )  # float round-off of 1e-7 against overlaps of 1e-3, velocities of 7


@pytest.mark.parametrize("en", [0.1, 0.35, 0.6, 0.9, 0.999, 1.0])
def test_a_restitution_becomes_yades_damping_ratio(en):
    ip2 = Ip2_FrictMat_FrictMat_MindlinPhys(en=constant(en), es=constant(0.5))
    new_scene(), sphere(0, 0), sphere(0.99, 0)
    engines_of("hertzMindlin")
    O.engines[2].physDispatcher.functors = [ip2]
    O.step()
    phys = next(i for i in O.interactions if i.isReal).phys
    found = loop_laws.damping_ratios(ip2)
    # 1 - (1 + e)^2 exp(...) nearly cancels for e near 1
    assert found["normalDampingRatio"] == pytest.approx(phys.betan, rel=1e-9)
    assert found["tangentialDampingRatio"] == pytest.approx(phys.betas, rel=1e-9)


@pytest.mark.parametrize(
    "given, ratios",
    [
        (dict(betan=0.1), (0.1, 0.1)),
        (dict(betan=0.1, betas=0.3), (0.1, 0.3)),
        (dict(betas=0.3), (0.0, 0.3)),
        (dict(es=0.5), None),
        (dict(), (0.0, 0.0)),
    ],
)
def test_damping_ratios_are_made_as_yade_makes_them(given, ratios):
    ip2 = Ip2_FrictMat_FrictMat_MindlinPhys(**{key: constant(value) for key, value in given.items()})
    new_scene(), sphere(0, 0), sphere(0.99, 0)
    engines_of("hertzMindlin")
    O.engines[2].physDispatcher.functors = [ip2]
    O.step()
    phys = next(i for i in O.interactions if i.isReal).phys
    found = tuple(loop_laws.damping_ratios(ip2).values())
    assert found == pytest.approx((phys.betan, phys.betas), rel=1e-12)
    assert ratios is None or found == ratios


def test_constants_come_from_the_bodies_materials():
    new_scene(young=3e5, angle=0.3)
    sphere(0, 0), sphere(5, 0)
    O.materials.append(FrictMat(young=1e9, frictionAngle=1.2))  # no body has this material
    engines_of("cundallStrack", damping=0.4, dampGravity=False)
    functors = O.engines[2].geomDispatcher.functors
    O.engines[2].geomDispatcher.functors = [
        Ig2_Facet_Sphere_ScGeom(),
        *functors,
    ]  # other shapes' functors do not matter
    loop = grain_loop.use_grain_loop()
    assert (loop.law, loop.young, loop.poisson, loop.friction) == ("cundallStrack", 3e5, 0.3, math.tan(0.3))
    assert (loop.damping, loop.dampGravity) == (0.4, False)


def other_material():
    O.bodies[1].mat = FrictMat(young=2e6, poisson=0.3, frictionAngle=0.5)


def of_ip2(**attributes):
    def change():
        for key, value in attributes.items():
            setattr(O.engines[2].physDispatcher.functors[0], key, value)

    return change


def of_law(**attributes):
    def change():
        for key, value in attributes.items():
            setattr(O.engines[2].lawDispatcher.functors[0], key, value)

    return change


def of_ig2(**attributes):
    def change():
        for key, value in attributes.items():
            setattr(O.engines[2].geomDispatcher.functors[0], key, value)

    return change


def undamped_body():
    O.bodies[1].state.isDamped = False


def free_clump():
    members = [sphere(9 + 0.6 * k, 8, 0.45) for k in (0, 1)]
    O.bodies.clump(members)


CS, HM = "cundallStrack", "hertzMindlin"


@pytest.mark.parametrize(
    "law, change, words",
    [
        (CS, other_material, "young of body 1 is 2e+06, that of body 0 is 1e+06"),
        (CS, of_ip2(kn=MatchMaker(algo="val", val=1e6)), "Ip2_FrictMat_FrictMat_FrictPhys.kn"),
        (CS, of_ip2(frictAngle=MatchMaker(matches=((0, 0, 0.3),))), "frictAngle must not list matches"),
        (CS, of_law(traceEnergy=True), "CundallStrack.traceEnergy: it must be False, got True"),
        (CS, of_law(neverErase=True), "CundallStrack.neverErase"),
        (CS, of_ig2(avoidGranularRatcheting=False), "avoidGranularRatcheting: it must be True, got False"),
        (HM, of_law(includeAdhesion=True), "Mindlin.includeAdhesion"),
        (HM, of_law(includeMoment=True), "Mindlin.includeMoment"),
        (HM, of_law(calcEnergy=True), "Mindlin.calcEnergy"),
        (HM, of_ip2(gamma=1.0), "MindlinPhys.gamma"),
        (HM, of_ip2(eta=0.1), "MindlinPhys.eta"),
        (HM, of_ip2(krot=0.1), "MindlinPhys.krot"),
        (HM, of_ip2(ktwist=0.1), "MindlinPhys.ktwist"),
        (HM, of_ip2(en=constant(0.5), betan=constant(0.1)), "only one of en and betan"),
        (CS, undamped_body, "body 1 has state.isDamped=False"),
        (CS, free_clump, "clump 4 may turn about x and y"),
    ],
)
def test_what_grainloop_would_compute_otherwise_is_refused_by_name(law, change, words):
    new_scene(), sphere(0, 0), sphere(5, 0)
    engines_of(law, damping=0.1)
    change()
    with pytest.raises(UsageError, match=re.escape(words)):
        grain_loop.use_grain_loop()


def test_an_ip2_of_another_law_and_a_law_of_another_kind_are_refused():
    new_scene(), sphere(0, 0), sphere(5, 0)
    engines_of("cundallStrack")
    O.engines[2].physDispatcher.functors = [Ip2_FrictMat_FrictMat_MindlinPhys()]
    with pytest.raises(
        UsageError, match="CundallStrack with Ip2_FrictMat_FrictMat_FrictPhys only, got Ip2_FrictMat_FrictMat_Min"
    ):
        grain_loop.use_grain_loop()
    O.engines[2].lawDispatcher.functors = [Law2_ScGeom_MindlinPhys_HertzWithLinearShear()]
    with pytest.raises(
        UsageError, match="GrainLoop knows the laws .* the scene uses Law2_ScGeom_MindlinPhys_HertzWithLinearShear"
    ):
        grain_loop.use_grain_loop()


@pytest.mark.parametrize("law", ["cundallStrack", "hertzMindlin"])
def test_the_energy_ledger_and_walls_are_refused_by_the_laws_name(law):
    bed(law, damping=0.0)
    loop = grain_loop.use_grain_loop(trackEnergy=True)
    with pytest.raises(ValueError, match="no exact entries for the laws cundallStrack and hertzMindlin"):
        loop.positions
    bed(law, damping=0.0)
    loop = grain_loop.use_grain_loop()
    with pytest.raises(ValueError, match="cundallStrack and hertzMindlin are for pairs of disks"):
        loop.setWall("x_low", position=-1)
        loop.positions


def test_the_energy_ledger_needs_no_damping():
    disks.shaken_bed()
    loop = grain_loop.use_grain_loop(damping=0.2, trackEnergy=True)
    with pytest.raises(ValueError, match="energy ledger needs damping = 0, got 0.2"):
        loop.positions


def test_settings_out_of_range_are_refused():
    for settings, words in (
        (dict(damping=1.0), "damping must lie in .0, 1., got 1"),
        (dict(damping=-0.1), "damping must lie in .0, 1., got -0.1"),
        (dict(normalDampingRatio=-1), "GrainLoop.normalDampingRatio must not be negative, got -1"),
        (dict(law="cundallStrack", poisson=-0.2), "GrainLoop.poisson must not be negative, got -0.2"),
        (dict(law="mindlin"), "'cundallStrack' or 'hertzMindlin', got mindlin"),
    ):
        with pytest.raises(ValueError, match=words):
            disks.engines.GrainLoop(**settings)
