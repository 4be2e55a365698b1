"""Common parts for LAMMPS and LIGGGHTS: the data file, a run in a folder, and reading its log."""

import math
import re
import resource
import subprocess
from pathlib import Path

import numpy as np

from . import layout

# What follows the settings of either peer: gravity, the plane of disks, and the energies that its log is asked for.
STEPS = """timestep {dt}
fix weight free gravity {weight} vector {down}
{plane}
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


def boundary(a_scene):
    """Return the peers' words for the box's sides: p periodic, f fixed; disks lie in a plane that is periodic along z."""
    sides = ["p" if period else "f" for period in layout.periods(a_scene)]
    return " ".join(sides if layout.in_space(a_scene) else [*sides[:2], "p"])


def box(a_scene):
    """Return low and high ends of the box along x, y and z: a period, or far beyond all grains; disks have z = -0.5 to 0.5."""
    margin = 20 * a_scene["r"].max()
    ends = []
    for period, x in zip(layout.periods(a_scene), layout.places(a_scene).T):
        ends.append((0.0, period) if period else (x.min() - margin, x.max() + margin))
    return ends if layout.in_space(a_scene) else [*ends[:2], (-0.5, 0.5)]


def write_data(a_scene, folder, size_of):
    """Write scene.data; `size_of(i)` gives diameter and density of grain i in the columns of the peer's atom style."""
    place = layout.places(a_scene)
    for axis, period in enumerate(layout.periods(a_scene)):
        if period:
            place[:, axis] %= period
    lines = [f"scene\n\n{len(place)} atoms\n3 atom types\n"]
    lines += [f"{low:.17g} {high:.17g} {axis}lo {axis}hi" for (low, high), axis in zip(box(a_scene), "xyz")]
    kind = a_scene["kind"]
    lines.append("\nAtoms\n")
    lines += [f"{i + 1} {kind[i] + 1} {size_of(i)} {words(at)}" for i, at in enumerate(place)]
    lines.append("\nVelocities\n")
    motion = np.hstack([layout.velocities(a_scene), layout.spins(a_scene)])
    lines += [f"{i + 1} {words(row)}" for i, row in enumerate(motion)]
    (Path(folder) / "scene.data").write_text("\n".join(lines) + "\n")


def words(numbers):
    """Return numbers to the last bit, with spaces between."""
    return " ".join(f"{number:.17g}" for number in numbers)


def last_lines(a_scene, steps):
    """Return STEPS for a scene."""
    gravity = layout.gravity(a_scene)
    weight = math.hypot(*gravity)
    return STEPS.format(
        dt=float(a_scene["dt"]),
        weight=f"{weight:.17g}",
        down=words(gravity) if weight else "0 -1 0",
        plane="" if layout.in_space(a_scene) else "fix plane all enforce2d",
        steps=steps,
        thermo=max(steps, 1),
    )


def run(command, a_scene, settings, steps, folder, name):
    """Run an input of `settings` and STEPS; return wall and processor time [s], and the last two energies, slide and turn."""
    log, processor_time = run_once(command, a_scene, settings, steps, folder, name)
    wall = float(re.search(r"Loop time of (\S+)", log)[1])
    share = re.search(r"([\d.]+)% CPU use", log)
    if share:
        cpu = wall * float(share[1]) / 100
    else:  # LIGGGHTS does not print it: a run without steps measures the set-up
        cpu = processor_time - run_once(command, a_scene, settings, 0, folder, name)[1]
    rows = [line.split() for line in log[: log.index("Loop time")].splitlines() if re.match(r"\s*\d+\s", line)]
    _, slide, turn = map(float, rows[-1])
    return dict(wall=wall, cpu=cpu, slide=slide, turn=turn)


def run_once(command, a_scene, settings, steps, folder, name):
    """Run the input; return the log and the processor time of the whole program [s]."""
    (Path(folder) / "scene.in").write_text(settings + last_lines(a_scene, steps))
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
