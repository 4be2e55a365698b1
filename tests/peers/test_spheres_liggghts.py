"""The same spheres in LIGGGHTS (Debian's `liggghts`) and on GrainLoop: impacts of two spheres, and of a sphere on a plane.

Both integrate by leapfrog, both have Hertz's law with restitution. Their tangential forces differ in three things:

- the lever: in LIGGGHTS the radius less half an overlap, here the radius, as in LAMMPS and papers. Contacts here are so
  stiff and slow that overlaps are a millionth of a radius.
- how the spring turns with the contact: LIGGGHTS projects it on the new tangent plane, as LAMMPS' `gran/*`, which shortens it;
  LAMMPS' `granular` rescales it; we turn it by the rotation of the normal. Here contacts turn by a millionth of a radian.
- slip: LIGGGHTS limits the spring to Coulomb's bound and adds the dashpot below the bound, so that its force may exceed
  the bound; we limit both together, as in the papers. Tests compare impacts that stick (with so much friction
  that the moments in which F_n passes zero are negligible), and impacts without dashpots that slide.
"""

import shutil
import subprocess

import numpy as np
import pytest
import spheres
from disks import new_scene, run
from graindrive import engines
from yade import O

pytestmark = pytest.mark.skipif(shutil.which("liggghts") is None, reason="needs LIGGGHTS, which scripts/setup installs")

YOUNG, POISSON, SPEED = 1e9, 0.3, 2e-4
DT, STEPS = 2e-6, 15_000  # an impact at SPEED lasts 3,000 steps or so

INPUT = """
atom_style granular
atom_modify map array
units si
newton off
soft_particles yes
communicate single vel yes
boundary f f f
read_data scene.data
neighbor 0.1 bin
neigh_modify delay 0 every 1 check yes
fix young all property/global youngsModulus peratomtype {young}
fix poisson all property/global poissonsRatio peratomtype {poisson}
fix bounce all property/global coefficientRestitution peratomtypepair 1 {restitution}
fix rub all property/global coefficientFriction peratomtypepair 1 {friction}
pair_style gran model hertz tangential history
pair_coeff * *
timestep {dt}
fix move all nve/sphere
{plane}
dump end all custom {steps} end.txt id x y z vx vy vz omegax omegay omegaz
dump_modify end sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
run {steps}
"""


def liggghts(folder, grains, restitution, friction, plane):
    """Return rows x, v, spin of every sphere at the end; `grains` are rows x, radius, density, v, spin."""
    low, high = grains[:, :3].min(axis=0) - 5, grains[:, :3].max(axis=0) + 5
    lines = [f"scene\n\n{len(grains)} atoms\n1 atom types\n"]
    lines += [f"{low[k]:.17g} {high[k]:.17g} {axis}lo {axis}hi" for k, axis in enumerate("xyz")]
    lines.append("\nAtoms\n")
    lines += [f"{i} 1 {2 * g[3]:.17g} {g[4]:.17g} {g[0]:.17g} {g[1]:.17g} {g[2]:.17g}" for i, g in enumerate(grains, 1)]
    lines.append("\nVelocities\n")
    lines += [f"{i} " + " ".join(f"{v:.17g}" for v in g[5:]) for i, g in enumerate(grains, 1)]
    (folder / "scene.data").write_text("\n".join(lines) + "\n")
    wall = "fix floor all wall/gran model hertz tangential history primitive type 1 zplane 0.0" if plane else ""
    values = dict(restitution=restitution, friction=friction, dt=DT, steps=STEPS, plane=wall)
    (folder / "scene.in").write_text(INPUT.format(young=YOUNG, poisson=POISSON, **values))
    done = subprocess.run(
        ["liggghts", "-in", "scene.in", "-log", "log", "-screen", "none"], cwd=folder, capture_output=True, timeout=120
    )
    assert done.returncode == 0, (folder / "log").read_text()[-2000:]
    return np.loadtxt((folder / "end.txt").read_text().splitlines()[-len(grains) :])[:, 1:]


def ours(grains, restitution, friction, plane):
    new_scene(dt=DT)
    for g in grains:
        spheres.sphere(g[:3], g[3], g[5:8], g[8:], density=g[4])
    law = engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=YOUNG, poisson=POISSON, restitution=restitution)
    loop = spheres.grain_loop(law, friction=friction)
    if plane:
        loop.setWall("z_low", position=0)
    run(STEPS)
    return np.array([[*b.state.pos, *b.state.vel, *b.state.angVel] for b in O.bodies])


