"""Times GrainLoop against LAMMPS, LIGGGHTS and YADE's loop, the continuum against interFoam, alternating; prints median ratios.

usage: scripts/bench [--json] [--scene NAME | --features] [--quick] [--threads N] [--kernel NAME] [--lammps COMMAND]

  --json        a list of {scene, law, precision, threads, kernel, peer, ours, theirs, ratio}, rates in particle-steps/s
  --scene NAME  one of bed10k magnus_dilute magnus_dense wiggle63k drum150 (disks), lift20k lift190k lift_flow (spheres),
                continuum drum_newtonian; without it all of them, in that order
  --features    cost of friction, gravity, walls, the ledger, measures, the third dimension, ... in one scene of GrainLoop: time
                per particle-step with each feature over that without it, median, lowest and highest of the rounds
  --quick       short runs of that scene, by default of bed10k: about a minute once it is in the cache,
                half as long again for lift190k
  --threads N   largest number of threads (and of LAMMPS's ranks) to compare; 2 by default
  --kernel NAME instruction set of GrainLoop: avx512, avx2 or portable; by default the best of this processor
  --lammps COMMAND  a LAMMPS other than Debian's `lmp`, for example one built for this processor

Spheres are those of the lift study: 20,000 and 190,000 settled, and the 20,000 flowing down 24 degrees. Their energies are
compared after 300 steps, with friction and without it, before a ratio is printed.

The continuum is the drum study's on 107^2 and 400^2 cells; its rates are cell-steps per second.
drum_newtonian is a half full drum of a Newtonian fluid beside OpenFOAM's interFoam (Debian's package openfoam, which
scripts/setup leaves to you: 0.4 GB): cell-steps per second on one grid, then costs at equal error of the velocity.

On one core, rates are particle-steps per second of processor time, so that a busy machine does not matter; on several cores, of
wall time. A scene whose kinetic energies differ after 300 steps (LIGGGHTS: after the first portion) gets no ratio.
"""

import argparse
import functools
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

import numpy as np

from ..lazily import engines
from ..study import house, loaded
from . import continuum, drum_newtonian, features, lammps, layout, liggghts
from .scenes import SCENES, scene, with_restitution

# Largest relative difference of kinetic energy then, by law. Hertz: the same arithmetic from the same
# state, and LAMMPS's first slip of moving starts (1e-6). Drum: LAMMPS damps by m_eff gamma and lets springs slip otherwise:
# alike, not equal. Restitution in the plane: without
# friction 1e-14; with it LIGGGHTS takes half an overlap off the friction's lever and cuts springs alone at the bound, 4e-5.
SAME = {"hertzHistory": 1e-5, "springDashpot": 0.05, "hertzRestitution": 1e-3}
# Spheres: LAMMPS's `granular` takes half an overlap off the torque's lever, LIGGGHTS off both levers, and deep beds overlap by
# several hundredths of a radius. What is left of a settled bed's energy then differs by 5e-3 (LAMMPS) and 2.5e-2 (LIGGGHTS);
# without friction by 1e-13. Hence two comparisons: with friction, and of the same scene without it. In the first step of a scene
# that moves LIGGGHTS differs by up to 3e-4 after the first steps, and no more later; why has not been found.
SAME_SPHERES, SAME_SMOOTH_SPHERES, SAME_SMOOTH_FLOW_IN_LIGGGHTS = 0.05, 1e-9, 1e-3
SAME_ON_YADES_LOOP = 1e-5  # the same law with the same formulas
WARM_UP = 10  # steps
FLOWS = (continuum.NAME, drum_newtonian.NAME)
OWN_SHARE = 6  # GrainLoop's portions of spheres have this many times the steps of the peer's; else they are too short to be timed
# with which O.run begins and ends, 0.3 s for 190,000 bodies
YADE_SHARE = 100  # YADE's loop runs a hundredth of the steps
COMPARED = 300  # steps after which energies are compared: soon after, chaos amplifies round-off in dense flows

# The codes with which each scene is compared.
PLAN = {
    "bed10k": ("lammps", "liggghts", "single", "yade"),
    "magnus_dilute": ("lammps", "binned"),
    "magnus_dense": ("lammps",),
    "wiggle63k": ("lammps", "bed10k"),
    "drum150": ("lammps",),
    "lift20k": ("liggghts", "lammps", "threads", "single", "yade"),
    "lift190k": ("liggghts", "threads", "lift20k"),
    "lift_flow": ("liggghts",),
}


