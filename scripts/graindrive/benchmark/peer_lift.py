"""Compares drag and lift of the lift study with LIGGGHTS: the same bed, initially at rest, moves past the same cylinder.

usage: scripts/compare_lift [key=value …] [--seeds 1 2 3] [--out DIR]

  key=value    keys of the lift study, such as scale=demo lid_density=20 (its demo by default); frame=cylinder is set
  --seeds      seeds of the packings to compare, 1 by default
  --out DIR    folder for LIGGGHTS's input, forces.json, the numbers, and report.md, for `scripts/results DIR`; by default a
               temporary folder

Both start from the bed at rest without its tangential springs, which LIGGGHTS cannot be given, and run one after the other on
one core. The output holds means over the travel in which both are steady, with standard errors, and the difference over the
combined error. The error of the mean over packings is the larger of the runs' own error and the scatter of the packings.
"""

import argparse
import json
import resource
import sys
import tempfile
from pathlib import Path

import numpy as np

from ..commands import command_line
from ..scenes import scene
from .. import study
from ..base.errors import UsageError
from ..base.numbers import with_error
from ..base.whole_files import write_text
from ..postproc.lift import forces
from ..postproc.measured import Measured, mean_of
from ..postproc.statistics import block_mean
from . import liggghts_lift as peer

EVERY = 10  # steps between two samples
SIGMAS = 2  # number of combined errors up to which means count as equal


# ---- one scene in both codes -----------------------------------------------------------------------------------------


def without_springs(_bed, found):
    """Return a bed at rest without its tangential springs, for `build` of the study."""
    return {**found, "springs": [], "wall_springs": []}


def theirs(lift, p, stage, material, steps, every, folder):
    """Return LIGGGHTS's forces on cylinder and base at intervals, without the initial ones, (n, 6)."""
    given = lift.GRAVITY, p.bulk_gravity, p.cylinder_diameter * lift.D
    found, _ = peer.dragged(stage, material, *given, steps, every, folder)
    return np.stack([found[name] for name in peer.COLUMNS], axis=1)[1:]


