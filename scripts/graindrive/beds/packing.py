"""Makes beds of disks around a held intruder by random insertion and settling under gravity; places spheres at random."""

import sys
from dataclasses import asdict, dataclass

import numpy as np

from . import cache, lid
from ..bodies import cover
from ..lazily import engines
from ..runs import progress
from ..scenes import scene
from ..base.errors import UsageError
from ..scenes.material import HertzHistoryMaterial
from ..runs.progress_line import Calming
from ..scenes.yade_march import YadeMarch

RECIPE = 4  # version of the recipe; increase it when the same parameters give a different bed
MOST_GRAINS = 10_000_000  # some 10 GB of YADE's bodies
INSERTION_FRACTION = 0.45  # random insertion jams near 0.547
MOST_SPHERES = 0.36  # largest volume fraction: random insertion of equal spheres jams near 0.384
LARGEST_OVERLAP = 0.3  # [R] largest allowed overlap while a bed settles


@dataclass(frozen=True)
class BedRecipe:
    """A bed of disks on a base of disks of diameter 1 at y = 0, periodic in x, around a held clump.

    Lengths in grain diameters d, times in sqrt(d/g), masses in rho d^2. `beads` are rows x, y of the held clump's bead
    centres, `outline` rows x, y of its corners, both in the coordinates of the scene. The bed counts as settled if its kinetic
    energy per grain is below `rest` [m g d]. `lid_pressure` [rho g d] is the weight over width of the `lid`, "rigid" or "grains".
    """

    width: float
    height: float
    d_min: float
    d_max: float
    material: HertzHistoryMaterial
    beads: tuple
    bead_radius: float
    outline: tuple
    outline_area: float
    dt: float
    rest: float
    seed: int
    lid: str = "rigid"
    lid_pressure: float = 0.0


def settled_bed(recipe):
    """Return a settled bed as a dict: x, y, r, density of its grains, shape (n,), kinetic energy per grain, deepest overlap.

    The same recipe gives the same bed; it is taken from the cache if possible.
    """
    return cache.cached("bed", as_plain(recipe), RECIPE, lambda: settle(recipe))


def random_spheres(box, fraction, d_min, d_max, seed, *, periodic="", keep_out=None):
    """Return centres (n, 3) and radii (n,) of spheres placed at random without overlaps [length].

    `box` is (x_min, x_max, y_min, y_max, z_min, z_max); it repeats along the axes that `periodic` names, as "xy".
    `keep_out(points (m, 3))` gives signed distances (m,) to a solid, > 0 outside of it and to its nearest image where the
    box repeats: no sphere reaches into it. The spheres, with diameters uniform in [d_min, d_max), fill `fraction` of the volume
    outside of the solid, which is measured on a grid of points. A seed gives the same result on every machine.
    UsageError for a fraction that random insertion cannot reach or a room too small for a sphere, ValueError for bad input.
    """
    if not 0 < fraction <= MOST_SPHERES:
        raise UsageError(
            f"fraction must lie in (0, {MOST_SPHERES}], got {fraction:g}: random insertion of equal spheres jams at 0.384;"
            " make a looser packing and compress it"
        )
    engines.overlaps_in_space(box, periodic, np.empty((0, 3)), ())  # refuses an invalid box
    room = room_outside(np.array(box, dtype=float), keep_out)
    mean_volume = np.pi / 24 * (d_min + d_max) * (d_min**2 + d_max**2)  # pi/6 <d^3>
    count = round(fraction * room / mean_volume)
    if count < 1:
        raise UsageError(f"a volume of {room:.3g} has no room for spheres of volume {mean_volume:.3g}; enlarge the box")
    radii = engines.uniform_radii(count, d_min, d_max, seed)
    return engines.random_insertion_in_space(box, periodic, radii, seed, keep_out), radii


