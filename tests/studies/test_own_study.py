"""The guide's study, which needs neither YADE nor grains: progress, checkpoints, kill and resume, campaign, report, commands."""

import json
import math
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
from guide_pages import TOP, write_files

from graindrive.commands.killtest import TIMED
from graindrive.postproc import __main__ as postproc
from graindrive.postproc.reader import Run
from graindrive.study import loaded

BUILT = next(folder for folder in sys.path if (Path(folder) / "graindrive").is_dir())
KEYS = ["time=20", "damping=0.2", "checkpoint_seconds=0"]  # a checkpoint after every block of 100 steps
# The study's file as a module whose march kills its process, or sends it a stop signal, before a step.
STOPPED = """
import os, sys
from graindrive.commands import headless
from graindrive.study import loaded
study, number, at = loaded(sys.argv.pop(1)), int(sys.argv.pop(1)), int(sys.argv.pop(1))
oscillator = sys.modules[study.run.__module__].Oscillator
advance = oscillator.advance
def stopped(self, count):
    if self.steps == at:
        os.kill(os.getpid(), number)
    advance(self, count)
oscillator.advance = stopped
headless.main(study)
"""
REPORTED = """
import dataclasses
from graindrive.postproc.campaign.claims import claim_on
from graindrive.postproc.campaign.planned import PlannedFigure, Report
from graindrive.postproc.campaign.plots import canvas, draw_points
from graindrive.postproc.campaign.runs import curve, quantity
from graindrive.postproc.campaign.verdicts import Agrees
from graindrive.postproc.measured import Measured, UNKNOWN
import oscillator

def claims(campaign, rows):
    left = float(rows[rows["damping"] == 0.2]["energy_left"].iloc[0])
    return [claim_on({"damping": ("c", "/s")}, rows, "energy decays as exp(-c t)", "a textbook", "0.67",
                     Measured(left, 0.0), Agrees(0.67, 0.05, 0.01))]

def draw(campaign, rows):
    figure, ((axes,),) = canvas(1, 1, width=3, height=2)
    draw_points(axes, *curve(rows, "damping", "energy_left"))
    return figure

FIGURE = PlannedFigure("decay", "rates", "Decay", "Energy left against damping.", claims, draw)
STUDY = dataclasses.replace(oscillator.STUDY, report=Report("oscillator", "A mass on a spring", {"rates": "damping"}, (FIGURE,)))
"""


@pytest.fixture
def place(tmp_path):
    """A folder with the study of studies/guides/study.md."""
    write_files("study.md", tmp_path)
    return tmp_path


def environment(place, *also):
    """Return an environment with the package but without YADE on Python's path, and with a separate cache."""
    path = os.pathsep.join([BUILT, *map(str, also)])
    return {**os.environ, "PYTHONPATH": path, "XDG_CACHE_HOME": str(place / "cache"), "HOME": str(place)}


def call(place, *arguments):
    """Call plain Python with these arguments in the folder; return the finished process."""
    pipes = dict(stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120)
    return subprocess.run([sys.executable, *arguments], cwd=place, env=environment(place), **pipes)


def contents(run):
    """Return the series and the summary of a run folder, without times."""
    summary = json.loads((run / "summary.json").read_text())
    with h5py.File(run / "run.h5") as file:
        series = {name: dataset[()] for name, dataset in file["series"].items()}
    return series, {
        key: value for key, value in summary.items() if key.removesuffix("_unit") not in TIMED or value is None
    }


