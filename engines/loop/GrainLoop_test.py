"""GrainLoop in YADE: the same motion as YADE's own loop with the same law, drives and measures, and the same interface."""

import math

import disks
import numpy as np
import pytest
from graindrive import engines
from graindrive.loops import grain_loop
from yade import O

STEPS = 1500  # the bed has fallen onto its base and is being shaken
# The loops add the same forces in different orders: 1e-16 a step, times the growth of round-off in 1500 steps of shaken grains.
ROUND_OFF = 1e-9


def both_loops(build, steps=STEPS, **settings):
    """Return the results of `observe` after some steps on YADE's loop and on GrainLoop, as two arrays."""
    build()
    disks.run(steps)
    expected = disks.everything()
    build()
    loop = grain_loop.use_grain_loop(**settings)
    disks.run(steps)
    return expected, disks.everything(), loop


def moving_parts(rows):
    """Positions, velocities and spins; orientations of free disks are not kept."""
    return np.c_[rows[:, 0:6], rows[:, 10:13]]


def assert_same_motion(expected, found, tolerance=ROUND_OFF):
    np.testing.assert_allclose(moving_parts(found), moving_parts(expected), rtol=0, atol=tolerance)


def collision():
    disks.new_scene()
    disks.disk(0, 0, velocity=(1, 0.2), spin=3)
    disks.disk(1.05, 0.3, velocity=(-1, 0), spin=1)
    disks.loop(disks.hertz(gamma_n=50, gamma_t=50), friction=0.4)


def test_two_disks_collide_as_on_yades_loop():
    expected, found, _ = both_loops(collision, steps=2000)
    # Few collisions: only the round-off of 2000 steps.
    assert_same_motion(expected, found, 1e-11)


def test_a_bed_with_every_drive_moves_as_on_yades_loop():
    expected, found, _ = both_loops(disks.shaken_bed)
    assert_same_motion(expected, found)


def test_drives_and_measures_see_the_same_forces():
    def seen():
        return (
            *disks.engine("shake").force,
            *disks.engine("drum").force,
            disks.engine("drum").torque[2],
            disks.engine("shake").work,
            disks.engine("drum").work,
            *disks.engine("bins").lastForce,
            disks.engine("bins").lastContactNumber,
            *np.ravel(disks.engine("bins").normalForce),
            *np.ravel(disks.engine("bins").tangentialForce),
        )

    disks.shaken_bed()
    disks.run(STEPS)
    expected = seen()
    disks.shaken_bed()
    grain_loop.use_grain_loop()
    disks.run(STEPS)
    # Forces are stiffness (1e5) times positions that agree to ROUND_OFF.
    np.testing.assert_allclose(seen(), expected, rtol=1e-6, atol=1e5 * ROUND_OFF)


def test_a_periodic_box_repeats_in_x():
    def build():
        disks.new_scene(period=(5, 40, 5))
        rng = np.random.default_rng(3)
        for row in range(4):
            for column in range(5):
                disks.disk(column + 0.5, 1.02 * row + 0.5, rng.uniform(0.45, 0.5), velocity=rng.uniform(-1, 1, 2))
        disks.loop(disks.hertz(gamma_n=50, gamma_t=50), friction=0.3)

    expected, found, _ = both_loops(build, steps=1000)
    assert_same_motion(expected, found)


def test_threads_give_the_same_bits():
    both = []
    for threads in (1, 2):
        disks.shaken_bed()
        grain_loop.use_grain_loop(threads=threads)
        disks.run(STEPS)
        both.append(disks.everything())
    assert np.array_equal(*both)


def test_driven_bodies_are_true_at_every_step_and_all_at_the_end():
    disks.shaken_bed()
    loop = grain_loop.use_grain_loop()
    clump = next(b.id for b in O.bodies if b.isClump)
    free = int(loop.ids[-20])
    for step in (1, 2):
        O.step()
        swing = 0.1 * math.sin(2 * math.pi * step * O.dt / 0.5)
        assert O.bodies[clump].state.pos[0] == pytest.approx(3.6 + swing, rel=1e-14)
    disks.run(50)
    row = list(loop.ids).index(free)
    position = O.bodies[free].state.pos
    assert (position[0], position[1]) == tuple(loop.positions[row])


