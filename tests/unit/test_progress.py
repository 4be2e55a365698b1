"""Driving YADE's loop in blocks: how many steps, what they cost, how failures inside the loop come out."""

import time

import pytest

pytest.importorskip("yade")

from graindrive.errors import UsageError  # noqa: E402
from graindrive.progress import Timing, run_blocks  # noqa: E402


@pytest.fixture
def scene():
    from yade import ForceResetter, O

    O.reset()
    O.engines = [ForceResetter()]
    O.dt = 1e-3
    yield O
    O.reset()


def test_all_steps_are_run_in_blocks(scene):
    seen = []
    timing = run_blocks(105, 10, lambda done: seen.append((done, scene.iter)), grains=7)
    assert seen == [(done, done) for done in [*range(10, 101, 10), 105]]
    assert (timing.steps, timing.grains) == (105, 7)
    assert timing.particle_steps_per_second == pytest.approx(7 * 105 / timing.seconds)


def test_a_block_may_end_the_run(scene):
    assert run_blocks(1000, 10, lambda done: done >= 30).steps == scene.iter == 30


def test_no_steps_cost_nothing(scene):
    timing = run_blocks(0, 10)
    assert timing == Timing(0, 0.0, 0) and timing.particle_steps_per_second != timing.particle_steps_per_second


@pytest.mark.parametrize("steps, block", [(-1, 10), (10, 0)])
def test_impossible_counts_are_refused(scene, steps, block):
    with pytest.raises(ValueError, match="steps must be >= 0 and block >= 1"):
        run_blocks(steps, block)


def test_a_block_costs_far_less_than_yades_own_wait(scene):
    """O.run(n, True) looks every 40 ms: 100 blocks would take 4 s."""
    start = time.perf_counter()
    run_blocks(100, 1)
    assert time.perf_counter() - start < 2


@pytest.mark.parametrize("period", [1, 7, 1000])
def test_an_engines_error_comes_out_with_its_text(scene, period):
    from yade import PyRunner

    scene.engines = scene.engines + [
        PyRunner(command="import time; time.sleep(1e-3); [][0]", iterPeriod=period, initRun=True)
    ]
    with pytest.raises(RuntimeError, match="list index out of range"):
        run_blocks(2000, 500)


def test_a_loop_that_something_paused_is_not_taken_for_complete(scene):
    from yade import PyRunner

    scene.engines = scene.engines + [PyRunner(command="O.pause()", iterPeriod=30)]
    with pytest.raises(RuntimeError, match="paused YADE's loop"):
        run_blocks(1000, 100)


def test_ten_lines_where_nobody_watches(scene, capsys):
    run_blocks(1000, 10, grains=5, label="settle")
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 10 and lines[0].startswith("settle:  10 %, ") and "M particle-steps/s" in lines[0]
    assert lines[-1].startswith("settle: 100 %") and lines[-1].endswith("0:00 left")


def test_a_run_that_would_never_end_is_refused(scene):
    with pytest.raises(UsageError, match="would take 2e\\+10 steps, more than 1e\\+10; raise dt_factor"):
        run_blocks(20_000_000_000, 10)
    assert scene.iter == 0
