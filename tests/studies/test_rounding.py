"""The rounding study: six kinds of numbers in one regular scene, how the drift is determined, resuming, stopping, bad input."""

import importlib
import json
import subprocess
from decimal import Decimal, localcontext
from pathlib import Path

import numpy as np
import pytest

from known_names import unexplained

from graindrive.rounding import number_types
from graindrive.runs import run_folder
from graindrive.base.errors import EngineError, Interrupted, UsageError
from graindrive.postproc.reader import Run
from graindrive.postproc.rounding import averages, distances

STUDIES = Path(__file__).resolve().parents[2] / "studies"
RATE = 1.7  # of the made-up runs [1/t_0]


@pytest.fixture
def rounding(monkeypatch):
    """The study as a module, in this process."""
    monkeypatch.syspath_prepend(str(STUDIES))
    return importlib.import_module("rounding")


@pytest.fixture(scope="module")
def drifts(tmp_path_factory):
    """{kind of numbers: largest distance from the run with 150 digits}, and the number of steps; two wells, half a t_0."""
    patch, place = pytest.MonkeyPatch(), tmp_path_factory.mktemp("rows")
    patch.syspath_prepend(str(STUDIES))
    study, rows = importlib.import_module("rounding"), {}
    p = study.RoundingParameters(scene="regular", grains=2, time=0.5)
    for name in number_types.TYPES:
        number_types.run(name, dict(study.scene(p), steps=study.steps_of(p)), place / name)
        rows[name] = number_types.read(place / name)
    patch.undo()
    truth = rows[number_types.TRUTH]
    assert all((found.steps == truth.steps).all() for found in rows.values()) and len(truth.steps) == 4
    apart = {name: distances.distances(rows[name].place, truth.place).max() for name in study.COMPARED}
    assert np.ptp(truth.places[..., 1]) > 1e-3  # the grains oscillate
    return apart, study.steps_of(p)


@pytest.mark.parametrize("name", ["float128", "longdouble", "yade_double", "double"])
def test_each_kind_of_numbers_is_right_to_its_own_last_place_times_steps(drifts, name):
    """A step has a round-off of half of 2^(3 - bits) in a position below 8, and less in a force; the wells do not amplify it."""
    apart, steps = drifts
    last_place = 2.0 ** (3 - number_types.TYPES[name].bits)
    assert last_place / 100 < apart[name] < steps * last_place


def test_single_precision_is_worse_by_its_missing_bits(drifts):
    """The last digits of single and double precision differ by a factor of 2^29.

    GrainLoop keeps positions in double precision in both, with a round-off of 2^-50 in each of 513 steps. This makes double worse
    by up to 2^3 times the root of the steps, 2^4.5, and the few operations of a contact make single worse.
    """
    apart, _ = drifts
    assert 2.0 ** (29 - 8) < apart["single"] / apart["double"] < 2.0 ** (29 + 3)


def made_up(name, scene, file):
    """Stand in for a program: write rows of grains that depart as 2^-bits exp(RATE t) from those with 150 digits."""
    moving = [disk for disk in scene["disks"] if not disk[4]]
    start = np.array(moving)[:, :2].ravel()
    rng = np.random.default_rng(len(name))
    with open(file, "w") as rows:
        for steps in range(scene["every"] + 1, scene["steps"] + 1, scene["every"]):
            t = steps * scene["dt"]
            off = 0.0 if name == number_types.TRUTH else 2.0 ** -number_types.TYPES[name].bits * np.exp(RATE * t)
            with localcontext(prec=60):
                place = [str(Decimal(x) + Decimal(off)) for x in start]
            velocity = rng.normal(size=len(start)).tolist()
            rows.write(json.dumps(dict(steps=steps, place=place, velocity=velocity)) + "\n")


def carry_out(rounding, out, **changes):
    """Run the study with made-up programs into the folder `out`; return its Run."""
    p = rounding.RoundingParameters(
        **{**dict(grains=9, time=8.0, average_time=20.0, relax_time=2.0, out=str(out)), **changes}
    )
    with run_folder.RunFolder(p, study="rounding") as folder:
        rounding.run(p, folder)
    return Run(out)


