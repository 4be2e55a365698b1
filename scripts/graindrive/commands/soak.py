"""Tests whether GrainLoop's energy ledger closes over a day of model time, in a small scene with all features.

Some sixty soft, light disks of 0.1 m and 100 kg/m^2 under Hertz contacts with history and friction lie between flat walls,
under gravity and a lid that presses with a force; a clump of three beads is shaken sideways among them and moves freely up and
down. The time step is a thousandth of a second, a third of the critical one.

At every report ledger.csv gets a line: model time, the ledger's entries, and closure = |residual|/turnover, where the residual is
the energy that the entries do not explain, and the turnover the sum of all changes. The run fails if closure exceeds 1e-6. Drift
is the slope of the residual against the turnover in the second half. A checkpoint follows every report; after kill -9 the same
command continues from it, with the same bits as a run that was never stopped. summary.json is written at the end.
"""

import argparse
import csv
import json
import math
import sys
import time
from pathlib import Path

import numpy as np

from ..lazily import engines
from ..loops import grain_loop
from ..runs import progress
from ..scenes import scene
from ..base import signals, whole_files
from ..base.errors import Interrupted, UsageError
from ..scenes.material import HertzHistoryMaterial
from ..scenes.yade_march import YadeMarch

BOUND = 1e-6  # largest closure [-]
TIME_STEP = 1e-3  # [s]
DAY = 86400.0  # [s]
WIDTH, LID, SPACING = 1.2, 0.75, 0.1  # of the box [m]; of the grid that grains start on [m]
MATERIAL = HertzHistoryMaterial(3.2e6, 3.9e6, 8000.0, 8000.0, 0.3, 100.0)  # SI
COLUMNS = ("time", "closure", "residual", "turnover", "timeStep", "stored", "workOfBodies", "workOfWalls", "searches")
STORED = ("kineticTranslation", "kineticRotation", "elasticNormal", "elasticTangential", "potential")

# Scene ----------------------------------------------------------------------------------------------------------------


def build(seed=1):
    """Make the scene in YADE; return its GrainLoop."""
    from yade import O

    O.reset()
    O.dt = TIME_STEP
    scene.check_time_step(TIME_STEP, MATERIAL, 0.045, 0.3)
    add_grains(np.random.default_rng(seed))
    body = add_shaken_bar(WIDTH / 2, 0.35)
    drive = engines.OscillationDrive(body=body, amplitude=0.04, period=2.0, label="drive")
    binner = engines.ContactForceBinner(body=body, every=100, label="binner")
    scene.yade_loop(MATERIAL, 9.81, [binner, drive])
    loop = grain_loop.use_grain_loop(trackEnergy=True, largestOverlap=0.3, label="loop")
    for side, position in (("x_low", 0), ("x_high", WIDTH), ("y_low", 0)):
        loop.setWall(side, position=position)
    loop.setWall("y_high", position=LID, pressure=100, mass=5, damping=50, speedLimit=1)
    return loop


def add_grains(rng):
    """Put disks of 0.09 to 0.1 m on a square grid, except at the place of the bar."""
    grid = np.arange(SPACING / 2, WIDTH, SPACING), np.arange(SPACING / 2, LID - SPACING / 2, SPACING)
    x, y = (axis.ravel() for axis in np.meshgrid(*grid))
    free = (np.abs(x - WIDTH / 2) > 0.22) | (np.abs(y - 0.35) > 0.12)
    return scene.add_disks(x[free], y[free], rng.uniform(0.045, 0.05, free.sum()), MATERIAL.density)


def add_shaken_bar(x, y):
    """Add a rigid bar of three beads that does not turn and is free in y; return its id."""
    from yade import O
    from yade.minieigenHP import Vector3

    body, _ = O.bodies.appendClumped([scene.disk(x + dx, y, 0.06, MATERIAL.density) for dx in (-0.08, 0, 0.08)])
    state = O.bodies[body].state
    state.mass, state.inertia, state.blockedDOFs = 3.0, Vector3(1, 1, 1) * 0.03, "xzXYZ"
    return body


# Watch ----------------------------------------------------------------------------------------------------------------


def row_of(loop):
    """Return the present row of ledger.csv, in the order of COLUMNS."""
    from yade import O

    energy = loop.energy
    known = {**energy, "time": O.iter * O.dt, "stored": sum(energy[name] for name in STORED), "searches": loop.searches}
    return [known[name] for name in COLUMNS]


def rows_until(path, end):
    """Return the rows of ledger.csv up to the model time `end`, shape (n, columns); an incomplete line is left out."""
    with open(path, newline="") as file:
        lines = [line for line in csv.reader(file) if len(line) == len(COLUMNS)][1:]
    rows = np.array(lines, float).reshape(-1, len(COLUMNS))
    return rows[rows[:, 0] <= end * (1 + 1e-12)]


