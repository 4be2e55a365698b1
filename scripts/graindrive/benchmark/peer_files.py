"""What LAMMPS and LIGGGHTS have in common: the data file, a run in a folder, and what its log says."""

import re
import resource
import subprocess
from pathlib import Path

import numpy as np

# What follows the settings of either peer: gravity, the plane, and the energies that its log is asked for.
STEPS = """pair_coeff * *
timestep {dt}
fix weight free gravity {gravity} vector 0 -1 0
fix plane all enforce2d
compute slide free ke
compute turn free erotate/sphere
thermo {thermo}
thermo_style custom step c_slide c_turn
thermo_modify lost error norm no format float %.15g
run {steps}
"""


def skin(a_scene):
    """Return the neighbour lists' skin: a tenth of a median diameter."""
    return 0.1 * 2 * float(np.median(a_scene["r"]))


def write_data(a_scene, folder, size_of):
    """Write scene.data; `size_of(i)` gives diameter and density of disk i in the columns of the peer's atom style."""
    kind, r, period = a_scene["kind"], a_scene["r"], float(a_scene["period"])
    margin = 20 * r.max()
    low, high = a_scene["y"].min() - margin, a_scene["y"].max() + margin
    left, right = (0, period) if period > 0 else (a_scene["x"].min() - margin, a_scene["x"].max() + margin)
    x = a_scene["x"] % period if period > 0 else a_scene["x"]
    lines = [
        f"scene\n\n{len(r)} atoms\n3 atom types\n\n{left:.17g} {right:.17g} xlo xhi\n{low:.17g} {high:.17g} ylo yhi"
    ]
    lines.append("-0.5 0.5 zlo zhi\n\nAtoms\n")
    lines += [f"{i + 1} {kind[i] + 1} {size_of(i)} {x[i]:.17g} {a_scene['y'][i]:.17g} 0" for i in range(len(r))]
    lines.append("\nVelocities\n")
    v = a_scene["vx"], a_scene["vy"], a_scene["spin"]
    lines += [f"{i + 1} {v[0][i]:.17g} {v[1][i]:.17g} 0 0 0 {v[2][i]:.17g}" for i in range(len(r))]
    (Path(folder) / "scene.data").write_text("\n".join(lines) + "\n")


def run(command, a_scene, settings, steps, folder, name):
    """Run an input of `settings` and STEPS; return wall and processor time [s], and the last two energies, slide and turn."""
    log, processor_time = run_once(command, a_scene, settings, steps, folder, name)
    wall = float(re.search(r"Loop time of (\S+)", log)[1])
    share = re.search(r"([\d.]+)% CPU use", log)
    if share:
        cpu = wall * float(share[1]) / 100
    else:  # LIGGGHTS does not say: what a run of no steps takes is its set-up
        cpu = processor_time - run_once(command, a_scene, settings, 0, folder, name)[1]
    rows = [line.split() for line in log[: log.index("Loop time")].splitlines() if re.match(r"\s*\d+\s", line)]
    _, slide, turn = map(float, rows[-1])
    return dict(wall=wall, cpu=cpu, slide=slide, turn=turn)


def run_once(command, a_scene, settings, steps, folder, name):
    """Run the input; return the log and the processor time of the whole program [s]."""
    last = STEPS.format(dt=float(a_scene["dt"]), gravity=float(a_scene["gravity"]), steps=steps, thermo=max(steps, 1))
    (Path(folder) / "scene.in").write_text(settings + last)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [*command, "-in", "scene.in", "-log", "scene.log", "-screen", "none"],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    log = (Path(folder) / "scene.log").read_text()
    if done.returncode or "Loop time" not in log:
        said = (done.stderr or log).strip().splitlines()[-1:]
        raise RuntimeError(f"{name} failed: {said}; its input is {folder}/scene.in")
    return log, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
