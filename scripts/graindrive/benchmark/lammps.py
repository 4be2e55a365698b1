"""Runs a scene in LAMMPS: writes data file and input, runs it once, reads its log."""

import shutil

import numpy as np

from . import layout, peer_files
from .layout import DRIVEN
from .ours import DRUM_MASS, is_drum

# Pitfalls: in 2D `read_data` gives disks the mass of spheres until `set density/disc`; two ranks need `processors 2 1 1` for a
# wide bed; without `disc`, nve/sphere uses the inertia of spheres. erotate/sphere assumes spheres: a disk's rotational energy is
# 5/4 of its value. Spheres have their density in the data file.
INPUT = """
units lj
{dimension}
boundary {boundary}
processors {ranks} 1 1
atom_style sphere
comm_modify vel yes
read_data scene.data
{density}
group wall type 2
group driven type 3
group led type 2 3
group free type 1
{masses}
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes exclude group wall wall
{pair}
fix move free nve/sphere {disc}
{walls}
"""

command = "lmp"  # Debian's; scripts/bench --lammps puts another in its place


def available():
    """Return LAMMPS's path, or None."""
    return shutil.which(command)


def write(a_scene, folder):
    """Write the data file of a scene; masses of disks come from `set density/disc`."""
    density = float(a_scene["density"]) if layout.in_space(a_scene) else 1.0
    peer_files.write_data(a_scene, folder, lambda i: f"{2 * a_scene['r'][i]:.17g} {density:.17g}")


def pair_style(a_scene):
    """Return the lines that set the pair style.

    gran/hooke/history damps by m_eff gamma where the drum's law has sqrt(m_eff): gamma is taken at the mean mass.
    """
    mu, constants = float(a_scene["friction"]), [float(c) for c in a_scene["constants"]]
    if str(a_scene["law"]) == "hertzHistory":
        return "pair_style gran/hertz/history {} {} {} {} {} 1\npair_coeff * *".format(*constants, mu)
    if str(a_scene["law"]) == "hertzRestitution":
        return granular(*constants, mu)
    k_n, k_t, restitution = constants
    free = a_scene["kind"] == 0
    half_mass = float(a_scene["density"]) * np.pi * np.mean(a_scene["r"][free] ** 2) / 2
    gamma = -2 * np.log(restitution) * np.sqrt(k_n / half_mass / (np.pi**2 + np.log(restitution) ** 2))
    return f"pair_style gran/hooke/history {k_n} {k_t} {gamma} {gamma} {mu} 1\npair_coeff * *"


def granular(young, poisson, restitution, mu):
    """Return pair_style and pair_coeff of the package `granular` for the law with restitution damping.

    Its `tsuji` damps by alpha sqrt(m_eff k_n), alpha a polynomial of the restitution (Tsuji et al. 1992) where the law has
    sqrt(5) b: it is given the restitution whose alpha that is. Its tangential damping is a multiple of the normal one, here
    sqrt(2 c / 3). `mindlin` keeps the spring as long as it was when the normal turns, as the law does; `mindlin_rescale`
    would shorten it with the contact's radius. NULL takes the tangential stiffness from the material.
    """
    b = -np.log(restitution) / np.hypot(np.log(restitution), np.pi)
    ratio = 3 * (1 - poisson) / (2 - poisson)
    damping = restitution_of_tsuji(np.sqrt(5) * b)
    coefficients = f"{young:.17g} {damping:.17g} {poisson:.17g}"
    tangential = f"tangential mindlin NULL {np.sqrt(2 * ratio / 3):.17g} {mu:.17g}"
    return f"pair_style granular\npair_coeff * * hertz/material {coefficients} {tangential} damping tsuji"


TSUJI = (1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)  # alpha as LAMMPS computes it, powers of e rising


def restitution_of_tsuji(alpha):
    """Return the e at which LAMMPS's polynomial is alpha, by bisection in [0, 1], where it falls from 1.27 to about 0."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        too_much = np.polynomial.polynomial.polyval(middle, TSUJI) > alpha
        low, high = (middle, high) if too_much else (low, middle)
    return low


def walls(a_scene):
    """Return the fixes of what does not move freely, and the masses it counts with."""
    if layout.in_space(a_scene):
        return "fix rest wall freeze", ""
    vx, vy, spin = map(float, a_scene["drive"])
    if is_drum(a_scene):
        return (
            f"fix turns wall move rotate 0 0 0 0 0 1 {2 * np.pi / spin:.17g}",
            f"set group wall density/disc {DRUM_MASS}",
        )
    fixes = "fix rest wall freeze"
    if np.any(a_scene["kind"] == DRIVEN):
        fixes += f"\nfix led driven move linear {vx} {vy} 0"
    return fixes, ""


def run(a_scene, steps, folder, ranks):
    """Run some steps from the scene's start; return {wall, cpu, energy}."""
    fixes, masses = walls(a_scene)
    in_space = layout.in_space(a_scene)
    text = INPUT.format(
        dimension="" if in_space else "dimension 2",
        boundary=peer_files.boundary(a_scene),
        ranks=ranks,
        density="" if in_space else f"set group all density/disc {float(a_scene['density'])}",
        disc="" if in_space else "disc",
        skin=peer_files.skin(a_scene),
        pair=pair_style(a_scene),
        walls=fixes,
        masses=masses,
    )
    launcher = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(ranks)] if ranks > 1 else []
    timing = peer_files.run([*launcher, command], a_scene, text, steps, folder, "LAMMPS")
    return dict(
        wall=timing["wall"], cpu=timing["cpu"], energy=timing["slide"] + (1 if in_space else 1.25) * timing["turn"]
    )
