"""Makes beds of spheres at rest around a held solid, poured in two portions, optionally under a lid of heavy grains.

As in Guillard, Forterre, Pouliquen 2014: grains are poured up to the solid, the solid is put in, more are poured; then
a lid of heavy grains, a square lattice, is laid on them.
"""

import sys
from dataclasses import asdict, dataclass

import numpy as np

from . import cache, packing
from ..lazily import engines
from ..runs import progress
from ..scenes import scene, space
from ..solids import surfaces
from ..base.errors import UsageError
from ..scenes.material import HertzRestitutionSpheres
from ..runs.progress_line import Calming
from ..scenes.yade_march import YadeMarch

RECIPE = 1  # version of the recipe; increase it when the same parameters give a different bed
BED_FRACTION = 0.59  # volume fraction from which the number of grains is computed
INSERTION_FRACTION = 0.33
LARGEST_OVERLAP = (
    0.3  # [R] largest allowed overlap while a bed settles: a tall column that lands loads its foot heavily
)
LOOK_EVERY = 100  # steps between two checks of a bed that comes to rest
LOAD_ERROR = (
    1e-3  # allowed relative error of the forces on base and solid, at least the weight of one grain that may still roll
)
POURED_ERROR = 5e-3  # the same while a bed is poured
LOOKS_BORNE = 3  # number of successive checks in which the error must be allowed
MOST_LOOKS = 1000
MOST_GRAINS = 5_000_000


@dataclass(frozen=True)
class SphereBed:
    """A bed of spheres on a base at z = 0 around a held solid, lengths in m.

    The solid, given by the text `surface`, lies at (width/2, breadth/2, axis), reaches down to `bottom` [m] below the axis, and
    takes `volume` of the bed, which is `height` high. `gravity` [m/s^2]; `dt` [s] of the pouring. The bed counts as at rest if
    its kinetic energy per grain over m g d is below `rest`.
    """

    width: float
    breadth: float
    height: float
    d: float
    d_min: float
    d_max: float
    surface: str
    axis: float
    bottom: float
    volume: float
    material: HertzRestitutionSpheres
    gravity: float
    dt: float
    rest: float
    seed: int

    @property
    def centre(self):
        """Position of the solid's origin, (3,) [m]."""
        return np.array([self.width / 2, self.breadth / 2, self.axis])

    @property
    def grain_volume(self):
        """Mean volume of a grain [m^3]: that of diameters uniform from d_min to d_max."""
        return np.pi / 24 * (self.d_min + self.d_max) * (self.d_min**2 + self.d_max**2)

    def counts(self):
        """Return the number of grains below the solid's lowest point, and the number above it."""
        area = self.width * self.breadth
        below = BED_FRACTION * area * (self.axis - self.bottom) / self.grain_volume
        above = BED_FRACTION * (area * (self.height - self.axis + self.bottom) - self.volume) / self.grain_volume
        return round(below), round(above)


@dataclass(frozen=True)
class Lid:
    """A square lattice of grains of diameter d and `density` [kg/m^3], free only along z (with `turns` they may also rotate).

    With `bulk_gravity` False the grains below have no weight.
    """

    density: float
    turns: bool
    bulk_gravity: bool


def check(bed):
    """Raise UsageError for a bed with too few grains below or above the solid, or with more than a run can hold."""
    below, above = bed.counts()
    if min(below, above) < 1:
        raise UsageError(f"a bed with {below} grains below the body and {above} above it is too small; enlarge the box")
    if below + above > MOST_GRAINS:
        raise UsageError(
            f"the bed has {below + above:.3g} grains, more than {MOST_GRAINS:.0e}; lower width, breadth or height"
        )


def poured(bed):
    """Return a settled bed as a dict: centres x (n, 3) and radii r (n,) [m]; from the cache if possible."""
    return cache.cached("spheres", asdict(bed), RECIPE, lambda: pour(bed))


def at_rest(bed, lid):
    """Return a settled bed under its lid, at rest, as a dict; from the cache if possible.

    x (n, 3), r (n,) of its grains and lid (m, 3), centres [m]; springs and wall_springs of the contacts in GrainLoop's
    form, for the bodies of `build`; load_error: difference between the forces on base and solid and the weight, over the weight.
    """
    key = dict(bed=asdict(bed), lid=asdict(lid))
    return cache.cached("spheres-at-rest", key, RECIPE, lambda: rest_under(bed, lid, poured(bed)))


# ---- pouring -----------------------------------------------------------------------------------------------------


def pour(bed):
    """Pour grains up to the solid's lowest point, put the solid in, pour the others; return the bed."""
    from_above = surfaces.Surface(bed.surface)
    below, above = bed.counts()
    x, r = inserted(bed, below, bed.d / 2, None, 0.0, bed.seed)
    x = fallen(bed, x, r, with_solid=False, label="pouring up to the body")
    away = image_distance(bed, from_above)
    kept = away(x) > r
    x, r = x[kept], r[kept]
    more, radii = inserted(bed, above + below - len(x), float((x[:, 2] + r).max()), away, bed.volume, bed.seed + 1)
    x, r = np.concatenate([x, more]), np.concatenate([r, radii])
    return dict(x=fallen(bed, x, r, with_solid=True, label="pouring the rest"), r=r)


