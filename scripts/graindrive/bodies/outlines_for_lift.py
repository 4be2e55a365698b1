"""Writes the outlines of bodies for tests of resistive-force theory: tilted plates and half-cylinders, in studies/shapes/.

    PYTHONPATH=build/python /usr/bin/python3 -m graindrive.bodies.outlines_for_lift

writes them again. Lengths in grain diameters; x is the direction of travel, y is up. A plate's tilt beta is counted from the
horizontal and is > 0 where its front edge is the higher one, so that the face which meets the grains looks down.
"""

import sys
from pathlib import Path

import numpy as np

from ..base.whole_files import write_text

LENGTH = 3.0  # d, of the plates
THICKNESS = 0.3  # d: thin, and yet twice as thick as the deepest overlap of a grain at the default of largest_overlap
DIAMETER = 3.3  # d, of the half-cylinders, as of the cylinder of the study
CHORDS = 24  # of a half circle; the area is 0.3 % less than the circle's
TILTS = (-67.5, -45.0, -22.5, 0.0, 22.5, 45.0, 67.5, 90.0)  # degrees; -90 is 90
FOLDER = Path(__file__).resolve().parents[3] / "studies" / "shapes"


def plate(tilt):
    """Return the corners (4, 2) of a plate tilted by `tilt` [degrees]."""
    half = np.array([LENGTH, THICKNESS]) / 2
    corners = half * [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    cos, sin = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    return corners @ np.array([[cos, sin], [-sin, cos]])


def half_cylinder(flat_up):
    """Return the corners (CHORDS + 1, 2) of a half circle, its flat side up or down."""
    angles = np.linspace(0, np.pi, CHORDS + 1) + (np.pi if flat_up else 0)
    return DIAMETER / 2 * np.column_stack([np.cos(angles), np.sin(angles)])


def outlines():
    """Return {name of the file: corners (n, 2)} of all bodies."""
    plates = {f"plate_{tilt:g}.csv": plate(tilt) for tilt in TILTS}
    return {**plates, "half_flat_up.csv": half_cylinder(True), "half_flat_down.csv": half_cylinder(False)}


def text_of(corners):
    """Return the text of an outline's file."""
    rounded = np.round(corners, 6) + 0.0  # no minus before a zero
    return "x [d], y [d]\n" + "".join(f"{x:g}, {y:g}\n" for x, y in rounded)


def write(folder):
    """Write all outlines into `folder`."""
    folder.mkdir(exist_ok=True)
    for name, corners in outlines().items():
        write_text(folder / name, text_of(corners))


if __name__ == "__main__":
    write(FOLDER)
    print(f"outlines: see {FOLDER}", file=sys.stderr)
