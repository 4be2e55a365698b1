"""Graindrive: forces on bodies driven through granular media, a study package on YADE."""

__version__ = "0.1.0"


def run(study, *, progress=True, **keys):
    """Return the `Run` of a study with these keys, made unless it is there; see `graindrive.commands.started.run`."""
    from .commands.started import run  # it needs the whole package, which most imports of a part do not

    return run(study, progress=progress, **keys)
