"""The body that a study drives: a disk, or an outline by name or from a file, turned, with a clump of beads along it."""

import functools
import hashlib
import math
import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..lazily import engines
from ..scenes import scene
from ..base.errors import UsageError, one_line
from ..parameters import StudyParameters

LARGEST_FILE = 4 << 20  # bytes; engines.read_outline reads no more


MOST_BEADS = 10_000  # each bead is a disk in YADE


@dataclass(frozen=True)
class Intruder:
    """A body about its centroid: `beads` (n, 2), their `bead_radius`, corners of its `outline` (m, 2), mass and inertia.

    A single exact disk has one bead and no outline, (0, 2). `area` and `fall_height` are the outline's own, exact for a
    disk: the latter is from the lowest point with a vertical tangent to the top (the cavity model's l). Units are the
    caller's.
    """

    beads: np.ndarray
    bead_radius: float
    outline: np.ndarray
    area: float
    fall_height: float
    mass: float
    inertia: float

    @property
    def height(self):
        """Extent along y of a body with an outline."""
        return float(np.ptp(self.outline[:, 1]))

    def placed(self, at):
        """Return the data for a packing's recipe, with the centroid at `at`: beads and outline as rows, the beads' radius."""
        beads, outline = (tuple(map(tuple, points + at)) for points in (self.beads, self.outline))
        return dict(beads=beads, bead_radius=self.bead_radius, outline=outline)

    def scaled(self, factor):
        """Return the body with all lengths times `factor` and the same mass."""
        lengths = {name: getattr(self, name) * factor for name in ("beads", "bead_radius", "outline", "fall_height")}
        return replace(self, **lengths, area=self.area * factor**2, inertia=self.inertia * factor**2)

    def as_arrays(self, unit):
        """Return the arrays of the group `intruder` of a run folder."""
        arrays = dict(beads=(self.beads, unit), bead_radius=(self.bead_radius, unit))
        return {**arrays, "outline": (self.outline, unit)} if len(self.outline) else arrays


def exact_disk(diameter, density):
    """Return a disk made of one bead; the unit of density is mass over the square of the diameter's unit."""
    radius, area = diameter / 2, np.pi * diameter**2 / 4
    inertia = density * area * diameter**2 / 8
    return Intruder(np.zeros((1, 2)), radius, np.zeros((0, 2)), area, radius, density * area, inertia)


def make(shape, *, bead_diameter, mass, orientation_deg=0, bead_spacing=1):
    """Return the `Intruder` of that shape, turned counter-clockwise about its centroid by `orientation_deg`.

    `shape` is a name that `engines.outline_of` knows or a file of vertices; lengths in d, `bead_spacing` in bead
    diameters. Raises UsageError for an invalid body.
    """
    outline = outline_of(shape, orientation_deg)
    require_length(shape, np.ptp(about_centroid(outline), axis=0).max())
    return beads_along(outline, shape, bead_diameter, bead_spacing, mass)


def require_length(shape, length):
    """Raise UsageError for a shape whose `length` is below 1 d: its file may be in metres."""
    if length < 1:
        raise UsageError(
            f"shape={one_line(shape)} is {length:.3g} d long, less than a grain; its lengths are in grain diameters, so divide"
            " them by d"
        )


def of_size(shape, size, bead_diameter, density):
    """Return a disk of diameter `size` for "disk", else the outline of that shape scaled to `size` as its longer side.

    Lengths in one unit, density in mass over its square. Raises UsageError for what cannot be a body.
    """
    if shape == "disk":
        return exact_disk(size, density)
    outline = outline_of(shape)
    scale = size / np.ptp(about_centroid(outline), axis=0).max()
    mass = density * (outline.area * scale**2)
    return beads_along(outline, shape, bead_diameter / scale, 1, mass).scaled(scale)


def outline_of(shape, orientation_deg=0):
    """Return the outline given by a name or a file, relative to its centroid, rotated; UsageError if there is none.

    `orientation_deg` may be any finite number; whole turns are subtracted first, without round-off.
    """
    try:
        is_file = names_a_file(shape)
        drawn = engines.read_outline(os.path.expanduser(shape)) if is_file else engines.outline_of(shape)
    except ValueError as error:
        raise not_a_body(shape, error) from None
    return drawn.about_centroid.turned(math.radians(math.remainder(orientation_deg, 360)))


