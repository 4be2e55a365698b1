"""Films of runs (MP4): all frames of a run drawn into one figure, with one view and one scale of colours."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FFMpegWriter

from ..whole_files import written
from .figures import STYLE
from .reader import Run, RunError

FRAMES_PER_SECOND = 20
FEWEST_FRAMES = 2
INCHES, DOTS_PER_INCH = 6.4, 150


def film(path, prepared):
    """Write animation.mp4 into the run folder `path`, in one step, and return its path; raises RunError where that cannot be.

    `prepared(run)` returns a figure and a function of a frame that draws it there in place of the one before. A run has as
    many frames as its key `frames` asked for. Every frame of the film costs about half a second.
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
        shoot(run, temporary, prepared)
    return target


def shoot(run, target, prepared):
    """Draw all frames of a run into the file `target`."""
    figure, draw = prepared(run)
    writer = FFMpegWriter(fps=FRAMES_PER_SECOND, codec="libx264", extra_args=["-pix_fmt", "yuv420p", "-f", "mp4"])
    try:
        with writer.saving(figure, str(target), DOTS_PER_INCH):
            for k in range(len(run.frame_names)):
                draw(run.frame(k))
                writer.grab_frame()
    finally:
        plt.close(figure)


def picture_size(width, height):
    """Return (width, height) [inches] for a view of any unit, so that both have an even number of dots, as the codec asks."""
    inches = np.array([INCHES, 0.6 + INCHES * height / width])
    return tuple(np.round(inches * DOTS_PER_INCH / 2) * 2 / DOTS_PER_INCH)
