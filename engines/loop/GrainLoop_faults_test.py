"""GrainLoop in scenes that it cannot run: each is refused with the reason, and the process survives."""

import math

import disks
import pytest

from graindrive.loops import grain_loop
from graindrive.scenes import yade_march
from graindrive.scenes import scene
from graindrive.engines import GrainLoop, OscillationDrive
from yade import O, utils, wrapper


@pytest.fixture
def bed():
    """Five disks in a row on three frozen ones, under GrainLoop."""
    O.reset()
    base = scene.add_disks([0, 1, 2], [0, 0, 0], [0.5, 0.5, 0.5], 1.0, "xyzXYZ")
    free = scene.add_disks([0.1, 1.1, 2.1, 3.1, 4.1], [5] * 5, [0.5] * 5, 1.0)
    O.engines = [GrainLoop(gravity=(0, -1, 0), label="loop")]
    O.dt = 1e-4
    return base, free


def step():
    """Make one step of the loop in this thread, so that its error is raised here."""
    O.engines[-1]()


@pytest.mark.parametrize("which", ["base", "free"])
def test_an_erased_body_ends_the_run_and_not_the_process(bed, which):
    O.run(5, True)
    O.bodies.erase(bed[which == "free"][0])
    with pytest.raises(RuntimeError, match=f"body {bed[which == 'free'][0]} was erased"):
        step()


def test_an_erased_clump_ends_the_run_and_not_the_process(bed):
    clump, members = O.bodies.appendClumped([scene.disk(8, 5, 0.3, 1.0), scene.disk(8.4, 5, 0.3, 1.0)])
    O.run(5, True)
    O.bodies.erase(clump, True)
    with pytest.raises(RuntimeError, match="was erased"):
        step()


def test_after_sync_and_read_the_loop_goes_on_without_the_erased(bed):
    loop = O.engines[0]
    O.run(5, True)
    loop.sync()
    O.bodies.erase(bed[1][0])
    loop.read()
    O.run(5, True)
    assert len(loop.ids) == 7


def test_a_disk_off_the_plane_is_refused(bed):
    O.bodies[bed[1][0]].state.pos = (0.1, 5, 0.3)
    with pytest.raises(ValueError, match="one plane"):
        step()


def test_spheres_and_disks_together_are_refused_and_spheres_alone_roll_as_spheres(bed):
    ball = O.bodies.append(utils.sphere((8, 5, 0), 0.5, color=(1, 1, 1)))
    O.bodies[ball].state.blockedDOFs = "zXY"
    with pytest.raises(ValueError, match=f"body {ball} differs"):
        step()


@pytest.mark.parametrize("rival", ["NewtonIntegrator", "GrainLoop"])
def test_a_second_integrator_is_refused(bed, rival):
    other = wrapper.NewtonIntegrator() if rival == "NewtonIntegrator" else GrainLoop()
    O.engines = [other] + O.engines
    with pytest.raises(RuntimeError, match=f"also holds {rival}"):
        step()


@pytest.mark.parametrize(
    "bad",
    [
        dict(gravity=(0, 0, -1)),
        dict(gravity=(math.nan, 0, 0)),
        dict(skin=math.nan),
        dict(normalStiffness=math.inf),
        dict(largestOverlap=0),
    ],
)
def test_numbers_out_of_range_are_refused(bad):
    with pytest.raises(ValueError, match="GrainLoop"):
        GrainLoop(**bad)


def test_a_drive_behind_the_loop_is_refused(bed):
    drive = OscillationDrive(body=bed[1][0], amplitude=1, period=1)
    O.engines = O.engines + [drive]
    with pytest.raises(RuntimeError, match="stands after GrainLoop"):
        drive()


def test_a_drive_on_a_clumps_member_is_refused(bed):
    clump, members = O.bodies.appendClumped([scene.disk(8, 5, 0.3, 1.0), scene.disk(8.4, 5, 0.3, 1.0)])
    drive = OscillationDrive(body=members[0], amplitude=1, period=1)
    O.engines = [drive] + O.engines
    with pytest.raises(RuntimeError, match=f"member of clump {clump}"):
        drive()


def test_a_grain_that_falls_past_the_base_ends_the_run_with_its_id_and_place(bed):
    lost = bed[1][-1]  # beside the base
    O.bodies[lost].state.vel = (0, -50, 0)
    with pytest.raises(RuntimeError, match=f"grain {lost} at .* has left the box") as caught:
        yade_march.advance(10_000)  # hears an engine that fails before anyone waits; O.run may not
    assert f"step {O.iter}: " in str(caught.value)
    assert O.bodies[lost].state.pos[1] < -3.5  # three diameters below the base, and synced


def test_a_guard_that_trips_in_a_drive_shows_the_grains_too(bed):
    lost = bed[1][-1]
    O.bodies[lost].state.vel = (0, -50, 0)
    O.engines = [OscillationDrive(body=bed[1][0], amplitude=0, period=1)] + O.engines
    with pytest.raises(RuntimeError, match="has left the box"):
        yade_march.advance(10_000)  # hears an engine that fails before anyone waits; O.run may not
    assert O.bodies[lost].state.pos[1] < -3.5


def test_bounds_let_grains_fall_and_stop_those_that_leave_them(bed):
    loop = O.engines[0]
    O.bodies[bed[1][-1]].state.vel = (0, -50, 0)
    loop.bounds = [0, 0, 0, 0]
    O.run(2500, True)
    assert O.bodies[bed[1][-1]].state.pos[1] < -7
    loop.bounds = [-1, -5, 10, 10]
    with pytest.raises(RuntimeError, match="y is below -5, the bounds that were set"):
        step()


@pytest.mark.parametrize("bad", [[1, 2, 3], [0, 0, -1, 5], [0, 0, math.inf, 1]])
def test_bounds_that_are_none_are_refused(bad):
    with pytest.raises(ValueError, match="GrainLoop.bounds must (be|hold)"):
        GrainLoop(bounds=bad)


@pytest.mark.parametrize("periods", [(9, 0, 0), (10, 21, 0)])
def test_periods_that_contradict_the_cell_are_refused(periods):
    scene.start(10, 5)  # along y the cell, 30, is longer than the bed, so that it does not repeat there
    scene.add_disks([2], [2], [0.5], 1.0)
    O.engines = [GrainLoop(periods=periods)]
    O.dt = 1e-4
    with pytest.raises(ValueError, match="O.cell has the period"):
        step()


def test_periods_of_the_cell_are_taken_and_an_axis_may_be_left_free():
    for periods in ((10, 0, 0), (0, 30, 0), (10, 30, 0)):
        scene.start(10, 5)
        scene.add_disks([2], [2], [0.5], 1.0)
        O.engines = [GrainLoop(periods=periods)]
        O.dt = 1e-4
        O.run(3, True)
        assert O.iter == 3


@pytest.mark.parametrize("bad", [dict(young=-1), dict(poisson=0.6), dict(restitution=0), dict(young=math.inf)])
@pytest.mark.parametrize("law", ["hertzHistory", "hertzRestitution", "springDashpot"])
def test_material_numbers_are_checked_under_every_law(law, bad):
    with pytest.raises(ValueError, match="must"):
        GrainLoop(law=law, **bad)


def test_a_run_that_fails_in_its_first_step_raises_every_time():
    """YADE's O.run(n, True) returned without an error in a third of such runs."""
    for _ in range(12):
        disks.new_scene(dt=1e-3)
        disks.disk(0, 0), disks.disk(0.5, 0)
        disks.loop()
        grain_loop.use_grain_loop()
        with pytest.raises(RuntimeError, match="overlap"):
            O.run(5, True)
