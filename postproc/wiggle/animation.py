"""A film of a run (MP4): all its frames of the bed, with one view and one scale of colours."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FFMpegWriter
from matplotlib.cm import ScalarMappable

from ...whole_files import written
from ..figures import STYLE
from ..reader import GRAIN, Run, RunError
from . import figure as drawing

FRAMES_PER_SECOND = 20
FEWEST_FRAMES = 2
INCHES, DOTS_PER_INCH = 6.4, 150


def film(path):
    """Write animation.mp4 into the run folder `path`, in one step; raises RunError where that cannot be.

    A run has as many frames as its key `frames` asked for: some 20 a period show the motion. Every frame of the film costs
    about half a second.
    """
    run = Run(path)
    if len(run.frame_names) < FEWEST_FRAMES:
        raise RunError(
            f"{path} holds {len(run.frame_names)} frames, a film needs more; run again with frames=200 or so"
        )
    if not FFMpegWriter.isAvailable():
        raise RunError("a film needs ffmpeg; install Debian's package ffmpeg")
    target = Path(path) / "animation.mp4"
    with plt.rc_context(STYLE), written(target) as temporary:
        shoot(run, temporary)
    return target


def shoot(run, target):
    """Draw all frames of a run into the file `target`."""
    beds = [run.frame(k) for k in range(len(run.frame_names))]
    norm = drawing.speed_scale([bed.speed[bed.role == GRAIN] for bed in beds])
    box = drawing.view(run, beds[len(beds) // 2])
    figure, axes = plt.subplots(figsize=picture_size(box), layout="constrained")
    figure.suptitle(drawing.title(run))
    figure.colorbar(ScalarMappable(norm, "YlGnBu"), ax=axes, pad=0.01, extend="max", label=r"speed  [$\sqrt{gd}$]")
    writer = FFMpegWriter(fps=FRAMES_PER_SECOND, codec="libx264", extra_args=["-pix_fmt", "yuv420p", "-f", "mp4"])
    try:
        with writer.saving(figure, str(target), DOTS_PER_INCH):
            for bed in beds:
                axes.clear()
                drawing.draw_bed(axes, run, bed, box, norm)
                writer.grab_frame()
    finally:
        plt.close(figure)


def picture_size(box):
    """Return (width, height) [inches] for a view, so that both have an even number of dots, as the codec asks."""
    inches = np.array([INCHES, 0.6 + INCHES * box[1, 1] / box[1, 0]])
    return tuple(np.round(inches * DOTS_PER_INCH / 2) * 2 / DOTS_PER_INCH)
