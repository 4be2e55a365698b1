"""Makes channels of disks at a given area fraction between two rough walls, around a held body.

The three methods (insertion, closing walls, thinning) follow Kumar, Dhiman, Reddy, Phys. Rev. E 99, 012902 (2019), section II.
Channels are stored in the cache.
"""

from dataclasses import asdict, replace

import numpy as np

from . import cache
from .channel_recipe import ChannelRecipe, check, finished, insert
from .closing_walls import close
from ..base.errors import UsageError

RECIPE = 2  # version of the recipe; increase it when the same parameters give a different channel
THINNED_FROM, INSERTED_BELOW = 0.78, 0.5  # the paper's bounds between its three recipes

__all__ = ["ChannelRecipe", "channel", "check", "check_room"]


def check_room(width, height, diameter):
    """Raise UsageError for a channel that is too small for a body of that diameter; all in d."""
    least = 2 * diameter + 4
    if min(width, height) < least:
        raise UsageError(
            f"a channel of {width:g} d x {height:g} d is too small for a body of {diameter:g} d;"
            f" both must be at least {least:g} d"
        )


def fraction_after(phi, grain_area, widening):
    """Return the area fraction after the area between the walls has grown by `widening`; it was `phi` before."""
    return grain_area / (grain_area / phi + widening)


def channel(recipe):
    """Return a channel as a dict: x, y, r of its grains, shape (n,); phi, mean kinetic energy, deepest overlap.

    The same recipe gives the same channel; it is taken from the cache if possible. Raises UsageError for an area
    fraction that cannot be reached, with the one that was reached.
    """
    check(recipe)
    if INSERTED_BELOW <= recipe.phi < THINNED_FROM:
        return thinned(recipe, channel(replace(recipe, phi=THINNED_FROM)))
    plain = {**asdict(recipe), "beads": rows(recipe.beads), "outline": rows(recipe.outline)}
    return cache.cached("channel", plain, RECIPE, lambda: build(recipe))


def rows(points):
    """Return rows of numbers as plain lists, for the cache's key."""
    return [list(map(float, row)) for row in points]


def build(recipe):
    """Make the channel by insertion or by closing walls; return its arrays."""
    if recipe.phi < INSERTED_BELOW:
        x, y, r = insert(recipe, recipe.height)
        return finished(recipe, x, y, r, energy=0.0)
    return close(recipe)


def thinned(recipe, denser):
    """Return the channel after grains were removed at random until its area fraction is that of the recipe."""
    order = np.random.default_rng(recipe.seed).permutation(len(denser["r"]))
    kept_area = np.cumsum(np.pi * denser["r"][order] ** 2)
    count = 1 + np.argmin(np.abs(kept_area - recipe.phi * recipe.free_area()))
    kept = np.sort(order[:count])
    return finished(recipe, *(denser[name][kept] for name in ("x", "y", "r")), energy=float(denser["kinetic_energy"]))
