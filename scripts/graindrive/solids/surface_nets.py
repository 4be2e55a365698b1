"""The surface of a solid known by its distance, as a closed mesh of quads: surface nets (Gibson 1998)."""

import itertools

import numpy as np

CELLS = 48  # along the longest side of the box


def mesh(surface, low, high):
    """Return points (n, 3) [m] and quads (m, 4), counter-clockwise seen from outside, of a solid within low, high (3,) [m].

    A step along the normal puts the points of the nets onto the surface.

    surface: answers `distance(points)` and `normal(points)` as those of `surfaces`. Parts and holes thinner than a 48th of
    the box's longest side may be lost. A solid that fills no node gives empty arrays.
    """
    low, high = np.asarray(low, float), np.asarray(high, float)
    step = float((high - low).max()) / CELLS
    count = np.ceil((high - low) / step).astype(int) + 5
    start = (low + high - (count - 1) * step) / 2
    nodes = np.stack(np.meshgrid(*(a + step * np.arange(n) for a, n in zip(start, count)), indexing="ij"), axis=-1)
    values = np.asarray(surface.distance(nodes.reshape(-1, 3)), float).reshape(count)
    places, index = vertices(values)
    points = start + step * places
    if len(points):
        points = points - np.asarray(surface.distance(points))[:, None] * np.asarray(surface.normal(points))
    return points, quads(values < 0, index)


def vertices(values):
    """Return one place (n, 3) for each cell that the surface crosses, in nodes, and the place's row by cell, -1 without."""
    cells = tuple(n - 1 for n in values.shape)
    total, number = np.zeros((*cells, 3)), np.zeros(cells)
    for axis in range(3):
        for sides in itertools.product((0, 1), repeat=2):
            corner = np.insert(sides, axis, 0)
            begin, end = at(values, corner, cells), at(values, corner + np.eye(3, dtype=int)[axis], cells)
            crossed = (begin < 0) != (end < 0)
            share = np.divide(begin, begin - end, out=np.zeros(cells), where=crossed)
            total += crossed[..., None] * (corner + share[..., None] * np.eye(3)[axis])
            number += crossed
    met = number > 0
    index = np.full(cells, -1)
    index[met] = np.arange(met.sum())
    return np.argwhere(met) + total[met] / number[met][:, None], index


def at(values, corner, cells):
    """Return the values in one corner, (3,) of 0 or 1, of all cells."""
    return values[tuple(slice(c, c + n) for c, n in zip(corner, cells))]


def quads(inside, index):
    """Return a quad (m, 4) of the four cells around each edge between a node inside and one outside."""
    found = [np.zeros((0, 4), int)]
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        along = np.moveaxis(inside, axis, 0)
        begin, end = (np.moveaxis(part, 0, axis) for part in (along[:-1], along[1:]))
        for nodes, turn in ((begin & ~end, 1), (~begin & end, -1)):
            edge = np.argwhere(nodes)
            around = [tuple((edge - offset).T) for offset in (u + v, v, 0 * u, u)]
            found.append(np.stack([index[cell] for cell in around], axis=1)[:, ::turn])
    return np.concatenate(found)
