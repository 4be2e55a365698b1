"""The lift study's scene in LIGGGHTS, for comparison: the same bed at rest is carried past the same cylinder, which is held.

LIGGGHTS's cylinders cannot move along x, so the scene is the study's with frame=cylinder: base, lid and bed move along -x.
"""

import shutil
import subprocess
from pathlib import Path

import numpy as np

from ..scenes import scene

GRAINS, BASE, LID = 1, 2, 3  # atom types
AHEAD = 20  # largest radii of free height above and below all spheres

# The sum of all forces between spheres is zero. `push` keeps the forces as they are when the cylinder has acted and nothing
# else has, so their sum is the cylinder's. (LIGGGHTS's own store_force keeps those of contacts that have ended, too.)
INPUT = """
atom_style granular
atom_modify map array sort 1000 0
units si
newton off
soft_particles yes
communicate single vel yes
boundary p p f
read_data scene.data
neighbor {skin:.17g} bin
neigh_modify delay 0 every 1 check yes
group bed type 1
group base type 2
group lid type 3
group heavy type {heavy}
neigh_modify exclude group base base
fix young all property/global youngsModulus peratomtype {young}
fix poisson all property/global poissonsRatio peratomtype {poisson}
fix bounce all property/global coefficientRestitution peratomtypepair 3 {restitution}
fix rub all property/global coefficientFriction peratomtypepair 3 {friction}
pair_style gran model hertz tangential history
pair_coeff * *
timestep {dt:.17g}
fix cylinder all wall/gran model hertz tangential history primitive type 1 ycylinder {radius:.17g} {z:.17g} {x:.17g}
fix push all store/force
fix held base freeze
fix weight heavy gravity {gravity:.17g} vector 0 0 -1
fix upright lid setforce 0.0 0.0 NULL
fix move bed nve/sphere
fix lift lid nve
fix carry base nve/noforce
compute pushed all reduce sum f_push[1] f_push[2] f_push[3]
thermo {every}
thermo_style custom step c_pushed[1] c_pushed[2] c_pushed[3] f_held[1] f_held[2] f_held[3]
thermo_modify lost error norm no format float %.15g
dump end all custom {steps} end.txt id x y z
dump_modify end sort id format "%d %.17g %.17g %.17g"
run {steps}
"""
COLUMNS = ("fx", "fy", "fz", "base_fx", "base_fy", "base_fz")


def available():
    """Return LIGGGHTS's command, or None."""
    return shutil.which("liggghts")


def spheres_of(stage):
    """Return the spheres of a lift scene that YADE holds, before its first step: arrays type, r, density, x (n, 3), v (n, 3).

    `stage` is what the study's `build` returned. They stand in the order grains, lid, base.
    """
    from yade import O

    members = scene.members(stage["base"])
    ids = [*range(*stage["grains"]), *range(*stage["lid"]), *members]
    kinds = np.repeat([GRAINS, LID, BASE], [np.ptp(stage["grains"]), np.ptp(stage["lid"]), len(members)])
    bodies = [O.bodies[id_] for id_ in ids]
    carried = O.bodies[stage["base"]].state.vel
    velocity = [carried if kind == BASE else body.state.vel for kind, body in zip(kinds, bodies)]
    r = np.array([body.shape.radius for body in bodies])
    mass = np.array([body.state.mass for body in bodies])
    place = np.array([body.state.pos for body in bodies])
    return dict(type=kinds, r=r, density=mass / (4 / 3 * np.pi * r**3), x=place, v=np.array(velocity))


def write_data(spheres, period, folder):
    """Write scene.data; `period` holds those along x and y [m]."""
    place, margin = spheres["x"].copy(), AHEAD * spheres["r"].max()
    place[:, :2] %= period
    ends = [(0, period[0]), (0, period[1]), (place[:, 2].min() - margin, place[:, 2].max() + margin)]
    lines = [f"scene\n\n{len(place)} atoms\n3 atom types\n"]
    lines += [f"{low:.17g} {high:.17g} {axis}lo {axis}hi" for (low, high), axis in zip(ends, "xyz")]
    lines.append("\nAtoms\n")
    rows = np.c_[2 * spheres["r"], spheres["density"], place]
    lines += [f"{i} {kind} {words(row)}" for i, (kind, row) in enumerate(zip(spheres["type"], rows), 1)]
    lines.append("\nVelocities\n")
    lines += [f"{i} {words(row)} 0 0 0" for i, row in enumerate(spheres["v"], 1)]
    (Path(folder) / "scene.data").write_text("\n".join(lines) + "\n")


def words(numbers):
    """Return numbers to the last bit, with spaces between."""
    return " ".join(f"{number:.17g}" for number in numbers)


def dragged(stage, material, gravity, bulk_gravity, diameter, steps, every, folder):
    """Move the scene that YADE holds past the cylinder; return forces at intervals, and all positions at the end.

    Forces are those on the cylinder and on the base [N], a dict of `COLUMNS`, from the scene's start on; places (n, 3) [m]
    stand in the order of `spheres_of`. material is a `HertzRestitutionSpheres`, diameter that of the cylinder [m].
    RuntimeError with LIGGGHTS's output if it fails.
    """
    from yade import O

    spheres, centre = spheres_of(stage), O.bodies[stage["body"]].state.pos
    write_data(spheres, np.array([O.cell.size[0], O.cell.size[1]]), folder)
    text = INPUT.format(
        skin=0.2 * float(np.median(spheres["r"])),
        heavy=f"{GRAINS} {LID}" if bulk_gravity else LID,
        young=words([material.young] * 3),
        poisson=words([material.poisson] * 3),
        restitution=words([material.restitution] * 9),
        friction=words([material.friction] * 9),
        dt=O.dt,
        radius=diameter / 2,
        z=centre[2],
        x=centre[0],
        gravity=gravity,
        every=every,
        steps=steps,
    )
    log = run(text, folder)
    lines = map(str.split, log[: log.index("Loop time")].splitlines())
    rows = [line for line in lines if len(line) == 1 + len(COLUMNS) and line[0].isdigit()]
    table = np.array(rows, float)[:, 1:] * [-1, -1, -1, 1, 1, 1]  # `push` holds the cylinder's forces on the spheres
    return dict(zip(COLUMNS, table.T)), places(folder, len(spheres["r"]))


def run(text, folder):
    """Run an input in a folder; return the log. RuntimeError if LIGGGHTS does not come to its end."""
    (Path(folder) / "scene.in").write_text(text)
    command = ["liggghts", "-in", "scene.in", "-log", "scene.log", "-screen", "none"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    log = (Path(folder) / "scene.log").read_text()
    if done.returncode or "Loop time" not in log:
        said = (done.stderr or log).strip().splitlines()[-1:]
        raise RuntimeError(f"LIGGGHTS failed: {said}; its input is {folder}/scene.in")
    return log


def places(folder, count):
    """Return the centres (n, 3) at the end."""
    lines = (Path(folder) / "end.txt").read_text().splitlines()[-count:]
    return np.loadtxt(lines)[:, 1:4]
