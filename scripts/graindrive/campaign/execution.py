"""Carrying out a plan: its folder, Snakemake as a child that a signal ends cleanly, and what came of each run."""

import contextlib
import errno
import fcntl
import os
import signal
import subprocess
import sys
from pathlib import Path

from ..base.errors import Interrupted, UsageError
from ..runs.run_place import damage, set_aside, stored_digest
from . import plan_json

PROGRAM = [sys.executable]  # that runs a study's file: YADE is a library there, which opens no port
SNAKEFILE = Path(__file__).with_name("Snakefile")
IN_THE_WAY = {getattr(errno, f"E{name}") for name in "ISDIR NOTDIR EXIST ACCES PERM ROFS NAMETOOLONG LOOP".split()}


@contextlib.contextmanager
def nothing_in_the_way(folder):
    """Turn the system's refusal to write a file of the campaign's `folder` into a UsageError that names the file."""
    try:
        yield
    except OSError as error:
        if error.errno not in IN_THE_WAY:
            raise
        place = error.filename2 or error.filename or folder
        raise UsageError(f"{place} cannot be written ({error.strerror}); move it away, or give another --out") from None


@contextlib.contextmanager
def opened(folder, plan):
    """Make the campaign's folder, hold its lock, which is yielded, and leave the plan in it as `campaign.json`."""
    try:
        for name in ("runs", "logs", "done"):
            (folder / name).mkdir(parents=True, exist_ok=True)
        lock = open(folder / ".lock", "w")
    except OSError as error:
        raise UsageError(f"out={folder} cannot be written ({error.strerror}); give --out a folder of yours") from None
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UsageError(f"another scripts/campaign is at work in {folder}; wait for it, or give --out") from None
        plan_json.write(folder, plan, PROGRAM)
        yield lock


def missing(folder, plan):
    """Return the planned runs that have no complete run folder."""
    return [run for run in plan.runs if stored_digest(folder / "runs" / run.name) != run.parameters.digest()]


def set_damaged_aside(folder, plan):
    """Move run folders that cannot be read out of the way, so that they are made again; return a line on each."""
    places = {run.name: folder / "runs" / run.name for run in plan.runs}
    found = {name: problem for name, place in places.items() if (problem := damage(place))}
    return [
        f"{problem}; it is kept as {set_aside(places[name]).name} and made again" for name, problem in found.items()
    ]


def set_marks(folder, plan):
    """Make the marks in `done/` agree with the run folders, which may have been removed, or made by hand."""
    names = {run.name for run in missing(folder, plan)}
    for run in plan.runs:
        mark = folder / "done" / run.name
        if mark.is_dir():
            raise UsageError(f"{mark} is a folder where a file belongs; move it away, or give another --out")
        mark.unlink(missing_ok=True) if run.name in names else mark.touch()


def carry_out(folder, plan, cores, options, lock):
    """Have Snakemake make the runs that are missing; return its exit code. A signal ends it and its runs, and is raised.

    Snakemake gets a process group of its own, so that each run hears of Ctrl-C, or of a SIGTERM, exactly once. It holds the
    open file `lock` too: where this process is killed, Snakemake works on and must keep a second call out.
    """
    set_marks(folder, plan)
    command = [
        sys.executable,
        "-m",
        "snakemake",
        "--snakefile",
        SNAKEFILE,
        "--directory",
        folder,
        *ours(cores, options),
    ]
    child = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        process_group=0,
        preexec_fn=hear_interrupts,
        env=environment(),
        pass_fds=[lock.fileno()],
    )
    try:
        return child.wait()
    except (Interrupted, KeyboardInterrupt):
        print("graindrive: stopping; what the runs have so far is kept for the next call", file=sys.stderr)
        end_group(child)
        raise


def hear_interrupts():
    """Let SIGINT through to Snakemake and the runs: a shell has it ignored in what it starts in the background."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def ours(cores, options):
    """Return Snakemake's options, the user's last; marks are true, and locks are the campaign's own."""
    manners = ["--keep-going", "--nolock", "--ignore-incomplete", "--rerun-triggers", "mtime", "--nocolor"]
    return ["--cores", str(cores), *manners, *options]


def environment():
    """Return the environment of the runs: one core each."""
    return {**os.environ, "OMP_NUM_THREADS": "1"}


def end_group(child):
    """Pass the signal on to Snakemake and its runs, as Ctrl-C, and wait until all have gone."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGINT)
    child.wait()


def failures(folder, plan):
    """Return {name of a run that is missing: last words of its log}."""
    return {run.name: last_words(folder / "logs" / f"{run.name}.log") for run in missing(folder, plan)}


def last_words(log):
    """Return the last line of a log that holds something."""
    try:
        lines = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
    except FileNotFoundError:
        lines = []
    except OSError as error:
        return f"its log cannot be read ({error.strerror})"
    return lines[-1] if lines else "it has not been started"
