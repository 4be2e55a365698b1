"""GrainLoop over spheres: against YADE's own loop, the same bits on any number of threads, and its views."""

import disks
import numpy as np
import pytest
import spheres
from graindrive import engines
from yade import O
from yade.minieigenHP import Vector3

DAMPED = {"law": spheres.hertz(gamma_n=50, gamma_t=50), "friction": 0.3}


def state():
    return np.array([[*b.state.pos, *b.state.vel, *b.state.angVel] for b in O.bodies])


def both(build, steps, **settings):
    """The state after some steps on YADE's loop and on GrainLoop."""
    after = []
    for loop in (spheres.loop, spheres.grain_loop):
        build()
        loop(**{**DAMPED, **settings})
        disks.run(steps)
        after.append(state())
    return after


def test_a_falling_bed_moves_as_on_yades_loop():
    yade, grain = both(spheres.bed, 600, gravity=(0.3, 0, -1))
    # The loops turn springs by different formulas: 1e-5 rad a step, and differences of its third power.
    assert np.abs(yade - grain).max() < 1e-6
    assert np.abs(yade[:, 3:6]).max() > 0.1


@pytest.mark.parametrize("law", ["HertzHistory", "HertzRestitution", "SpringDashpot"])
def test_every_law_for_spheres(law):
    made = {
        "HertzHistory": DAMPED["law"],
        "HertzRestitution": engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=2e5, poisson=0.3, restitution=0.7),
        "SpringDashpot": engines.Law2_ScGeom_ContactPhys_SpringDashpot(
            normalStiffness=1e5, tangentialStiffness=3e4, restitution=0.8
        ),
    }[law]
    yade, grain = both(lambda: spheres.bed(layers=2, side=4), 300, law=made, gravity=(0, 0, -1))
    assert np.abs(yade - grain).max() < 1e-6


def test_bodies_held_driven_and_half_free_feel_what_they_feel_on_yades_loop():
    """A sphere that may move along x and turn about y only, a driven one, one with an external force."""

    def build():
        spheres.bed(layers=3, side=4)
        O.bodies[37].state.blockedDOFs = "yzXZ"
        O.bodies[40].state.blockedDOFs, O.bodies[40].state.vel = "xyzXYZ", Vector3(0, 0.5, 0.2)
        O.forces.setPermF(50, Vector3(0.1, -0.2, 0.3))

    build()
    start = state()
    yade, grain = both(build, 900, gravity=(0, 0, -1))
    assert np.abs(yade - grain).max() < 1e-6
    assert tuple(grain[40, 3:6]) == (0, 0.5, 0.2)
    assert (grain[37, [4, 5, 6, 8]] == start[37, [4, 5, 6, 8]]).all() and (grain[37, [3, 7]] != start[37, [3, 7]]).all()


def test_a_clump_tumbles_and_hits_with_an_error_of_the_first_order_of_yades_integrator():
    """Without torque angular momentum is kept to round-off; YADE's own integrator has an error of order dt in the rotation."""
    differences = []
    for dt in (4e-4, 2e-4, 1e-4):
        after = []
        for loop in (spheres.loop, spheres.grain_loop):
            disks.new_scene(dt=dt)
            ident, _ = spheres.free_clump([(0, 0, 0), (0.4, 0, 0), (0.4, 0.4, 0.1)])
            spheres.spin_up(ident, (1, 2, -1))
            spheres.sphere((0.3, 0.2, 1.0), velocity=(0, 0, -1))
            loop(**DAMPED)
            disks.run(round(0.8 / dt))
            after.append(state())
        differences.append(np.abs(after[0] - after[1]).max())
    assert abs(after[0][4, 5] + 1) > 0.2  # the spheres have collided
    assert differences[0] < 1e-3
    assert differences[1] / differences[0] == pytest.approx(0.5, abs=0.05)
    assert differences[2] / differences[1] == pytest.approx(0.5, abs=0.05)


def test_a_clump_without_torque_keeps_its_angular_momentum_and_energy():
    disks.new_scene(dt=1e-3)
    ident, _ = spheres.free_clump([(0, 0, 0), (0.4, 0, 0), (0.4, 0.4, 0.1)])
    spheres.spin_up(ident, (1, 2, -1))
    spheres.grain_loop(**DAMPED)
    body = O.bodies[ident].state
    disks.run(1)
    first = np.array(body.angMom)

    def energy():
        return np.dot(body.angVel, body.angMom) / 2

    start, seen = energy(), []
    for _ in range(40):
        disks.run(500)
        seen.append(energy())
    assert np.abs(np.array(body.angMom) - first).max() < 1e-13  # 20,000 sums of zero, and a round-off of writing
    # Midpoint rule: the energy oscillates by (w dt)^2, 1e-5, and does not drift.
    assert np.abs(np.array(seen) / start - 1).max() < 1e-4