def test_rates_of_a_known_growth_and_averages_come_out(rounding, tmp_path, monkeypatch):
    monkeypatch.setattr(number_types, "run", made_up)
    run = carry_out(rounding, tmp_path / "run")
    assert unexplained(run) == []
    assert run.summary["lyapunov_rate_single"] == pytest.approx(RATE, rel=1e-6)  # digits of the made-up positions
    assert run.summary["lyapunov_rate_double"] == pytest.approx(RATE, rel=1e-6)
    error = run.summary["kinetic_energy_double_err"]
    assert run.summary["kinetic_energy_double"] == pytest.approx(1.0, abs=5 * error) and error < 0.1  # two unit normals
    assert run.summary["averages_apart_double"] < 5  # standard errors
    rounding.STUDY.figure(run.path)
    assert (run.path / "figure.png").exists()


def test_a_resumed_run_does_not_repeat_programs_and_gives_the_same(rounding, tmp_path, monkeypatch):
    monkeypatch.setattr(number_types, "run", made_up)
    whole = carry_out(rounding, tmp_path / "whole")
    called = []

    def stopping(name, scene, file):
        called.append(name)
        if called == ["mpfr150", "float128", "longdouble"]:
            raise Interrupted(15)
        made_up(name, scene, file)

    monkeypatch.setattr(number_types, "run", stopping)
    with pytest.raises(Interrupted):
        carry_out(rounding, tmp_path / "run", checkpoint_seconds=0)
    called.clear()
    resumed = carry_out(rounding, tmp_path / "run", checkpoint_seconds=0, resume=True)
    assert called == ["longdouble", "yade_double", "double", "single"]
    for name, column in whole.series.items():
        np.testing.assert_array_equal(resumed.series[name], column)


def test_a_stopped_run_leaves_no_program(rounding, tmp_path, monkeypatch):
    started = []

    class Stopped(subprocess.Popen):
        def wait(self, timeout=None):
            if not started:
                started.append(self)
                raise KeyboardInterrupt
            return super().wait(timeout)

    monkeypatch.setattr(subprocess, "Popen", Stopped)
    scene = rounding.scene(rounding.RoundingParameters(scene="regular"))
    with pytest.raises(KeyboardInterrupt):
        number_types.run("mpfr150", dict(scene, steps=10**9), tmp_path / "rows")
    assert started[0].returncode == -9


def test_a_program_that_fails_says_its_last_words(rounding, tmp_path):
    scene = dict(rounding.scene(rounding.RoundingParameters(scene="regular", grains=2)), steps=1, disks=[["x"] * 5])
    with pytest.raises(EngineError, match="yade-double with the loop yade ended with 1: .*could not convert string"):
        number_types.run("yade_double", scene, tmp_path / "rows")


def test_a_missing_program_is_named(rounding, monkeypatch):
    monkeypatch.setattr(number_types.glob, "glob", lambda pattern: [] if "float128" in pattern else ["there"])
    with pytest.raises(UsageError, match="yade-float128 is missing; install Debian's package yade"):
        rounding.check(rounding.RoundingParameters())


@pytest.mark.parametrize(
    "keys, words",
    [
        (dict(loop="yade"), "loop=yade precision=double: the rounding study runs both loops"),
        (dict(precision="single"), "precision=single: the rounding study runs both loops in every precision"),
        (dict(grains=10), "a square number, got grains=10"),
        (dict(grains=4), "grains=4 must be at least 9 in the chaotic scene"),
        (dict(dt_factor=40), "dt_factor=40 gives a time step of 0.62 times the critical one"),
        (dict(average_time=21, relax_time=20), "average_time=21 must be longer than relax_time=20"),
    ],
)
def test_values_that_do_not_go_together_are_refused(rounding, keys, words):
    with pytest.raises(UsageError, match=words):
        rounding.check(rounding.RoundingParameters(**keys))


def test_a_distance_keeps_what_doubles_would_lose():
    place, truth = [["1." + "0" * 99 + "3", "0.5"]], [["1", "7.5"]]
    assert distances.distances(place, truth, period=7.0)[0, 0] == pytest.approx(3e-100, rel=1e-12)


def test_the_virial_of_two_disks_across_a_side_is_force_times_branch():
    places = np.array([[[0.2, 1.0], [3.3, 1.0]]])  # 0.9 apart across the side of 4
    assert averages.virial(places, 4.0, 512.0)[0] == pytest.approx(512 * 0.1 * 0.9, rel=1e-12)
