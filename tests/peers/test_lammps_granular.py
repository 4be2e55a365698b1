"""The same disks in LAMMPS (Debian's `lmp`) and in YADE's loop with Graindrive's laws: impacts, and a bed.

Both integrate by leapfrog and give the law x at n and v at n-1/2, so that from a start without contacts results agree except for
round-off and one thing: LAMMPS projects the tangential spring on the new tangent, which shortens it by (d theta)^2/2 each
step; we keep its length. Stiff contacts turn so little that this stays below 1e-9.
"""

import math
import shutil
import subprocess

import numpy as np
import pytest
from disks import disk, engines, hertz, loop, new_scene, run
from yade import O

pytestmark = pytest.mark.skipif(shutil.which("lmp") is None, reason="needs LAMMPS, which scripts/setup installs")

K_N, K_T, GAMMA = 2e9, 2.46e9, 4e4
DT, STEPS = 5e-7, 20000  # an impact at speed 1 lasts 1,100 steps, all begin within 12,000

HEADER = """
units lj
dimension 2
boundary {boundary} p
atom_style sphere
newton off
comm_modify vel yes
region box block {x0!r} {x1!r} {y0!r} {y1!r} -0.5 0.5
create_box 1 box
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
"""


def lammps(folder, disks, law, steps, dt, box, boundary="f f", gravity=0.0, frozen=()):
    """Rows x, y, vx, vy, spin of every disk at the end; disks: rows x, y, radius, vx, vy, spin; density 1."""
    x0, x1, y0, y1 = box
    lines = [HEADER.format(boundary=boundary, x0=x0, x1=x1, y0=y0, y1=y1, skin=0.1)]
    for i, (x, y, radius, vx, vy, spin) in enumerate(disks, 1):
        lines.append(f"create_atoms 1 single {x!r} {y!r} 0.0 units box")
        # Without density/disc a two-dimensional disk would have the mass of a sphere.
        lines.append(f"set atom {i} diameter {2 * radius!r} density/disc 1.0 omega 0 0 {spin!r} vx {vx!r} vy {vy!r}")
    lines += [f"pair_style {law}", "pair_coeff * *", f"timestep {dt!r}"]
    moving = "all"
    if len(frozen):
        lines += ["group base id " + " ".join(str(i + 1) for i in frozen), "group grains subtract all base"]
        lines += ["fix hold base freeze"]
        moving = "grains"
    lines += [f"fix move {moving} nve/sphere disc", "fix plane all enforce2d"]
    if gravity:
        lines.insert(-1, f"fix weight {moving} gravity {gravity!r} vector 0 -1 0")
    lines += [f"run {steps}"]
    columns = "id xu yu vx vy omegaz"
    lines += [f"write_dump all custom end.txt {columns} modify sort id format float %.17g"]
    (folder / "in.lmp").write_text("\n".join(lines) + "\n")
    result = subprocess.run(["lmp", "-in", "in.lmp", "-screen", "none"], cwd=folder, capture_output=True, timeout=120)
    assert result.returncode == 0, (folder / "log.lammps").read_text()[-2000:]
    return np.loadtxt(folder / "end.txt", skiprows=9)[:, 1:]


def ours(disks, law, friction, steps, dt, period=None, gravity=0.0, frozen=()):
    new_scene(dt, period)
    for i, (x, y, radius, vx, vy, spin) in enumerate(disks):
        held = i in set(frozen)
        # Both start from the velocity at time 0; YADE interprets a given velocity as that half a step earlier.
        disk(x, y, radius, (vx, vy + gravity * dt / 2 * (not held)), spin, frozen=held)
    loop(law, friction=friction, gravity=(0, -gravity))
    run(steps)
    places, before = motions()
    O.step()
    # The velocity at a whole step, which LAMMPS gives, is the mean of the two around it.
    return np.hstack([places, (before + motions()[1]) / 2])


def motions():
    states = [b.state for b in O.bodies]
    return np.array([[s.pos[0], s.pos[1]] for s in states]), np.array(
        [[s.vel[0], s.vel[1], s.angVel[2]] for s in states]
    )


