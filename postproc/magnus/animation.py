"""A film of a Magnus run (MP4): the body in the middle as it turns, grains that pass by coloured by speed over V0."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import PowerNorm

from .. import films
from ..figures import GREY, colour_bar, draw_grains, set_title
from ..reader import GRAIN
from . import body
from . import figure as drawing

MAP = "viridis"
VIEW = np.array([120.0, 80.0])  # d, width and height; of a larger channel the part around the body is shown
FASTEST = 1.5  # V0, where the scale of colours ends


def film(path):
    """Write animation.mp4 into the run folder `path`, in one step; raises RunError where that cannot be."""
    return films.film(path, prepared)


def prepared(run):
    """Return a figure and the function that draws a frame into it."""
    p, d = run.parameters, drawing.grain_diameter(run)
    size, scale = np.minimum(VIEW, [p["width"], p["height"]]), ScalarMappable(PowerNorm(0.5, 0, FASTEST), MAP)
    figure, axes = plt.subplots(figsize=films.picture_size(*size), layout="constrained")
    set_title(figure, drawing.title(run))

    def draw(bed):
        axes.clear()
        draw_passing(axes, bed, d, p["v0"], scale.norm)
        body.draw(axes, run, body.turned(run, bed), unit=d)
        colour_bar(axes, scale, r"$|\mathbf{v}|/V_0$", extend="max")
        axes.set(xlim=(-size[0] / 2, size[0] / 2), ylim=(-size[1] / 2, size[1] / 2), aspect="equal")
        axes.set(xlabel="$x - x_\\mathrm{body}$  [$d$]", ylabel="$y - y_\\mathrm{body}$  [$d$]")
        axes.set_title(f"$t$ = {bed.t:.4g} s, travel {p['v0'] * bed.t / d:.1f} $d$")

    return figure, draw


def draw_passing(axes, bed, d, v0, norm):
    """Draw the grains about the body by their speed over V0, and the walls in grey; lengths in d."""
    x, y = relative(bed)
    grains, walls = bed.role == GRAIN, bed.role != GRAIN
    r = bed.grains["r"] / d
    shown = draw_grains(axes, x[grains] / d, y[grains] / d, r[grains], values=bed.speed[grains] / v0, cmap=MAP)
    shown.set_norm(norm)
    draw_grains(axes, x[walls] / d, y[walls] / d, r[walls], colour=GREY)


def relative(bed):
    """Return x and y (n,) of the grains from the body's centre, x in the periodic image nearest to it."""
    (x_body, y_body), period = bed.intruder["centre"][:2], bed.periods[0]
    x = bed.grains["x"] - x_body
    return x - period * np.round(x / period) if period else x, bed.grains["y"] - y_body
