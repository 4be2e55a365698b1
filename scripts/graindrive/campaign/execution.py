"""Carries out a plan: makes its folder, runs Snakemake as a child that a signal ends cleanly, and reports failed runs."""

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

PROGRAM = [sys.executable]  # runs a study's file; YADE is then a library, which opens no port
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
    """Make the campaign's folder, write the plan into it as `campaign.json`, and yield its lock, held in this block."""
    try:
        for name in ("runs", "logs", "done"):
            (folder / name).mkdir(parents=True, exist_ok=True)
        lock = open(folder / ".lock", "w")
    except OSError as error:
        raise UsageError(f"out={folder} cannot be written ({error.strerror}); give another --out") from None
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UsageError(
                f"another scripts/campaign is working in {folder}, or one that was killed has left runs at work there;"
                " wait until they have ended, or give another --out"
            ) from None
        plan_json.write(folder, plan, PROGRAM)
        yield lock


def missing(folder, plan):
    """Return the planned runs that have no complete run folder."""
    return [run for run in plan.runs if stored_digest(folder / "runs" / run.name) != run.parameters.digest()]


def set_damaged_aside(folder, plan):
    """Rename run folders that cannot be read, so that the runs are made again; return a line on each."""
    places = {run.name: folder / "runs" / run.name for run in plan.runs}
    found = {name: problem for name, place in places.items() if (problem := damage(place))}
    return [
        f"{problem}; it is kept as {set_aside(places[name]).name} and made again" for name, problem in found.items()
    ]


def set_marks(folder, plan):
    """Make the marks in `done/` agree with the run folders, which users may have removed or made."""
    names = {run.name for run in missing(folder, plan)}
    for run in plan.runs:
        mark = folder / "done" / run.name
        if mark.is_dir():
            raise UsageError(f"{mark} must be a file, but it is a folder; move it away, or give another --out")
        mark.unlink(missing_ok=True) if run.name in names else mark.touch()


def carry_out(folder, plan, cores, options, lock):
    """Make the missing runs with Snakemake; return its exit code. A signal ends it and its runs, and is then raised.

    Snakemake gets its own process group, so that each run receives Ctrl-C or SIGTERM exactly once. It also holds the
    open file `lock`: if this process is killed, Snakemake continues and must prevent a second call.
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
        print("graindrive: stopping; the runs' data so far are kept for the next call", file=sys.stderr)
        end_group(child)
        raise


def hear_interrupts():
    """Restore SIGINT for Snakemake and the runs: a shell makes background processes ignore it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def ours(cores, options):
    """Return Snakemake's options, the user's last; Snakemake relies on the marks and uses no locks of its own."""
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
    """Return {name of a missing run: last line of its log}."""
    return {run.name: last_words(folder / "logs" / f"{run.name}.log") for run in missing(folder, plan)}


def last_words(log):
    """Return the last line of a log that is not empty."""
    try:
        lines = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
    except FileNotFoundError:
        lines = []
    except OSError as error:
        return f"its log cannot be read ({error.strerror})"
    return lines[-1] if lines else "it has not been started"
