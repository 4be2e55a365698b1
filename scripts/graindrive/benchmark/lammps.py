"""The same scene in LAMMPS: data file, input, one run, and what its log says."""

import shutil

import numpy as np

from . import peer_files
from .ours import DRUM_MASS
from .scenes import DRIVEN

# Three traps: 2D `read_data` takes a sphere's mass until `set density/disc`; two ranks need `processors 2 1 1` for a wide
# bed; without `disc` nve/sphere turns spheres. erotate/sphere knows spheres only: a disk's energy is 5/4 of what it says.
INPUT = """
units lj
dimension 2
boundary {boundary} f p
processors {ranks} 1 1
atom_style sphere
comm_modify vel yes
read_data scene.data
set group all density/disc {density}
group wall type 2
group driven type 3
group led type 2 3
group free type 1
{masses}
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes exclude group wall wall
{pair}
fix move free nve/sphere disc
{walls}
"""

command = "lmp"  # Debian's; scripts/bench --lammps puts another in its place


def available():
    """Return LAMMPS's path, or None."""
    return shutil.which(command)


def write(a_scene, folder):
    """Write the data file of a scene; masses come from `set density/disc`."""
    peer_files.write_data(a_scene, folder, lambda i: f"{2 * a_scene['r'][i]:.17g} 1.0")


def pair_style(a_scene):
    """Return the pair style.

    gran/hooke/history damps by m_eff gamma where the drum's law has sqrt(m_eff): gamma is taken at the mean mass.
    """
    mu, constants = float(a_scene["friction"]), [float(c) for c in a_scene["constants"]]
    if str(a_scene["law"]) == "hertzHistory":
        return "pair_style gran/hertz/history {} {} {} {} {} 1".format(*constants, mu)
    k_n, k_t, restitution = constants
    free = a_scene["kind"] == 0
    half_mass = float(a_scene["density"]) * np.pi * np.mean(a_scene["r"][free] ** 2) / 2
    gamma = -2 * np.log(restitution) * np.sqrt(k_n / half_mass / (np.pi**2 + np.log(restitution) ** 2))
    return f"pair_style gran/hooke/history {k_n} {k_t} {gamma} {gamma} {mu} 1"


def walls(a_scene):
    """Return the fixes of what does not move freely, and the masses it counts with."""
    vx, vy, spin = map(float, a_scene["drive"])
    if a_scene["period"] == 0 and spin:
        return (
            f"fix turns wall move rotate 0 0 0 0 0 1 {2 * np.pi / spin:.17g}",
            f"set group wall density/disc {DRUM_MASS}",
        )
    fixes = "fix rest wall freeze"
    if np.any(a_scene["kind"] == DRIVEN):
        fixes += f"\nfix led driven move linear {vx} {vy} 0"
    return fixes, ""


def run(a_scene, folder, steps, ranks):
    """Run some steps from the scene's start; return {wall, cpu, energy}."""
    fixes, masses = walls(a_scene)
    text = INPUT.format(
        boundary="p" if a_scene["period"] > 0 else "f",
        ranks=ranks,
        density=float(a_scene["density"]),
        skin=peer_files.skin(a_scene),
        pair=pair_style(a_scene),
        walls=fixes,
        masses=masses,
    )
    launcher = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(ranks)] if ranks > 1 else []
    timing = peer_files.run([*launcher, command], a_scene, text, steps, folder, "LAMMPS")
    return dict(wall=timing["wall"], cpu=timing["cpu"], energy=timing["slide"] + 1.25 * timing["turn"])
