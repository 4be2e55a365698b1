"""The body of the Magnus study: an exact disk, or another shape as beads along its outline, of a given size."""

from dataclasses import dataclass

import numpy as np

from . import intruder, scene

COARSE = 0.01  # bead diameter for a first look at a shape's size, in its own units


@dataclass(frozen=True)
class Body:
    """A body about its centroid: bead centres (n, 2) and their radius, corners (m, 2), (0, 2) for a single disk; area, mass."""

    beads: np.ndarray
    bead_radius: float
    outline: np.ndarray
    area: float
    mass: float
    inertia: float

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
        return Body(np.zeros((1, 2)), size / 2, np.zeros((0, 2)), area, density * area, density * area * size**2 / 8)
    drawn = made(shape, COARSE, 1.0)
    scale = size / np.ptp(drawn.vertices, axis=0).max()
    area = drawn.area * scale**2
    clump = made(shape, bead_diameter / scale, density * area).clump
    radius, inertia = clump.bead_radius * scale, clump.inertia * scale**2
    return Body(clump.beads * scale, radius, drawn.vertices * scale, area, density * area, inertia)


def made(shape, bead_diameter, mass):
    """Return the `Intruder` of that shape in its own units, upright, with touching beads."""
    return intruder.make(shape, orientation_deg=0, bead_diameter=bead_diameter, bead_spacing=1, mass=mass)


def add(body, x, y, density):
    """Put the body into YADE at (x, y), held; return its id."""
    if len(body.outline) == 0:
        return scene.add_disks([x], [y], [body.bead_radius], density, "xyzXYZ")[0]
    return scene.add_intruder(body, x, y)
