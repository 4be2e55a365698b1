"""A lid that replaces part of a bed's depth: it has the weight and the mass of the missing part of the bed.

`grains`: the uppermost layer of the bed is made heavier; it deforms like a free surface. `rigid`: a row of disks
glued together lies on the bed and keeps its surface level; it is free to move up and down.
"""

import numpy as np

from ..scenes import scene

LAYER = 5.0  # thickness of the heavy layer [d]
BED_FRACTION = 0.84  # area fraction of a settled bed of 0.9-1.1 d disks


def weight_of_bed(depth):
    """Return the weight over width [rho d g] of a bed of depth `depth` [d], 0 for depth <= 0."""
    return 100 * BED_FRACTION * max(depth, 0.0) / 100  # in this order 55 d give exactly 46.2


def heavy_layer(bed, width, pressure, density, area_fraction):
    """Return the densities (n,) of a settled bed's grains with which its uppermost layer adds `pressure` to the bed.

    `bed` holds y and r, shape (n,); the layer consists of the highest grains that fill LAYER at `area_fraction`. Units of
    the caller with g = 1; `pressure` is weight over width, `density` is the density of the other grains.
    """
    areas = np.pi * bed["r"] ** 2
    from_the_top = np.argsort(-bed["y"], kind="stable")
    count = int(np.searchsorted(np.cumsum(areas[from_the_top]), LAYER * width * area_fraction)) + 1
    densities = np.full(len(areas), float(density))
    chosen = from_the_top[:count]
    densities[chosen] += pressure * width / areas[chosen].sum()
    return densities


def pressures_in_words(depth, papers_depth, load, is_auto):
    """Return a line on the pressure at `depth` [d] under a lid of `load` [rho d g], and on the paper's pressure."""
    bed, papers = weight_of_bed(depth), weight_of_bed(papers_depth)
    return (
        f"pressure at the body's depth: {bed + load:.4g} rho d g, {bed:.4g} from the bed above and {load:.4g} from a lid"
        f" (lid_pressure={'auto' if is_auto else format(load, 'g')}); {papers:.4g} in the paper"
    )


def room(kind, pressure):
    """Return the thickness of the uppermost part of the bed that the lid occupies [d]."""
    return LAYER if pressure > 0 and kind == "grains" else 0.0


def add_rigid(width, y, pressure):
    """Put a row of glued disks of diameter 1 at height `y` that weighs `pressure` times `width` (g = 1); return its id."""
    density = pressure * width / (len(scene.row(width, 1.0)) * np.pi / 4)
    return scene.add_wall_clump(width, 1.0, density, y, blocked="xzXYZ")