def random_impacts(count, seed, same_size=False):
    """Pairs far from each other, each about to collide at random speed, angle, offset, sizes and spins."""
    rng = np.random.default_rng(seed)
    rows = []
    for i in range(count):
        at = np.array([6.0 * (i % 10), 6.0 * (i // 10)])
        r1, r2 = (0.5, 0.5) if same_size else rng.uniform(0.3, 0.6, 2)
        angle, offset = rng.uniform(0, 2 * math.pi), rng.uniform(-0.95, 0.95) * (r1 + r2)
        speed = rng.uniform(0.5, 2.0)
        along, across = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        # The gap takes 2,000 to 10,000 steps to close.
        reach = math.sqrt((r1 + r2) ** 2 - offset**2) + speed * DT * rng.integers(2000, 10000)
        drift = rng.uniform(-0.5, 0.5, 2)
        rows.append((*(at - reach * along), r1, *(drift + speed * along), rng.uniform(-3, 3)))
        rows.append((*(at + offset * across), r2, *drift, rng.uniform(-3, 3)))
    return [tuple(float(value) for value in row) for row in rows]


def changed(before, after):
    """Share of the disks whose velocity the impacts changed."""
    return np.mean(np.abs(np.array(before)[:, 3:5] - after[:, 2:4]).max(axis=1) > 1e-3)


BOX = (-5.0, 65.0, -5.0, 65.0)


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.5, 100.0])
def test_a_hundred_random_impacts_end_as_in_lammps(tmp_path, friction):
    disks = random_impacts(100, seed=int(10 * friction) + 1)
    law = f"gran/hertz/history {K_N!r} {K_T!r} {GAMMA!r} {GAMMA!r} {friction!r} 1"
    theirs = lammps(tmp_path, disks, law, STEPS, DT, BOX)
    mine = ours(disks, hertz(K_N, K_T, GAMMA, GAMMA), friction, STEPS, DT)
    assert changed(disks, mine) > 0.95
    if friction:
        assert np.mean(np.abs(np.array(disks)[:, 5] - mine[:, 4]) > 1e-3) > 0.9
    else:
        np.testing.assert_array_equal(mine[:, 4], np.array(disks)[:, 5])
    # See the docstring of this file: 0.5 x 1,100 steps x (2 x 5e-7)^2 = 5e-10 of the tangential velocity, at most 3 here.
    np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-9)


def test_the_comparison_can_fail(tmp_path):
    # An error of a millionth in the stiffness is detected.
    disks = random_impacts(10, seed=4)
    theirs = lammps(tmp_path, disks, f"gran/hertz/history {K_N!r} {K_T!r} {GAMMA!r} {GAMMA!r} 0.5 1", STEPS, DT, BOX)
    mine = ours(disks, hertz(K_N * (1 + 1e-6), K_T, GAMMA, GAMMA), 0.5, STEPS, DT)
    assert np.abs(mine - theirs).max() > 1e-8


@pytest.mark.parametrize("friction", [0.0, 1e4])
def test_linear_impacts_without_slip_end_as_in_lammps(tmp_path, friction):
    # LAMMPS' gran/hooke/history shortens the spring of a slipping contact, our law keeps it: they are equal only without slip.
    # Its damping is given per mass, ours by the restitution; for equal masses they can be made equal.
    # 1e4 is the largest friction that LAMMPS accepts; few contacts slip just before they end, and none with this seed.
    disks = random_impacts(40, seed=7, same_size=True)
    k_n, k_t, restitution = 1e6, 2e6 / 7, 0.92
    log_e, mass = math.log(restitution), math.pi / 8  # reduced mass of two disks of diameter and density 1
    gamma = -2 * log_e * math.sqrt(k_n / mass / (math.pi**2 + log_e**2))
    law = engines.Law2_ScGeom_ContactPhys_SpringDashpot(
        normalStiffness=k_n, tangentialStiffness=k_t, restitution=restitution
    )
    theirs = lammps(
        tmp_path, disks, f"gran/hooke/history {k_n!r} {k_t!r} {gamma!r} {gamma!r} {friction!r} 1", STEPS, DT, BOX
    )
    mine = ours(disks, law, friction, STEPS, DT)
    assert changed(disks, mine) > 0.95
    # Contacts last 4,000 steps here and turn four times further: 0.5 x 4,000 x (2 x 5e-7)^2 = 2e-9 of the spring.
    np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-8)


def test_a_bed_settles_as_in_lammps(tmp_path):
    # Periodic in x, frozen base, gravity, different sizes, friction; compared before chaos has amplified round-off.
    rng = np.random.default_rng(3)
    base = [(x + 0.5, 0.5, 0.5, 0.0, 0.0, 0.0) for x in range(8)]
    grains = []
    for row in range(7):
        for column in range(7):
            x, y = 8 / 7 * (column + 0.5 * (row % 2)) + 0.3, 1.55 + 1.02 * row
            radius = rng.uniform(0.45, 0.5)
            jitter = rng.uniform(-0.01, 0.01, 2)
            grains.append((x + jitter[0], y + jitter[1], radius, *rng.uniform(-1, 1, 2), rng.uniform(-1, 1)))
    disks = [tuple(float(v) for v in row) for row in base + grains]
    disks = [(x % 8.0, *rest) for x, *rest in disks]
    steps, dt, k_n = 10_000, 2e-5, 2e7
    law = f"gran/hertz/history {k_n!r} {1.23 * k_n!r} 2500.0 2500.0 0.3 1"
    frozen = range(len(base))
    theirs = lammps(tmp_path, disks, law, steps, dt, (0.0, 8.0, -1.0, 30.0), "p f", gravity=5.0, frozen=frozen)
    mine = ours(
        disks, hertz(k_n, 1.23 * k_n, 2500.0, 2500.0), 0.3, steps, dt, period=(8, 60, 10), gravity=5.0, frozen=frozen
    )
    real = sum(i.isReal for i in O.interactions)
    moved = np.abs(mine[:, 4] - np.array(disks)[:, 5]) > 1e-3
    assert real > 5 and moved.sum() > 20  # spins that friction changed
    # Collisions amplify round-off and the shortening of springs: 1e-11 after 6,000 steps, 2e-10 in positions and velocities
    # after 10,000 (0.2 s, two collisions a grain), ten times more after twice the time.
    np.testing.assert_allclose(mine, theirs, rtol=0, atol=3e-9)
