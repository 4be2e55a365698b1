"""The body that a study drives: its outline by name or from a file, turned, with the clump of beads along it."""

import functools
import hashlib
import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import engines
from .errors import UsageError, one_line


@dataclass(frozen=True)
class Intruder:
    """A body about its centroid: corners of its outline, shape (m, 2) [d], and the clump from `engines.clump_of`.

    `area` [d^2] and `fall_height` [d] are the outline's own, exact for a disk: from the lowest point with a vertical
    tangent to the top (the cavity model's l).
    """

    vertices: np.ndarray
    area: float
    fall_height: float
    clump: object

    @property
    def height(self):
        """Extent along y [d]."""
        return float(np.ptp(self.vertices[:, 1]))

    def placed(self, at):
        """Return rows x, y of beads and of corners with the centroid at `at`, as hashable tuples."""
        return tuple(map(tuple, self.clump.beads + at)), tuple(map(tuple, self.vertices + at))


def make(shape, *, orientation_deg, bead_diameter, bead_spacing, mass):
    """Return the `Intruder` of that shape, turned counter-clockwise about its centroid by `orientation_deg`.

    `shape` is a name that `engines.outline_of` knows or a file of vertices; lengths in d, `bead_spacing` in bead
    diameters, mass in rho d^2. Raises UsageError for what cannot be a body.
    """
    try:
        is_file = names_a_file(shape)
        drawn = engines.read_outline(os.path.expanduser(shape)) if is_file else engines.outline_of(shape)
    except ValueError as error:
        raise not_a_body(shape, error) from None
    outline = drawn.turned(math.radians(orientation_deg))
    clump = beads_along(outline, shape, bead_diameter, bead_spacing, mass)
    return Intruder(outline.vertices - np.array(outline.centroid), outline.area, outline.fall_height, clump)


def beads_along(outline, shape, bead_diameter, bead_spacing, mass):
    """Return the clump of beads along the outline of `shape`; UsageError if they do not fit."""
    try:
        return engines.clump_of(outline, bead_diameter, mass, bead_spacing)
    except ValueError as error:
        raise not_a_body(shape, error) from None


def not_a_body(shape, error):
    """Return the UsageError that says why a shape cannot be a body (without words where a file holds no text)."""
    reason = one_line(error, 400) or "it must be a text file of vertices in WKT or CSV"
    return UsageError(f"shape={one_line(shape)}: {reason}")


def names_a_file(shape):
    """True for an outline's file, False for the name of a built-in shape."""
    return shape.lower().endswith((".wkt", ".csv"))


@functools.lru_cache(maxsize=None)
def contents_of(path):
    """Return what stands for a file's contents, as they are when the program first asks; "" if it cannot be read."""
    try:
        return hashlib.sha256(Path(path).expanduser().read_bytes()).hexdigest()[:12]
    except (OSError, RuntimeError):
        return ""


def check_room(body, *, swing, width, height, depth, lid):
    """Raise UsageError unless a bed has room for the body and its motion.

    The body's centre lies `depth` below the surface of a bed `width` wide and `height` high and moves by `swing` to either
    side; the uppermost `lid` of the bed is not for it. All in d.
    """
    (left, bottom), (right, top) = body.vertices.min(axis=0), body.vertices.max(axis=0)
    needed = right - left + 2 * swing + 4
    if needed > width:
        raise UsageError(
            f"width={width:g} d is too small for the body and its motion, which need {needed:g} d;"
            " raise width or lower amplitude"
        )
    if height - depth + bottom < 1:
        raise UsageError(
            f"height={height:g} d and depth={depth:g} d put the body into the base; raise height or lower depth"
        )
    if depth < top + lid:
        free = f"bed below its lid of {lid:g} d" if lid else "bed"
        raise UsageError(
            f"depth={depth:g} d lets the body stick out of the {free} by {top + lid - depth:g} d; raise depth"
        )
