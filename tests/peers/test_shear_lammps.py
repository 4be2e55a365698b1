"""Homogeneous shear against LAMMPS: friction, pressure and contacts in steady flow, in a cell that both codes deform."""

import subprocess

import numpy as np
import pytest

from graindrive import engines
from graindrive.loops import grain_loop
from graindrive.benchmark import lammps
from graindrive.postproc.statistics import block_mean, ratio_mean
import disks
from yade import O

pytestmark = pytest.mark.skipif(lammps.available() is None, reason="LAMMPS is not installed (Debian's package lammps)")

SIDE, SPACING, RATE, DT, MU, PHI = 12, 1.12, 1.0, 1e-4, 0.4, 0.77
SETTLE, STEPS, EVERY = 30_000, 80_000, 20  # a strain of 3 to reach steady flow, then one of 8
K_N, K_T, GAMMA = 5e5, 6e5, 1000.0

INPUT = """
units lj
dimension 2
boundary p p p
atom_style sphere
comm_modify vel yes
read_data scene.data
set group all density/disc 1.0
neighbor 0.3 bin
neigh_modify delay 0 every 1 check yes
pair_style gran/hertz/history {k_n} {k_t} {gamma} {gamma} {mu} 1
pair_coeff * *
fix move all nve/sphere disc
fix shear all deform 1 xy erate {rate} remap v
fix flat all enforce2d
compute stress all pressure NULL virial
timestep {dt}
fix out all ave/time {every} 1 {every} c_stress[1] c_stress[2] c_stress[4] file stress.txt format " %.10g"
run {steps}
"""


def flowing():
    """Shear disks of area fraction 0.77 on GrainLoop until they flow; return the drive."""
    rng = np.random.default_rng(2)
    n, width = SIDE * SIDE, SIDE * SPACING
    x, y = (np.indices((SIDE, SIDE)).reshape(2, n) + 0.5) * SPACING + rng.uniform(-0.005, 0.005, (2, n))
    radii = rng.uniform(0.43, 0.55, n)
    disks.new_scene(dt=DT, period=(width, width, width))
    for place in zip(x, y, radii):
        disks.disk(*place)
    height = np.pi * np.sum(radii**2) / width / PHI
    drive = engines.ShearDrive(shearRate=RATE, height=height, heightRate=0.1, every=EVERY, label="shear")
    disks.loop(disks.hertz(K_N, K_T, GAMMA, GAMMA), friction=MU, before_newton=[drive])
    grain_loop.use_grain_loop(largestOverlap=0.2)
    disks.run(SETTLE)
    return drive


def write_data(folder):
    """Write the present disks for LAMMPS: those outside of the cell in y as their image inside, with the image's velocity."""
    cell = O.cell.hSize
    width, height, tilt = (
        cell[0][0],
        cell[1][1],
        (cell[0][1] + DT * RATE * cell[1][1]) % cell[0][0],
    )  # at the step of the bodies
    tilt -= width * (tilt > width / 2)
    atoms, motion = [], []
    for k, body in enumerate(O.bodies):
        x, y, _ = body.state.pos
        vx, vy, _ = body.state.vel
        up = np.floor(y / height)
        x, y, vx = x - up * tilt, y - up * height, vx - up * RATE * height
        x -= width * np.floor((x - tilt * y / height) / width)
        atoms.append(f"{k + 1} 1 {2 * body.shape.radius:.17g} 1 {x:.17g} {y:.17g} 0")
        motion.append(f"{k + 1} {vx:.17g} {vy:.17g} 0 0 0 {body.state.angVel[2]:.17g}")
    box = f"0 {width:.17g} xlo xhi\n0 {height:.17g} ylo yhi\n-0.5 0.5 zlo zhi\n{tilt:.17g} 0 0 xy xz yz"
    text = f"shear\n\n{len(atoms)} atoms\n1 atom types\n{box}\n\nAtoms\n\n" + "\n".join(atoms)
    (folder / "scene.data").write_text(text + "\n\nVelocities\n\n" + "\n".join(motion) + "\n")


def stresses_of_lammps(folder):
    """Return (tau, p) (n,) of the contact stress in LAMMPS, starting from the present state."""
    write_data(folder)
    numbers = dict(k_n=K_N, k_t=K_T, gamma=GAMMA, mu=MU, rate=RATE, dt=DT)
    (folder / "in.shear").write_text(INPUT.format(**numbers, steps=STEPS, every=EVERY))
    done = subprocess.run([lammps.command, "-in", "in.shear"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-500:]
    _, sxx, syy, sxy = np.loadtxt(folder / "stress.txt").T
    return -sxy, (sxx + syy) / 2


def stresses_of_grain_loop(drive):
    """Return the same from GrainLoop, by ShearDrive's measures."""
    rows = []
    for _ in range(STEPS // EVERY):
        drive.clear()
        disks.run(EVERY)
        rows.append([-drive.sums[1], (drive.sums[0] + drive.sums[3]) / 2])
    return np.array(rows).T


def test_friction_and_pressure_of_a_steady_shear(tmp_path):
    """By chaos the two differ after a strain of 1; means over a strain of 8 must agree within two errors of the difference."""
    drive = flowing()
    their_tau, their_p = stresses_of_lammps(tmp_path)
    tau, p = stresses_of_grain_loop(drive)
    ours, theirs = ratio_mean(tau, p), ratio_mean(their_tau, their_p)
    error = np.hypot(ours.error, theirs.error)
    assert 0.2 < ours.value < 0.6 and error < 0.03
    assert abs(ours.value - theirs.value) < 2 * error
    ours, theirs = block_mean(p), block_mean(their_p)
    assert abs(ours.value - theirs.value) < 2 * np.hypot(ours.error, theirs.error)
    assert ours.error < 0.1 * ours.value
