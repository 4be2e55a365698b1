"""Runs started from Python: `graindrive.run` with a user's study."""

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import graindrive
from graindrive.campaign.execution import hear_interrupts
from graindrive.base.errors import EngineError, UsageError
from graindrive.postproc.reader import Run

COUNTER = '''
"""Counter: counts, and fails or waits where it is told to."""
import os, signal
from graindrive.commands import headless
from graindrive.base.errors import EngineError
from graindrive.parameters import StudyParameters, quantity
from graindrive.study import Observable, Study

class Parameters(StudyParameters):
    number: int = quantity(3, "-", "how far to count", ge=1)
    fails: bool = quantity(False, "-", "end with an error")
    interrupts: bool = quantity(False, "-", "interrupt the one who asked")

def run(p, folder):
    folder.declare_series(t="s", count="-")
    for k in range(p.number):
        folder.append(t=0.1 * k, count=k)
    if p.fails:
        raise EngineError("a grain has left the world")
    if p.interrupts:
        os.kill(os.getppid(), signal.SIGINT)
        signal.pause()
    folder.summarize(sum=sum(range(p.number)), sum_err=0.5)

STUDY = Study(name="counter", parameters=Parameters, presets={"demo": {}}, run=run,
              observables=(Observable("sum", "m", "of all numbers", headline=True),))
if __name__ == "__main__":
    headless.main(STUDY)
'''


@pytest.fixture
def place(tmp_path, monkeypatch):
    (tmp_path / "counter.py").write_text(COUNTER)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_run_comes_back_opened_and_is_made_once(place, capfd):
    run = graindrive.run("counter.py", number=5)
    assert run.summary["sum"] == 10 and list(run.series["count"]) == [0, 1, 2, 3, 4]
    assert run.path == place / "counter-demo-number=5" and "counter: done" in capfd.readouterr().err
    when = (run.path / "run.h5").stat().st_mtime_ns
    again = graindrive.run(place / "counter.py", number=5, progress=False)
    assert (again.path / "run.h5").stat().st_mtime_ns == when and capfd.readouterr().err == ""


def test_a_run_lists_what_it_holds_with_units_and_meanings(place):
    rows = graindrive.run("counter.py", out="here", progress=False).contents().set_index(["where", "name"])
    assert rows.loc[("summary", "sum"), "value"] == "3.00 ± 0.50" and rows.loc[("summary", "sum"), "unit"] == "m"
    assert rows.loc[("parameters", "number"), "meaning"] == "how far to count"
    assert rows.loc[("series", "count"), "value"] == "(3,)"
    assert "processor time" in rows.loc[("summary", "core_seconds"), "meaning"]


@pytest.mark.parametrize(
    "keys, words",
    [
        (dict(numer=3), "there is no key 'numer'; did you mean number"),
        (dict(number=0), "number=0 is not allowed: number is a whole number >= 1"),
        (dict(number="many"), "number=many is not allowed"),
        (dict(number=[1, 2]), "number must be a number, a word or a switch"),
    ],
)
def test_bad_keys_are_refused_before_anything_runs(place, keys, words):
    with pytest.raises(UsageError, match=words):
        graindrive.run("counter.py", **keys)
    assert sorted(p.name for p in place.iterdir() if p.name != "__pycache__") == ["counter.py"]


def test_an_unknown_study_is_refused_by_name():
    with pytest.raises(UsageError, match="no study 'wigle'; did you mean wiggle"):
        graindrive.run("wigle")
    with pytest.raises(UsageError, match="there is no file nowhere.py"):
        graindrive.run("nowhere.py")


def test_a_run_that_fails_raises_with_its_last_words_and_keeps_its_data(place):
    with pytest.raises(EngineError, match="a grain has left the world"):
        graindrive.run("counter.py", fails=True, progress=False, out="lost")
    assert list(Run(place / "lost.failed").series["count"]) == [0, 1, 2]


def test_an_interrupt_ends_the_run_which_keeps_its_data(place):
    asking = """
        import graindrive
        try:
            graindrive.run("counter.py", interrupts=True, progress=False, out="cut")
        except KeyboardInterrupt:
            print("interrupted")
    """
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = [sys.executable, "-c", textwrap.dedent(asking)]
    pipes = dict(stdout=subprocess.PIPE, text=True, env=environment, cwd=place)
    said = subprocess.run(command, timeout=60, preexec_fn=hear_interrupts, **pipes)
    assert said.stdout == "interrupted\n"
    assert list(Run(Path(place) / "cut.interrupted").series["count"]) == [0, 1, 2]