def run_of(steps, **settings):
    spheres.bed()
    ident, _ = spheres.free_clump([(2, 2, 7), (2.4, 2, 7), (2.4, 2.4, 7.1)])
    loop = spheres.grain_loop(gravity=(0.3, 0, -1), **DAMPED, **settings)
    if steps:
        disks.run(steps)
    return loop


def test_same_bits_on_any_number_of_threads():
    run_of(900)
    one = disks.everything()
    run_of(900, threads=2)
    assert (one == disks.everything()).all()


def test_looking_and_asking_change_no_bit():
    run_of(600)
    plain = disks.everything()
    loop = run_of(0)
    for _ in range(6):
        disks.run(100)
        loop.contacts(), loop.presentContacts(), loop.sync(), loop.kineticEnergyOnStep()
    assert (plain == disks.everything()).all()


def test_a_checkpoint_goes_on_to_the_last_bit(tmp_path):
    loop = run_of(400)
    loop.checkpoint(str(tmp_path / "loop"))
    disks.run(500)
    straight = disks.everything()
    loop = run_of(0, threads=2)
    loop.restore(str(tmp_path / "loop"))
    disks.run(500)
    assert (straight == disks.everything()).all()


def test_saved_and_loaded_it_goes_on_with_its_springs(tmp_path):
    loop = run_of(400)
    springs = list(loop.springs)
    assert len(springs) > 5 and len(springs) % 5 == 0
    O.save(str(tmp_path / "scene.yade"))
    disks.run(100)
    straight = state()
    O.reset()
    O.load(str(tmp_path / "scene.yade"))
    assert O.engines[-1].dimensions == 3 and list(O.engines[-1].springs) == springs
    disks.run(100)
    # Springs are restored, but rows are sorted again: sums in another order.
    assert np.abs(straight - state()).max() < 1e-9


def test_contacts_balance_and_carry_the_weight():
    """At rest the contacts of every sphere bear its weight."""
    disks.new_scene(dt=5e-4, period=(4, 4, 50))
    for k in range(4):
        for j in range(4):
            for i in range(4):
                spheres.sphere((i + 0.5, j + 0.5, k * 0.999), 0.5, blocked="xyzXYZ" if k == 0 else "")
    loop = spheres.grain_loop(gravity=(0, 0, -1), law=spheres.hertz(gamma_n=2000, gamma_t=2000))
    disks.run(20000)
    table = loop.presentContacts()
    force = np.zeros((64, 3))
    np.add.at(force, table["j"], table["normal_force"] + table["tangential_force"])
    np.add.at(force, table["i"], -table["normal_force"] - table["tangential_force"])
    weight = 4 / 3 * np.pi / 8
    assert force[16:, 2] == pytest.approx(weight, rel=1e-6)
    assert force[:16, 2] == pytest.approx(-3 * weight, rel=1e-6)  # three layers on each of the base
    assert table["slip"].shape == (len(table["i"]), 3)


def test_a_settled_bed_weighs_on_its_base_what_it_weighs():
    spheres.bed(layers=5, side=4, base=False)
    law = engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=2e5, poisson=0.3, restitution=0.3)
    loop = spheres.grain_loop(law, friction=0.5, gravity=(0, 0, -1))
    loop.setWall("z_low", position=0.45)
    disks.run(100_000)
    weight = sum(b.state.mass for b in O.bodies)
    forces = []
    for _ in range(100):
        disks.run(100)
        forces.append(loop.walls["z_low"]["force"])
    # Sideways forces still oscillate by 1e-3 of the weight, with little effect on the mean; vertical ones by less than 1e-4.
    assert np.mean(forces, axis=0)[2] == pytest.approx(-weight, rel=1e-3)
    assert np.abs(np.mean(forces, axis=0)[:2]).max() < 1e-3 * weight


def test_forces_on_a_driven_sphere_are_the_same_on_both_loops():
    seen = []
    for loop in (spheres.loop, spheres.grain_loop):
        spheres.bed(layers=3, side=5)
        O.bodies[60].state.blockedDOFs = "xyzXYZ"
        drive = engines.SpinTranslateDrive(body=60, velocity=(0.3, 0, 0), spin=(0, 0.7, 0))
        binner = engines.ContactForceBinner(body=60, planeNormal=(0, 1, 0))
        loop(gravity=(0, 0, -1), before_newton=[binner, drive], **DAMPED)
        disks.run(2000)
        seen.append(np.concatenate([binner.force, binner.torque, binner.normalForce]))
    assert np.abs(seen[0]).max() > 0.01
    assert np.abs(seen[0] - seen[1]).max() < 1e-5 * np.abs(seen[0]).max()


