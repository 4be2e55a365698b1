"""The recipe for a channel of disks: walls, free area, the grains for an area fraction, their random insertion.

The area fraction of Kumar, Dhiman, Reddy, Phys. Rev. E 99, 012902 (2019), section II, is that of the free area: between the
centre lines of the walls, without the wall disks' halves in it and without the body.
"""

from dataclasses import dataclass

import numpy as np

from ..lazily import engines
from . import packing
from ..base.errors import UsageError
from ..scenes.material import HertzHistoryMaterial

TOLERANCE = 1e-3  # of the area fraction
MOST_GRAINS = 10_000_000


@dataclass(frozen=True)
class ChannelRecipe:
    """A channel periodic in x, 0 <= x < width, between rows of frozen disks of diameter d centred at y = ±(height - d)/2.

    Any consistent units: lengths, masses by `material.density`, times by its stiffness. Grains have diameters uniform in
    d_min..d_max. `beads` are rows x, y of the held body's bead centres, `outline` rows x, y of its corners, () for a single
    disk. Walls close in with `closing_speed`; `material` is used for this and may differ from the run's. Grains count as at
    rest when their mean kinetic energy is below that of the speed `rest_speed`.
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
        disks = round(self.width / self.d)  # per wall; half of each disk lies inside the centre lines
        return self.width * ((height or self.height) - self.d) - disks * np.pi * self.d**2 / 4 - self.body_area

    def height_for(self, area, fraction):
        """Return the height at which grains with the total `area` cover the `fraction` of the free area."""
        return self.height + (area / fraction - self.free_area()) / self.width


def check(recipe):
    """Raise UsageError for a channel without room, or if its length is no whole number of wall disks."""
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


def radii_for(recipe):
    """Return radii whose areas sum to `phi` times the free area, to within half a grain."""
    wanted = recipe.phi * recipe.free_area()
    radii = engines.uniform_radii(
        int(wanted / (np.pi / 4 * recipe.d_min**2)) + 1, recipe.d_min, recipe.d_max, recipe.seed
    )
    return radii[: 1 + np.argmin(np.abs(np.cumsum(np.pi * radii**2) - wanted))]


def insert(recipe, height):
    """Place the grains at random between walls `height` apart, clear of the body; return x, y, r."""
    radii = radii_for(recipe)
    inner = height / 2 - recipe.d  # out of reach of the wall disks
    obstacles = packing.keep_clear(recipe)
    try:
        centres = engines.random_insertion((0, recipe.width, -inner, inner), True, radii, obstacles, recipe.seed)
    except ValueError as error:
        raise UsageError(
            f"phi={recipe.phi:g} is too dense for this box: {error}; lower phi or enlarge the box"
        ) from None
    return centres[:, 0], centres[:, 1], radii


def finished(recipe, x, y, r, energy):
    """Return the arrays of a channel with its measured area fraction, which must agree with the recipe's."""
    reached = float(np.sum(np.pi * r**2) / recipe.free_area())
    if abs(reached - recipe.phi) > TOLERANCE:
        raise UsageError(
            f"phi={recipe.phi:g} cannot be reached to {TOLERANCE:g} with {len(r)} whole grains, {reached:.4f} was;"
            " enlarge the box"
        )
    limit = recipe.height / 2
    deepest, _, _ = engines.overlaps((0, recipe.width, -limit, limit), True, np.c_[x % recipe.width, y], r)
    return dict(x=x % recipe.width, y=y, r=r, phi=reached, kinetic_energy=energy, deepest_overlap=deepest)
