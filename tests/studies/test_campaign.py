"""A small campaign under the real Snakemake and `yade`: no run is made twice, failures are reported, stopped runs are resumed."""

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

pytestmark = pytest.mark.skipif(
    not shutil.which("yade") or not shutil.which("snakemake"), reason="needs yade and snakemake"
)
TOY = Path(__file__).parents[1] / "faults" / "toy_study.py"


class Place:
    """A folder with home and cache inside, in which campaigns of the toy study are made."""

    def __init__(self, path):
        self.path, self.runs = path, path / "toy" / "runs"
        self.environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(p for p in sys.path if p),
            "HOME": str(path),
            "XDG_CACHE_HOME": str(path / "cache"),
        }

    def start(self, sweeps, *options):
        """Start a campaign of the toy study with these sweeps, in the folder `toy`."""
        (self.path / "toy.yaml").write_text(f"study: {TOY}\ncommon: {{scale: smoke}}\nsweeps:\n{sweeps}")
        command = [sys.executable, "-m", "graindrive.campaign", "toy.yaml", *options]
        pipes = dict(stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        return subprocess.Popen(command, cwd=self.path, env=self.environment, **pipes)

    def run(self, sweeps, *options):
        """Run a campaign; return its exit code and its output."""
        process = self.start(sweeps, *options)
        _, words = process.communicate(timeout=120)
        return process.returncode, words

    def folder(self, word):
        """Return the one run folder with this word in its name that is complete."""
        (found,) = [p for p in self.runs.iterdir() if word in p.name and not p.name.startswith(".") and not p.suffix]
        return found

    def log(self, word):
        """Return the log of the run with this word in its name."""
        (found,) = (self.path / "toy" / "logs").glob(f"*{word}*.log")
        return found.read_text()


@pytest.fixture
def place(tmp_path):
    return Place(tmp_path)


def test_a_campaign_runs_where_the_path_has_braces_and_blanks(tmp_path):
    folder = tmp_path / "{name} 'of' {x!r}"
    folder.mkdir()
    place = Place(folder)
    code, words = place.run("  a: {seed: 31}\n")
    assert code == 0 and "0 of 1 runs are there already" in words
    assert place.folder("seed=31")


def test_failures_are_told_killed_runs_resume_and_finished_runs_are_not_repeated(place):
    sweeps = "  a: {seed: 11}\n  b: {seed: 12, ask: KILL}\n  c: {seed: 13, fault: study}\n"
    code, words = place.run(sweeps, "--cores", "2")
    assert code == 1 and "0 of 3 runs are there already" in words
    assert "ValueError: the study has a bug" in words and "2 of 3 runs are missing" in words
    good = place.folder("seed=11")
    before = {p.name: p.stat().st_mtime_ns for p in good.iterdir()}
    assert list(pd.read_csv(place.path / "toy" / "table.csv")["seed"]) == [11]

    code, words = place.run(sweeps.replace(", ask: KILL", "").replace(", fault: study", ""), "--cores", "2")
    assert code == 0 and "1 of 3 runs are there already" in words
    assert {p.name: p.stat().st_mtime_ns for p in good.iterdir()} == before
    assert "going on from step" in place.log("seed=12") and place.folder("seed=12")
    table = pd.read_csv(place.path / "toy" / "table.csv")
    assert list(table["seed"]) == [11, 12, 13] and list(table["first"]) == [
        0,
        50,
        0,
    ]  # half of 100 steps before the kill

    code, words = place.run(sweeps.replace(", ask: KILL", "").replace(", fault: study", ""))
    assert code == 0 and "3 of 3 runs are there already" in words and "Building DAG" not in words


def wait_for(text, read, process):
    """Wait until `read()` holds the text, or fail when the process has ended."""
    while text not in read():
        assert process.poll() is None
        os.sched_yield()


def test_an_interrupt_ends_all_and_the_next_call_goes_on(place):
    sweeps = "  a: {seed: 21, fault: slow, steps: 4000}\n"
    process = place.start(sweeps)
    wait_for("toy:  20 %", lambda: place.log("seed=21") if list(place.path.glob("toy/logs/*.log")) else "", process)
    process.send_signal(signal.SIGINT)
    _, words = process.communicate(timeout=60)
    assert process.returncode == 130 and "kept for the next call" in words
    (kept,) = place.runs.iterdir()
    assert kept.name.endswith(".interrupted") and not list(place.path.glob("toy/table.csv"))

    code, words = place.run(sweeps)
    assert code == 0 and "going on from step" in place.log("seed=21")
    assert [p.name for p in place.runs.iterdir()] == [place.folder("seed=21").name]