def test_a_run_without_yade_and_grains_leaves_a_run_folder(place):
    done = call(place, "oscillator.py", *KEYS, "out=a")
    assert done.returncode == 0, done.stderr
    assert (
        "swinging:  10 %, " in done.stderr
        and "swinging: 100 %, " in done.stderr
        and "M oscillator-steps/s" in done.stderr
    )
    series, summary = contents(place / "a")
    assert list(series["t"]) == pytest.approx(np.arange(0, 20.05, 0.1)) and summary["energy_left_unit"] == "-"
    # The mean over a cycle falls as exp(-c t); within a cycle the energy departs from it by a relative c at most.
    assert summary["energy_left"] == pytest.approx(math.exp(-0.2 * 20), rel=0.2)
    assert (summary["steps"], summary["n_grains"], summary["particle_steps_per_second"]) == (20000, None, None)
    run = Run(place / "a")
    assert run.provenance["yade_version"] == "none" and run.provenance["work_unit"] == "oscillator-steps"
    assert run.provenance["work_per_second"] > 0 and not list((place / "a").glob("checkpoint*"))


def test_help_says_keys_levers_observables_and_cost(place):
    file = "oscillator.py"
    said = call(place, file, "help").stdout
    assert said.startswith(f"usage: scripts/run {file} [key=value …]   or   yade -n -x {file} [key=value …]\n\nkey ")
    lines = [" ".join(line.split()) for line in said.splitlines()]
    assert "dt_factor 1 higher" in lines and "time 20 s lower" in lines
    assert "* energy_left - energy at the end over that at the start" in lines
    assert (
        "cost on one core, without the packing: smoke 2e+03 oscillator-steps, 1 s; demo 2e+04 oscillator-steps, 1 s"
        in lines[-1]
    )
    wrong = call(place, "oscillator.py", "dampin=1")
    assert (
        wrong.returncode == 2 and "did you mean damping?" in wrong.stderr and not (place / "oscillator-demo").exists()
    )


@pytest.mark.parametrize("number, code", [(signal.SIGKILL, -9), (signal.SIGTERM, 143)])
def test_a_run_that_was_stopped_goes_on_with_the_same_bits(place, number, code):
    assert call(place, "oscillator.py", *KEYS, "out=whole").returncode == 0
    stopped = call(place, "-c", STOPPED, "oscillator.py", str(int(number)), "7300", *KEYS, "out=parts")
    assert stopped.returncode == code and not (place / "parts").exists(), stopped.stderr
    resumed = call(place, "oscillator.py", *KEYS, "out=parts", "resume=1")
    assert resumed.returncode == 0 and "going on from step 7300" in resumed.stderr
    (expected, quantities), (found, others) = contents(place / "whole"), contents(place / "parts")
    assert all(np.array_equal(expected[name], found[name]) for name in ("t", "x")) and quantities == others


@pytest.mark.skipif(shutil.which("snakemake") is None, reason="needs snakemake")
def test_a_campaign_runs_it_in_plain_python_and_reports(place):
    (place / "reported.py").write_text(REPORTED + "\nif __name__ == '__main__':\n    oscillator.headless.main(STUDY)\n")
    plan = "study: reported.py\nreport: oscillator\ncommon: {time: 2}\nsweeps:\n  rates: {damping: [0.1, 0.2]}\n"
    (place / "c.yaml").write_text(plan)
    dry = call(place, "-m", "graindrive.campaign", "c.yaml", "-n")
    assert (
        "2 of 2 runs would be made" in dry.stdout
        and "4e+03 oscillator-steps, about 1 s of processor time" in dry.stdout
    )
    done = call(place, "-m", "graindrive.campaign", "c.yaml")
    assert done.returncode == 0, done.stderr
    assert list(pd.read_csv(place / "c/table.csv")["damping"]) == [0.1, 0.2]
    report = (place / "c/report.md").read_text()
    # exp(-0.4) = 0.670; the tolerance is the effect of an incomplete cycle.
    assert "1 reproduced" in report and "core-seconds, 4e+03 steps, on " in report
    assert (place / "c/figures/c-decay.png").exists()


