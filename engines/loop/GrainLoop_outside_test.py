"""Forces from outside under GrainLoop: the same motion as on YADE's loop, on free disks, bodies and clumps."""

import disks
import numpy as np
import pytest
from graindrive import engines
from graindrive.loops import grain_loop
from yade import O, wrapper
from yade.minieigenHP import Vector3

STEPS = 100
ROUND_OFF = 1e-12  # a hundred sums in another order


def scene():
    """A clump, a large disk, a free disk and a frozen one, far from each other; return their ids."""
    disks.new_scene(dt=1e-3)
    clump, members = disks.clump([(-0.3, 0), (0.3, 0)])
    ids = dict(
        clump=clump, member=members[1], large=disks.disk(10, 0, 2.0), free=disks.disk(20, 0), other=disks.disk(25, 0)
    )
    ids["frozen"] = disks.disk(30, 0, frozen=True)
    disks.loop(gravity=(0, -1))
    return ids


def forever(ids, which):
    O.forces.setPermF(ids[which], Vector3(1, 2, 0))


def forever_turning(ids, which):
    O.forces.setPermT(ids[which], Vector3(0, 0, 1))


def force_engine(ids, which):
    O.engines = O.engines[:-1] + [wrapper.ForceEngine(ids=[ids[which]], force=(1, 2, 0)), O.engines[-1]]


def torque_engine(ids, which):
    O.engines = O.engines[:-1] + [wrapper.TorqueEngine(ids=[ids[which]], moment=(0, 0, 1)), O.engines[-1]]


def runner(ids, which):
    command = f"O.forces.addF({ids[which]}, (1, 2, 0)); O.forces.addT({ids[which]}, (0, 0, 1))"
    O.engines = O.engines[:-1] + [wrapper.PyRunner(command=command, iterPeriod=1), O.engines[-1]]


@pytest.mark.parametrize("which", ["free", "large", "clump", "member", "frozen"])
@pytest.mark.parametrize("push", [forever, forever_turning, force_engine, torque_engine, runner])
def test_a_force_from_outside_moves_disks_as_on_yades_loop(push, which):
    seen = []
    for loop in ("yade", "grain"):
        push(scene(), which)
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(STEPS)
        seen.append(disks.everything())
    yade, grain = seen
    np.testing.assert_allclose(grain[:, 0:6], yade[:, 0:6], rtol=0, atol=ROUND_OFF)
    np.testing.assert_allclose(grain[:, 10:13], yade[:, 10:13], rtol=0, atol=ROUND_OFF)


def test_a_constant_force_gives_force_times_time_over_mass():
    ids = scene()
    O.forces.setPermF(ids["clump"], Vector3(1, 0, 0))
    grain_loop.use_grain_loop()
    disks.run(STEPS)
    assert O.bodies[ids["clump"]].state.vel[0] == pytest.approx(1 * 0.1 / 2, rel=1e-12)  # F t/m


def test_a_force_acts_in_the_steps_in_which_it_is_added_and_no_longer():
    ids = scene()
    command = f"O.forces.addF({ids['free']}, (1, 0, 0)) if O.iter < 10 else None"
    O.engines = O.engines[:-1] + [wrapper.PyRunner(command=command, iterPeriod=1, initRun=True), O.engines[-1]]
    grain_loop.use_grain_loop()
    disks.run(STEPS)
    state = O.bodies[ids["free"]].state
    assert state.vel[0] == pytest.approx(10 * 1e-3 / state.mass, rel=1e-12)


def test_the_ledger_books_the_work_of_forces_from_outside():
    ids = scene()
    O.forces.setPermF(ids["free"], Vector3(3, 0, 0))
    O.forces.setPermF(ids["clump"], Vector3(0, 1, 0))
    O.forces.setPermT(ids["free"], Vector3(0, 0, 1))
    loop = grain_loop.use_grain_loop(trackEnergy=True)
    disks.run(STEPS)
    assert loop.energy["workOfLoads"] > 0
    assert loop.energy["closure"] < 1e-12  # round-off of a hundred steps


def test_a_force_out_of_the_plane_is_refused_where_a_disk_would_follow():
    ids = scene()
    O.bodies[ids["free"]].state.blockedDOFs = "XY"
    O.forces.setPermF(ids["free"], Vector3(0, 0, 1))
    grain_loop.use_grain_loop()
    with pytest.raises(RuntimeError, match=f"body {ids['free']} would move it out of the plane"):
        O.engines[-1]()


def test_a_restart_goes_on_with_the_same_force(tmp_path):
    scene_ids = scene()
    O.forces.setPermF(scene_ids["free"], Vector3(1, 0, 0))
    loop = grain_loop.use_grain_loop(label="loop")
    disks.run(STEPS)
    path = str(tmp_path / "scene.checkpoint")
    loop.checkpoint(path)
    disks.run(STEPS)
    expected = disks.everything()
    loop.restore(path)
    disks.run(STEPS)
    assert np.array_equal(disks.everything(), expected)


def test_an_engine_of_ones_own_that_reads_free_disks_sees_them_as_they_are():
    """Drag F = -c v on a falling disk: the velocity approaches its limit as exp(-c t/m) only if F uses present velocities."""
    seen = []
    for loop in ("yade", "grain"):
        ids = scene()
        O.engines = O.engines[:-1] + [
            wrapper.PyRunner(
                command=f"O.forces.addF({ids['free']}, -5*O.bodies[{ids['free']}].state.vel)",
                iterPeriod=1,
                initRun=True,
            ),
            O.engines[-1],
        ]
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(1000)
        seen.append(O.bodies[ids["free"]].state.vel[1])
    assert seen[1] == pytest.approx(seen[0], rel=1e-12)
    assert seen[0] > -0.2  # over the -1 of free fall; the terminal velocity is m g/c = 0.157


def test_measures_and_drives_see_the_grains_forces_alone():
    ids = scene()
    drive = engines.SpinTranslateDrive(body=ids["large"], velocity=(1, 0, 0))
    O.engines = O.engines[:-1] + [drive, O.engines[-1]]
    O.forces.setPermF(ids["large"], Vector3(7, 0, 0))
    grain_loop.use_grain_loop()
    disks.run(STEPS)
    assert drive.force == Vector3.Zero and drive.work == 0


def test_forces_that_someone_has_summed_up_before_still_act():
    seen = []
    for loop in ("yade", "grain"):
        disks.new_scene(dt=1e-3)
        pushed = disks.disk(0, 0)
        disks.disk(10, 0)
        disks.loop()
        looks = wrapper.PyRunner(command="O.forces.f(0, sync=True)", iterPeriod=1, initRun=True)
        O.engines = O.engines[:-1] + [wrapper.ForceEngine(ids=[pushed], force=(1, 0, 0)), looks, O.engines[-1]]
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(100)
        seen.append(O.bodies[pushed].state.vel[0])
    assert seen[0] > 0.1
    assert seen[1] == pytest.approx(seen[0], rel=1e-12)
