"""Imports Debian's YADE and offers every engine, functor and function of the compiled module."""

try:
    import yade  # noqa: F401  (before our module: it loads YADE's libraries)
except ModuleNotFoundError as error:
    raise ImportError(f"cannot import YADE ({error}); install Debian's package yade and use /usr/bin/python3") from None

from .base import attribute_help  # noqa: E402
from .loops import interaction_helpers, pausing, solid_errors  # noqa: E402
from .solids import surface_algebra  # noqa: E402
from . import _engines  # noqa: E402
from ._engines import *  # noqa: E402, F401, F403
from ._engines import prove_layout  # noqa: E402, F401


def classes():
    """Return the classes that Graindrive adds to YADE: engines, functors, a shape, a contact."""
    from yade.wrapper import Serializable

    return [c for c in vars(_engines).values() if isinstance(c, type) and issubclass(c, Serializable)]


attribute_help.extend(classes())
interaction_helpers.install()
pausing.watch()
solid_errors.watch()
surface_algebra.install()