def rewrite(path, rows):
    """Replace ledger.csv by these rows, in one step (by a rename)."""
    with whole_files.written(path) as beside, open(beside, "w", newline="") as file:
        csv.writer(file).writerows([COLUMNS, *(map(repr, map(float, row)) for row in rows)])


def summary_of(rows, steps, grains, seconds):
    """Return a flat dict that summarises the ledger of the whole run; it never raises, `passed` holds the verdict."""
    table = dict(zip(COLUMNS, np.asarray(rows, float).T))
    late = table["time"] >= table["time"][-1] / 2
    slope = np.polyfit(table["turnover"][late], table["residual"][late], 1)[0] if late.sum() > 1 else math.nan
    worst = float(table["closure"].max())
    return dict(
        passed=bool(worst < BOUND and not abs(slope) >= BOUND),
        bound=BOUND,
        model_time_s=float(table["time"][-1]),
        steps=steps,
        n_grains=grains,
        dt=TIME_STEP,
        closure_worst=worst,
        closure_first=float(table["closure"][0]),
        closure_last=float(table["closure"][-1]),
        residual_J=float(table["residual"][-1]),
        turnover_J=float(table["turnover"][-1]),
        drift=float(slope),
        time_step_over_turnover=float(table["timeStep"][-1] / table["turnover"][-1]),
        stored_first_J=float(table["stored"][0]),
        stored_last_J=float(table["stored"][-1]),
        wall_s=seconds,
        particle_steps_per_second=steps * grains / seconds if seconds > 0 else math.nan,
    )


# Run ------------------------------------------------------------------------------------------------------------------


def soak(out, steps, block, on_report=None):
    """Run up to `steps` steps in the folder `out`, or continue from its checkpoint; return the summary."""
    from yade import O

    ledger, checkpoint, loop = out / "ledger.csv", out / "scene.checkpoint", build()
    rows = []
    if checkpoint.exists():
        loop.restore(str(checkpoint))
        rows = rows_until(ledger, O.iter * O.dt).tolist()
        print(f"going on from step {O.iter}", file=sys.stderr)
    rewrite(ledger, rows)
    first = O.iter

    def report(_):
        rows.append(row_of(loop))
        with signals.deferred():
            with open(ledger, "a", newline="") as file:
                csv.writer(file).writerow(map(repr, map(float, rows[-1])))
            loop.checkpoint(str(checkpoint))
        if on_report is not None:
            on_report(rows)
        if not rows[-1][1] < BOUND:
            raise RuntimeError(
                f"step {O.iter}: the ledger's residual is {rows[-1][1]:.3g} of the turnover, over {BOUND:g}"
            )

    timing = progress.run_blocks(YadeMarch(len(loop.ids)), max(0, steps - first), block, report, label="soaking")
    if not rows:
        raise UsageError(f"steps={steps} is less than one report of {block} steps; give more steps, or shorter reports")
    return dict(summary_of(rows, O.iter, len(loop.ids), timing.seconds), steps_before=first)


def write_summary(out, summary):
    """Write summary.json whole or not at all."""
    whole_files.write_text(out / "summary.json", json.dumps(summary, indent=1) + "\n")


def parser():
    """Return the parser of scripts/soak."""
    made = argparse.ArgumentParser(
        prog="scripts/soak", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    made.add_argument("--out", type=Path, default=Path("soak"), help="folder of this run (default: soak)")
    made.add_argument("--hours", type=float, default=DAY / 3600, help="model time [h] (default: 24)")
    made.add_argument("--report", type=float, default=60.0, help="model time between two reports [s] (default: 60)")
    return made


def main(arguments=None):
    """Entry of scripts/soak; returns the exit status."""
    chosen = parser().parse_args(arguments)
    steps, block = round(chosen.hours * 3600 / TIME_STEP), round(chosen.report / TIME_STEP)
    if steps < 1 or block < 1:
        parser().error(f"--hours and --report must be positive, got {chosen.hours:g} h and {chosen.report:g} s")
    chosen.out.mkdir(parents=True, exist_ok=True)
    start = time.strftime("%F %T")
    try:
        with signals.handled():
            summary = soak(chosen.out, steps, block)
    except (UsageError, Interrupted, RuntimeError) as error:
        print(f"scripts/soak: {error}", file=sys.stderr)
        return getattr(error, "exit_code", 1)
    write_summary(chosen.out, dict(summary, started=start))
    print(json.dumps(summary, indent=1))
    return 0 if summary["passed"] else 1


if __name__ == "__main__":
    sys.exit(main())
