"""A film of a wiggle run (MP4): all its frames of the bed, with one view and one scale of colours."""

import matplotlib.pyplot as plt

from .. import films
from ..figures import colour_bar, set_title
from ..reader import GRAIN
from . import figure as drawing


def film(path):
    """Write animation.mp4 into the run folder `path`, in one step; raises RunError where that cannot be.

    Some 20 frames a period show the motion.
    """
    return films.film(path, prepared)


def prepared(run):
    """Return a figure and the function that draws a frame into it."""
    beds = [run.frame(k) for k in range(len(run.frame_names))]
    norm = drawing.speed_scale([bed.speed[bed.role == GRAIN] for bed in beds])
    box = drawing.view(run, beds[len(beds) // 2])
    figure, axes = plt.subplots(figsize=films.picture_size(*box[1]), layout="constrained")
    set_title(figure, drawing.title(run))

    def draw(bed):
        axes.clear()
        circles = drawing.draw_bed(axes, run, bed, box, norm)
        colour_bar(axes, circles, r"speed  [$\sqrt{gd}$]", extend="max")

    return figure, draw
