"""Runs one scene of elastic disks with several number types: in YADE's builds, each in its own process, and on GrainLoop."""

import glob
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..base import signals
from ..base.errors import EngineError, UsageError, one_line

SCRIPT = Path(__file__).with_name("rounding_script.py")


@dataclass(frozen=True)
class NumberType:
    """A program that runs a scene: YADE's `build`, its `loop` ("yade", or GrainLoop's precision), `bits` of its mantissa."""

    build: str
    loop: str
    bits: int
    words: str


# The longest type comes first and is the reference for the others. GrainLoop's single precision has 24 bits only in contacts.
TYPES = {
    "mpfr150": NumberType("mpfr150", "yade", 500, "yade-mpfr150, 150 digits"),
    "float128": NumberType("float128", "yade", 113, "yade-float128, 113 bits"),
    "longdouble": NumberType("longdouble", "yade", 64, "yade-longdouble, 64 bits"),
    "yade_double": NumberType("double", "yade", 53, "yade-double, 53 bits"),
    "double": NumberType("double", "double", 53, "GrainLoop double, 53 bits"),
    "single": NumberType("double", "single", 24, "GrainLoop single, contacts in 24 bits"),
}
TRUTH = next(iter(TYPES))


def modules_of(build):
    """Return the folder with the Python modules of a build of YADE; UsageError naming the program if it is missing."""
    found = glob.glob(f"/usr/lib/*/yade-{build}/py")
    if not found:
        raise UsageError(
            f"the program yade-{build} is missing; install Debian's package yade, or leave its numbers out"
        )
    return found[0]


@dataclass(frozen=True)
class Rows:
    """Samples of a run: `steps` (n,), `place` (n, 2m) as decimal texts, `velocity` (n, 2m), half a step earlier."""

    steps: np.ndarray
    place: list
    velocity: np.ndarray

    @property
    def places(self):
        """The places as doubles (n, m, 2)."""
        return np.array(self.place, dtype=float).reshape(len(self.steps), -1, 2)

    @property
    def velocities(self):
        """The velocities (n, m, 2)."""
        return self.velocity.reshape(len(self.steps), -1, 2)


def run(name, scene, rows_file):
    """Run a scene (the dict that rounding_script.py reads, without its loop) with the number type `name`; write `rows_file`.

    The program runs in a separate folder, without YADE's console and ports. It is killed if this call is interrupted, and it
    ends at its next sample if this process was killed. Raises UsageError if it is missing, EngineError with its last line of
    output if it fails.
    """
    kind = TYPES[name]
    with tempfile.TemporaryDirectory(prefix="graindrive-rounding-") as folder:
        folder = Path(folder)
        shutil.copy(SCRIPT, folder)
        (folder / "scene.json").write_text(json.dumps(dict(scene, loop=kind.loop)))
        command = ["/usr/bin/python3", "-P", SCRIPT.name]
        with open(rows_file, "w") as rows, open(folder / "errors", "w") as errors:
            places = dict(cwd=folder, stdin=subprocess.DEVNULL, stdout=rows, stderr=errors)
            program = None
            try:
                with signals.deferred():
                    program = subprocess.Popen(command, env=environment(kind.build), start_new_session=True, **places)
                code = program.wait()
            except BaseException:
                if program is not None:
                    end(program, rows_file)
                raise
        if code:
            said = (folder / "errors").read_text().strip().splitlines()[-1:] or ["it said nothing"]
            raise EngineError(f"yade-{kind.build} with the loop {kind.loop} ended with {code}: {one_line(said[0])}")


def environment(build):
    """Return the environment in which a plain Python finds that build of YADE, and Graindrive beside it; one thread."""
    package = (
        Path(sys.modules[__package__.partition(".")[0]].__path__[-1]).absolute().parent
    )  # where the compiled part is
    path = os.pathsep.join([modules_of(build), str(package)])
    return {**os.environ, "PYTHONPATH": path, "PYTHONNOUSERSITE": "1", "OMP_NUM_THREADS": "1"}


def end(program, rows_file):
    """Kill a program and what it has started, and remove the folder that YADE had made for itself."""
    os.killpg(program.pid, signal.SIGKILL)
    program.wait()
    with open(rows_file) as rows:
        made = [line for line in rows if line.startswith('{"folder"') and line.endswith("\n")]
    for line in made:
        shutil.rmtree(json.loads(line)["folder"], ignore_errors=True)


def read(rows_file):
    """Return the `Rows` of a run."""
    found = []
    with open(rows_file) as lines:
        for line in lines:
            if line.startswith('{"steps"'):  # YADE prints lines of its own too
                found.append(json.loads(line))
    steps = np.array([row["steps"] for row in found])
    return Rows(steps, [row["place"] for row in found], np.array([row["velocity"] for row in found]))
