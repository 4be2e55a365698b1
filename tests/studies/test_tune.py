"""The command tune with a user's study, without YADE: the files that it writes, and how it continues after a kill."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import matplotlib.image
import pandas as pd
import pytest

from graindrive.postproc.reader import Run
from graindrive.accuracy import book

BUILT = next(folder for folder in sys.path if (Path(folder) / "graindrive").is_dir())
DECAY = '''
"""Decay: what Euler's steps leave of a decaying quantity, and what noise makes of it."""
import numpy as np
from graindrive.commands import headless
from graindrive.parameters import Lever, StudyParameters, quantity
from graindrive.study import Cost, Observable, Study

class Parameters(StudyParameters):
    rate: float = quantity(1.0, "1/s", "of the decay", gt=0)
    noise: float = quantity(1e-4, "-", "of the result", ge=0)

def steps(p):
    return round(1e4 / p.dt_factor)

def run(p, folder):
    x = (1 - p.rate / steps(p) * 1e2) ** (steps(p) // 100)
    folder.summarize(left=x * (1 + np.random.default_rng(p.seed).normal(0, p.noise)), left_err=x * p.noise)

STUDY = Study(
    name="decay", parameters=Parameters, presets={"demo": {}, "paper": {}}, run=run,
    observables=(Observable("left", "-", "what is left after 1 s", headline=True),), cost=Cost(steps, 1e6, "steps"),
)
if __name__ == "__main__":
    headless.main(STUDY)
'''
KEYS = ["rate=1,1.1", "vary=dt_factor", "target=1%", "seeds=2", "cores=2", "out=tuned"]


@pytest.fixture
def place(tmp_path):
    (tmp_path / "decay.py").write_text(DECAY)
    return tmp_path


def environment():
    path = os.pathsep.join([BUILT, *filter(None, [os.environ.get("PYTHONPATH")])])
    return {**os.environ, "PYTHONPATH": path, "MPLBACKEND": "Agg"}


def started(place, *arguments, **options):
    command = [sys.executable, "-m", "graindrive.tuning", "decay.py", *arguments]
    return subprocess.Popen(command, cwd=place, env=environment(), stderr=subprocess.PIPE, text=True, **options)


def tuned(place, *arguments):
    process = started(place, *arguments)
    _, words = process.communicate(timeout=300)
    return process.returncode, words


def test_a_tuning_leaves_figure_table_sentences_book_and_parameters(place):
    code, words = tuned(place, *KEYS)
    assert code == 0, words
    out = place / "tuned"
    table = pd.read_csv(out / "table.csv").set_index("setting")
    # After 1 s of Euler steps of 0.01 f s the solution is (1 - r f/100)^(100/f), with dt_factor f and the rate r.
    shift = [((1 - r * 0.02) ** 50 / (1 - r * 0.01) ** 100) - 1 for r in (1, 1.1)]
    assert table.loc["dt_factor=2", "left_bias_percent"] == pytest.approx(100 * sum(shift) / 2, abs=0.03)
    assert table.loc["dt_factor=2", "verdict"] in (
        "good",
        "saves nothing",
    )  # it depends on the processor's time, which is not tested
    text = (out / "report.md").read_text()
    assert "- dt_factor=2 changes left by −0.5" in text
    assert matplotlib.image.imread(out / "figures" / "tuned-levers.png").std() > 0
    made = book.read(out / "measured.json")
    assert made.cover["rate"] == [1.0, 1.1] and made.same["noise"] == 1e-4 and made.study == "decay"
    chosen = float(re.search(r"dt_factor: ([0-9.]+)", (out / "tuned.yaml").read_text())[1])
    assert f"Chosen: {'reference' if chosen == 1 else f'dt_factor={chosen:g}'}," in text
    run = [sys.executable, "decay.py", "@tuned/tuned.yaml", "rate=1.05", "out=run"]
    subprocess.run(run, cwd=place, env=environment(), check=True, stdin=subprocess.DEVNULL)
    parameters = Run(place / "run").parameters
    assert parameters["dt_factor"] == chosen and parameters["rate"] == 1.05


def test_a_tuning_that_was_killed_makes_no_run_again(place):
    keys = ["vary=dt_factor", "target=0.1%", "seeds=2", "cores=1", "out=tuned"]
    process = started(place, *keys, start_new_session=True)
    runs = place / "tuned" / "runs"
    deadline = time.monotonic() + 120
    while not (runs.is_dir() and any((r / "summary.json").is_file() for r in runs.iterdir())):
        assert time.monotonic() < deadline and process.poll() is None, "no run was made"
        os.sched_yield()
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    before = {
        r.name: (r / "run.h5").stat().st_mtime_ns
        for r in runs.iterdir()
        if (r / "summary.json").is_file() and r.name[0] != "."
    }
    deadline = time.monotonic() + 120
    while True:  # Snakemake has a process group of its own, and keeps the campaign's lock until its runs have ended
        code, words = tuned(place, *keys)
        if "another scripts/campaign is working" not in words:
            break
        assert time.monotonic() < deadline
    assert code == 0, words
    assert all((runs / name / "run.h5").stat().st_mtime_ns == when for name, when in before.items())
    whole = place / "whole"
    assert tuned(place, *keys[:-1], f"out={whole}")[0] == 0
    columns = ["setting", "runs", "left_bias_percent", "left_bound_percent"]
    one, other = (pd.read_csv(folder / "table.csv")[columns] for folder in (place / "tuned", whole))
    pd.testing.assert_frame_equal(one, other)


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["budget=1ms"], "budget=1ms must be a time as 90s, 30min or 2h"),
        (["budget=0.001s"], "the reference alone needs about"),
        (["rate=-1"], "rate=-1.0 is not allowed: rate is a number > 0"),
        (["seeds=1"], "seeds=1 must be a whole number of at least 2"),
        (["vary=rate"], "rate is no lever of decay"),
        (["--lunch"], "there is no option --lunch; there are -n and --launch"),
        (["raet=1"], "did you mean rate"),
    ],
)
def test_what_cannot_be_tuned_is_refused_in_one_line(place, arguments, words):
    code, said = tuned(place, *arguments)
    assert code == 2 and words in said and "Traceback" not in said
    assert not (place / "tune_decay").exists()


def test_a_dry_run_says_what_would_be_varied_and_runs_nothing(place):
    code, words = tuned(place, "-n")
    assert code == 0 and "dt_factor: 2, 4, 8, 16, 32" in words and "2 runs of the reference" in words
    assert not (place / "tune_decay").exists()
