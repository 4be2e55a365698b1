"""Redraw the figure of run folders: `python3 -m graindrive.postproc OUT … [frame=N]`."""

import sys

from . import magnus, wiggle
from .reader import Run, RunError

FIGURES = {"wiggle": wiggle.draw, "magnus": magnus.draw}


def main(arguments):
    """Draw the figures that the arguments ask for; return the exit code: 0, or 2 after one line on stderr."""
    if not arguments or {"help", "-h", "--help"} & set(arguments):
        print("usage: python3 -m graindrive.postproc OUT … [frame=N]   (frame: place in time, -1 is the last)")
        return 0 if arguments else 2
    try:
        options = dict(a.split("=", 1) for a in arguments if a.startswith("frame="))
        frame = int(options.get("frame", -1))
        for path in (a for a in arguments if not a.startswith("frame=")):
            print(f"{path}: drawing figure.png and figure.pdf")
            figure_of(path)(path, frame)
        return 0
    except ValueError as error:
        print(f"graindrive.postproc: error: frame must be a whole number, got {error}", file=sys.stderr)
    except RunError as error:
        print(f"graindrive.postproc: error: {error}", file=sys.stderr)
    return 2


def figure_of(path):
    """Return the function that draws the figure of the study which made the run folder `path`."""
    study = Run(path).study.split("_")[0]
    if study not in FIGURES:
        raise RunError(f"{path} holds a run of {study}, which has no figure yet; there are: {', '.join(FIGURES)}")
    return FIGURES[study]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