def direction(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def pairs(count, seed, slide):
    """Pairs far from each other, of unequal sizes and densities, about to touch: oblique, spinning; `slide` is v_t/v_n."""
    rng = np.random.default_rng(seed)
    rows = []
    for k in range(count):
        at, n = np.array([4.0 * k, 0.3 * k, -0.2 * k]), direction(rng)
        r1, r2 = rng.uniform(0.3, 0.6, 2)
        along = np.cross(n, direction(rng))
        drift = SPEED * rng.uniform(-0.5, 0.5, 3)
        v = drift + SPEED * (n + slide * along / np.linalg.norm(along))
        spin = [0.1 * SPEED * direction(rng) / r for r in (r1, r2)]
        rows.append([*at, r1, rng.uniform(0.5, 2), *v, *spin[0]])
        rows.append([*(at + (r1 + r2 + 1e-9) * n), r2, rng.uniform(0.5, 2), *drift, *spin[1]])
    return np.array(rows)


def on_plane(count, seed, slide):
    """Spheres about to touch the plane z = 0."""
    rng = np.random.default_rng(seed)
    rows = []
    for k in range(count):
        radius, angle = rng.uniform(0.3, 0.6), rng.uniform(0, 2 * np.pi)
        v = SPEED * np.array([slide * np.cos(angle), slide * np.sin(angle), -rng.uniform(0.7, 1.3)])
        rows.append(
            [4.0 * k, 0, radius + 1e-9, radius, rng.uniform(0.5, 2), *v, *(0.1 * SPEED * direction(rng) / radius)]
        )
    return np.array(rows)


def compare(mine, theirs, grains):
    """Velocities and surface speeds over the impact's speed, and by how much the impact changed them."""
    radius = grains[:, 3:4]
    scale = np.hstack([np.full((len(grains), 3), 1 / SPEED), np.repeat(radius / SPEED, 3, axis=1)])
    changed = np.abs((mine[:, 3:] - grains[:, 5:]) * scale)
    return (
        np.abs((mine - theirs)[:, 3:] * scale).max(),
        changed[:, :3].max(axis=1).min(),
        changed[:, 3:].max(axis=1).min(),
    )


@pytest.mark.parametrize(
    "restitution, friction, slide",
    [(0.7, 0.0, 1.0), (0.7, 1e4, 0.5), (1.0, 0.02, 2.0), (1.0, 0.1, 5.0)],
    ids=["smooth", "sticks", "slides", "slides fast"],
)
@pytest.mark.parametrize("plane", [False, True], ids=["two spheres", "plane"])
def test_impacts_end_as_in_liggghts(tmp_path, plane, restitution, friction, slide):
    grains = (on_plane if plane else pairs)(8, seed=3, slide=slide)
    theirs, mine = liggghts(tmp_path, grains, restitution, friction, plane), ours(grains, restitution, friction, plane)
    difference, velocity_changed, spin_changed = compare(mine, theirs, grains)
    assert velocity_changed > 0.1 and (spin_changed > 0.01) == (friction > 0)
    assert difference < 1e-6


def test_the_comparison_can_fail(tmp_path):
    # An error of 1e-4 in the friction is detected.
    grains = pairs(4, seed=5, slide=2.0)
    theirs, mine = liggghts(tmp_path, grains, 1.0, 0.02, False), ours(grains, 1.0, 0.02 * 1.0001, False)
    assert compare(mine, theirs, grains)[0] > 1e-6


# Guillard, Forterre, Pouliquen, Phys. Fluids 26, 043301 (2014), Table I: E = 5 MPa, nu = 0.45, e = 0.6, d = 1.5 mm, 2.5 g/cm^3.
DIAMETER, DENSITY = 1.5e-3, 2500.0


def contact_of(plane, restitution, normal_speed=0.0, tangential_speed=0.0):
    """F_n, |F_t| [N], overlap and spring [m] of a sphere at another one, or at a plane; v_n > 0 parts."""
    radius, overlap = DIAMETER / 2, 1e-6
    new_scene(dt=1e-9)  # so short that the spring is negligible
    spheres.sphere((0, 0, radius - overlap), radius, (tangential_speed, 0, normal_speed), density=DENSITY)
    if not plane:
        spheres.sphere((0, 0, -radius), radius, density=DENSITY)
    law = engines.Law2_ScGeom_ContactPhys_HertzRestitution(young=5e6, poisson=0.45, restitution=restitution)
    loop = spheres.grain_loop(law, friction=1e3)
    if plane:
        loop.setWall("z_low", position=0)
    run(1)
    table = loop.wallContacts() if plane else loop.contacts()
    normal, tangential = -table["normal_force"][0][2], np.linalg.norm(table["tangential_force"][0])
    delta, slip = table["overlap"][0], np.linalg.norm(table["slip"][0])
    return normal, tangential, delta, slip


@pytest.mark.parametrize(
    "plane, k_n, k_t, gamma_n, gamma_t",
    [(False, 81e3, 86e3, 0.15, 0.13), (True, 114e3, 122e3, 0.26, 0.21)],
    ids=["two grains", "grain and cylinder"],
)
def test_table_1_of_guillard_and_others(plane, k_n, k_t, gamma_n, gamma_t):
    """The numbers that the paper prints: [N m^-3/2] to half a thousand, [kg s^-1 m^-1/4] to half a hundredth."""
    normal, tangential, delta, slip = contact_of(plane, 1.0, tangential_speed=1e-3)
    assert normal / delta**1.5 == pytest.approx(k_n, abs=500)
    assert tangential / (delta**0.5 * slip) == pytest.approx(k_t, abs=500)
    elastic = normal / delta**1.5
    normal, tangential, delta, _ = contact_of(plane, 0.6, -1e-3, 1e-3)
    assert (normal - elastic * delta**1.5) / (delta**0.25 * 1e-3) == pytest.approx(gamma_n, abs=0.005)
    assert tangential / (delta**0.25 * 1e-3) == pytest.approx(gamma_t, abs=0.005)
