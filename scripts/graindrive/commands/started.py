"""Starts runs from Python: `run("wiggle", shape="star.csv", period=3)` makes a run, or finds it, and opens it."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from .command_line import parse
from ..base.errors import EngineError, UsageError, one_line
from .parameter_values import argument, nearest
from ..postproc.reader import Run
from ..study import house, loaded

DONE, REFUSED = 0, UsageError.exit_code


def run(study, *, progress=True, **keys):
    """Return the `Run` of a study with these keys; it is made as by `scripts/run STUDY key=value …`, in a new process.

    `study` is the name of a study of this checkout, or a .py file; `keys` are the study's keys with numbers, words or switches.
    A run that exists is not made again; an interrupted run continues with resume=True. `progress` prints the run's progress on
    stderr, line by line. Ctrl-C (a notebook's stop button) ends the run, which keeps its data. Raises UsageError for keys that
    the study refuses, and EngineError for a run that fails, with the last line that the study printed.
    """
    file = study_file(study)
    known = loaded(file)
    arguments = [argument(known.parameters, key, value) for key, value in keys.items()]
    out = Path(parse(known, arguments, environment={}).out).expanduser().absolute()
    arguments = [a for a in arguments if not a.startswith("out=")]
    last = carried_out([sys.executable, str(file), *arguments, f"out={out}"], progress)
    if last is not None:
        code, words = last
        raise (UsageError if code == REFUSED else EngineError)(words.removeprefix(f"{known.name}: error: "))
    return Run(out)


def study_file(study):
    """Return the file of a study, given by its name in this checkout or as a .py file; UsageError for anything else."""
    if str(study).endswith(".py"):
        if not Path(study).is_file():
            raise UsageError(f"there is no file {one_line(study)}")
        return Path(study).resolve()
    known = house()
    if study not in known:
        hint = nearest(study, known, "did you mean ", "? ")
        raise UsageError(f"there is no study '{one_line(study)}'; {hint}there are: {' '.join(known)}")
    return known[study]


def carried_out(command, progress):
    """Run a command to its end; return None after success, or (exit code, last line printed) after a failure."""
    environment = {"OMP_NUM_THREADS": "1", **os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    child = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env=environment,
        text=True,
        errors="replace",
        process_group=0,
    )
    last = ""
    try:
        for line in child.stderr:
            last = line.strip() or last
            if progress:
                print(line, end="", file=sys.stderr, flush=True)
        code = child.wait()
    except BaseException:
        child.send_signal(signal.SIGINT)
        child.wait()
        raise
    finally:
        child.stderr.close()
    return None if code == DONE else (code, last)
