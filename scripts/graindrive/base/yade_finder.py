"""Finds Debian's YADE where it is imported, so that `from yade import O` works in any Python after `import graindrive`."""

import contextlib
import glob
import io
import os
import sys
from importlib.machinery import PathFinder

FOLDERS = "/usr/lib/*/yade-double/py"


class YadeFinder:
    """Looks for the module `yade` on Python's path, then in Debian's folder, and prepares its import."""

    def find_spec(self, name, _path=None, _target=None):
        """Return the spec of `yade`, None for other modules or without YADE."""
        spec = PathFinder.find_spec(name, [*sys.path, *glob.glob(FOLDERS)]) if name == "yade" else None
        if spec is None:
            return None
        # As the `yade` program does: idle OpenMP threads that spin slow a busy machine.
        os.environ.setdefault("OMP_NUM_THREADS", "1")
        folder = os.path.dirname(spec.submodule_search_locations[0])
        if folder not in sys.path:
            sys.path.append(folder)  # for what YADE itself imports
        spec.loader.exec_module = quietly(spec.loader.exec_module)
        return spec


def quietly(execute):
    """Return a function that executes a module without its output: YADE prints the version of Python."""

    def executed(module):
        with contextlib.redirect_stdout(io.StringIO()):
            execute(module)

    return executed


def install():
    """Let this finder serve every `import yade` from now on; a second call changes nothing."""
    if not any(isinstance(finder, YadeFinder) for finder in sys.meta_path):
        sys.meta_path.insert(0, YadeFinder())
