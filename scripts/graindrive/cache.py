"""A cache of costly arrays (settled packings) on disk, keyed by the parameters and the recipe that made them."""

import hashlib
import os
import sys
import tempfile
import zipfile
from pathlib import Path

import numpy as np

from .parameters import digest


def cache_folder():
    """Return the cache's folder: $GRAINDRIVE_CACHE, else $XDG_CACHE_HOME/graindrive, else ~/.cache/graindrive."""
    own = os.environ.get("GRAINDRIVE_CACHE")
    shared = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(own) if own else Path(shared) / "graindrive"


def cached(kind, parameters, recipe, build):
    """Return the dict of arrays that `build()` makes, from the cache if they are there already.

    `kind` names the entry ("bed"), `parameters` is the dict of plain values that decides it, `recipe` the version of
    the code that builds it: raise it when the result changes. A damaged entry is built anew. Builders at the same time
    are safe: each writes its own file and renames it, the last one wins with the same content. Where the cache cannot
    be written the arrays are returned all the same, with a note.
    """
    path = cache_folder() / f"{kind}-{digest({'parameters': parameters, 'recipe': recipe})}.npz"
    arrays = load(path)
    if arrays is None:
        arrays = {name: np.asarray(array) for name, array in build().items()}
        store(path, arrays)
    return arrays


def load(path):
    """Return the dict of arrays stored at `path`; None if there is none or it is damaged."""
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        checksum = arrays.pop("checksum", np.array("")).item()
    except FileNotFoundError:
        return None
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile) as error:
        return damaged(path, error)
    return arrays if checksum == checksum_of(arrays) else damaged(path, "its checksum differs")


def damaged(path, reason):
    """Say that an entry is damaged; return None, so that it is built anew."""
    print(f"graindrive: cache entry {path} is damaged ({reason}); building it anew", file=sys.stderr)
    return None


def store(path, arrays):
    """Write a dict of arrays to `path` in one step: a reader sees the old entry or the new, never half of one."""
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.stem}-", suffix=".npz", delete=False) as file:
            temporary = file.name
            np.savez(file, checksum=checksum_of(arrays), **arrays)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except OSError as error:
        remove(temporary)
        print(f"graindrive: cannot write cache {path} ({error.strerror}); going on without", file=sys.stderr)
    except BaseException:
        remove(temporary)
        raise


def remove(path):
    """Remove a file if it is there."""
    if path and os.path.exists(path):
        os.unlink(path)


def checksum_of(arrays):
    """Return a hexadecimal checksum of names, shapes, types and contents of a dict of arrays."""
    sum_ = hashlib.sha256()
    for name in sorted(arrays):
        array = np.ascontiguousarray(arrays[name])
        sum_.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        sum_.update(array.tobytes())
    return sum_.hexdigest()
