"""Finds Debian's YADE where it is imported, so that `from yade import O` works in any Python after `import graindrive`."""

import contextlib
import glob
import io
import os
import sys
from importlib.machinery import PathFinder

FOLDERS = "/usr/lib/*/yade-double/py"


class YadeFinder:
    """Looks for the module `yade` where Python's own search has not found it; the program `yade` has it on its path."""

    def find_spec(self, name, _path=None, _target=None):
        """Return the spec of `yade` from Debian's folder, None for other modules or without YADE."""
        spec = PathFinder.find_spec(name, glob.glob(FOLDERS)) if name == "yade" else None
        if spec is None:
            return None
        # As the `yade` program does: idle OpenMP threads that spin slow a busy machine.
        os.environ.setdefault("OMP_NUM_THREADS", "1")
        sys.path.append(os.path.dirname(spec.submodule_search_locations[0]))  # for what YADE itself imports
        spec.loader.exec_module = quietly(spec.loader.exec_module)
        return spec


def quietly(execute):
    """Return a function that executes a module without its output: YADE prints the version of Python."""

    def executed(module):
        with contextlib.redirect_stdout(io.StringIO()):
            execute(module)

    return executed


def install():
    """Let `import yade` look into Debian's folder from now on; a second call changes nothing."""
    if not any(isinstance(finder, YadeFinder) for finder in sys.meta_path):
        sys.meta_path.append(YadeFinder())
