"""A cache on disk for costly arrays (settled packings); the key is made of the parameters and the recipe's version."""

import contextlib
import fcntl
import glob
import hashlib
import os
import sys
import tempfile
from pathlib import Path

import numpy as np

from ..base import whole_files
from ..parameters import digest


def cache_folder():
    """Return the cache's folder: $GRAINDRIVE_CACHE, else $XDG_CACHE_HOME/graindrive, else ~/.cache/graindrive."""
    own = os.environ.get("GRAINDRIVE_CACHE")
    shared = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(own) if own else Path(shared) / "graindrive"


def cached(kind, parameters, recipe, build):
    """Return the dict of arrays that `build()` makes, from the cache if it holds them.

    `kind` names the entry ("bed"), `parameters` is the dict of plain values that determines it, `recipe` is the version
    of the code that builds it: increase it when the result changes. A damaged entry is built again. If several processes
    need the same entry, the first one builds it and the others wait; if the first one fails, the next one builds.
    If the cache cannot be written or locked, the arrays are still returned; a message says if they were not written.
    """
    path = cache_folder() / f"{kind}-{digest({'parameters': parameters, 'recipe': recipe})}.npz"
    damaged_before = path.exists()
    arrays = load(path)
    if arrays is not None:
        return arrays
    with one_at_a_time(path) as waited:
        arrays = load(path) if waited or not damaged_before else None  # another process may have stored it meanwhile
        if arrays is None:
            arrays = {name: np.asarray(array) for name, array in build().items()}
            store(path, arrays)
    return arrays


@contextlib.contextmanager
def one_at_a_time(path):
    """Hold the lock of the entry at `path` among all processes that share the cache; yield whether we had to wait for it.

    The lock is a file that its holder removes. It is released when the process ends, so a killed builder blocks no one.
    Where locks are impossible (a read-only folder, some network file systems) every process builds and stores the same.
    """
    try:
        lock, waited = take_lock(path.with_name(f".{path.stem}.lock"), path.stem)
    except OSError:
        yield True
        return
    with lock:
        for left in path.parent.glob(f".{glob.escape(path.stem)}-*{path.suffix}"):
            remove(left)  # left by a builder that was killed while it stored the entry
        try:
            yield waited
        finally:
            remove(lock.name)


def take_lock(path, entry):
    """Return the locked, open file `path`, and whether another process held it before."""
    path.parent.mkdir(parents=True, exist_ok=True)
    waited = False
    while True:
        file = open(path, "w")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print(f"graindrive: {entry} is being made by another run; waiting for it", file=sys.stderr)
            waited = True
            fcntl.flock(file, fcntl.LOCK_EX)
        if is_at(file, path):
            return file, waited
        file.close()  # its holder removed this file meanwhile; the lock is a new file now
        waited = True


def is_at(file, path):
    """True if the open `file` is still the one that `path` names."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), os.stat(path))
    except FileNotFoundError:
        return False


def load(path):
    """Return the dict of arrays stored at `path`; None if there is none or it is damaged."""
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        checksum = arrays.pop("checksum", np.array("")).item()
    except FileNotFoundError:
        return None
    except Exception as error:  # zipfile and numpy raise some ten kinds of errors for damaged files
        return damaged(path, error)
    return arrays if checksum == checksum_of(arrays) else damaged(path, "its checksum differs")


def damaged(path, reason):
    """Print that an entry is damaged; return None, so that it is built again."""
    print(f"graindrive: cache entry {path} is damaged ({reason}); building it again", file=sys.stderr)
    return None


def store(path, arrays):
    """Write a dict of arrays to `path` in one step: a reader sees the old entry or the new one, never an incomplete one."""
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.stem}-", suffix=".npz", delete=False) as file:
            temporary = file.name
            np.savez(file, checksum=checksum_of(arrays), **arrays)
        whole_files.put_in_place(temporary, path)
    except OSError as error:
        remove(temporary)
        print(f"graindrive: cannot write cache {path} ({error.strerror}); continuing without it", file=sys.stderr)
    except BaseException:
        remove(temporary)
        raise


def remove(path):
    """Remove a file if it exists."""
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
