"""Kills studies of smoke size at random times, resumes them, and counts the differences from runs that were not killed.

usage: scripts/killtest [--kills N] [--study NAME] [--seed S] [--work DIR]

Every trial starts a study and kills it (SIGKILL) at a random time of its work. In half of the trials it also kills the resumed
run within the first second of its work, perhaps several times, and then lets it end. One line is printed per kill. The last line
counts lost rows, differing bits of series, frames, fields and summary (without times), tracebacks, and wedged folders, which
means an exit code other than 0 or files left beside the result. The exit code is 1 if any of these numbers is not 0; the folder
of such a trial is kept.
"""

import argparse
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from ..base import output, signals
from ..base.errors import UsageError
from .headless import guarded

NAME = "killtest"
STUDIES = {  # at smoke size, with keys that test as much as possible
    "magnus": "scale=smoke travel=20 settle_travel=8 frames=4 spin_ratio=5".split(),
    "wiggle": "scale=smoke time=12 frames=6 fields=1".split(),
    "lift": "scale=smoke travel=12 frames=4 fields=1".split(),
    "drum": "scale=smoke drum_diameter=24 froude=.01 start_turn=20 turn=20 frames=4 model=both cells=20 continuum_dt=.05".split(),
    "shear": "scale=smoke grains=80".split(),
}
INTERVALS = (0.0, 0.1, 1.0)  # s between checkpoints
TIMED = ("wall_s", "core_seconds", "peak_memory", "particle_steps_per_second", "continuum_core_seconds")
AT_WORK = ("going on from step", "starting anew")  # messages of a run with resume=1 when its folder is made
COUNTED = ("lost rows", "differing bits", "tracebacks", "wedged")


@dataclass
class Subject:
    """A study under test: its folder, its run that was not killed, and the working time of that run in seconds."""

    name: str
    place: Path
    whole: Path
    seconds: float


def main(arguments):
    """Carry out a campaign of kills; return the exit code."""
    options = read_arguments(arguments)
    outcome = []
    code = guarded(lambda: outcome.append(campaign(options)), NAME)
    return code or outcome[0]


