"""Redraw the figure of run folders, film or export them: `python3 -m graindrive.postproc OUT … [frame=N] [export=vtk,xyz]`."""

import sys

from .. import exports
from ..errors import UsageError
from ..parameters import EXPORTS, known_formats
from .magnus import figure as magnus
from .reader import Run, RunError
from .wiggle import animation
from .wiggle import figure as wiggle

FIGURES = {"wiggle": wiggle.draw, "magnus": magnus.draw}
KEYS = ("frame=", "animation=", "export=")
USAGE = f"""usage: python3 -m graindrive.postproc OUT … [frame=N] [animation=1] [export=FORMAT,…]
frame: place in time of the picture, -1 is the last; animation: also film all frames, as animation.mp4
export: write frames for other programs, as {', '.join(EXPORTS)}; alone it draws no figure"""


def main(arguments):
    """Draw the figures that the arguments ask for; return the exit code: 0, or 2 after one line on stderr."""
    if not arguments or {"help", "-h", "--help"} & set(arguments):
        print(USAGE)
        return 0 if arguments else 2
    try:
        options = dict(a.split("=", 1) for a in arguments if a.startswith(KEYS))
        frame, filmed = (whole(key, options.get(key, usual)) for key, usual in (("frame", -1), ("animation", 0)))
        formats = known_formats(options.get("export", ""))
        for path in (a for a in arguments if not a.startswith(KEYS)):
            if set(options) != {"export"}:
                print(f"{path}: drawing figure.png and figure.pdf")
                figure_of(path)(path, frame)
            if filmed:
                print(f"{path}: filming animation.mp4")
                film_of(path)
            if formats:
                print(f"{path}: writing {', '.join(exports.FILES[name] for name in formats)}")
                exports.write(path, formats)
        return 0
    except (ValueError, RunError, UsageError) as error:
        print(f"graindrive.postproc: error: {error}", file=sys.stderr)
    return 2


def whole(key, text):
    """Return the whole number that a key was given; ValueError with the rule if it is none."""
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"frame and animation must be whole numbers, got {key}={text}") from None


def figure_of(path):
    """Return the function that draws the figure of the study which made the run folder `path`."""
    study = Run(path).study.split("_")[0]
    if study not in FIGURES:
        raise RunError(f"{path} holds a run of {study}, which has no figure yet; there are: {', '.join(FIGURES)}")
    return FIGURES[study]


def film_of(path):
    """Film the run in `path`; RunError for a study whose frames cannot be filmed."""
    if figure_of(path) is not wiggle.draw:
        raise RunError(f"{path} is no run of wiggle; only those can be filmed yet")
    animation.film(path)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