def room_outside(box, keep_out, points=40):
    """Return the volume of a box outside of a solid, from a grid of points (the error is some 1/points of the solid's volume)."""
    low, side = box[::2], box[1::2] - box[::2]
    if keep_out is None:
        return np.prod(side)
    middles = np.stack(np.meshgrid(*3 * [(np.arange(points) + 0.5) / points], indexing="ij"), axis=-1).reshape(-1, 3)
    distances = np.asarray(keep_out(low + side * middles))
    if distances.shape != (len(middles),):
        raise ValueError(f"keep_out must return one distance per point, shape (n,), got shape {distances.shape}")
    return np.prod(side) * np.mean(distances > 0)


def as_plain(recipe):
    """Return a recipe as a dict of numbers and lists, for the cache's key."""
    plain = asdict(recipe)
    for name in ("beads", "outline"):
        plain[name] = [list(map(float, row)) for row in plain[name]]
    return plain


def count_grains(recipe):
    """Return the number of grains that fill the bed; UsageError if it is 0 or more than a run can hold."""
    mean_area = np.pi / 12 * (recipe.d_max**2 + recipe.d_max * recipe.d_min + recipe.d_min**2)
    count = (lid.BED_FRACTION * recipe.width * recipe.height - recipe.outline_area) / mean_area
    if count < 1:
        raise UsageError(
            f"a bed {recipe.width} d wide and {recipe.height} d high has no room for grains; make it larger"
        )
    if count > MOST_GRAINS:
        raise UsageError(
            f"a bed {recipe.width:g} d wide and {recipe.height:g} d high has {count:.3g} grains, more than {MOST_GRAINS};"
            " lower width or height"
        )
    return int(count)


def check_load(recipe, largest_overlap, body_load):
    """Raise UsageError for weights that make resting grains of 1 d overlap by more than `largest_overlap` radii.

    The weights are that of bed and lid at the base, and that of the body over its width, `body_load` [rho d g].
    """
    most = recipe.material.force_between(0.5, min(largest_overlap, LARGEST_OVERLAP))
    at_base = lid.weight_of_bed(recipe.height) + recipe.lid_pressure
    bear = f"grains can carry only {most:.3g} rho d g at largest_overlap={largest_overlap:g} R"
    if at_base > most:
        raise UsageError(
            f"a bed of height={recipe.height:g} d under a lid of {recipe.lid_pressure:g} rho d g weighs {at_base:.3g} rho d g,"
            f" but {bear}; lower height or lid_pressure, or raise largest_overlap"
        )
    if body_load > most:
        raise UsageError(
            f"a body whose mass over width is {body_load:.3g} rho d loads the grains with as many rho d g,"
            f" but {bear}; lower intruder_mass, or raise largest_overlap"
        )


def insert(recipe):
    """Place the bed's grains at random above the base and around the intruder; return x, y, r."""
    count = count_grains(recipe)
    radii = engines.uniform_radii(count, recipe.d_min, recipe.d_max, recipe.seed)
    filled = np.sum(np.pi * radii**2) / INSERTION_FRACTION + recipe.outline_area
    box = (0.0, recipe.width, 0.5, 0.5 + filled / recipe.width)
    obstacles = keep_clear(recipe)
    centres = engines.random_insertion(box, True, radii, obstacles, recipe.seed)
    return centres[:, 0], centres[:, 1], radii


def keep_clear(recipe):
    """Return rows x, y, radius of disks that cover the intruder, so that no grain is placed inside its ring of beads."""
    beads, outline = np.array(recipe.beads), np.array(recipe.outline)
    ring = np.c_[beads, np.full(len(beads), recipe.bead_radius)]
    if len(outline) == 0:  # a single disk
        return ring
    return np.concatenate([ring, cover.disks_inside(outline, recipe.d_min / 4)])


def settle(recipe):
    """Insert the grains, let them settle, lay the lid on them and let them settle again; return the bed.

    Under a rigid lid the bed also holds `lid_y`, the height of the lid's centres.
    """
    x, y, r = insert(recipe)
    bed = come_to_rest(recipe, x, y, r, np.full(len(r), recipe.material.density))
    if recipe.lid_pressure == 0:
        return bed
    if recipe.lid == "rigid":
        top = float((bed["y"] + bed["r"]).max())
        return come_to_rest(recipe, bed["x"], bed["y"], bed["r"], bed["density"], top + 0.5, " under a rigid lid")
    density = lid.heavy_layer(bed, recipe.width, recipe.lid_pressure, recipe.material.density, lid.BED_FRACTION)
    return come_to_rest(recipe, bed["x"], bed["y"], bed["r"], density, under=" under a lid of heavy grains")


