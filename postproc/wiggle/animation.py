"""A film of a wiggle run (MP4): all its frames of the bed, with one view and one scale of colours."""

import matplotlib.pyplot as plt
from matplotlib.cm import ScalarMappable

from .. import films
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
    figure.suptitle(drawing.title(run))
    figure.colorbar(ScalarMappable(norm, "YlGnBu"), ax=axes, pad=0.01, extend="max", label=r"speed  [$\sqrt{gd}$]")

    def draw(bed):
        axes.clear()
        drawing.draw_bed(axes, run, bed, box, norm)

    return figure, draw
