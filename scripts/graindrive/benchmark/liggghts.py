"""The same scene in LIGGGHTS: Hertz with restitution damping; with `dimension 2` it weighs and turns disks, as we do."""

import shutil

from . import layout, peer_files

INPUT = """
atom_style granular
atom_modify map array sort 1000 0
{dimension}
units si
newton off
soft_particles yes
communicate single vel yes
boundary {boundary}
read_data scene.data
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
group wall type 2
group free type 1
neigh_modify exclude group wall wall
fix young all property/global youngsModulus peratomtype {young} {young} {young}
fix poisson all property/global poissonsRatio peratomtype {poisson} {poisson} {poisson}
fix bounce all property/global coefficientRestitution peratomtypepair 3 {restitution}
fix rub all property/global coefficientFriction peratomtypepair 3 {friction}
pair_style gran model hertz tangential history
pair_coeff * *
fix move free nve/sphere
fix rest wall freeze
"""


def available():
    """Return LIGGGHTS's command, or None."""
    return shutil.which("liggghts")


def write(a_scene, folder):
    """Write the data file."""
    density, r = float(a_scene["density"]), a_scene["r"]
    peer_files.write_data(a_scene, folder, lambda i: f"{2 * r[i]:.17g} {density:.17g}")


def run(a_scene, steps, folder):
    """Run some steps from the scene's start on one core; return {wall, cpu, energy}."""
    young, poisson, restitution = map(float, a_scene["constants"])
    text = INPUT.format(
        dimension="" if layout.in_space(a_scene) else "dimension 2",
        boundary=peer_files.boundary(a_scene),
        skin=peer_files.skin(a_scene),
        young=young,
        poisson=poisson,
        restitution=" ".join([str(restitution)] * 9),
        friction=" ".join([str(float(a_scene["friction"]))] * 9),
    )
    timing = peer_files.run(["liggghts"], a_scene, text, steps, folder, "LIGGGHTS")
    return dict(wall=timing["wall"], cpu=timing["cpu"], energy=timing["slide"] + timing["turn"])
