"""A lid in place of depth: it presses on a bed as much as the bed that was left out would weigh, and has as much mass.

`grains`: the uppermost layer of the bed is made heavier; it heaves and sags as a surface does. `rigid`: a row of disks
glued together, free to move up and down, lies on the bed and keeps it level.
"""

import numpy as np

from ..scenes import scene

LAYER = 5.0  # thickness of the heavy layer [d]
BED_FRACTION = 0.84  # area fraction of a settled bed of 0.9-1.1 d disks


def weight_of_bed(depth):
    """Return the weight over width [rho d g] of `depth` [d] of bed, 0 where there is none."""
    return 100 * BED_FRACTION * max(depth, 0.0) / 100  # in this order 55 d weigh 46.2 to the last bit


def heavy_layer(bed, width, pressure, density, area_fraction):
    """Return the densities (n,) of a settled bed's grains with which its uppermost layer presses by `pressure` more.

    `bed` holds y and r, shape (n,); the layer are the highest grains with the area of LAYER at `area_fraction`. Units of
    the caller with g = 1; `pressure` is weight over width, `density` that of the other grains.
    """
    areas = np.pi * bed["r"] ** 2
    from_the_top = np.argsort(-bed["y"], kind="stable")
    count = int(np.searchsorted(np.cumsum(areas[from_the_top]), LAYER * width * area_fraction)) + 1
    densities = np.full(len(areas), float(density))
    chosen = from_the_top[:count]
    densities[chosen] += pressure * width / areas[chosen].sum()
    return densities


def pressures_in_words(depth, papers_depth, load, is_auto):
    """Return the line that says which pressure acts at `depth` [d] under a lid of `load` [rho d g], and the paper's."""
    bed, papers = weight_of_bed(depth), weight_of_bed(papers_depth)
    return (
        f"pressure at the body's depth: {bed + load:.4g} rho d g, {bed:.4g} of the bed above and {load:.4g} of a lid"
        f" (lid_pressure={'auto' if is_auto else format(load, 'g')}); {papers:.4g} in the paper"
    )


def room(kind, pressure):
    """Return how much of the bed the lid takes for itself, from the surface down [d]."""
    return LAYER if pressure > 0 and kind == "grains" else 0.0


def add_rigid(width, y, pressure):
    """Put a row of glued disks of diameter 1 at height `y` that weighs `pressure` times `width` (g = 1); return its id."""
    density = pressure * width / (len(scene.row(width, 1.0)) * np.pi / 4)
    return scene.add_wall_clump(width, 1.0, density, y, blocked="xzXYZ")