def about_centroid(outline):
    """Return the corners of an outline about its centroid, shape (m, 2)."""
    return outline.about_centroid.vertices


def beads_along(outline, shape, bead_diameter, bead_spacing, mass):
    """Return the `Intruder` with beads along the outline of `shape`; UsageError if they do not fit."""
    check_bead_count(outline, shape, bead_diameter * bead_spacing)
    try:
        clump = engines.clump_of(outline, bead_diameter, mass, bead_spacing)
    except ValueError as error:
        raise not_a_body(shape, error) from None
    own = about_centroid(outline), outline.area, outline.fall_height
    return Intruder(clump.beads, clump.bead_radius, *own, clump.mass, clump.inertia)


def check_bead_count(outline, shape, step):
    """Raise UsageError for an outline on which beads `step` apart, in its unit, would be more than a run can move."""
    corners = outline.vertices
    count = np.hypot(*(corners - np.roll(corners, 1, axis=0)).T).sum() / step
    if not count <= MOST_BEADS:
        raise UsageError(
            f"shape={one_line(shape)} needs {count:.3g} beads, more than {MOST_BEADS}; raise bead_diameter [d], or make"
            " the outline smaller: its lengths are in grain diameters"
        )


def add_held(body, x, y, density):
    """Put a body that only a drive moves into YADE at (x, y), as a clump or a single disk; return its id."""
    if len(body.outline) == 0:
        return scene.add_disks([x], [y], [body.bead_radius], density, "xyzXYZ")[0]
    return scene.add_intruder(body, x, y)


def not_a_body(shape, error):
    """Return the UsageError that says why a shape cannot be a body; `error` has no message if a file holds no text."""
    reason = one_line(error, 400) or "it must be a text file of vertices in WKT or CSV"
    return UsageError(f"shape={one_line(shape)}: {reason}")


def names_a_file(shape):
    """True for an outline's file, False for the name of a built-in shape."""
    return shape.lower().endswith((".wkt", ".csv"))


class BodyParameters(StudyParameters):
    """Parameters of a study whose key `shape` may name an outline's file."""

    def identity(self):
        """Return all that decides the result: for an outline from a file its contents too, not the name alone."""
        outline = {"outline": contents_of(self.shape)} if names_a_file(self.shape) else {}
        return {**super().identity(), **outline}


@functools.lru_cache(maxsize=None)
def contents_of(path):
    """Return a digest of a file's contents at the first call of the program; "" if the file cannot be an outline.

    A pipe or a device is not opened, because its contents may have no end.
    """
    file = Path(os.path.expanduser(path))
    try:
        if not file.is_file() or file.stat().st_size > LARGEST_FILE:
            return ""
        return hashlib.sha256(file.read_bytes()).hexdigest()[:12]
    except OSError:
        return ""


def check_room(body, *, swing, width, height, depth, lid):
    """Raise UsageError unless a bed has room for the body and its motion.

    The body's centre lies `depth` below the surface of a bed `width` wide and `height` high and moves by `swing` to either
    side; it must stay below the uppermost part of thickness `lid`. All lengths in d.
    """
    (left, bottom), (right, top) = body.outline.min(axis=0), body.outline.max(axis=0)
    needed = right - left + 2 * swing + 4
    wrong = []
    if needed > width:
        wrong.append(
            f"width={width:g} d is too small for the body and its motion, which need {needed:g} d; raise width or lower amplitude"
        )
    if height - depth + bottom < 1:
        wrong.append(
            f"height={height:g} d and depth={depth:g} d put the body into the base; raise height or lower depth"
        )
    if depth < top + lid:
        free = f"bed below its lid of {lid:g} d" if lid else "bed"
        wrong.append(
            f"depth={depth:g} d lets the body protrude from the {free} by {top + lid - depth:g} d; raise depth"
        )
    if wrong:
        raise UsageError("; and ".join(wrong))
