"""The body of a Magnus run as it is at a moment: its outline turned by its angle, a disk with a mark, and the way it spins."""

from pathlib import Path

import numpy as np
from matplotlib.patches import Circle

from .. import figures
from ..figures import GREY


def name_of(run):
    """Return the body's shape in words."""
    shape = str(run.parameters.get("shape", "disk"))
    return Path(shape).stem.replace("$", r"\$")


def turned(run, bed=None):
    """Return the angle [rad] by which the body has turned at a frame, by its beads; at the end of the run without one."""
    body = run.group("intruder")
    if bed is None or "x" not in bed.intruder:
        p, d = run.parameters, run.constants.get("d", np.nan)
        spin = p["spin_ratio"] * p["v0"] / (p["intruder_diameter"] * d / 2)
        return float(spin * run.series["t"][-1]) if p["spin_ratio"] else 0.0
    along = np.diff(bed.place(np.array([[0.0, 0.0], [1.0, 0.0]]), body["beads"]), axis=0)[0]
    return float(np.arctan2(along[1], along[0]))


def draw(axes, run, angle, *, centre=(0.0, 0.0), unit, swept=False):
    """Draw the body about `centre` [unit], turned by `angle` [rad]; `unit` is what a length of 1 is [m].

    `swept` adds the circle that a turning body other than a disk sweeps: averages over time see it instead of the body.
    """
    body, spin = run.group("intruder"), run.parameters["spin_ratio"]
    beads, radius = body["beads"] / unit, float(np.atleast_1d(body["bead_radius"])[0]) / unit
    if "outline" not in body or len(body["outline"]) < 3:
        figures.draw_disk(axes, centre, radius, angle=angle if spin else None, spin=spin)
        return
    cos, sin = np.cos(angle), np.sin(angle)
    corners = body["outline"] / unit @ np.array([[cos, sin], [-sin, cos]]) + centre
    figures.draw_body(axes, corners)
    reach = np.hypot(*beads.T).max() + radius
    if spin and swept:
        axes.add_patch(
            Circle(centre, reach, fill=False, edgecolor=GREY, linewidth=0.6, linestyle=(0, (3, 2)), zorder=3)
        )
    figures.draw_spin(axes, centre, 0.3 * reach, spin)
