"""Graindrive: forces on bodies driven through granular media, a study package on YADE."""

from .base import yade_finder

__version__ = "0.1.0"

yade_finder.install()


def run(study, *, progress=True, **keys):
    """Return the `Run` of a study with these keys; it is made if it does not exist. See `graindrive.commands.started.run`."""
    from .commands.started import run  # not above: it imports the whole package

    return run(study, progress=progress, **keys)
