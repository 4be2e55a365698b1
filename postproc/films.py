"""Films of runs (MP4): all frames of a run drawn into one figure, with one view and one scale of colours."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FFMpegWriter

from ..base.errors import UsageError
from ..base.whole_files import written
from .figures import STYLE
from .reader import Run, RunError

NAME = "animation.mp4"
FRAMES_PER_SECOND = 20
FEWEST_FRAMES = 2
NO_FFMPEG = "a film needs ffmpeg; install Debian's package ffmpeg (scripts/setup film)"
INCHES, DOTS_PER_INCH = 6.4, 150


class GrainFrames:
    """The frames of a run as a sequence, each read when it is asked for."""

    def __init__(self, run):
        self.run = run

    def __len__(self):
        return len(self.run.frame_names)

    def __getitem__(self, k):
        if not 0 <= k < len(self):
            raise IndexError(k)
        return self.run.frame(k)


def require_possible(study, p):
    """UsageError with the way out where a run of the `Study` with the parameters `p` could not be filmed; before it is made."""
    if study.film is None:
        raise UsageError(f"film=1: runs of {study.name} cannot be filmed; leave it out")
    if p.frames < FEWEST_FRAMES:
        raise UsageError(f"film=1 needs frames={FEWEST_FRAMES} or more, got frames={p.frames}; frames=200 makes 10 s")
    if not FFMpegWriter.isAvailable():
        raise UsageError(f"film=1: {NO_FFMPEG}, or leave it out")


def film(path, prepared, frames_of=GrainFrames):
    """Write animation.mp4 into the run folder `path`, in one step, and return its path; raises RunError where that cannot be.

    `prepared(run)` returns a figure and a function of a frame that draws it there in place of the one before. `frames_of(run)`
    returns the sequence of frames. A run has as many as its key `frames` asked for. Every frame of the film costs about half a
    second.
    """
    run = Run(path)
    frames = frames_of(run)
    if len(frames) < FEWEST_FRAMES:
        raise RunError(f"{path} holds {len(frames)} frames, a film needs more; run again with frames=200 or so")
    if not FFMpegWriter.isAvailable():
        raise RunError(NO_FFMPEG)
    target = Path(path) / NAME
    with plt.rc_context(STYLE), written(target) as temporary:
        shoot(frames, temporary, *prepared(run))
    return target


def shoot(frames, target, figure, draw):
    """Draw all frames into the file `target`."""
    writer = FFMpegWriter(fps=FRAMES_PER_SECOND, codec="libx264", extra_args=["-pix_fmt", "yuv420p", "-f", "mp4"])
    try:
        with writer.saving(figure, str(target), DOTS_PER_INCH):
            for frame in frames:
                draw(frame)
                writer.grab_frame()
    finally:
        plt.close(figure)


def picture_size(width, height):
    """Return (width, height) [inches] for a view of any unit, so that both have an even number of dots, as the codec asks."""
    inches = np.array([INCHES, 0.6 + INCHES * height / width])
    dots = np.round(inches * DOTS_PER_INCH / 2) * 2
    return tuple((dots + 0.25) / DOTS_PER_INCH)  # the writer cuts to whole dots: round-off must not take one