def test_a_run_of_a_study_elsewhere_is_drawn_by_its_file(place, capsys):
    assert call(place, "oscillator.py", *KEYS, "out=a").returncode == 0
    assert postproc.main([str(place / "a")]) == 2 and "oscillator, which has no figure here" in capsys.readouterr().err
    assert postproc.main([str(place / "a"), f"study={place / 'oscillator.py'}"]) == 2
    assert "a run of oscillator, which has no figure yet" in capsys.readouterr().err
    text = (place / "oscillator.py").read_text()
    figure = (
        "from pathlib import Path\n\ndef figure(path, frame=-1):\n    (Path(path) / 'figure.png').touch()\n\nSTUDY ="
    )
    text = text.replace("STUDY =", figure).replace("run=run,", "run=run, figure=figure,")
    (place / "drawn.py").write_text(text)
    assert postproc.main([str(place / "a"), f"study={place / 'drawn.py'}"]) == 0 and (place / "a/figure.png").exists()


def test_importing_a_study_file_runs_nothing_and_a_preset_keeps_what_it_does_not_change(place, monkeypatch):
    monkeypatch.chdir(place)
    before, path = sorted(place.iterdir()), list(sys.path)
    study = loaded("oscillator.py")
    assert (study.name, study.headline.name, list(study.levers)) == (
        "oscillator",
        "energy_left",
        ["precision", "dt_factor", "time"],
    )
    assert sys.path == path and [p for p in sorted(place.iterdir()) if p.name != "__pycache__"] == before
    slow = study.preset("slow", damping=0.01)
    assert (slow.name, slow.family, slow.run, slow.usual("demo").damping) == ("slow", "oscillator", study.run, 0.01)
    assert study.usual("demo").damping == 0.1


needs_yade = pytest.mark.skipif(shutil.which("yade") is None, reason="needs the yade program")
RUN = str(TOP / "scripts" / "run")


def skip_where_it_would_build(command):
    """Skip a call of scripts/run in a checkout that is not completely built, because it would first build the rest."""
    if command == RUN:
        asked = subprocess.run(["ninja", "-C", str(TOP / "build"), "-n"], capture_output=True, text=True)
        if "no work to do" not in asked.stdout:
            pytest.skip("scripts/run would build this checkout first")


@needs_yade
@pytest.mark.parametrize("command", [["yade"], ["yade", "-n", "-x"], [RUN]], ids=["yade", "-n -x", "run"])
@pytest.mark.parametrize("study", ["wiggle_triangle.py", "magnus.py"])
def test_a_study_file_is_a_command_under_each_program(tmp_path, command, study):
    skip_where_it_would_build(command[0])
    also = dict(GRAINDRIVE_NO_PACKAGES="1", HOME=str(tmp_path), XDG_CACHE_HOME=str(tmp_path))
    pipes = dict(stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)
    done = subprocess.run(
        [*command, str(TOP / "studies" / study), "help"], cwd=tmp_path, env={**os.environ, **also}, **pipes
    )
    assert done.returncode == 0, done.stderr
    usage = f"{RUN} {TOP / 'studies' / study}" if command == [RUN] else f"yade -n -x {TOP / 'studies' / study}"
    assert f"{usage} [key=value …]\n" in done.stdout and "observables of summary.json" in done.stdout


@needs_yade
def test_a_study_file_is_a_command_under_yade_batch_and_in_scripts_run_by_its_path(place):
    (place / "table").write_text("damping\n0.1\n0.2\n")
    also = {**environment(place), "GRAINDRIVE_NO_PACKAGES": "1"}
    pipes = dict(cwd=place, env=also, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)
    batch = subprocess.run(["yade-batch", "-j2", "table", "oscillator.py"], **pipes)
    assert batch.returncode == 0 and batch.stdout.count("exit status 0") == 2, batch.stdout + batch.stderr
    runs = sorted(path.parent.name for path in place.glob("*/summary.json"))
    assert runs == ["oscillator-demo-damping=0.1", "oscillator-demo-damping=0.2"]
    skip_where_it_would_build(RUN)
    assert subprocess.run([RUN, "oscillator.py", "out=r"], **pipes).returncode == 0
    assert (place / "r" / "summary.json").exists()