def image_distance(bed, surface):
    """Return a function that takes points (n, 3) and returns their distances to the solid's nearest image."""
    period = np.array([bed.width, bed.breadth])

    def distance(points):
        apart = np.atleast_2d(points) - bed.centre
        apart[:, :2] -= period * np.round(apart[:, :2] / period)
        return np.asarray(surface.distance(apart))

    return distance


def inserted(bed, count, low, keep_out, volume, seed):
    """Return centres (n, 3) and radii (n,) of about `count` spheres placed at random above the height `low`."""
    room = count * bed.grain_volume / INSERTION_FRACTION
    high = low + (room + volume) / (bed.width * bed.breadth) + 2 * bed.d_max
    box = (0, bed.width, 0, bed.breadth, low, high)
    fraction = count * bed.grain_volume / (packing.room_outside(np.array(box, float), keep_out))
    return packing.random_spheres(box, fraction, bed.d_min, bed.d_max, seed, periodic="xy", keep_out=keep_out)


def fallen(bed, x, r, with_solid, label):
    """Let spheres fall on the base, and on the solid, until they are at rest; return their centres within the box."""
    from yade import O

    space.start(bed.width, bed.breadth, float(x[:, 2].max()) + bed.height)
    base = space.add_base(bed.width, bed.breadth, bed.d, bed.material.density)
    solid = [space.add_solid(surfaces.Surface(bed.surface), bed.centre)] if with_solid else []
    ids = scene.add_spheres(x, r, bed.material.density)
    come_to_rest(bed, base, solid, ids, [], bed.gravity, np.sqrt(2 * float(x[:, 2].max()) / bed.gravity), label)
    centres = np.array([O.bodies[i].state.pos for i in ids])
    return in_box(bed, centres)


def in_box(bed, centres):
    """Return centres moved by whole periods into the box."""
    moved = centres.copy()
    moved[:, :2] %= np.array([bed.width, bed.breadth])
    return moved


# ---- the bed at rest ---------------------------------------------------------------------------------------------


def build(bed, lid, x, r, lid_at):
    """Put base, solid, grains and lid into YADE; return their ids: base, body, grains and lid (lists for the last two)."""
    space.start(bed.width, bed.breadth, bed.height + 20 * bed.d)
    base = space.add_base(bed.width, bed.breadth, bed.d, bed.material.density)
    body = space.add_solid(surfaces.Surface(bed.surface), bed.centre)
    ids = scene.add_spheres(x, r, bed.material.density)
    lids = scene.add_spheres(lid_at, np.full(len(lid_at), bed.d / 2), lid.density, "xy" if lid.turns else "xyXYZ")
    return dict(base=base, body=body, grains=ids, lid=lids)


def lid_above(bed, lid, x, r):
    """Return the initial centres (m, 3) of the lid's grains, above the bed; none for a lid without weight."""
    if lid.density == 0:
        return np.zeros((0, 3))
    return space.lattice(bed.width, bed.breadth, bed.d, float((x[:, 2] + r).max()) + bed.d / 2)


def weight_on_lid(bed, lid):
    """Return the force (3,) [N] on each of the lid's grains if gravity acts only on the lid."""
    return (0.0, 0.0, -lid.density * np.pi / 6 * bed.d**3 * bed.gravity)


def rest_under(bed, lid, arrays):
    """Lay the lid on a settled bed and let both come to rest; return the dict of `at_rest`."""
    from yade import O

    x, r = arrays["x"], arrays["r"]
    made = build(bed, lid, x, r, lid_above(bed, lid, x, r))
    gravity = bed.gravity if lid.bulk_gravity else 0.0
    words = "letting the bed rest" + (" under its lid" if made["lid"] else "")
    error = come_to_rest(bed, made["base"], [made["body"]], made["grains"], made["lid"], gravity, 0, words, lid)
    loop = scene.fast_loop()
    centres = in_box(bed, np.array([O.bodies[i].state.pos for i in made["grains"]]))
    lids = np.array([O.bodies[i].state.pos for i in made["lid"]]).reshape(-1, 3)
    springs = dict(springs=np.array(loop.springs), wall_springs=np.array(loop.wallSprings))
    return dict(x=centres, r=r, lid=lids, load_error=error, **springs)


