"""Makes drums half full of disks: the rough wall is one clump, grains are poured into it at rest and stored in the cache.

The scene of Oba, Otsuki, "Scaling laws for velocity profile of granular flow in rotating drums" (2025), section II.2.
"""

import sys
from dataclasses import asdict, dataclass
from types import SimpleNamespace

import numpy as np

from . import cache, packing
from ..lazily import engines
from ..scenes import scene
from ..base.errors import UsageError
from ..scenes.material import SpringDashpotMaterial

RECIPE = 1  # version of the recipe; increase it when the same parameters give a different drum
CLEARANCE = 0.02  # [d] initial gap between neighbours, and between grains and wall
STIR = 1.0  # [sqrt(g d)] initial speed of the grains; random motion destroys the order of the lattice
WALL_MASS = 1e9  # [rho d^2] of the whole wall; so large that the reduced mass of a contact with it is the grain's mass
MOST_FILLING = 0.7  # largest filling: the grains of such a bed, of 1 to 1.2 d, still fit in as a loose lattice


@dataclass(frozen=True)
class DrumRecipe:
    """A resting drum, its axis at the origin, with a wall of `wall_disks` disks of diameter 1 centred on its circle.

    Lengths in d, times in sqrt(d/g), masses in rho d^2. Grains have diameters uniform in d_min..d_max. `material` is used for
    the pouring. The grains count as settled if their kinetic energy per grain is below `rest` [m g d].
    """

    diameter: float
    wall_disks: int
    grains: int
    d_min: float
    d_max: float
    material: SpringDashpotMaterial
    dt: float
    rest: float
    seed: int

    @property
    def room(self):
        """Radius of the circle that grains may fill [d]."""
        return self.diameter / 2 - 0.5

    @property
    def pitch(self):
        """Spacing of the square lattice on which the grains are placed [d]: the lattice fills the whole room."""
        return float(np.sqrt(np.pi) * (self.room - self.d_max / 2) / np.sqrt(self.grains))


def settled(recipe):
    """Return a drum's settled grains as a dict: x, y, r, shape (n,), kinetic energy per grain, deepest overlap [smaller radius].

    The same recipe gives the same grains; they are taken from the cache if possible.
    """
    check(recipe)
    return cache.cached("drum", asdict(recipe), RECIPE, lambda: pour(recipe))


def check(recipe):
    """Raise UsageError for a drum that has no grain, too many grains, or no room for its grains."""
    if recipe.grains < 1:
        raise UsageError(
            f"a drum of {recipe.diameter:g} d holds no grain at this filling; raise filling or drum_diameter"
        )
    if recipe.grains > packing.MOST_GRAINS:
        raise UsageError(
            f"a drum of {recipe.diameter:g} d would hold {recipe.grains:.3g} grains, more than {packing.MOST_GRAINS};"
            " lower drum_diameter"
        )
    lattice_of(recipe)


def too_full(recipe):
    """Return the UsageError for grains that do not fit."""
    return UsageError(
        f"{recipe.grains} grains of up to {recipe.d_max:g} d do not fit loosely into a drum of {recipe.diameter:g} d;"
        " lower filling or grains"
    )


def filling_by_level():
    """Return (share of a drum's area below a level, height of the level above the bottom over the diameter), each (n,)."""
    level = np.linspace(-0.5, 0.5, 4001)
    area = np.cumsum(np.sqrt(np.maximum(0.25 - level**2, 0)))
    return area / area[-1], level + 0.5


def wall_places(diameter, disks):
    """Return (x, y) of the wall's disks, equally spaced on the circle of that diameter, each (disks,)."""
    angle = 2 * np.pi * np.arange(disks) / disks
    return diameter / 2 * np.cos(angle), diameter / 2 * np.sin(angle)


