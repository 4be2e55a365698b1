"""Files and folders that appear on disk whole or not at all: written beside, synced, renamed; removed the same way.

A rename is the only step that a reader, or the call after a kill, can see. Syncing before it keeps the order on disk after a
power failure too. Names that end in `.tmp` are being written and mean nothing to anybody else.
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
    """Write a text file (UTF-8), whole or not at all; an older one stays until then."""
    with written(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextlib.contextmanager
def written(path):
    """Yield the name to write in this block; afterwards it takes the name `path`, or goes if the block failed."""
    temporary = beside(path)
    try:
        yield temporary
        put_in_place(temporary, path)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise


class Patient(io.FileIO):
    """A new file for a writer that cannot bear an error, as HDF5, which crashes: `raise_error` tells of the first one later.

    What is written after an error goes nowhere.
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
        """Call `action()` unless an error was met before; True if there is none now, its result is `done` then."""
        try:
            self.done = action() if self.error is None else None
        except OSError as error:
            self.error = error
        return self.error is None

    def raise_error(self):
        """Raise the first error that was met, if any."""
        if self.error is not None:
            raise self.error


def reserve(path, size):
    """Have the file system keep room for `size` bytes of the file `path`, made if need be; OSError if it has none."""
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        os.posix_fallocate(descriptor, 0, size)
    except OSError as error:  # some file systems cannot
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
    """Give `folder` the name `path`, which is free or an empty folder, after all in it is synced."""
    sync_tree(folder)
    os.rename(folder, path)
    sync(Path(path).parent)


def sync(path):
    """Have the disk hold what was written to a file, or which names a folder has."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError:  # some network file systems sync no folders
        if not os.path.isdir(path):
            raise
    finally:
        os.close(descriptor)


def sync_tree(folder):
    """Sync a folder and all that is in it."""
    for place, _, names in os.walk(folder):
        for name in names:
            sync(os.path.join(place, name))
        sync(place)


def discard(folder, hidden):
    """Remove a folder: it gets the name `hidden` first, under which a call that follows a kill removes the rest."""
    shutil.rmtree(hidden, ignore_errors=True)
    os.rename(folder, hidden)
    shutil.rmtree(hidden, ignore_errors=True)
