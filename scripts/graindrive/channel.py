"""Channels of disks at a given area fraction between two rough walls, around a held body: insertion, closing walls, thinning.

The recipes of Kumar, Dhiman, Reddy, Phys. Rev. E 99, 012902 (2019), section II. The area fraction is that of the free area:
between the centre lines of the walls, without the wall disks' halves in it and without the body.
"""

import os
import sys
from dataclasses import asdict, dataclass, replace

import numpy as np

from . import cache, engines, packing, progress, scene
from .errors import UsageError
from .material import HertzHistoryMaterial

RECIPE = 1  # raise it when a channel of the same parameters comes out different
THINNED_FROM, INSERTED_BELOW = 0.78, 0.5  # the paper's bounds between its three recipes
INSERTION_FRACTION = 0.45  # random insertion jams near 0.547
TOLERANCE = 1e-3  # of the area fraction
DEEPEST_OVERLAP = 0.01  # [R] where closing walls count as jammed
CLOSING_DEPTH = 0.03  # [R] of overlap for which the time step of the preparation is chosen
MOST_STOPS = 50  # until grains that are stopped again and again count as pressed
MOST_GRAINS = 10_000_000


@dataclass(frozen=True)
class ChannelRecipe:
    """A channel periodic in x, 0 <= x < width, between rows of frozen disks of diameter d centred at y = ±(height - d)/2.

    Any consistent units: lengths, masses by `material.density`, times by its stiffness. Grains have diameters uniform in
    d_min..d_max. `beads` are rows x, y of the held body's bead centres, `outline` rows x, y of its corners, () for a single
    disk. Walls close in with `closing_speed` under `material`, which may differ from the run's; grains count as at rest
    when their mean kinetic energy is below that of the speed `rest_speed`.
    """

    width: float
    height: float
    d: float
    d_min: float
    d_max: float
    phi: float
    material: HertzHistoryMaterial
    beads: tuple
    bead_radius: float
    outline: tuple
    body_area: float
    closing_speed: float
    rest_speed: float
    seed: int

    def free_area(self, height=None):
        """Return the area that is free to grains in a channel of `height` (by default the recipe's own)."""
        disks = round(self.width / self.d)  # of each wall; half of each disk lies inside the centre lines
        return self.width * ((height or self.height) - self.d) - disks * np.pi * self.d**2 / 4 - self.body_area

    def height_for(self, area, fraction):
        """Return the height in which grains of that `area` are the `fraction` of the free area."""
        return self.height + (area / fraction - self.free_area()) / self.width


def channel(recipe):
    """Return a channel as a dict: x, y, r of its grains, shape (n,); phi, mean kinetic energy, deepest overlap.

    The same recipe gives the same channel; it is taken from the cache when it is there. Raises UsageError for an area
    fraction that cannot be reached, with what was.
    """
    check(recipe)
    if INSERTED_BELOW <= recipe.phi < THINNED_FROM:
        return thinned(recipe, channel(replace(recipe, phi=THINNED_FROM)))
    plain = {**asdict(recipe), "beads": rows(recipe.beads), "outline": rows(recipe.outline)}
    return cache.cached("channel", plain, RECIPE, lambda: build(recipe))


def rows(points):
    """Return rows of numbers as plain lists, for the cache's key."""
    return [list(map(float, row)) for row in points]


def check(recipe):
    """Raise UsageError for a channel without room, or whose walls cannot be tiled."""
    if abs(recipe.width / recipe.d - round(recipe.width / recipe.d)) > 1e-9:
        raise UsageError(f"width must be a whole number of wall disks, got {recipe.width / recipe.d:g}; round it")
    grains = recipe.phi * recipe.free_area() / mean_area(recipe)
    if not 1 <= grains <= MOST_GRAINS:
        raise UsageError(
            f"the channel would hold {grains:.3g} grains; between 1 and {MOST_GRAINS} are possible: change width or height"
        )


def mean_area(recipe):
    """Return the mean area of disks with diameters uniform in d_min..d_max."""
    return np.pi / 12 * (recipe.d_max**2 + recipe.d_max * recipe.d_min + recipe.d_min**2)


def build(recipe):
    """Make the channel by insertion or by closing walls; return its arrays and what was reached."""
    if recipe.phi < INSERTED_BELOW:
        x, y, r = insert(recipe, recipe.height)
        return finished(recipe, x, y, r, energy=0.0)
    return close(recipe)


def radii_for(recipe):
    """Return the radii whose areas sum to `phi` of the free area, to within half a grain."""
    wanted = recipe.phi * recipe.free_area()
    radii = engines.uniform_radii(int(wanted / (np.pi / 4 * recipe.d_min**2)) + 1, recipe.d_min, recipe.d_max, recipe.seed)
    return radii[: 1 + np.argmin(np.abs(np.cumsum(np.pi * radii**2) - wanted))]


def insert(recipe, height):
    """Place the grains at random between walls `height` apart, clear of the body; return x, y, r."""
    radii = radii_for(recipe)
    inner = height / 2 - recipe.d  # nowhere in reach of a wall disk
    obstacles = packing.keep_clear(recipe)
    try:
        centres = engines.random_insertion((0, recipe.width, -inner, inner), True, radii, obstacles, recipe.seed)
    except ValueError as error:
        raise UsageError(f"phi={recipe.phi:g} is too dense for this box: {error}; lower phi or enlarge the box") from None
    return centres[:, 0], centres[:, 1], radii