class Ours:
    """A scene in a separate process, on GrainLoop ("grain") or on YADE's loop ("yade")."""

    def __init__(self, path, which, **settings):
        command = [sys.executable, "-m", "graindrive.benchmark.ours", path, which, json.dumps(settings)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def run(self, steps):
        """Run some steps; return the worker's answer."""
        self.process.stdin.write(f"{steps}\n")
        self.process.stdin.flush()
        for line in self.process.stdout:
            if line.startswith("{"):
                return json.loads(line)
        raise RuntimeError("the worker that runs GrainLoop or YADE's loop died; its messages are above")

    def warm_up(self):
        """Run the first steps, in which a loop reads its bodies."""
        self.run(WARM_UP)

    def close(self):
        self.process.kill()  # nothing is lost: it only answers
        self.process.wait()


def rate(result, particles, steps, threads):
    """Return particle-steps per second, of processor time on one core, of wall time on several cores."""
    return particles * steps / result["cpu" if threads == 1 else "wall"]


def differs(ours, theirs, tolerance):
    """Return why two kinetic energies do not agree, or None if they do."""
    difference = abs(ours - theirs) / max(abs(theirs), 1e-300)
    return (
        None
        if difference <= tolerance
        else f"kinetic energies {ours:.10g} and {theirs:.10g} differ by {difference:.1e}"
    )


def row(name, a_scene, threads, kernel, peer, ours, theirs, precision="double"):
    """Return one line of the table from lists of rates measured alternately; `kernel` is the worker's instruction set."""
    ratios = [a / b for a, b in zip(ours, theirs)]
    return dict(
        scene=name,
        law=str(a_scene["law"]),
        precision=precision,
        threads=threads,
        kernel=kernel,
        peer=peer,
        ours=statistics.median(ours),
        theirs=statistics.median(theirs),
        ratio=statistics.median(ratios),
    )


def tolerance(a_scene):
    """Return the largest allowed relative difference of kinetic energies, with friction."""
    return SAME_SPHERES if layout.in_space(a_scene) else SAME[str(a_scene["law"])]


def tolerance_when_smooth(peer_name, a_scene):
    """Return the same for spheres without friction."""
    starts_in_motion = layout.kinetic_energy(a_scene) > 0
    return SAME_SMOOTH_FLOW_IN_LIGGGHTS if peer_name == "LIGGGHTS" and starts_in_motion else SAME_SMOOTH_SPHERES


def differs_when_smooth(peer_name, run, a_scene, folder, threads, compared):
    """Return why a peer's result for a scene without friction differs from ours, or None if it does not."""
    smooth = dict(a_scene, friction=0.0)
    worker = Ours(save(smooth, folder, "smooth.npz"), "grain", threads=threads)
    try:
        own, peer = worker.run(compared - 1), run(smooth, compared)
    finally:
        worker.close()
    reason = differs(own["energy"], peer["energy"], tolerance_when_smooth(peer_name, a_scene))
    return reason and f"without friction {reason}"


def against(peer_name, run, name, a_scene, path, threads, rounds, steps, compared=COMPARED):
    """Return the row of the comparison with a peer; None, with the reason on stderr, if the results differ.

    `run(scene, steps)` runs the peer from the start of the scene, or of the same scene without friction. Energies are compared
    after `compared` steps.
    """
    ours, theirs, particles = [], [], len(a_scene["x"])
    own_steps = steps * (OWN_SHARE if layout.in_space(a_scene) else 1)
    worker = Ours(path, "grain", threads=threads)
    try:
        peer, own = run(a_scene, compared), worker.run(compared - 1)  # beginning on the step was the first
        reason = differs(own["energy"], peer["energy"], tolerance(a_scene))
        if reason is None and layout.in_space(a_scene):
            reason = differs_when_smooth(peer_name, run, a_scene, os.path.dirname(path), threads, compared)
        if reason:
            print(f"{name}: no ratio against {peer_name}: {reason}", file=sys.stderr)
            return None
        for _ in range(rounds):
            theirs.append(rate(run(a_scene, steps), particles, steps, threads))
            ours.append(rate(worker.run(own_steps), particles, own_steps, threads))
    finally:
        worker.close()
    against_whom = peer_name if threads == 1 else f"{peer_name}, {threads} ranks"
    return row(name, a_scene, threads, own["processor"], against_whom, ours, theirs)


def against_lammps(name, a_scene, path, folder, threads, rounds, steps):
    """Yield the rows of the comparison with LAMMPS on as many ranks as threads."""
    if not lammps.available():
        print("LAMMPS is not installed (Debian's package lammps); no ratio against it", file=sys.stderr)
        return
    lammps.write(a_scene, folder)
    for n in range(1, threads + 1):
        yield against(
            "LAMMPS", functools.partial(lammps.run, folder=folder, ranks=n), name, a_scene, path, n, rounds, steps
        )


def against_liggghts(name, a_scene, folder, rounds, steps):
    """Yield the row of the same bed with the law of LIGGGHTS.

    Energies of disks are compared after the first portion: in LIGGGHTS's first steps, while the bed adapts to another law, they
    differ by more than later.
    """
    if not liggghts.available():
        print("LIGGGHTS is not installed (Debian's package liggghts); no ratio against it", file=sys.stderr)
        return
    twin = a_scene if str(a_scene["law"]) == "hertzRestitution" else with_restitution(a_scene)
    path = save(twin, folder, "restitution.npz")
    liggghts.write(twin, folder)
    compared = min(COMPARED, 3 * steps) if layout.in_space(twin) else steps
    run = functools.partial(liggghts.run, folder=folder)
    yield against("LIGGGHTS", run, name, twin, path, 1, rounds, steps, compared)


def against_yade(name, a_scene, path, rounds, steps):
    """Return the row of the comparison with YADE's own loop on one core."""
    few = max(10, steps // YADE_SHARE)
    twin, own, peer = Ours(path, "grain", onStep=False), Ours(path, "grain", onStep=False), Ours(path, "yade")
    ours, theirs, particles = [], [], len(a_scene["x"])
    try:
        for k in range(rounds):
            slow, fast = peer.run(few), own.run(steps)
            reason = differs(twin.run(few)["half_step"], slow["half_step"], SAME_ON_YADES_LOOP) if k == 0 else None
            if reason:
                print(f"{name}: no ratio against YADE's loop: {reason}", file=sys.stderr)
                return None
            ours.append(rate(fast, particles, steps, 1))
            theirs.append(rate(slow, particles, few, 1))
    finally:
        for worker in (twin, own, peer):
            worker.close()
    return row(name, a_scene, 1, fast["processor"], "YADE's loop", ours, theirs)


def against_ourselves(name, a_scene, path, rounds, steps, peer, precision="double", threads=1, **settings):
    """Return the row of GrainLoop with other `settings` over GrainLoop without them; wall time on several threads."""
    other, plain = Ours(path, "grain", precision=precision, threads=threads, **settings), Ours(path, "grain")
    particles = len(a_scene["x"])
    try:
        other.warm_up(), plain.warm_up()
        answers = [(other.run(steps), plain.run(steps)) for _ in range(rounds)]
    finally:
        other.close(), plain.close()
    ours, theirs = ([rate(answer, particles, steps, threads) for answer in side] for side in zip(*answers))
    return row(name, a_scene, threads, answers[0][0]["processor"], peer, ours, theirs, precision=precision)


def against_small_bed(name, a_scene, path, rounds, steps, folder, small_name):
    """Return the row of a large bed over our own rate on a small bed, with as many particle-steps."""
    small = scene(small_name)
    small_path = save(small, folder, "small.npz")
    times = round(len(a_scene["x"]) / len(small["x"]))
    large, little = Ours(path, "grain"), Ours(small_path, "grain")
    try:
        large.warm_up(), little.warm_up()
        answers = [(large.run(steps), little.run(times * steps)) for _ in range(rounds)]
    finally:
        large.close(), little.close()
    ours = [rate(answer, len(a_scene["x"]), steps, 1) for answer, _ in answers]
    theirs = [rate(answer, len(small["x"]), times * steps, 1) for _, answer in answers]
    return row(name, a_scene, 1, answers[0][0]["processor"], f"own {small_name}", ours, theirs)


def save(a_scene, folder, file_name):
    """Write a scene for a worker; return the path."""
    path = os.path.join(folder, file_name)
    np.savez(path, **a_scene)
    return path


def portions(a_scene, quick):
    """Return the number of timed portions and the steps of each; expensive scenes get fewer.

    A peer's step of a sphere takes up to half a microsecond, and quick runs of spheres are mostly spent on comparing energies.
    """
    size = len(a_scene["x"])
    if layout.in_space(a_scene):
        many = size > 100_000
        return ((2, 50) if many else (3, 100)) if quick else (5, 300 if many else 1000)
    rounds, steps = (3, 1000) if quick else (5, 3000)
    return rounds, steps // (3 if size > 21_000 else 1)


def measure(name, quick, threads):
    """Yield the rows of one scene."""
    if name == continuum.NAME:
        yield from continuum.measure(loaded(house()["drum"]), quick)
        return
    if name == drum_newtonian.NAME:
        yield from drum_newtonian.measure(quick)
        return
    a_scene, plan = scene(name), PLAN[name]
    rounds, steps = portions(a_scene, quick)
    with tempfile.TemporaryDirectory(prefix="graindrive-bench-") as folder:
        path = save(a_scene, folder, "scene.npz")
        own = functools.partial(against_ourselves, name, a_scene, path)
        longer = steps * (OWN_SHARE if layout.in_space(a_scene) else 2)
        if "lammps" in plan:
            yield from against_lammps(name, a_scene, path, folder, threads, rounds, steps)
        if "liggghts" in plan:
            yield from against_liggghts(name, a_scene, folder, rounds, steps)
        if "threads" in plan and threads > 1:
            yield own(rounds, longer, "own 1 thread", threads=threads)
        if "single" in plan:
            yield own(rounds, longer, "own double", precision="single")
        if "yade" in plan:
            yield against_yade(name, a_scene, path, 3, longer)
        if "binned" in plan:  # forces by angle sampled at every step
            yield own(3 * rounds, steps, "own, not binned", binned=True)
        for small_name in set(plan) & set(SCENES):
            yield against_small_bed(name, a_scene, path, rounds, longer, folder, small_name)


def print_row(entry):
    """Print one line of the table."""
    columns = (
        "{scene:14} {law:16} {precision:7} {threads:7d} {kernel:8} {peer:16} {ours:8.1f} {theirs:8.2f} {ratio:7.2f}"
    )
    print(columns.format(**{**entry, "ours": entry["ours"] / 1e6, "theirs": entry["theirs"] / 1e6}), flush=True)


def print_features(quick, as_json):
    """Measure the cost of features; print it line by line or as JSON; return the exit status."""
    rounds, steps, rows = (3, 100, []) if quick else (9, 300, [])
    if not as_json:
        print(features.HEADING, flush=True)
    with tempfile.TemporaryDirectory(prefix="graindrive-bench-") as folder:
        start = functools.partial(Ours, which="grain")
        for found in features.measure(start, lambda a_scene, name: save(a_scene, folder, name), rounds, steps):
            rows.append(found)
            if not as_json:
                print(features.line(found), flush=True)
    if as_json:
        json.dump(rows, sys.stdout, indent=1)
        print()
    return 0


def main(arguments=None):
    """Entry of scripts/bench; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="scripts/bench", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--scene", choices=sorted([*SCENES, *FLOWS]))
    parser.add_argument("--features", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--kernel", choices=("avx512", "avx2", "portable"))
    parser.add_argument("--lammps", metavar="COMMAND")
    chosen = parser.parse_args(arguments)
    if chosen.threads < 1:
        parser.error(f"--threads must be at least 1, got {chosen.threads}")
    if chosen.kernel:
        if chosen.kernel not in engines.processors():
            parser.error(f"--kernel {chosen.kernel}: this processor runs {', '.join(engines.processors())} only")
        os.environ["GRAINDRIVE_PROCESSOR"] = chosen.kernel  # the workers inherit it
    if chosen.lammps:
        if not shutil.which(chosen.lammps):
            parser.error(f"--lammps {chosen.lammps}: no such program")
        lammps.command = os.path.abspath(shutil.which(chosen.lammps))
    if chosen.features:
        if chosen.scene:
            parser.error(f"--features has its own scene; leave --scene {chosen.scene} out")
        return print_features(chosen.quick, chosen.json)
    names = [chosen.scene] if chosen.scene else ["bed10k"] if chosen.quick else [*SCENES, *FLOWS]
    if not chosen.json:
        print(
            "scene          law              precis. threads kernel   peer             ours M/s   theirs   ratio",
            flush=True,
        )
    rows = []
    for name in names:
        for entry in measure(name, chosen.quick, chosen.threads):
            if entry is None:
                continue
            rows.append(entry)
            if not chosen.json:
                print_row(entry)
    if chosen.json:
        json.dump(rows, sys.stdout, indent=1)
        print()
    return 0 if rows else 1


if __name__ == "__main__":
    sys.exit(main())
