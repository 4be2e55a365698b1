"""A film of a lift run (MP4): the cut through the bed in the middle of its breadth, grains coloured by speed over U_0."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import PowerNorm

from .. import figures, films
from ..figures import GREY, colour_bar, draw_grains, set_title
from ..reader import GRAIN
from . import figure as drawing

MAP = "YlGnBu"


def film(path):
    """Write animation.mp4 into the run folder `path`, in one step; raises RunError where that cannot be."""
    return films.film(path, prepared)


def prepared(run):
    """Return a figure and the function that draws a frame into it."""
    norm, (width, top) = PowerNorm(0.5, 0, 1), view(run)
    figure, axes = plt.subplots(figsize=films.picture_size(width, top + 1), layout="constrained")
    set_title(figure, drawing.title(run))

    def draw(bed):
        axes.clear()
        draw_cut(axes, run, bed, norm)
        colour_bar(axes, ScalarMappable(norm, MAP), "speed in the bed's frame over $U_0$", extend="max")
        axes.set(xlim=(0, width), ylim=(-1, top), aspect="equal", xlabel="$x$  [$d$]", ylabel="$z$  [$d$]")
        axes.set_title(f"$t$ = {bed.t:.4g} s")

    return figure, draw


def view(run):
    """Return width and top of the picture [d], from the first frame; a few grains may fly above it."""
    bed, d = run.frame(0), run.summary["grain_diameter"]
    return float(run.parameters["width"]), float(np.quantile(bed.grains["z"], 0.995)) / d + 3


def draw_cut(axes, run, bed, norm):
    """Draw what the plane in the middle of the breadth meets of grains and body; base and lid in grey. Lengths in d."""
    d = run.summary["grain_diameter"]
    x, z, r = cut(bed, bed.periods[1] / 2)
    x, z, shown = x / d, z / d, r > 0
    moved = np.array([run.parameters["speed"] if run.parameters["frame"] == "cylinder" else 0.0, 0, 0])
    speed = np.linalg.norm(bed.along_axes(bed.grains, "v{}") + moved, axis=1) / run.parameters["speed"]
    grains, held = shown & (bed.role == GRAIN), shown & (bed.role != GRAIN)
    draw_grains(axes, x[grains], z[grains], r[grains] / d, values=speed[grains], cmap=MAP, norm=norm)
    draw_grains(axes, x[held], z[held], r[held] / d, colour=GREY)
    draw_body(axes, run, bed, d)


def cut(bed, y):
    """Return x, z and the radius (n,) of the circle in which the plane at y meets each grain; 0 where it does not."""
    grains, period = bed.grains, bed.periods[1]
    away = grains["y"] - y
    away = away - period * np.round(away / period) if period else away
    return grains["x"], grains["z"], np.sqrt(np.maximum(grains["r"] ** 2 - away**2, 0))


def draw_body(axes, run, bed, d):
    """Draw the section of an endless body at its place and beyond the periodic side; others are the grains that they lack."""
    outline = run.group("intruder")["outline"]
    if not len(outline):
        return
    place = bed.place_solid(np.insert(outline, 1, 0.0, axis=1))[:, [0, 2]]
    for image in (-1, 0, 1):
        corners = (place + [image * bed.periods[0], 0]) / d
        figures.draw_body(axes, corners)