def read_arguments(arguments):
    """Return the options."""
    parser = argparse.ArgumentParser(
        prog="scripts/killtest", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--kills", type=int, default=200, help="number of kills (default: 200)")
    parser.add_argument("--study", choices=sorted(STUDIES), help="test only this study (default: all in turn)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the random times of the kills (default: 1)")
    parser.add_argument("--work", type=Path, help="folder to work in (default: a temporary one)")
    return parser.parse_args(arguments)


def campaign(options):
    """Make the reference runs, then carry out trials until the number of kills is reached; return the exit code."""
    if options.kills < 1:
        raise UsageError(f"kills={options.kills} must be at least 1")
    work = Path(tempfile.mkdtemp(prefix="killtest-")) if options.work is None else options.work.absolute()
    work.mkdir(parents=True, exist_ok=True)
    chance, total = random.Random(options.seed), Counter()
    with signals.handled():
        subjects = [prepare(name, work) for name in ([options.study] if options.study else STUDIES)]
        trial = 0
        while total["kills"] < options.kills:
            total += killed_and_resumed(subjects[trial % len(subjects)], trial, chance, options.kills - total["kills"])
            trial += 1
    bad = any(total[name] for name in COUNTED)
    print(f"{total['kills']} kills in {trial} runs: " + ", ".join(f"{total[name]} {name}" for name in COUNTED))
    if not bad and options.work is None:
        shutil.rmtree(work)
    return int(bad)


def prepare(name, work):
    """Run a study to its end twice, because the first run also makes the packing; return the `Subject`."""
    for whole in (work / f"{name}-warm", work / f"{name}-whole"):
        process = start(name, whole, 60.0)
        heard = Heard(process)
        heard.at_work.wait()
        started = time.monotonic()
        if process.wait():
            raise RuntimeError(f"{name} fails without being killed: {heard.text()[-500:]}")
    seconds = time.monotonic() - started
    print(f"{name}: {seconds:.1f} s of work without a kill", flush=True)
    return Subject(name, work, whole, seconds)


def start(name, out, interval):
    """Start a study with resume=1 in a process of its own."""
    study = Path(__file__).resolve().parents[3] / "studies" / f"{name}.py"
    keys = [*STUDIES[name], f"out={out}", f"checkpoint_seconds={interval}", "resume=1"]
    return subprocess.Popen(
        ["yade", "-n", "-x", "-j1", str(study), *keys],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
    )


def killed_and_resumed(subject, trial, chance, most):
    """Carry out one trial with at most `most` kills; return a Counter of kills and faults."""
    out, count = subject.place / f"{subject.name}-{trial}" / "run", Counter()
    out.parent.mkdir()
    interval = chance.choice(INTERVALS)
    words = []
    if kill_after(start(subject.name, out, interval), chance.uniform(0, subject.seconds), words):
        count["kills"] += 1
        say(subject, trial, count, "at its work", words[-1], out)
    while 0 < count["kills"] < most and chance.random() < 0.5:
        if kill_after(start(subject.name, out, interval), chance.uniform(0, 1), words):
            count["kills"] += 1
            say(subject, trial, count, "just resumed", words[-1], out)
    process = start(subject.name, out, interval)
    words.append(process.communicate()[1])
    count += judge(subject, out, process.returncode, words)
    if any(count[name] for name in COUNTED):
        (out.parent / "stderr").write_text("\n---- next process ----\n".join(words))
        print(f"{subject.name} {trial}: {dict(count)}, see {out.parent}", flush=True)
    else:
        shutil.rmtree(out.parent)
    return count


def say(subject, trial, count, when, words, out):
    """Print the line of one kill."""
    last = [line for line in words.splitlines() if line.strip()][-1:] or ["no output yet"]
    left = ", ".join(sorted(p.name for p in out.parent.iterdir())) or "nothing"
    print(f"{subject.name} {trial}: kill {count['kills']}, {when}: {last[0][:80]!r}, left {left}", flush=True)


def kill_after(process, seconds, words):
    """Kill a process `seconds` after it began its work; True if it still ran. Its output is added to `words`."""
    heard = Heard(process)
    heard.at_work.wait()
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        process.kill()
    words.append(heard.text())
    return process.wait() < 0


class Heard:
    """Reads what a process prints on stderr; `at_work` is set when it has its folder, or has ended."""

    def __init__(self, process):
        self.process, self.lines, self.at_work = process, [], threading.Event()
        self.thread = threading.Thread(target=self.listen, daemon=True)
        self.thread.start()

    def listen(self):
        """Take in all lines."""
        for line in self.process.stderr:
            self.lines.append(line)
            if any(told in line for told in AT_WORK):
                self.at_work.set()
        self.at_work.set()

    def text(self):
        """Return the whole output after the process has ended."""
        self.thread.join()
        return "".join(self.lines)


def judge(subject, out, code, words):
    """Compare a resumed run with the reference run; return a Counter of faults."""
    count = Counter()
    count["tracebacks"] = sum("Traceback" in text for text in words)
    left = sorted(p.name for p in out.parent.iterdir())
    if code or left != [out.name]:
        count["wedged"] = 1
    if (out / "run.h5").exists():
        rows, bits = differences(subject.whole, out)
        count["lost rows"], count["differing bits"] = rows, bits
    return count


def differences(whole, other):
    """Return (number of rows that the other run lacks, number of bits in which its data and its summary differ)."""
    with h5py.File(whole / "run.h5") as a, h5py.File(other / "run.h5") as b:
        expected, found = ({n: d for n, d in datasets(file) if not n.startswith("parameters/")} for file in (a, b))
    lost = max(len(expected[n]) - len(found.get(n, ())) for n in expected if n.startswith("series/"))
    bits = sum(differing_bits(expected.get(n), found.get(n)) for n in expected.keys() | found.keys())
    one, two = (summary_of(folder) for folder in (whole, other))
    keys = (one.keys() | two.keys()) - set(TIMED)
    return max(0, lost), bits + sum(64 for key in keys if one.get(key, "") != two.get(key, ""))


def datasets(file):
    """Return [(name, array)] of all datasets and attributes of frames in an HDF5 file."""
    found = []

    def add(name, item):
        if isinstance(item, h5py.Dataset):
            found.append((name, np.asarray(item[()])))
        elif name.startswith("frames/") and "t" in item.attrs:
            found.append((f"{name}@t", np.asarray(item.attrs["t"])))

    file.visititems(add)
    return found


def differing_bits(one, other):
    """Return the number of bits in which two arrays differ: all bits of the larger one if shapes or types differ."""
    if one is None or other is None or one.shape != other.shape or one.dtype != other.dtype:
        return 8 * max(array.nbytes for array in (one, other) if array is not None)
    a, b = (np.frombuffer(array.tobytes(), np.uint8) for array in (one, other))
    return int(np.unpackbits(a ^ b).sum())


def summary_of(folder):
    """Return the content of summary.json; empty where it cannot be read."""
    try:
        return json.loads((folder / "summary.json").read_text())
    except (OSError, ValueError):
        return {}


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    output.forgive()
    sys.exit(main(sys.argv[1:]))
