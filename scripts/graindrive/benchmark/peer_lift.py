"""Compares drag and lift of the lift study with LIGGGHTS's: the same bed at rest, carried past the same cylinder.

usage: scripts/compare_lift [key=value …] [--seeds 1 2 3] [--out DIR]

  key=value    keys of the lift study, such as scale=demo lid_density=20 (its demo by default); frame=cylinder is set
  --seeds      the packings that are compared, 1 by default
  --out DIR    where LIGGGHTS's input and forces.json, the numbers, are left; a folder that is removed by default

Both start from the bed at rest without its tangential springs, which LIGGGHTS cannot be given, and run one after the other on
one core. Printed are means over the travel in which both are steady, with standard errors, and what the difference is over
the combined error. The packings' mean has the larger of the runs' own error and the scatter of the packings.
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from .. import command_line, scene, study
from ..errors import UsageError
from ..postproc.lift import forces
from ..postproc.measured import Measured, mean_of
from ..postproc.statistics import block_mean
from . import liggghts_lift as peer

EVERY = 10  # steps between two samples


# ---- one scene in both codes -----------------------------------------------------------------------------------------


def without_springs(_bed, found):
    """Return a bed at rest without its tangential springs, for `build` of the study."""
    return {**found, "springs": [], "wall_springs": []}


def theirs(lift, p, stage, material, steps, every, folder):
    """Return LIGGGHTS's forces on cylinder and base every so many steps, without those of the start, (n, 6)."""
    given = lift.GRAVITY, p.bulk_gravity, p.cylinder_diameter * lift.D
    found, _ = peer.dragged(stage, material, *given, steps, every, folder)
    return np.stack([found[name] for name in peer.COLUMNS], axis=1)[1:]


def ours(steps, every, block):
    """Return GrainLoop's forces on cylinder and base, (steps/block, 6): means over blocks of samples `every` so many steps.

    Velocities begin on the step, as LIGGGHTS's.
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
    """Return (our means, theirs, seconds of ours, of theirs): drag and lift [N] as `Mean`s, dicts, in the same window."""
    body = lift.body_of(p)
    stage = lift.build(p, body, lift.time_step(p), without_springs)
    per_d = lift.D / (p.speed * lift.time_step(p))
    block = max(1, round(lift.BLOCK_TRAVEL * per_d / EVERY)) * EVERY
    steps = int(p.way * per_d) // block * block
    start = time.monotonic()
    other = theirs(lift, p, stage, lift.material(p), steps, EVERY, folder)
    between = time.monotonic()
    own = ours(steps, EVERY, block)
    seconds = time.monotonic() - between, between - start
    other = other.reshape(len(own), -1, len(peer.COLUMNS)).mean(axis=1)
    return *means((own, other), block / per_d, forces.PAPERS_TRANSIENT * body.height / lift.D), *seconds


def means(found, block, transient):
    """Return drag and lift as `Mean`s of each of `found` (n, 6), from where all are steady; `block` and `transient` in d."""
    travel = np.arange(1, len(found[0]) + 1) * block
    series = [dict(travel=travel, fx=rows[:, 0], fz=rows[:, 2]) for rows in found]
    first = max(forces.steady_window(one, transient)[0].start for one in series)
    return [dict(drag=block_mean(-one["fx"][first:]), lift=block_mean(one["fz"][first:])) for one in series]


# ---- several packings ------------------------------------------------------------------------------------------------


def over_packings(found):
    """Return the mean of `Mean`s of several packings as `Measured`."""
    return mean_of([Measured(mean.value, mean.error) for mean in found])


def line(seed, name, own, other):
    """Return a row of the table as text."""
    apart = abs(own.value - other.value) / np.hypot(own.error, other.error)
    return f"{seed:>6} {name:>5} {own.value:10.4g} ± {own.error:8.2g} {other.value:10.4g} ± {other.error:8.2g} {apart:7.2f}"


def compare(lift, parameters, seeds, folder):
    """Run both codes for each seed; print a line for each force, and return the rows for forces.json."""
    found, rows = [], []
    print("  seed force     GrainLoop [N]         LIGGGHTS [N]      apart [combined errors]")
    for seed in seeds:
        place = Path(folder) / f"seed-{seed}"
        place.mkdir(parents=True, exist_ok=True)
        own, other, *seconds = both(lift, parameters.copy(update=dict(seed=seed)), place)
        found.append((own, other))
        rows += [row_of(seed, name, own[name], other[name], seconds) for name in own]
        print(*(line(seed, name, own[name], other[name]) for name in own), sep="\n", flush=True)
    for name in ("drag", "lift"):
        own, other = (over_packings([pair[side][name] for pair in found]) for side in (0, 1))
        rows.append(row_of("all", name, own, other, [None, None]))
        print(line("all", name, own, other))
    return rows


def row_of(seed, name, own, other, seconds):
    """Return what forces.json keeps of a comparison [N, s]."""
    values = dict(own=own.value, own_err=own.error, liggghts=other.value, liggghts_err=other.error)
    return dict(seed=seed, force=name, **values, own_s=seconds[0], liggghts_s=seconds[1])


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
        folder = Path(given.out or scratch)
        rows = compare(lift, p, given.seeds, folder)
        (folder / "forces.json").write_text(json.dumps(dict(parameters=given.keys, rows=rows), indent=1) + "\n")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except UsageError as error:
        print(f"compare_lift: error: {error}", file=sys.stderr)
        sys.exit(UsageError.exit_code)