def add_wall(diameter, disks):
    """Add the wall of disks of diameter 1 as one clump with all motions blocked; return the clump's id."""
    beads = np.column_stack(wall_places(diameter, disks))
    inertia = WALL_MASS * (diameter**2 / 4 + 1 / 8)
    wall = SimpleNamespace(beads=beads, bead_radius=0.5, mass=WALL_MASS, inertia=inertia)
    return scene.add_intruder(wall, 0.0, 0.0)


def start():
    """Empty YADE's scene and make it non-periodic."""
    from yade import O

    O.reset()
    O.periodic = False


def place(recipe):
    """Return x, y, r of grains on a jittered square lattice that fills the drum loosely, each (grains,)."""
    rng = np.random.default_rng(recipe.seed)
    r = engines.uniform_radii(recipe.grains, recipe.d_min, recipe.d_max, recipe.seed)
    pitch, reach = lattice_of(recipe)
    sites = np.arange(-np.ceil(reach / pitch), np.ceil(reach / pitch) + 1) * pitch
    x, y = (axis.ravel() for axis in np.meshgrid(sites, sites))
    inside = np.flatnonzero(np.hypot(x, y) <= reach)
    chosen = np.sort(rng.permutation(inside)[: recipe.grains])
    jitter = rng.uniform(-1, 1, (2, recipe.grains)) * (pitch - recipe.d_max - CLEARANCE) / 2
    return x[chosen] + jitter[0], y[chosen] + jitter[1], r


def lattice_of(recipe):
    """Return (spacing of the lattice, radius within which its sites lie) with room for all grains and their jitter."""
    pitch = recipe.pitch
    while pitch >= recipe.d_max + CLEARANCE:
        reach = recipe.room - recipe.d_max / 2 - (pitch - recipe.d_max) / np.sqrt(2)
        n = np.arange(-np.ceil(reach / pitch), np.ceil(reach / pitch) + 1)
        if np.count_nonzero(np.hypot(*np.meshgrid(n, n)) * pitch <= reach) >= recipe.grains:
            return pitch, reach
        pitch *= 0.995
    raise too_full(recipe)


def pour(recipe):
    """Let the grains fall onto the wall, which is at rest, until they are at rest; return them."""
    from yade import O
    from yade.minieigenHP import Vector3

    x, y, r = place(recipe)
    start()
    add_wall(recipe.diameter, recipe.wall_disks)
    ids = scene.add_disks(x, y, r, recipe.material.density)
    stir = np.random.default_rng(recipe.seed + 1).normal(0, STIR / np.sqrt(2), (len(ids), 2))
    for id_, (vx, vy) in zip(ids, stir):
        O.bodies[id_].state.vel = Vector3(float(vx), float(vy), 0)
    print(
        f"pouring {len(ids)} grains into a drum until each has less than {recipe.rest:g} m g d of kinetic energy",
        file=sys.stderr,
    )
    scene.run_on("grain", recipe.material, gravity=1.0, largest_overlap=packing.LARGEST_OVERLAP)
    O.dt = recipe.dt
    density = recipe.material.density
    energy = packing.run_until_at_rest(recipe, ids, density, fall_time=np.sqrt(2 * recipe.diameter))
    bed = scene.rows_of(ids)
    require_inside(recipe.diameter, bed)
    deepest = deepest_overlap(recipe, bed)
    return {**{name: bed[name] for name in ("x", "y", "r")}, "kinetic_energy": energy, "deepest_overlap": deepest}


def deepest_overlap(recipe, bed):
    """Return the deepest overlap of two of the drum's grains [smaller radius]."""
    reach = recipe.diameter / 2
    deepest, _, _ = engines.overlaps((-reach, reach, -reach, reach), False, np.c_[bed["x"], bed["y"]], bed["r"])
    return deepest


def require_inside(diameter, rows):
    """Raise RuntimeError if a grain of `rows` has left the drum through its wall."""
    reach = np.hypot(rows["x"], rows["y"])
    if len(reach) and not reach.max() < diameter / 2:
        raise RuntimeError(
            f"a grain left the drum of {diameter:g} d: it is {reach.max():.4g} d from the axis; lower dt_factor"
        )
