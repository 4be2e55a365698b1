"""Running YADE's loop in blocks: number of steps, overhead, and how errors inside the loop are raised."""

import time

import pytest

pytest.importorskip("yade")

from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.runs import progress_line  # noqa: E402
from graindrive.runs.progress import Timing, run_blocks  # noqa: E402
from graindrive.runs.progress_line import Calming  # noqa: E402
from graindrive.scenes.yade_march import YadeMarch  # noqa: E402


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
    timing = run_blocks(YadeMarch(7), 105, 10, lambda done: seen.append((done, scene.iter)))
    assert seen == [(done, done) for done in [*range(10, 101, 10), 105]]
    assert (timing.steps, timing.size) == (105, 7)
    assert timing.work_per_second == pytest.approx(7 * 105 / timing.seconds)


def test_a_block_may_end_the_run(scene):
    assert run_blocks(YadeMarch(), 1000, 10, lambda done: done >= 30).steps == scene.iter == 30


def test_no_steps_cost_nothing(scene):
    timing = run_blocks(YadeMarch(), 0, 10)
    assert timing == Timing(0, 0.0, 0) and timing.work_per_second != timing.work_per_second


@pytest.mark.parametrize("steps, block", [(-1, 10), (10, 0)])
def test_impossible_counts_are_refused(scene, steps, block):
    with pytest.raises(ValueError, match="steps must be >= 0 and block >= 1"):
        run_blocks(YadeMarch(), steps, block)


def test_a_block_costs_far_less_than_yades_own_wait(scene):
    """O.run(n, True) checks every 40 ms, so that 100 blocks would take 4 s."""
    start = time.perf_counter()
    run_blocks(YadeMarch(), 100, 1)
    assert time.perf_counter() - start < 2


@pytest.mark.parametrize("period", [1, 7, 1000])
def test_an_engines_error_comes_out_with_its_text(scene, period):
    from yade import PyRunner

    scene.engines = scene.engines + [
        PyRunner(command="import time; time.sleep(1e-3); [][0]", iterPeriod=period, initRun=True)
    ]
    with pytest.raises(RuntimeError, match="list index out of range"):
        run_blocks(YadeMarch(), 2000, 500)


def test_a_loop_that_something_paused_is_not_taken_for_complete(scene):
    from yade import PyRunner

    scene.engines = scene.engines + [PyRunner(command="O.pause()", iterPeriod=30)]
    with pytest.raises(RuntimeError, match="paused YADE's loop"):
        run_blocks(YadeMarch(), 1000, 100)


def test_ten_lines_where_nobody_watches(scene, capsys):
    run_blocks(YadeMarch(5), 1000, 10, label="settle")
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 10 and lines[0].startswith("settle:  10 %, ") and "M particle-steps/s" in lines[0]
    assert lines[-1].startswith("settle: 100 %") and lines[-1].endswith("0:00 left")


def test_the_way_to_rest_is_the_energys_on_a_logarithmic_scale():
    energies = iter([1.0, 100.0, 10.0, 1.0, 3.0, 0.1, 0.009])  # to 0.01: four powers of ten below the highest
    aim = Calming(lambda: next(energies), 0.01, "J")
    assert [aim.look(done) for done in range(1, 8)] == pytest.approx([0, 0, 0.25, 0.5, 0.5, 0.75, 1], abs=1e-12)
    assert aim.reached(1) and aim.in_words() == "kinetic energy 0.009 J, target 0.01"


def test_grains_that_have_not_fallen_yet_are_not_at_rest():
    energies = iter([0.0, 1.0, 0.1, 0.009])
    aim = Calming(lambda: next(energies), 0.01, "J", least_steps=20)
    found = [(aim.look(done), aim.reached(done)) for done in (5, 10, 20, 25)]
    assert found == [(0.125, False), (0.25, False), (pytest.approx(0.75), False), (1.0, True)]


def test_a_log_says_how_far_grains_have_calmed_and_ends_when_they_rest(scene, capsys):
    aim = Calming(lambda: 10.0 ** (-scene.iter / 100), 1e-4, "m g d", least_steps=100)
    timing = run_blocks(YadeMarch(5), 10_000, 10, aim.reached, label="settling", aim=aim)
    lines = capsys.readouterr().err.splitlines()
    assert timing.steps == 410 and len(lines) == 9, "from 40 % to 61 % when they may rest"
    assert lines[0].startswith("settling:  10 %, kinetic energy 0.63 m g d, target 0.0001, ")
    assert lines[0].endswith("M particle-steps/s") and lines[-1].startswith("settling: 100 %, ")


def test_a_log_is_not_silent_for_long_where_grains_calm_no_further(scene, capsys, monkeypatch):
    monkeypatch.setattr(progress_line, "SILENCE", 0.0)
    run_blocks(YadeMarch(), 50, 10, aim=Calming(lambda: 1.0, 0.1, "J"), label="settling")
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 5 and all(line.startswith("settling:   0 %, kinetic energy 1 J") for line in lines)


def test_a_run_that_would_never_end_is_refused(scene):
    with pytest.raises(UsageError, match="would take 2e\\+10 steps, more than 1e\\+10; raise dt_factor"):
        run_blocks(YadeMarch(), 20_000_000_000, 10)
    assert scene.iter == 0
