"""The body of the Magnus study: an exact disk, or another shape as beads along its outline, of a given size."""

from dataclasses import dataclass

import numpy as np

from . import engines, intruder, scene


@dataclass(frozen=True)
class Body:
    """A body about its centroid: bead centres (n, 2) and their radius, corners (m, 2) ((0, 2) for a single disk), area, mass."""

    beads: np.ndarray
    bead_radius: float
    outline: np.ndarray
    area: float
    mass: float
    clump: object = None

    def as_arrays(self, unit):
        """Return what a run folder keeps of it, for the group `intruder`."""
        arrays = dict(beads=(self.beads, unit), bead_radius=(self.bead_radius, unit))
        return {**arrays, "outline": (self.outline, unit)} if len(self.outline) else arrays


def body_of(shape, size, bead_diameter, density):
    """Return the `Body` of that shape: a disk of diameter `size`, or an outline scaled to `size` as its longer side.

    Lengths in one unit, density in mass over its square. Raises UsageError for a shape that cannot be a body.
    """
    if shape == "disk":
        area = np.pi * size**2 / 4
        return Body(np.zeros((1, 2)), size / 2, np.zeros((0, 2)), area, density * area)
    drawn = intruder.make(shape, orientation_deg=0, bead_diameter=1e-3, bead_spacing=1, mass=1)
    outline = engines.Outline(drawn.vertices * size / np.ptp(drawn.vertices, axis=0).max())
    mass = density * outline.area
    clump = intruder.beads_along(outline, shape, bead_diameter, 1, mass)
    return Body(clump.beads, clump.bead_radius, outline.vertices - outline.centroid, outline.area, mass, clump)


def add(body, x, y, density):
    """Put the body into YADE at (x, y), held; return its id."""
    if body.clump is None:
        return scene.add_disks([x], [y], [body.bead_radius], density, "xyzXYZ")[0]
    return scene.add_intruder(body.clump, x, y)
