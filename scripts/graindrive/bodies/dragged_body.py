"""The solid that the lift study drags: a cylinder, an outline swept along y, or a function of distance, from a file."""

import functools
import os
from dataclasses import dataclass

import numpy as np

from . import intruder
from ..solids import surface_nets, surfaces
from ..base.errors import UsageError, one_line

SAMPLED = ".py"  # the ending of a file that defines distance(points)
SPACING = 0.1  # d, of the grid in which a distance is sampled, unless its file says otherwise


@dataclass(frozen=True)
class DraggedBody:
    """A solid relative to its own origin, lengths in m: `surface`, corners `low` and `high` (3,) of its box, `volume`.

    `endless` bodies fill the box's breadth along y; their low and high in y are minus and plus half the breadth. `outline` (m, 2)
    holds the corners x, z of their section; other bodies have none, (0, 2).
    """

    surface: object
    low: np.ndarray
    high: np.ndarray
    volume: float
    endless: bool
    outline: np.ndarray

    @property
    def height(self):
        """Extent along z [m], the D of the drag coefficient; a cylinder's diameter."""
        return float(self.high[2] - self.low[2])

    @property
    def breadth(self):
        """Extent along y [m], the L of the drag coefficient."""
        return float(self.high[1] - self.low[1])

    def described(self):
        """Return the arrays that a run folder stores, by name [m]: outline, low, high; for bodies without outline a mesh."""
        told = dict(outline=self.outline, low=self.low, high=self.high)
        if not len(self.outline):
            told["points"], told["quads"] = surface_nets.mesh(self.surface, self.low, self.high)
        return told


def of_shape(shape, diameter, breadth, d):
    """Return the `DraggedBody` of a shape: "cylinder" of that diameter, or a body from a file, in grain diameters.

    `.csv` and `.wkt` hold an outline in the plane of x, the direction of travel, and z, up, that is swept along y; `.py` a
    Python function `distance(points)`, see `sampled_from`. diameter, breadth of the box and d in m. UsageError for other shapes.
    """
    if shape == "cylinder":
        return cylinder(diameter, breadth)
    if shape.lower().endswith(SAMPLED):
        return sampled_from(shape, d)
    if intruder.names_a_file(shape):
        return swept(shape, breadth, d)
    raise UsageError(
        f"shape must be cylinder, or a file: an outline (.csv, .wkt) or a function of distance (.py), got {one_line(shape)}"
    )


def cylinder(diameter, breadth):
    """Return an endless cylinder along y."""
    half = np.array([diameter / 2, breadth / 2, diameter / 2])
    made = surfaces.cylinder((0, 0, 0), (0, 1, 0), diameter / 2)
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    circle = diameter / 2 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return DraggedBody(made, -half, half, np.pi * diameter**2 / 4 * breadth, True, circle)


def swept(shape, breadth, d):
    """Return the outline of a file, swept along y; its x is the direction of travel, its y is up."""
    outline = intruder.outline_of(shape)
    corners = np.array(outline.vertices) * d
    prism = surfaces.swept_outline(corners).placed(axis=(1, 0, 0), angle=np.pi / 2)  # y to z, z to -y
    (x_low, z_low), (x_high, z_high) = corners.min(axis=0), corners.max(axis=0)
    low, high = np.array([x_low, -breadth / 2, z_low]), np.array([x_high, breadth / 2, z_high])
    return DraggedBody(prism, low, high, outline.area * d**2 * breadth, True, corners)


def sampled_from(path, d):
    """Return the body that a Python file describes, in grain diameters about its own origin.

    It defines `distance(points)`, which gives the signed distances (n,) of points (n, 3), > 0 outside; `low` and `high`,
    corners of the box to sample it in, which reach beyond the body by the radius of a grain; and, if wanted, `spacing` of
    the samples. The normal is computed from the sampled distance. UsageError with the reason for any other file.
    """
    told = told_by(path)
    try:
        low, high, spacing = (np.array(told[name], float) for name in ("low", "high", "spacing"))
        made = surfaces.sampled(lambda points: distances(told, points / d) * d, low * d, high * d, float(spacing) * d)
        points = grid(low, high, float(spacing))
        distance = distances(told, points)
    except (Exception, SystemExit) as error:  # a user's function may raise any error
        raise UsageError(
            f"shape={one_line(path)}: {one_line(error, 400)} (lengths are in grain diameters, distances > 0 outside)"
        ) from None
    if not np.any(distance < 0):
        raise UsageError(
            f"shape={one_line(path)}: distance(points) is nowhere negative between low and high, so the body has no inside;"
            " lengths are in grain diameters, and distances are > 0 outside of the body"
        )
    low, high = extent(points, distance, spacing)
    volume = np.clip(0.5 - distance / spacing, 0, 1).sum() * spacing**3
    return DraggedBody(made, low * d, high * d, float(volume * d**3), False, np.zeros((0, 2)))


def distances(told, points):
    """Return what a file's function says of points (n, 3), (n,); it gets a copy, which it may change."""
    return np.asarray(told["distance"](points.copy()), float)


def extent(points, distance, spacing):
    """Return the corners of a body's box, from points (n, 3) `spacing` apart and their distances (n,).

    A ball about a point that reaches the surface ends nowhere beyond the body's own end: inside, because the body contains it;
    outside, because it contains a point of the body. The error is of the order spacing^2 over the radius of curvature.
    """
    near = np.abs(distance) <= 0.6 * spacing  # one of two neighbours on either side of the surface is that near
    points, distance = points[near], distance[near, None]
    return (points + distance).min(axis=0), (points - distance).max(axis=0)


@functools.lru_cache(maxsize=None)
def told_by(path):
    """Return the names that a Python file defines; UsageError unless distance, low and high are among them."""
    file, names = os.path.expanduser(path), {"spacing": SPACING}
    try:
        with open(file, encoding="utf-8") as text:
            exec(compile(text.read(intruder.LARGEST_FILE), file, "exec"), names)
    except OSError as error:
        raise UsageError(
            f"shape={one_line(path)}: {error.strerror}; name a file that defines distance(points)"
        ) from None
    except (Exception, SystemExit) as error:
        raise UsageError(f"shape={one_line(path)}: {type(error).__name__}: {one_line(error, 400)}") from None
    missing = [name for name in ("distance", "low", "high") if name not in names]
    if missing:
        raise UsageError(
            f"shape={one_line(path)}: the file must define distance(points), low and high; it lacks {' and '.join(missing)}"
        )
    if np.shape(names["low"]) != (3,) or np.shape(names["high"]) != (3,):
        raise UsageError(f"shape={one_line(path)}: low and high must be three numbers each [d]")
    return names


def grid(low, high, spacing):
    """Return points `spacing` apart in a box, shape (n, 3)."""
    axes = [np.arange(a + spacing / 2, b, spacing) for a, b in zip(low, high)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def names_a_file(shape):
    """True for a shape that a file describes."""
    return intruder.names_a_file(shape) or shape.lower().endswith(SAMPLED)