def test_contacts_match_yades():
    disks.shaken_bed()
    disks.run(2 * STEPS)
    expected = engines.contact_table(O._sceneObj)
    disks.shaken_bed()
    loop = grain_loop.use_grain_loop()
    disks.run(2 * STEPS)
    forces = {}
    for table in (expected, loop.contacts()):
        for i, j, f in zip(table["i"], table["j"], table["normal_force"] + table["tangential_force"]):
            forces.setdefault((min(i, j), max(i, j)), []).append(f if i < j else -f)
    pairs = [pair for pair in forces.values() if len(pair) == 2]
    assert len(pairs) >= 20
    np.testing.assert_allclose([p[0] for p in pairs], [p[1] for p in pairs], rtol=1e-6, atol=1e5 * ROUND_OFF)


def test_both_loops_tell_a_contact_by_the_same_columns():
    """Compares springs and points too. GrainLoop's disks have already moved by a step when they are read, YADE's contacts not."""
    tables = []
    for fast in (False, True):
        disks.new_scene()
        disks.disk(0, 0, velocity=(1, 0.5), spin=3)
        disks.disk(1.05, 0.1, radius=0.6, velocity=(-1, 0), spin=1)
        disks.loop(disks.hertz(gamma_n=50, gamma_t=50), friction=0.9)
        loop = grain_loop.use_grain_loop(largestOverlap=0.5) if fast else None
        disks.run(60)
        table = loop.contacts() if fast else engines.contact_table(O._sceneObj)
        assert table["i"][0] == 0
        tables.append([np.hstack([table["point"][0], table["normal"][0], table["overlap"][0]]), table["slip"][0]])
    (yades, spring), (fast, fast_spring) = tables
    assert abs(spring) > 1e-3 and fast_spring == pytest.approx(spring, rel=1e-9)  # round-off of 60 steps
    np.testing.assert_allclose(fast, yades, rtol=0, atol=1e-3)  # a step of 1e-4 at relative speeds up to 9


def test_a_scene_moves_back_to_yades_loop():
    disks.shaken_bed()
    grain_loop.use_grain_loop()
    disks.run(100)
    before = disks.everything()
    grain_loop.use_yade_loop()
    assert [type(e).__name__ for e in O.engines][:3] == ["ForceResetter", "InsertionSortCollider", "InteractionLoop"]
    disks.run(100)
    assert not np.array_equal(before, disks.everything())


def test_a_checkpoint_continues_to_the_last_bit(tmp_path):
    disks.shaken_bed()
    grain_loop.use_grain_loop()
    disks.run(200)
    loop, path = grain_loop.find("GrainLoop"), str(tmp_path / "loop.checkpoint")
    loop.checkpoint(path)
    O.save(str(tmp_path / "scene.xml"))
    disks.run(200)
    expected = disks.everything()
    O.load(str(tmp_path / "scene.xml"))
    grain_loop.find("GrainLoop").restore(path)
    disks.run(200)
    assert np.array_equal(disks.everything()[:, 0:6], expected[:, 0:6])


def drifting_crowd():
    """40 disks that collide and move through the periodic sides, alternately to the left and to the right."""
    disks.new_scene(dt=1e-3, period=(10, 20, 10))
    rng = np.random.default_rng(3)
    for k in range(40):
        disks.disk(1.2 * (k % 8) + 0.6, 1.2 * (k // 8) + 0.6, velocity=(3 * (-1) ** k, rng.uniform(-1, 1)), spin=1)
    disks.loop(disks.hertz(gamma_n=50, gamma_t=50), friction=0.4)


def test_looking_often_changes_no_bit_of_what_is_seen():
    def last_seen(*, blocks):
        drifting_crowd()
        loop = grain_loop.use_grain_loop()
        for _ in range(blocks):
            disks.run(6000 // blocks)
            loop.sync()
        return disks.everything()

    seldom, often = last_seen(blocks=10), last_seen(blocks=200)
    assert np.array_equal(often[:, 0:6], seldom[:, 0:6])
    assert (seldom[:, 0] < 0).any() and (seldom[:, 0] > 10).any()  # some have left the box on both sides


def test_bad_settings_are_refused():
    with pytest.raises(ValueError, match="precision must be 'double' or 'single', got half"):
        engines.GrainLoop(precision="half")
    with pytest.raises(ValueError, match="friction must not be negative"):
        engines.GrainLoop(friction=-1)


def test_single_precision_stays_near_double():
    _, double, _ = both_loops(collision, steps=1000)
    _, single, _ = both_loops(collision, steps=1000, precision="single")
    # Round-off of 6e-8 d in overlaps of 1e-2 d: errors of forces of 1e-5, in a collision that reverses velocities of 1.
    assert_same_motion(double, single, 1e-4)
