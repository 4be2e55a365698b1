"""Disks that cover the inside of an outline, so that a packing puts no grain there."""

import numpy as np

SAMPLES = 16  # points on the outline per spacing of the grid: the error of distances to it is 1/2000 of the spacing
MARGIN = 1e-3  # of the spacing, more than that error: a disk that would barely touch the outline is left out


def disks_inside(outline, spacing):
    """Return rows x, y, radius of disks inside the closed polygon `outline` (m, 2), shape (n, 3).

    They have the radius `spacing` and lie on a square grid of that spacing, wherever such a disk fits in. They cover the whole
    inside except a strip along the outline that is narrower than two spacings.
    """
    from scipy.spatial import cKDTree  # this import takes half a second, and help does not need it

    grid = grid_inside(outline, spacing)
    if len(grid) == 0:
        return np.zeros((0, 3))
    away, _ = cKDTree(points_along(outline, spacing / SAMPLES)).query(
        grid, distance_upper_bound=2 * spacing
    )  # else infinite
    grid = grid[away > spacing * (1 + MARGIN)]
    return np.c_[grid, np.full(len(grid), spacing)]


def grid_inside(outline, spacing):
    """Return the points of a square grid that lie in the closed polygon, row by row, shape (n, 2).

    The edges cut a row into pieces that are outside and inside by turns.
    """
    (x0, y0), (x1, y1) = outline.min(axis=0), outline.max(axis=0)
    (ax, ay), (bx, by) = outline.T, np.roll(outline, -1, axis=0).T
    across, rows = np.arange(x0, x1, spacing), []
    for y in np.arange(y0, y1, spacing):
        cut = (ay > y) != (by > y)
        at = np.sort(ax[cut] + (y - ay[cut]) / (by[cut] - ay[cut]) * (bx[cut] - ax[cut]))
        x = across[np.searchsorted(at, across) % 2 == 1]
        rows.append(np.c_[x, np.full(len(x), y)])
    return np.concatenate(rows)


def points_along(outline, spacing):
    """Return points on the edges of the closed polygon, corners included, at most `spacing` apart, shape (n, 2)."""
    edges = np.roll(outline, -1, axis=0) - outline
    counts = np.ceil(np.hypot(*edges.T) / spacing).astype(int).clip(1)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    part = (np.arange(counts.sum()) - first) / np.repeat(counts, counts)
    return np.repeat(outline, counts, axis=0) + part[:, None] * np.repeat(edges, counts, axis=0)