def finished(recipe, x, y, r, energy):
    """Return the arrays of a channel with its measured area fraction, which must be the one asked for."""
    reached = float(np.sum(np.pi * r**2) / recipe.free_area())
    if abs(reached - recipe.phi) > TOLERANCE:
        raise UsageError(
            f"phi={recipe.phi:g} cannot be reached to {TOLERANCE:g} with {len(r)} whole grains, {reached:.4f} was;"
            " enlarge the box"
        )
    limit = recipe.height / 2
    deepest, _, _ = engines.overlaps((0, recipe.width, -limit, limit), True, np.c_[x % recipe.width, y], r)
    return dict(x=x % recipe.width, y=y, r=r, phi=reached, kinetic_energy=energy, deepest_overlap=deepest)


def thinned(recipe, denser):
    """Return the channel with grains taken away at random until its area fraction is the recipe's."""
    order = np.random.default_rng(recipe.seed).permutation(len(denser["r"]))
    kept_area = np.cumsum(np.pi * denser["r"][order] ** 2)
    count = 1 + np.argmin(np.abs(kept_area - recipe.phi * recipe.free_area()))
    kept = np.sort(order[:count])
    return finished(recipe, *(denser[name][kept] for name in ("x", "y", "r")), energy=float(denser["kinetic_energy"]))


# Closing walls ---------------------------------------------------------------------------------------------------------


def close(recipe):
    """Let the walls of a wide channel close in until it has its height and its grains rest; return its arrays.

    Grains start with the velocity of their share of the way, v_y = -v y/y_wall, so that the channel shrinks as a whole.
    Walls that push grains at rest leave the density of jamming behind them and a dilute middle: 0.84 and 0.53 at an area
    fraction of 0.78.
    """
    area = np.sum(np.pi * radii_for(recipe) ** 2)
    start = recipe.height_for(area, INSERTION_FRACTION)
    x, y, r = insert(recipe, start)
    scene.start(recipe.width, start)
    walls = [scene.add_wall_clump(recipe.width, recipe.d, recipe.material.density, side * (start - recipe.d) / 2) for side in (-1, 1)]
    beads = np.array(recipe.beads)
    scene.add_disks(beads[:, 0], beads[:, 1], np.full(len(beads), recipe.bead_radius), recipe.material.density, "xyzXYZ")
    ids = scene.add_disks(x, y, r, recipe.material.density)
    steps, speed = bring_together(recipe, walls, start)
    scene.set_motion(ids, -speed * y / ((start - recipe.d) / 2))
    print(f"closing walls on {len(ids)} grains from {start:.3g} to {recipe.height:.3g}, {steps} steps", file=sys.stderr)
    progress.run_blocks(steps, 1000, lambda done: stop_if_jammed(recipe, area, walls), grains=len(ids), label="closing walls")
    halt(walls)
    energy = rest(recipe, ids)
    stop_if_jammed(recipe, area, walls)
    packed = scene.rows_of(ids)
    return finished(recipe, packed["x"], packed["y"], packed["r"], energy)


def bring_together(recipe, walls, start):
    """Put the loop and the drives of the walls into YADE; return the steps until they are where they belong, and their speed."""
    from yade import O

    way = (start - recipe.height) / 2
    O.dt = 0.45 * recipe.material.critical_time_step(recipe.d_min / 2, CLOSING_DEPTH)
    steps = int(np.ceil(way / (recipe.closing_speed * O.dt)))
    speed = way / (steps * O.dt)
    drives = [
        engines.SpinTranslateDrive(body=wall, velocity=(0, -side * speed, 0)) for wall, side in zip(walls, (-1, 1))
    ]
    scene.run_on("grain", recipe.material, gravity=0.0, between=drives, largest_overlap=CLOSING_DEPTH, threads=free_cores())
    return steps, speed


def free_cores(most=2):
    """Return how many threads find a core of their own now: on a busy machine two that wait for each other are slower."""
    return int(np.clip(len(os.sched_getaffinity(0)) - os.getloadavg()[0] + 0.5, 1, most))


def halt(walls):
    """Take the drives away and stop the walls where they are."""
    from yade import O
    from yade.minieigenHP import Vector3

    O.engines = [engine for engine in O.engines if not isinstance(engine, engines.SpinTranslateDrive)]
    for wall in walls:
        O.bodies[wall].state.vel = Vector3.Zero


def stop_if_jammed(recipe, area, walls):
    """Raise UsageError with the area fraction reached so far, if grains are pressed together beyond jamming."""
    from yade import O

    contacts = scene.fast_loop().contacts()
    deepest = contacts["overlap"].max(initial=0.0)
    if deepest > DEEPEST_OVERLAP * recipe.d / 2:
        height = O.bodies[walls[1]].state.pos[1] - O.bodies[walls[0]].state.pos[1] + recipe.d
        raise UsageError(
            f"phi={recipe.phi:g} is beyond jamming: at {area / recipe.free_area(height):.4f} grains overlap by"
            f" {2 * deepest / recipe.d:.2g} R; lower phi"
        )


def rest(recipe, ids):
    """Stop the grains until they do not set out again; return their mean kinetic energy over that of `rest_speed`.

    Below jamming nothing but collisions stops them, and the slack between the walls sloshes for minutes at a few mm/s. So
    velocities are set to zero, and the springs of what still overlaps push it apart, until that gives no more motion.
    """
    from yade import O

    limit = len(ids) * mean_area(recipe) * recipe.material.density * recipe.rest_speed**2 / 2
    block = int(np.ceil(recipe.d / recipe.rest_speed / O.dt / 100))
    loop = scene.fast_loop()
    for _ in range(MOST_STOPS):
        scene.set_motion(ids, 0.0)
        progress.run_blocks(block, block, grains=len(ids), label="coming to rest")
        energy = loop.kineticEnergy / limit
        if energy < 1:
            return energy
    raise RuntimeError(f"grains keep a kinetic energy of {energy:.3g} times that at {recipe.rest_speed:g}")
