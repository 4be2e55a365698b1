"""Redraw the figure of run folders, film or export them: `python3 -m graindrive.postproc OUT … [frame=N] [export=vtk,xyz]`.

How a run is drawn its study says: one of this checkout, by the name in the run folder, or that of the file `study=FILE`.
"""

import contextlib
import sys
from pathlib import Path

from ..exports import exports
from ..base.errors import UsageError
from ..parameters import EXPORTS, known_formats
from ..study import house, loaded
from .reader import Run, RunError

KEYS = ("frame=", "animation=", "export=", "study=")
USAGE = f"""usage: python3 -m graindrive.postproc OUT … [frame=N] [animation=1] [export=FORMAT,…] [study=FILE]
frame: place in time of the picture, -1 is the last; animation: also film all frames, as animation.mp4
study: file of the study that made the run, where it is none of this checkout's
export: write frames for other programs, as {', '.join(EXPORTS)}; alone it draws no figure"""


def main(arguments):
    """Draw the figures that the arguments ask for; return the exit code: 0, or 2 after one line on stderr."""
    if not arguments or {"help", "-h", "--help"} & set(arguments):
        print(USAGE)
        return 0 if arguments else 2
    try:
        options, paths = sorted_out(arguments)
        frame, filmed = (whole(key, options.get(key, usual)) for key, usual in (("frame", -1), ("animation", 0)))
        formats = known_formats(options.get("export", ""))
        for path in paths:
            with said_of(path):
                if set(options) - {"study"} != {"export"}:
                    draw = figure_of(path, options.get("study"))
                    print(f"{path}: drawing figure.png and figure.pdf")
                    draw(path, frame)
                if filmed:
                    film = film_of(path, options.get("study"))
                    print(f"{path}: filming animation.mp4")
                    film(path)
                if formats:
                    print(f"{path}: writing {', '.join(exports.FILES[name] for name in formats)}")
                    exports.write(path, formats)
        return 0
    except (ValueError, RunError, UsageError) as error:
        print(f"graindrive.postproc: error: {error}", file=sys.stderr)
    return 2


@contextlib.contextmanager
def said_of(path):
    """Turn what a run folder lacks, and files that cannot be written, into a RunError that names the folder."""
    try:
        yield
    except (LookupError, StopIteration) as error:
        raise RunError(
            f"{path}, {Run(path).state}, does not hold {error} which this needs; finish or repeat the run"
        ) from None
    except OSError as error:
        raise RunError(f"{path}: {error.filename or ''} cannot be written ({error.strerror or error})") from None


def sorted_out(arguments):
    """Return the keys with their values, and the run folders, of which none may be missing before the first is drawn."""
    options, paths = {}, []
    for argument in arguments:
        key, equals, value = argument.partition("=")
        if f"{key}{equals}" in KEYS:
            if key in options:
                raise UsageError(f"{key} is given twice: {key}={options[key]} and {argument}; keep one")
            options[key] = value
        elif key.isidentifier() and equals and not Path(argument).exists():
            raise UsageError(f"there is no key {key!r}; allowed: {' '.join(known[:-1] for known in KEYS)}")
        else:
            paths.append(argument)
    if not paths:
        raise UsageError("no run folder is given; OUT is the folder of a run, which holds run.h5")
    for path in paths:
        Run(path)
    return options, paths


def whole(key, text):
    """Return the whole number that a key was given; ValueError with the rule if it is none."""
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"frame and animation must be whole numbers, got {key}={text}") from None


def figure_of(path, file=None):
    """Return the function that draws the figure of the study which made the run folder `path`."""
    study = study_of(path, file)
    if study.figure is None:
        raise RunError(f"{path} holds a run of {study.name}, which has no figure yet")
    return study.figure


def film_of(path, file=None):
    """Return the function that films the run in `path`; RunError for a study whose frames cannot be filmed."""
    study = study_of(path, file)
    if study.film is None:
        raise RunError(f"{path} holds a run of {study.name}, which cannot be filmed yet")
    return study.film


def study_of(path, file=None):
    """Return the `Study` that made the run folder `path`: that of a `file`, or one of this checkout by name or family."""
    run, known = Run(path), house()
    name = run.study if run.study in known else run.family
    if file is None and name not in known:
        raise RunError(
            f"{path} holds a run of {name}, which has no figure here; there are: {', '.join(known)}; give study=FILE"
        )
    try:
        study = loaded(file or known[name])
        if file and study.family != run.family:
            raise UsageError(
                f"{path} holds a run of {run.study}, but study={file} makes runs of {study.name}; leave study= out"
            )
        return study
    except OSError as error:
        raise UsageError(f"study={file} cannot be read ({error.strerror})") from None
    except ImportError as error:
        raise RunError(f"{path} is drawn as its study says, which cannot be loaded: {error}") from None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