def come_to_rest(recipe, x, y, r, density, lid_y=None, under=""):
    """Let grains fall until they are at rest, on the fast loop, under a rigid lid at `lid_y` if it is given; return the bed.

    `under` is a text on the lid for the progress message.
    """
    from yade import O

    scene.start(recipe.width, float(y.max()) + 2)
    scene.add_base(recipe.width, 1.0, recipe.material.density)
    beads = np.array(recipe.beads)
    scene.add_disks(
        beads[:, 0], beads[:, 1], np.full(len(beads), recipe.bead_radius), recipe.material.density, "xyzXYZ"
    )
    ids = scene.add_disks(x, y, r, density)
    print(
        f"settling a bed of {len(ids)} grains{under} until each has less than {recipe.rest:g} m g d of kinetic energy",
        file=sys.stderr,
    )
    rigid = None if lid_y is None else lid.add_rigid(recipe.width, lid_y, recipe.lid_pressure)
    scene.run_on("grain", recipe.material, gravity=1.0, largest_overlap=LARGEST_OVERLAP)
    O.dt = recipe.dt
    energy = run_until_at_rest(recipe, ids, density, fall_time=np.sqrt(2 * float(y.max())))
    bed = scene.rows_of(ids)
    facts = dict(kinetic_energy=energy, deepest_overlap=deepest_overlap(recipe, bed))
    if rigid is not None:
        facts["lid_y"] = O.bodies[rigid].state.pos[1]
    return {**{name: bed[name] for name in ("x", "y", "r")}, "density": density, **facts}


def deepest_overlap(recipe, bed):
    """Return the deepest overlap of a settled bed's grains [smaller radius]; RuntimeError if it is too deep for a bed at rest."""
    box = (0.0, recipe.width, -1.0, float(bed["y"].max()) + 1)
    deepest, i, j = engines.overlaps(box, True, np.c_[bed["x"] % recipe.width, bed["y"]], bed["r"])
    if deepest > 0.1:
        raise RuntimeError(
            f"grains {i} and {j} of the settled bed overlap by {deepest:.2g} of a radius; lower the time step"
        )
    return deepest


def run_until_at_rest(recipe, ids, density, fall_time):
    """Run in blocks of one time unit until the kinetic energy per grain is below `rest` m g d; return that energy.

    The energy is checked only after the time in which the highest grain falls down. A bed that does not come to rest in
    50 times that time raises RuntimeError: something gives it energy (too long a time step, grains inside the intruder).
    """
    from yade import O

    block, least = max(1, round(1 / O.dt)), fall_time / O.dt
    aim = Calming(
        lambda: kinetic_energy_per_grain(scene.rows_of(ids), density),
        recipe.rest,
        "m g d per grain",
        least,
    )
    progress.run_blocks(YadeMarch(len(ids)), round(50 * least), block, aim.reached, label="settling", aim=aim)
    if not aim.energy < recipe.rest:
        raise RuntimeError(
            f"the bed keeps a kinetic energy of {aim.energy:.2g} m g d per grain, over {recipe.rest:.2g};"
            " raise rest or lower dt_factor"
        )
    return aim.energy


def kinetic_energy_per_grain(grains, density):
    """Return the mean kinetic energy, translation and rotation, over the mean m g d of the grains (g = d = 1).

    `density` is one number for all grains, or of shape (n,).
    """
    mass = density * np.pi * grains["r"] ** 2
    energy = mass / 2 * (grains["vx"] ** 2 + grains["vy"] ** 2 + grains["r"] ** 2 / 2 * grains["spin"] ** 2)
    return float(energy.mean() / mass.mean())
