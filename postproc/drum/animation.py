"""A film of a drum run (MP4): grains, the continuum, or both side by side, coloured by speed, in the turning wall."""

from dataclasses import dataclass
from typing import Optional

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import PowerNorm
from matplotlib.patches import Wedge

from .. import films
from ..figures import BLACK, GREY, colour_bar, draw_grains, set_title
from ..reader import BEAD, Frame
from . import figure as drawing
from .flow_frames import FlowFrame, FlowFrames

MAP = "YlGnBu"
SECTORS = 36  # of the wall, in two colours by turns, which show how it turns
SAMPLE = 12  # frames that the scale of colours is taken from
BRIGHTEST = 0.998  # quantile of the speeds at which the scale ends
RIM = 0.012  # of the diameter: thickness of a continuum's wall in the picture
ARROWS = 5.0  # d, edge of the squares with an arrow, or an eighteenth of the drum
SEEN = 0.5  # of the surface's level: with less there is nothing to be seen


@dataclass(frozen=True)
class Moment:
    """A frame of the film: `grains` (reader.Frame) and `flow` of the continuum, None where the run has none; time `t`."""

    t: float
    grains: Optional[Frame]
    flow: Optional[FlowFrame]


class Moments:
    """The frames of a drum run as a sequence of `Moment`s.

    Of both models each picture of grains has the continuum's that is nearest in time beside it: after the end of the
    continuum's run, in which it became steady, its last.
    """

    def __init__(self, run):
        self.grains, self.flow = films.GrainFrames(run), FlowFrames(run)
        self.times = np.array([self.flow.time(k) for k in range(len(self.flow))])

    def __len__(self):
        return len(self.grains) or len(self.flow)

    @property
    def apart(self):
        """The time between two pictures of the continuum, 0 with fewer: pictures that lie further apart are of another moment."""
        return float(np.max(np.diff(self.times))) if len(self.times) > 1 else 0.0

    def __getitem__(self, k):
        if not len(self.grains):
            flow = self.flow[k]
            return Moment(flow.t, None, flow)
        grains = self.grains[k]
        flow = self.flow[int(np.argmin(np.abs(self.times - grains.t)))] if len(self.times) else None
        return Moment(grains.t, grains, flow)


def film(path):
    """Write animation.mp4 into the run folder `path`, in one step; raises RunError where that cannot be."""
    return films.film(path, prepared, Moments)


def prepared(run):
    """Return a figure and the function that draws a `Moment` into it."""
    moments, p = Moments(run), run.parameters
    models = [name for name, frames in (("grains", moments.grains), ("continuum", moments.flow)) if len(frames)]
    norm, radius = PowerNorm(0.5, 0, fastest(moments, p)), p["drum_diameter"] / 2
    width, height = 2.3 * radius * len(models) + 0.3 * radius, 2.3 * radius
    figure, axes = plt.subplots(
        1, len(models), figsize=films.picture_size(width, height), squeeze=False, layout="constrained"
    )
    set_title(figure, drawing.title(run))
    panels = dict(zip(models, axes[0]))

    def draw(moment):
        for name, panel in panels.items():
            panel.clear()
            t = draw_model(panel, name, moment, p, norm)
            panel.set(xlim=(-1.06 * radius, 1.06 * radius), ylim=(-1.06 * radius, 1.06 * radius), aspect="equal")
            panel.set(xlabel="$X$  [$d$]", ylabel="$Y$  [$d$]")
            colour_bar(panel, ScalarMappable(norm, MAP), r"$|\mathbf{v}|/\Omega D$", extend="max")
            ended = " (steady, its run has ended)" if t < moment.t - moments.apart else ""
            panel.set_title(f"{name}, turned by {np.degrees(p['angular_velocity'] * t):.1f}°{ended}")

    return figure, draw


def fastest(moments, p):
    """Return the speed over Omega D at which the scale of colours ends, from some frames all over the film."""
    scale, speeds = p["angular_velocity"] * p["drum_diameter"], [np.zeros(1)]
    for k in np.unique(np.linspace(0, len(moments) - 1, SAMPLE).round().astype(int)):
        moment = moments[int(k)]
        if moment.grains is not None:
            speeds.append(moment.grains.speed)
        if moment.flow is not None:
            speeds.append(speed_of(moment.flow.field).compressed())
    return max(0.5, float(np.quantile(np.concatenate(speeds), BRIGHTEST)) / scale)  # at least the wall's 1/2


def speed_of(field):
    """Return the speed of a continuum where it is to be seen, a masked array (ny, nx)."""
    return np.ma.masked_where(
        ~(field.fraction > SEEN * field.surface_level), np.hypot(field.velocity_x, field.velocity_y)
    )


def draw_model(axes, name, moment, p, norm):
    """Draw one model at a moment; return the time that the picture is of."""
    scale = p["angular_velocity"] * p["drum_diameter"]
    if name == "grains":
        draw_bed(axes, moment.grains, scale, norm)
        return moment.grains.t
    draw_flow(axes, moment.flow, p, scale, norm)
    return moment.flow.t


def draw_bed(axes, seen, scale, norm):
    """Draw the grains of a frame by their speed, and the wall's disks in sectors of two colours."""
    draw_grains(axes, *(seen.grains[name] for name in "xyr"), values=seen.speed / scale, cmap=MAP, norm=norm)
    disks = seen.disks()
    wall = np.flatnonzero(disks["role"] == BEAD)
    sector = np.arange(len(wall)) * SECTORS // max(1, len(wall)) % 2
    for k, colour in enumerate((BLACK, GREY)):
        draw_grains(axes, *(disks[name][wall[sector == k]] for name in "xyr"), colour=colour)


def draw_flow(axes, seen, p, scale, norm):
    """Draw a continuum by its speed, with arrows of its velocity, its surface, and the wall in sectors of two colours."""
    field, radius = seen.field, p["drum_diameter"] / 2
    axes.pcolormesh(field.x, field.y, speed_of(field) / scale, shading="nearest", rasterized=True, cmap=MAP, norm=norm)
    edge = max(ARROWS, p["drum_diameter"] / 18)
    x, y, v_x, v_y = drawing.in_squares(field, edge)
    axes.quiver(
        x, y, v_x, v_y, angles="xy", scale_units="xy", scale=0.5 * scale / edge, color=BLACK, width=0.003, pivot="mid"
    )
    drawing.draw_level(axes, field, radius, BLACK)
    turned, sector = np.degrees(p["angular_velocity"] * seen.t), 360 / SECTORS
    for k in range(SECTORS):
        low = turned + k * sector
        colour = (BLACK, GREY)[k % 2]
        axes.add_patch(
            Wedge((0, 0), radius + RIM * 2 * radius, low, low + sector, width=RIM * 2 * radius, color=colour)
        )
