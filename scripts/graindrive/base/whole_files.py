"""Writes files and folders that appear on disk whole or not at all: under a temporary name, synced, then renamed.

Readers, and a program started after a kill, see only the rename. The sync before it preserves this order after a power failure
too. Files whose names end in `.tmp` are unfinished and must be ignored. Folders are removed in the same way, after a rename.
"""

import contextlib
import io
import os
import shutil
from pathlib import Path

from .errors import is_full


def beside(path):
    """Return the name under which `path` is written before it is renamed."""
    path = Path(path)
    return path.with_name(f".{path.name}.tmp")


def write_text(path, text):
    """Write a text file (UTF-8), whole or not at all; an older file stays until the new one replaces it."""
    with written(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextlib.contextmanager
def written(path):
    """Yield a temporary name to write to in this block; the file is then renamed to `path`, or removed if the block failed."""
    temporary = beside(path)
    try:
        yield temporary
        put_in_place(temporary, path)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise


class Patient(io.FileIO):
    """A new file for a writer that crashes on errors, as HDF5 does: `raise_error` reports the first error later.

    Data written after an error are discarded.
    """

    def __init__(self, path):
        super().__init__(path, "w+")
        self.error = None

    def write(self, content):
        """Write all of `content`; return its length."""
        left = memoryview(content).cast("B")
        length = len(left)
        while len(left) and self.attempt(lambda: super(Patient, self).write(left)):
            left = left[self.done :]
        return length

    def truncate(self, size=None):
        """Cut or lengthen the file; return the size."""
        self.attempt(lambda: super(Patient, self).truncate(size))
        return size

    def attempt(self, action):
        """Call `action()` unless an error occurred before; True if there is still no error, and the result is in `done`."""
        try:
            self.done = action() if self.error is None else None
        except OSError as error:
            self.error = error
        return self.error is None

    def raise_error(self):
        """Raise the first error that occurred, if any."""
        if self.error is not None:
            raise self.error


def reserve(path, size):
    """Reserve space on the disk for `size` bytes of the file `path`, made if missing; OSError if there is not enough."""
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        os.posix_fallocate(descriptor, 0, size)
    except OSError as error:  # some file systems cannot reserve space
        if is_full(error):
            raise
    finally:
        os.close(descriptor)


def put_in_place(temporary, path):
    """Sync the file `temporary` and give it the name `path`."""
    sync(temporary)
    os.replace(temporary, path)
    sync(Path(path).parent)


def rename_folder(folder, path):
    """Sync all files in `folder`, then rename it to `path`, which must be free or an empty folder."""
    sync_tree(folder)
    os.rename(folder, path)
    sync(Path(path).parent)


def sync(path):
    """Flush a file's content, or a folder's list of names, to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError:  # some network file systems cannot sync folders
        if not os.path.isdir(path):
            raise
    finally:
        os.close(descriptor)


def sync_tree(folder):
    """Sync a folder and all its files and folders."""
    for place, _, names in os.walk(folder):
        for name in names:
            sync(os.path.join(place, name))
        sync(place)


def discard(folder, hidden):
    """Remove a folder: rename it to `hidden` first, so that after a kill the next call can find and remove the rest."""
    shutil.rmtree(hidden, ignore_errors=True)
    os.rename(folder, hidden)
    shutil.rmtree(hidden, ignore_errors=True)
