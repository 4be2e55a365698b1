"""A study under the real `yade` program: exit codes, messages, signals, ports, and files that remain on the disk."""

import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import pytest

from graindrive.runs.run_data import read_series

pytestmark = pytest.mark.skipif(shutil.which("yade") is None, reason="needs the yade program")
TOY = Path(__file__).with_name("toy_study.py")


class Place:
    """A folder of its own with home, cache and temporary folder inside; runs the toy study there."""

    def __init__(self, path):
        self.path = path
        for name in ("home", "tmp", "work"):
            (path / name).mkdir()
        self.work = path / "work"
        self.environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(p for p in sys.path if p),
            "PYTHONDONTWRITEBYTECODE": "1",
            "HOME": str(path / "home"),
            "TMPDIR": str(path / "tmp"),
            "XDG_CACHE_HOME": str(path / "cache"),
        }
        for name in ("GRAINDRIVE_CACHE", "MPLCONFIGDIR", "YADE_BATCH", "DISPLAY"):
            self.environment.pop(name, None)

    def start(self, *arguments, options=("-n", "-x"), preexec_fn=None, program=("yade",), **environment):
        command = [*program, *options, str(TOY), *arguments]
        pipes = dict(stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        pipes.update(preexec_fn=preexec_fn)
        return subprocess.Popen(command, cwd=self.work, env={**self.environment, **environment}, **pipes)

    def run(self, *arguments, **options):
        process = self.start(*arguments, **options)
        out, err = process.communicate(timeout=60)
        return process.returncode, out, err

    def names(self):
        return sorted(p.name for p in self.work.iterdir())


@pytest.fixture
def place(tmp_path):
    return Place(tmp_path)


def last_line(err):
    return [line for line in err.splitlines() if line][-1]


def test_a_good_run_is_complete_and_closes_its_ports(place):
    code, out, err = place.run("out=a")
    assert code == 0 and "ports []" in out
    assert "toy:  50 %" in err and "particle-steps/s" in err
    summary = json.loads((place.work / "a/summary.json").read_text())
    assert summary["answer"] == 42 and summary["answer_err"] is None
    for key in ("particle_steps_per_second", "steps", "n_grains", "wall_s", "dt_over_critical"):
        assert summary[key] > 0
    with h5py.File(place.work / "a/run.h5") as file:
        assert file.attrs["state"] == "complete"
        assert list(file["series/step"]) == list(range(10, 101, 10)) and file["series/t"].attrs["unit"] == "sqrt(d/g)"
        assert len(file["frames"]) == 10 and file["frames/0010/x"][0] == 100
        assert file["parameters/period"][()] == 4 and file["parameters/period"].attrs["unit"] == "sqrt(d/g)"
        assert file["provenance"].attrs["yade_version"][:2] == "20" and file["provenance"].attrs["dt"] == 1e-3
    assert sorted(p.name for p in (place.work / "a").iterdir()) == ["figure.png", "run.h5", "summary.json"]


def test_nothing_outside_the_run_folder_but_ipythons_profile(place):
    """YADE's program opens IPython's history in ~/.ipython before any script runs; IPYTHONDIR moves it."""
    yade_folders = set(Path("/tmp").glob("yade-*"))
    code, _, _ = place.run("out=a", IPYTHONDIR=str(place.path / "ipython"))
    assert code == 0 and place.names() == ["a"]
    assert not any((place.path / "home").iterdir()) and not any((place.path / "tmp").iterdir())
    mine = [p for p in set(Path("/tmp").glob("yade-*")) - yade_folders if p.stat().st_uid == os.getuid()]
    assert not [p for p in mine if time.time() - p.stat().st_mtime < 0.5], "YADE's folder in /tmp must be gone"


def test_the_same_run_is_there_already_and_another_is_refused(place):
    assert place.run("out=a")[0] == 0
    before = (place.work / "a/run.h5").stat().st_mtime_ns
    code, _, err = place.run("out=a")
    assert code == 0 and "is there already" in last_line(err)
    code, _, err = place.run("out=a", "period=2")
    assert code == 2 and "period=4.0 there, period=2.0 asked for" in last_line(err)
    assert (place.work / "a/run.h5").stat().st_mtime_ns == before
    assert place.run("out=a", "redo=1")[0] == 0
    assert (place.work / "a/run.h5").stat().st_mtime_ns != before
    assert place.names() == ["a"]


@pytest.mark.parametrize("out", ["/proc/nowhere", "/dev/null/x", str(TOY), "n" * 300, "x/" + "n" * 300], ids=range(5))
def test_an_unwritable_out_is_one_line_before_anything_is_computed(place, out):
    code, stdout, err = place.run(f"out={out}")
    assert code == 2 and "out=" in last_line(err) and "ports" not in stdout
    assert "Traceback" not in err and place.names() == []


@pytest.mark.parametrize("arguments", [["perio=2"], ["period=0"], ["steps=x"], ["period=1", "period=2"], ["demo"]])
def test_bad_arguments_write_nothing(place, arguments):
    code, _, err = place.run(*arguments)
    assert code == 2 and "toy_study: error: " in last_line(err) and "Traceback" not in err
    assert place.names() == []


@pytest.mark.parametrize("options", [(), ("-n", "-x", "-j2")])
def test_help_exits_0_with_and_without_options(place, options):
    code, out, _ = place.run("help", options=options)
    assert code == 0 and "sqrt(d/g)" in out and place.names() == []


def test_a_usage_error_of_the_study_removes_what_was_begun(place):
    code, _, err = place.run("out=deep/er/a", "fault=usage")
    assert code == 2 and last_line(err).endswith("error: dt=1 is over the critical 0.5; give a smaller dt_factor")
    assert "Traceback" not in err and place.names() == []
    code, _, err = place.run("fault=usage", GRAINDRIVE_DEBUG="1")
    assert code == 2 and "Traceback" in err


@pytest.mark.parametrize("fault, rows", [("engine", 4), ("study", 10)])
def test_a_failure_exits_1_and_keeps_the_data(place, fault, rows):
    code, _, err = place.run("out=a", f"fault={fault}")
    assert code == 1 and "Traceback" in err
    assert {"engine": "division by zero", "study": "ValueError: the study has a bug"}[fault] in last_line(err)
    assert place.names() == ["a.failed"]
    with h5py.File(place.work / "a.failed/run.h5") as file:
        assert file.attrs["state"] == "failed" and rows <= len(file["series/t"]) <= rows + 1


def test_a_figure_that_fails_keeps_the_finished_data(place):
    code, _, err = place.run("out=badfigure")
    assert code == 1 and "no figure" in last_line(err) and place.names() == ["badfigure.failed"]
    assert json.loads((place.work / "badfigure.failed/summary.json").read_text())["answer"] == 42


@pytest.mark.parametrize("name, code", [("INT", 130), ("TERM", 143)])
def test_a_signal_saves_the_data_and_resume_goes_on(place, name, code):
    returned, _, err = place.run("out=a", f"ask={name}")
    assert returned == code and f"stopped by SIG{name}" in last_line(err) and "a.interrupted" in err
    assert place.names() == ["a.interrupted"]
    with h5py.File(place.work / "a.interrupted/run.h5") as file:
        assert file.attrs["state"] == "interrupted" and list(file["series/step"]) == [10, 20, 30, 40, 50]
    returned, _, err = place.run("out=a", "resume=1")
    assert returned == 0 and "going on from step 50" in err and place.names() == ["a"]
    with h5py.File(place.work / "a/run.h5") as file:
        assert list(file["series/step"]) == list(range(10, 101, 10)) and len(file["frames"]) == 10
    assert json.loads((place.work / "a/summary.json").read_text())["first"] == 50


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_from_outside_ends_a_long_block_at_once(place, number, code):
    process = place.start("out=a", "fault=slow", "steps=100000")
    while "ports" not in process.stdout.readline():
        assert process.poll() is None
    time.sleep(0.5)
    sent = time.monotonic()
    process.send_signal(number)
    process.communicate(timeout=30)
    assert process.returncode == code
    assert time.monotonic() - sent < 5, "the block alone takes ten seconds"
    assert place.names() == [], "no block was finished, so there is nothing to keep"


def test_kill_leaves_readable_data_that_the_next_run_keeps(place):
    code, _, _ = place.run("out=a", "ask=KILL")
    assert code == -signal.SIGKILL
    (part,) = place.work.iterdir()
    assert part.name.startswith(".a.part-")
    series, units = read_series(part / "run.h5")
    assert list(series["step"]) == [10, 20, 30, 40, 50] and units["t"] == "sqrt(d/g)"
    code, _, err = place.run("out=a")
    assert code == 0 and "a.interrupted" in err and place.names() == ["a", "a.interrupted"]
    with h5py.File(place.work / "a.interrupted/run.h5") as file:
        assert len(file["frames"]) == 5 and file["parameters/steps"][()] == 100


def test_kill_and_resume(place):
    assert place.run("out=a", "ask=KILL")[0] == -signal.SIGKILL
    code, _, err = place.run("out=a", "resume=1")
    assert code == 0 and "going on from step 50" in err and place.names() == ["a"]
    with h5py.File(place.work / "a/run.h5") as file:
        assert list(file["series/step"]) == list(range(10, 101, 10))


def test_two_runs_do_not_share_a_folder(place):
    first = place.start("out=a", "fault=slow", "steps=100000")
    while "ports" not in first.stdout.readline():
        assert first.poll() is None
    code, _, err = place.run("out=a")
    first.send_signal(signal.SIGTERM)
    first.communicate(timeout=30)
    assert code == 2 and "another run is writing out=a" in last_line(err)


def test_batch_tables_run_rows_in_folders_of_their_own(place):
    (place.work / "table").write_text("period steps\n1 100\n2 =\n")
    toy = shutil.copy(TOY, place.work)  # yade-batch puts its logs beside the script
    command = ["yade-batch", "-j2", "table", str(toy)]
    options = dict(cwd=place.work, env=place.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    result = subprocess.run(command, timeout=120, **options)
    assert result.returncode == 0 and result.stdout.count("exit status 0") == 2, result.stdout + result.stderr
    folders = [p.parent for p in place.work.glob("*/summary.json")]
    assert len(folders) == 2 and all("period" in folder.name for folder in folders)


def test_a_disk_that_is_full_ends_in_a_message_and_exit_code_1(place):
    def small_files():  # a file size limit of the system stands for a full disk: writing fails at the same places
        resource.setrlimit(resource.RLIMIT_FSIZE, (40_000, 40_000))

    process = place.start(preexec_fn=small_files)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1, err[-2000:]
    assert "toy_study: failed: the disk or the quota is full" in last_line(err) and "Traceback" not in err
    assert list((place.path / "tmp").iterdir()) == [] and place.names() == []


@pytest.mark.parametrize(
    "text, said",
    [
        ("print('hello')\n", "defines no STUDY; a YADE script is run by"),
        ("STUDY = 1\n", "defines STUDY, but does not run it: end the file with `if __name__"),
        ("STUDY = (\n", "SyntaxError"),
    ],
)
def test_a_file_that_starts_no_study_is_refused(place, text, said):
    file = place.work / "none.py"
    file.write_text(text)
    command = (sys.executable, "-P", "-c", "from graindrive.commands.run_study import main; main()", str(file))
    ended = subprocess.run(command, cwd=place.work, env=place.environment, capture_output=True, text=True, timeout=60)
    assert (
        ended.returncode != 0 and said in ended.stderr and "none.py" in ended.stderr and "Traceback" not in ended.stderr
    )


def test_readers_that_leave_do_not_end_the_run(place):
    """As scripts/run starts a study."""
    program = (sys.executable, "-P", "-c", "from graindrive.commands.run_study import main; main()")
    process = place.start("out=a", program=program, options=())
    process.stdout.close()
    process.stderr.close()
    assert process.wait(60) == 0 and place.names() == ["a"]
    with open("/dev/full", "w") as full:
        command = [*program, str(TOY), "out=b"]
        options = dict(cwd=place.work, env=place.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        assert subprocess.run(command, stderr=full, timeout=60, **options).returncode == 0
    assert place.names() == ["a", "b"]
