"""Kills a small run before each of its changes of the file system, resumes it, kills it again, and counts differences.

Usage, with kill_at.cpp preloaded: kill_anywhere.py FOLDER SCENARIO EVERY; prints one JSON object. Every run is a fork of this
process, so that none has to import anything. Scenarios: plain, interrupted (Ctrl-C at a step), resumed, redo, vtk; full: no
kills, but no file can grow beyond a limit that rises by EVERY bytes or a third.
"""

import contextlib
import ctypes
import json
import os
import random
import resource
import shutil
import signal
import sys
from pathlib import Path

import h5py
import numpy as np

from graindrive.commands import headless
from graindrive.commands.killtest import TIMED
from graindrive.parameters import StudyParameters, quantity
from graindrive.study import Study

STEPS = 5
killer = ctypes.CDLL(os.environ["LD_PRELOAD"])
place = Path(sys.argv[1])


class Parameters(StudyParameters):
    """Parameters of the small study."""

    length: int = quantity(STEPS, "-", "steps of the run", ge=1)


def study(p, folder, interrupted_at=None):
    """Multiply a number at each step; write a row at each step, a frame and a checkpoint at every second one."""
    first, x, total = 0, 1, 0
    if folder.resumed:
        first = folder.resumed["step"]
        x, total = json.loads((folder.resumed["folder"] / "state").read_text())
    folder.declare_series(t="s", x="m")
    folder.write("body", {"beads": (np.arange(4.0), "m")})

    def save(there):
        (there / "state").write_text(json.dumps([x, total]))

    for step in range(first + 1, p.length + 1):
        x = x * 16807 % (2**31 - 1)
        total += x
        folder.append(t=step, x=x)
        if step % 2 == 0:
            folder.frame(step, {name: np.full(3, x) for name in ("x", "y", "r", "vx", "vy", "spin")})
            folder.checkpoint(save, step)
        if step == interrupted_at:
            raise KeyboardInterrupt
    folder.note(dt=1.0, dt_over_critical=0.1, n_grains=1, steps=p.length, particle_steps_per_second=1.0)
    folder.summarize(last=x, total=total)


def figure(path):
    """Draw a figure as a study does: from the finished data, into two files."""
    with h5py.File(path / "run.h5") as file:
        for name in ("figure.png", "figure.pdf"):
            (path / name).write_text(str(file["series/x"][-1]))


def session(at, interrupted_at=None, largest_file=None, **keys):
    """Run the study in a process of its own, killed before its change number `at` (0: not); return (exit code, stderr)."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.dup2(writing, 1)
        os.dup2(writing, 2)
        if largest_file is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))
        p = Parameters(out=str(place / "work" / "a"), **keys)
        killer.arm(at)
        small = Study(
            "small", Parameters, {"demo": {}}, lambda q, folder: study(q, folder, interrupted_at), figure=figure
        )
        code = headless.guarded(lambda: headless.carry_out(small, p), "small")
        if largest_file is None:
            os._exit(code)
        headless.end(code)  # end as a study does, because the interpreter's normal end may crash on a full disk
    os.close(writing)
    with open(reading, errors="replace") as words:
        said = words.read()
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status), said


def contents(folder):
    """Return the contents of a complete run folder, without computing times."""
    with h5py.File(folder / "run.h5") as file:
        data = {}
        file.visititems(lambda name, item: data.update({name: read(name, item)}))
        data["/"] = {key: value for key, value in file.attrs.items() if key != "resumed_from"}
    summary = json.loads((folder / "summary.json").read_text())
    files = sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))
    return {**data, "summary": {k: v for k, v in summary.items() if k not in TIMED}, "files": files}


def read(name, item):
    """Return a dataset as plain values; None for parameters and provenance, which depend on how the run was started."""
    timed = name.startswith(("parameters", "provenance"))
    return None if timed or isinstance(item, h5py.Group) else np.asarray(item[()]).tolist()


def wrong_after(end, expected, scenario):
    """Return a list of what is wrong after the last session, which was not killed."""
    code, err = end
    found = [f"exit code {code}: {err}"] if code else []
    if "Traceback" in err:
        found.append(err)
    left = sorted(p.name for p in (place / "work").iterdir())
    if left not in (["a"], ["a", "a.interrupted"] if scenario == "redo" else []):
        found.append(f"left {left}")
    with contextlib.suppress(OSError):
        found += ["other contents"] if contents(place / "work" / "a") != expected else []
        return found
    return found + ["no run"]


def empty():
    """Make the working folder anew."""
    shutil.rmtree(place / "work", ignore_errors=True)
    (place / "work").mkdir(parents=True)


def begin(scenario, at):
    """Carry out the first session of a scenario; return its exit code."""
    empty()
    if scenario == "redo":
        session(0)
        return session(at, redo=True)
    if scenario == "vtk":
        return session(at, vtk=True)
    if scenario == "resumed":
        session(0, interrupted_at=3)
        return session(at, resume=True)
    return session(at, interrupted_at=3 if scenario == "interrupted" else None)


def killed(scenario, every, expected):
    """Kill at every `every`-th change; half of the resumed runs are killed again, at any change; return the results."""
    chance, failures, kills, at = random.Random(1), [], 0, 1
    keys = dict(resume=True, vtk=scenario == "vtk")
    while True:
        code, err = begin(scenario, at)
        survived, ats = code != -signal.SIGKILL, [at]
        wrong = [err] if "Traceback" in err else []
        while chance.random() < 0.5:
            ats.append(chance.randint(1, 200))
            session(ats[-1], **keys)
        wrong += wrong_after(session(0, **keys), expected, scenario)
        failures += [[ats, wrong]] if wrong else []
        if survived:
            return dict(kills=kills, failures=failures)
        kills, at = kills + len(ats), at + every


def filled(step, expected):
    """Let files grow to a limit that rises by `step` bytes, or a third, until a run fits; each is resumed without one."""
    failures, codes, limit = [], [], 0
    while not codes or codes[-1] != 0:
        empty()
        code, err = session(0, largest_file=limit)
        codes.append(code)
        wrong = [err] if "Traceback" in err or (code and "is full" not in err) else []
        wrong += wrong_after(session(0, resume=True), expected, "full")
        failures += [[limit, wrong]] if wrong else []
        limit += max(step, limit // 3)
    return dict(codes=sorted(set(codes)), runs=len(codes), failures=failures)


def main():
    """Carry out one scenario and print the results."""
    scenario, every = sys.argv[2], int(sys.argv[3])
    empty()
    session(0, vtk=scenario == "vtk")
    expected = contents(place / "work" / "a")
    print(json.dumps(filled(every, expected) if scenario == "full" else killed(scenario, every, expected)), flush=True)


if __name__ == "__main__":
    main()
