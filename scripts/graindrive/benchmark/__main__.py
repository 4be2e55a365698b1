"""Times GrainLoop against LAMMPS, LIGGGHTS and YADE's loop, alternating, and prints median ratios.

usage: scripts/bench [--json] [--scene NAME] [--quick] [--threads N] [--kernel NAME] [--lammps COMMAND]

  --json        a list of {scene, law, precision, threads, kernel, peer, ours, theirs, ratio}, rates in particle-steps/s
  --scene NAME  one of bed10k magnus_dilute magnus_dense wiggle63k drum150; without it all of them, in that order
  --quick       bed10k only, short runs: about a minute once its bed is in the cache
  --threads N   largest number of threads (and of LAMMPS's ranks) to compare; 2 by default
  --kernel NAME instructions that GrainLoop runs on: avx512, avx2 or portable; by default the best of this processor
  --lammps COMMAND  another LAMMPS than Debian's `lmp`, such as one built for this processor

One core: particle-steps per second of processor time, so that a busy machine does not count; several: of wall time. A scene
whose kinetic energies differ after 300 steps (LIGGGHTS: the first portion) gets no ratio.
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

from .. import engines
from . import lammps, liggghts
from .scenes import FREE, SCENES, scene, with_restitution

# Largest relative difference of kinetic energy then, by law. Hertz: the same arithmetic from the same
# state, and LAMMPS's first slip of moving starts (1e-6). Drum: LAMMPS damps by m_eff gamma and lets springs slip otherwise:
# alike, not equal. Restitution: without
# friction 1e-14; with it LIGGGHTS takes half an overlap off the friction's lever and cuts springs alone at the bound, 4e-5.
SAME = {"hertzHistory": 1e-5, "springDashpot": 0.05, "hertzRestitution": 1e-3}
YADE_SHARE = 100  # YADE's loop gets a hundredth of the steps


class Ours:
    """A scene in a process of its own, on GrainLoop ("grain") or on YADE's loop ("yade")."""

    def __init__(self, path, which, **settings):
        command = [sys.executable, "-m", "graindrive.benchmark.ours", path, which, json.dumps(settings)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def run(self, steps):
        """Go on by some steps; return what the worker says."""
        self.process.stdin.write(f"{steps}\n")
        self.process.stdin.flush()
        for line in self.process.stdout:
            if line.startswith("{"):
                return json.loads(line)
        raise RuntimeError("the worker that runs GrainLoop or YADE's loop died; its words are above")

    def close(self):
        self.process.kill()  # nothing is lost: it only answers
        self.process.wait()


def rate(result, particles, steps, threads):
    """Return particle-steps per second: of processor time on one core, of wall time on several."""
    return particles * steps / result["cpu" if threads == 1 else "wall"]


def differs(ours, theirs, tolerance):
    """Return why two kinetic energies are not of the same scene, or None."""
    difference = abs(ours - theirs) / max(abs(theirs), 1e-300)
    return (
        None
        if difference <= tolerance
        else f"kinetic energies {ours:.10g} and {theirs:.10g} differ by {difference:.1e}"
    )


def row(name, a_scene, threads, kernel, peer, ours, theirs, precision="double"):
    """Return one line of the table from lists of rates taken alternately; `kernel` is what a worker said of itself."""
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


def against(peer_name, run_peer, name, a_scene, path, threads, rounds, steps, compared=300):
    """Return the row against a peer, run by `run_peer(steps)`; None, with the reason on standard error, if it differs.

    Energies are compared after `compared` steps: chaos parts round-off of dense flows soon after 300, and LIGGGHTS's first
    steps, in which the bed takes up another law, differ by more than those after them.
    """
    ours, theirs, particles = [], [], len(a_scene["x"])
    worker = Ours(path, "grain", threads=threads)
    try:
        peer, own = run_peer(compared), worker.run(compared - 1)  # beginning on the step was the first
        reason = differs(own["energy"], peer["energy"], SAME[str(a_scene["law"])])
        if reason:
            print(f"{name}: no ratio against {peer_name}: {reason}", file=sys.stderr)
            return None
        for _ in range(rounds):
            theirs.append(rate(run_peer(steps), particles, steps, threads))
            ours.append(rate(worker.run(steps), particles, steps, threads))
    finally:
        worker.close()
    against_whom = peer_name if threads == 1 else f"{peer_name}, {threads} ranks"
    return row(name, a_scene, threads, own["processor"], against_whom, ours, theirs)


def against_lammps(name, a_scene, path, folder, threads, rounds, steps):
    """Yield the rows against LAMMPS on as many ranks as threads."""
    if not lammps.available():
        print("LAMMPS is not installed (Debian's package lammps); no ratio against it", file=sys.stderr)
        return
    lammps.write(a_scene, folder)
    for n in range(1, threads + 1):
        run_peer = functools.partial(lammps.run, a_scene, folder, ranks=n)
        yield against("LAMMPS", run_peer, name, a_scene, path, n, rounds, steps)


def against_liggghts(name, a_scene, folder, rounds, steps):
    """Yield the row of the same bed under the law that LIGGGHTS has."""
    if not liggghts.available():
        print("LIGGGHTS is not installed (Debian's package liggghts); no ratio against it", file=sys.stderr)
        return
    twin = with_restitution(a_scene)
    path = save(twin, folder, "restitution.npz")
    liggghts.write(twin, folder)
    yield against("LIGGGHTS", functools.partial(liggghts.run, twin, folder), name, twin, path, 1, rounds, steps, steps)


def against_yade(name, a_scene, path, rounds, steps):
    """Return the row against YADE's own loop on one core."""
    few = max(10, steps // YADE_SHARE)
    twin, own, peer = Ours(path, "grain", onStep=False), Ours(path, "grain", onStep=False), Ours(path, "yade")
    ours, theirs, particles = [], [], len(a_scene["x"])
    try:
        for k in range(rounds):
            slow, fast = peer.run(few), own.run(steps)
            reason = differs(twin.run(few)["half_step"], slow["half_step"], SAME["hertzHistory"]) if k == 0 else None
            if reason:
                print(f"{name}: no ratio against YADE's loop: {reason}", file=sys.stderr)
                return None
            ours.append(rate(fast, particles, steps, 1))
            theirs.append(rate(slow, particles, few, 1))
    finally:
        for worker in (twin, own, peer):
            worker.close()
    return row(name, a_scene, 1, fast["processor"], "YADE's loop", ours, theirs)


def against_ourselves(name, a_scene, path, rounds, steps, peer, precision="double", **settings):
    """Return the row of GrainLoop with other `settings` against GrainLoop as it is."""
    other, plain = Ours(path, "grain", precision=precision, **settings), Ours(path, "grain")
    particles = len(a_scene["x"])
    try:
        answers = [(other.run(steps), plain.run(steps)) for _ in range(rounds)]
    finally:
        other.close(), plain.close()
    ours, theirs = ([rate(answer, particles, steps, 1) for answer in side] for side in zip(*answers))
    return row(name, a_scene, 1, answers[0][0]["processor"], peer, ours, theirs, precision=precision)


def against_small_bed(name, a_scene, path, rounds, steps, folder):
    """Return the row of the large bed against our own rate on bed10k."""
    small = scene("bed10k")
    small_path = save(small, folder, "small.npz")
    large, little = Ours(path, "grain"), Ours(small_path, "grain")
    try:
        answers = [(large.run(steps), little.run(6 * steps)) for _ in range(rounds)]
    finally:
        large.close(), little.close()
    ours = [rate(answer, len(a_scene["x"]), steps, 1) for answer, _ in answers]
    theirs = [rate(answer, len(small["x"]), 6 * steps, 1) for _, answer in answers]
    return row(name, a_scene, 1, answers[0][0]["processor"], "own bed10k", ours, theirs)


def save(a_scene, folder, file_name):
    """Write a scene for a worker; return the path."""
    path = os.path.join(folder, file_name)
    np.savez(path, **a_scene)
    return path


def measure(name, quick, threads):
    """Yield the rows of one scene."""
    a_scene = scene(name)
    rounds, steps = (3, 1000) if quick else (5, 3000)
    if np.sum(a_scene["kind"] == FREE) > 20_000:
        steps //= 3
    with tempfile.TemporaryDirectory(prefix="graindrive-bench-") as folder:
        path = save(a_scene, folder, "scene.npz")
        yield from against_lammps(name, a_scene, path, folder, threads, rounds, steps)
        if name == "bed10k":
            yield from against_liggghts(name, a_scene, folder, rounds, steps)
            yield against_ourselves(name, a_scene, path, rounds, 2 * steps, "own double", precision="single")
            yield against_yade(name, a_scene, path, 3, 2 * steps)
        if name == "magnus_dilute":  # forces by angle sampled at every step
            yield against_ourselves(name, a_scene, path, 3 * rounds, steps, "own, not binned", binned=True)
        if name == "wiggle63k":
            yield against_small_bed(name, a_scene, path, rounds, steps, folder)


def print_row(entry):
    """Print one line of the table."""
    columns = (
        "{scene:14} {law:16} {precision:7} {threads:7d} {kernel:8} {peer:16} {ours:8.1f} {theirs:8.2f} {ratio:7.2f}"
    )
    print(columns.format(**{**entry, "ours": entry["ours"] / 1e6, "theirs": entry["theirs"] / 1e6}), flush=True)


def main(arguments=None):
    """Entry of scripts/bench; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="scripts/bench", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--scene", choices=sorted(SCENES))
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
    names = [chosen.scene] if chosen.scene else ["bed10k"] if chosen.quick else list(SCENES)
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