def ours(steps, every, block):
    """Return GrainLoop's forces on cylinder and base, (steps/block, 6): means over blocks of samples.

    `every` is the number of steps between samples. Initial velocities belong to the time of the positions, as in LIGGGHTS.
    """
    from yade import O

    scene.fast_loop().beginOnStep()
    binners = [O.labeledEngine(name) for name in ("binner", "base_binner")]
    rows = []
    for binner in binners:
        binner.every = every
    for _ in range(steps // block):
        O.run(block, True)
        rows.append([*binners[0].force, *binners[1].force])
        for binner in binners:
            binner.clear()
    return np.array(rows)


def both(lift, p, folder):
    """Return (our means, theirs, processor time [s] of ours, of theirs): drag and lift [N] as `Mean`s, in the same window."""
    body = lift.body_of(p)
    stage = lift.build(p, body, lift.time_step(p), without_springs)
    per_d = lift.D / (p.speed * lift.time_step(p))
    block = max(1, round(lift.BLOCK_TRAVEL * per_d / EVERY)) * EVERY
    steps = int(p.way * per_d) // block * block
    start = processor_time()
    other = theirs(lift, p, stage, lift.material(p), steps, EVERY, folder)
    own = ours(steps, EVERY, block)
    seconds = processor_time() - start
    other = other.reshape(len(own), -1, len(peer.COLUMNS)).mean(axis=1)
    return *means((own, other), block / per_d, forces.PAPERS_TRANSIENT * body.height / lift.D), *seconds


def processor_time():
    """Return the processor time [s] of this process and of programs that it has run, (2,)."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return np.array([one.ru_utime + one.ru_stime for one in used])


def means(found, block, transient):
    """Return drag and lift as `Mean`s of each of `found` (n, 6), from where all are steady; `block` and `transient` in d."""
    travel = np.arange(1, len(found[0]) + 1) * block
    series = [dict(travel=travel, fx=rows[:, 0], fz=rows[:, 2]) for rows in found]
    first = max(forces.steady_window(one, transient)[0].start for one in series)
    return [dict(drag=block_mean(-one["fx"][first:]), lift=block_mean(one["fz"][first:])) for one in series]


# ---- several packings ------------------------------------------------------------------------------------------------


def apart(own, other):
    """Return the difference of two numbers with errors over their combined error."""
    return abs(own.value - other.value) / np.hypot(own.error, other.error)


def line(seed, name, own, other):
    """Return a row of the table as text."""
    numbers = " ".join(f"{with_error(force.value, force.error):>22}" for force in (own, other))
    return f"{seed:>6} {name:>5} {numbers} {apart(own, other):7.2f}"


def compare(lift, parameters, seeds, folder, keys):
    """Run both codes for each seed; print a line for each force, and leave forces.json and report.md after each seed."""
    rows = []
    print("  seed force          GrainLoop [N]           LIGGGHTS [N]  apart [combined errors]")
    for seed in seeds:
        place = Path(folder) / f"seed-{seed}"
        place.mkdir(parents=True, exist_ok=True)
        own, other, *seconds = both(lift, parameters.copy(update=dict(seed=seed)), place)
        rows += [row_of(seed, name, own[name], other[name], seconds) for name in own]
        print(*(line(seed, name, own[name], other[name]) for name in own), sep="\n", flush=True)
        told = rows + over_packings(rows)
        write_text(Path(folder) / "forces.json", json.dumps(dict(keys=keys, rows=told), indent=1) + "\n")
        write_text(Path(folder) / "report.md", report(Path(folder).name, keys, told))
    for row in over_packings(rows):
        print(line(row["seed"], row["force"], *measured(row)))


def row_of(seed, name, own, other, seconds):
    """Return the entry of a comparison in forces.json [N, s]."""
    values = dict(own=own.value, own_err=own.error, liggghts=other.value, liggghts_err=other.error)
    return dict(seed=seed, force=name, **values, own_s=seconds[0], liggghts_s=seconds[1])


def measured(row):
    """Return both codes' forces of a row as `Measured`."""
    return [Measured(row[name], row[f"{name}_err"]) for name in ("own", "liggghts")]


def over_packings(rows):
    """Return the rows of the means over all seeds, with the larger of the runs' own errors and those by scatter."""
    found = []
    for force in ("drag", "lift"):
        pairs = [measured(row) for row in rows if row["force"] == force]
        seconds = [sum(row[name] for row in rows if row["force"] == force) for name in ("own_s", "liggghts_s")]
        found.append(row_of("all", force, *(mean_of([pair[side] for pair in pairs]) for side in (0, 1)), seconds))
    return found


def report(name, keys, rows):
    """Return the Markdown of a comparison: its command, and a table with a verdict for the means over all seeds."""
    seeds = [row["seed"] for row in rows if row["force"] == "drag" and row["seed"] != "all"]
    seconds = next([row["own_s"], row["liggghts_s"]] for row in rows if row["seed"] == "all")
    command = " ".join(["scripts/compare_lift", *keys, "--seeds", *map(str, seeds), "--out", name])
    lines = [
        f"## Lift: the same beds in LIGGGHTS (`{name}`)",
        "",
        f"Repeat: `{command}`; {seconds[0]:.0f} s of processor time of GrainLoop and {seconds[1]:.0f} s of"
        f" LIGGGHTS. Means are the same if they lie within {SIGMAS} combined errors.",
        "",
        "| seed | force | GrainLoop [N] | LIGGGHTS [N] | apart, combined errors | verdict |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        own, other = measured(row)
        verdict = "" if row["seed"] != "all" else "**the same**" if apart(own, other) <= SIGMAS else "**not the same**"
        lines.append(f"| {row['seed']} | {row['force']} | {own} | {other} | {apart(own, other):.2f} | {verdict} |")
    return "\n".join(lines) + "\n"


def main(arguments):
    """Carry out the command line."""
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0], add_help=False)
    parser.add_argument("keys", nargs="*")
    parser.add_argument("--seeds", nargs="+", type=int, default=[1])
    parser.add_argument("--out")
    if {"-h", "--help", "help"} & set(arguments):
        print(__doc__)
        return 0
    given = parser.parse_args(arguments)
    if peer.available() is None:
        raise UsageError("LIGGGHTS is not installed; scripts/setup installs it, or apt-get install liggghts")
    made = study.loaded(study.house()["lift"])
    lift = sys.modules[made.run.__module__]
    p = command_line.parse(made, ["frame=cylinder", "fields=0", *given.keys])
    if p.shape != "cylinder" or p.frame != "cylinder" or p.loop != "grain":
        raise UsageError("only shape=cylinder, frame=cylinder and loop=grain are compared; leave these keys out")
    made.check(p)
    with tempfile.TemporaryDirectory() as scratch:
        compare(lift, p, given.seeds, given.out or scratch, given.keys)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except UsageError as error:
        print(f"compare_lift: error: {error}", file=sys.stderr)
        sys.exit(UsageError.exit_code)