def come_to_rest(bed, base, solid, ids, lids, gravity, fall_time, label, lid=None):
    """Run on GrainLoop until the grains are at rest and base and solid carry the weight; return the relative error.

    A bed under a heavy lid oscillates for long, because contacts damp slow motion little. So all motion is stopped whenever the
    force on base and solid passes through the weight: there the kinetic energy of the oscillation is largest. RuntimeError for a
    bed that does not come to rest.
    """
    from yade import O

    binners = [engines.ContactForceBinner(body=i, planeNormal=(0, 1, 0), count=4, every=20) for i in (base, *solid)]
    loop = space.run_on_grain_loop(
        bed.material, (0, 0, -gravity), binners, largestOverlap=LARGEST_OVERLAP, threads=scene_threads()
    )
    if lids and gravity == 0:
        space.load_all(lids, weight_on_lid(bed, lid))
    O.dt = bed.dt
    mass = bed.material.density * bed.grain_volume
    weight = total_weight(bed, ids, lids, gravity, lid)
    state = Swing(weight, max(LOAD_ERROR, mass * bed.gravity / weight) if lid else POURED_ERROR)
    unit = mass * bed.gravity * bed.d * len(ids)
    aim = Calming(lambda: loop.kineticEnergy / unit, bed.rest, "m g d per grain", round(fall_time / bed.dt))

    def look(done):
        if done < aim.least_steps:
            return False
        state.see(-sum(binner.lastForce[2] for binner in binners))
        if state.passes_the_weight:
            space.halt()
        return aim.energy < bed.rest and state.borne >= LOOKS_BORNE

    most = round(aim.least_steps) + MOST_LOOKS * LOOK_EVERY
    progress.run_blocks(YadeMarch(len(ids)), most, LOOK_EVERY, look, label=label, aim=aim)
    if not (aim.energy < bed.rest and state.borne >= LOOKS_BORNE):
        raise RuntimeError(
            f"the bed does not come to rest: kinetic energy {aim.energy:.2g} m g d per grain, the forces on base and body"
            f" differ from the weight by {state.error:.2g} of it; lower dt_factor or lid_density"
        )
    space.halt()
    print(
        f"{label}: {len(ids)} grains at rest, base and body carry the weight to within {state.error:.1e}",
        file=sys.stderr,
    )
    return state.error


class Swing:
    """The force that base and solid carry: its relative `error`, and whether it has just passed through the weight.

    `borne` counts the successive checks in which the error was at most `allowed`.
    """

    def __init__(self, weight, allowed):
        self.weight, self.allowed = weight, allowed
        self.error, self.borne, self.passes_the_weight = -1.0, 0, False

    def see(self, force):
        """Note the present force."""
        error = force / self.weight - 1
        farthest = max(abs(error), abs(self.error))
        self.borne = self.borne + 1 if farthest < self.allowed else 0
        self.passes_the_weight = error * self.error <= 0 and farthest >= self.allowed
        self.error = error


def total_weight(bed, ids, lids, gravity, lid):
    """Return the weight of grains and lid [N]."""
    from yade import O

    grains = sum(O.bodies[i].state.mass for i in ids) * gravity
    return grains + (len(lids) * -weight_on_lid(bed, lid)[2] if lids else 0.0)


def scene_threads():
    """Return the useful number of threads for the present scene: at most YADE's, and one per 20,000 spheres."""
    from yade import O

    return min(O.numThreads, 1 + len(O.bodies) // 20_000)


# ---- properties of a bed -----------------------------------------------------------------------------------------


def fraction_by_height(z, r, edges, area):
    """Return the volume fraction of spheres in slabs between heights `edges` (m + 1,) of a box of `area`, shape (m,).

    This is exact: a sphere has the volume pi t^2 (r - t/3) below z - r + t.
    """
    below = np.array([np.sum(cap(edge - z, r)) for edge in edges])
    return np.diff(below) / (np.diff(edges) * area)


def cap(above_centre, r):
    """Return the volume of spheres of radius r below a plane that is `above_centre` above their centres."""
    t = np.clip(above_centre + r, 0, 2 * r)
    return np.pi * t**2 * (r - t / 3)


FACTS = ("bulk_fraction", "effective_depth", "bed_weight", "lid_weight")


def facts(bed, lid, found):
    """Return properties and weights of a bed at rest (`at_rest`), a dict of `FACTS`.

    bulk_fraction is the volume fraction away from base and surface, without the solid. effective_depth [m] is the weight of
    all grains above the solid's origin, with the solid's upper part counted as filled with grains, over the weight of bed per
    unit depth: h + (pi d/6) rho*/rho of Guillard et al. for a lid with one grain per d^2. Weights in N.
    """
    z, r, area = found["x"][:, 2], found["r"], bed.width * bed.breadth
    volumes = 4 / 3 * np.pi * r**3
    surface = float((z + r).max())
    low, high = (share * surface for share in (0.2, 0.85))
    slab = area * (high - low) - bed.volume
    fraction = float(fraction_by_height(z, r, np.array([low, high]), area)[0] * area * (high - low) / slab)
    above = float(volumes.sum() - cap(bed.axis - z, r).sum()) / area + fraction * bed.volume / 2 / area
    lid_volume = len(found["lid"]) * np.pi / 6 * bed.d**3 * lid.density / bed.material.density
    depth = (above if lid.bulk_gravity else 0.0) / fraction + lid_volume / area / fraction
    weight = bed.material.density * bed.gravity
    bulk = float(volumes.sum()) * weight if lid.bulk_gravity else 0.0
    values = fraction, float(depth), bulk, float(lid_volume * weight)
    return dict(zip(FACTS, values))