def test_a_pressed_lid_and_a_sliding_floor():
    """Six sides: two periodic axes, a floor that slides along x and a lid under pressure, in N/m^2."""
    spheres.bed(layers=4, side=4, base=False)
    loop = spheres.grain_loop(law=spheres.hertz(gamma_n=2000, gamma_t=2000), friction=0.5)
    loop.setWall("z_low", position=0.4, slide=(0.2, 0, 0))
    loop.setWall("z_high", position=6, pressure=3, mass=5, damping=20)
    disks.run(40000)
    pressures = []
    for _ in range(400):
        disks.run(50)
        pressures.append([loop.walls[side]["measuredPressure"] for side in ("z_low", "z_high")])
    assert loop.walls["z_high"]["area"] == 16
    error = np.std(pressures, axis=0) / np.sqrt(20)  # the pressure oscillates: the mean has some 20 independent values
    assert (np.abs(np.mean(pressures, axis=0) - 3) < 3 * error).all() and (error < 0.1).all()
    drawn, aside = np.mean(loop.velocities[:, 0]), np.mean(loop.velocities[:, 1])
    assert drawn > 0.01 and abs(aside) < drawn / 2
    assert set(loop.wallContacts()["side"]) == {"z_low", "z_high"}


@pytest.mark.parametrize(
    "change, words",
    [
        (dict(dimensions=4), "dimensions must be 2 or 3, got 4"),
        (dict(damping=0.2), "non-viscous damping"),
        (
            {"law": "cundallStrack", "young": 1e5, "poisson": 0.3},
            "has only the laws hertzHistory, hertzRestitution and springDashpot",
        ),
        (dict(bounds=[0, 0, 1, 1]), "six numbers"),
        (dict(springs=[1, 2, 3]), "five numbers"),
    ],
)
def test_what_spheres_cannot_have_is_refused(change, words):
    spheres.bed(layers=1, side=4)
    with pytest.raises((ValueError, RuntimeError), match=words):
        loop = spheres.grain_loop()
        loop.updateAttrs(change)
        disks.run(1)


def test_a_scene_in_space_is_refused_by_the_loop_in_the_plane():
    spheres.bed(layers=1, side=4)
    spheres.grain_loop(dimensions=2, periods=(4, 4, 0))
    with pytest.raises((ValueError, RuntimeError), match="GrainLoop.dimensions to 3"):
        disks.run(1)


def test_a_sphere_that_is_moved_by_hand_meets_its_new_neighbours():
    """A moved sphere acts at once, as on YADE's loop, however far it was moved; overlap with another one stops the run."""
    after = []
    for loop in (spheres.loop, spheres.grain_loop):
        disks.new_scene(dt=2e-4)
        for k in range(6):
            spheres.sphere((3 * k, 0, 0))
        loop(**DAMPED)
        disks.run(5)
        O.bodies[0].state.pos = Vector3(14.02, 0, 0)
        disks.run(100)
        after.append(state())
    assert abs(after[0][0, 3]) > 0.1
    # YADE's collider may detect it a step later, so only velocities are the same.
    assert np.abs(after[0] - after[1])[:, 3:].max() < 1e-9
    O.bodies[1].state.pos = O.bodies[2].state.pos + Vector3(0.05, 0, 0)
    with pytest.raises(RuntimeError, match="grain 1 .* grain 2 .* overlap"):
        disks.run(1)


@pytest.mark.parametrize("what, value", [("vel", (np.nan, 0, 0)), ("pos", (0, np.inf, 0)), ("angVel", (0, 0, np.nan))])
def test_motions_that_are_none_name_the_body_at_once(what, value):
    disks.new_scene(dt=2e-4)
    spheres.sphere((0, 0, 0)), spheres.frozen((3, 0, 0), velocity=(1, 0, 0))
    loop = spheres.grain_loop(**DAMPED)
    disks.run(2)
    for ident in (0, 1):
        before = Vector3(*getattr(O.bodies[ident].state, what))
        setattr(O.bodies[ident].state, what, Vector3(*value))
        with pytest.raises(RuntimeError, match=f"of body {ident} is not finite"):
            disks.run(1)
        setattr(O.bodies[ident].state, what, before)
    with pytest.raises(ValueError, match="must be finite"):
        loop.setLoad(0, (np.nan, 0, 0))
    with pytest.raises(ValueError, match="body 99 is not in O.bodies"):
        loop.setLoad(99, (0, 0, 0))
