"""The place of a run folder: checks whether it can be used and whether another run works there, and renames folders."""

import contextlib
import fcntl
import os
import re
from pathlib import Path

from . import run_file, summary_file
from ..base import whole_files
from ..base.errors import UsageError, one_line
from .run_data import UNREADABLE

LONGEST_NAME = 255 - len(".interrupted-9999")  # bytes; file systems allow 255
HIDDEN_NAME = re.compile(
    r"\..+\.(part|old|gone)-\d+"
)  # names that `hidden` makes; such folders are removed after the run
LONGEST_SHOWN = 300  # characters of a path in a message


class AlreadyComplete(Exception):
    """The run folder exists and holds a complete run of the same parameters."""


def place_of(given):
    """Return the absolute path of `out=given`, with links resolved; UsageError if no folder can get that name."""
    expanded, refused = os.path.expanduser(given), f"out={one_line(given, LONGEST_SHOWN)}"
    path = os.path.abspath(expanded)
    if given.startswith("~") and expanded == given:
        raise UsageError(f"{refused} names a home folder that does not exist; give the path itself")
    if os.path.islink(path) and not os.path.exists(path):
        target = one_line(os.readlink(path), LONGEST_SHOWN)
        raise UsageError(f"{refused} is a link to {target}, which does not exist; make that folder or remove the link")
    path = Path(os.path.realpath(expanded))
    if not path.name or given.rstrip("/").endswith(".."):
        raise UsageError(f"{refused} is not the name of a run folder; give one below it")
    if HIDDEN_NAME.fullmatch(path.name):
        raise UsageError(
            f"{refused} is a name of the hidden folders of unfinished runs, which are removed; leave the dot out"
        )
    if os.path.ismount(path):
        raise UsageError(
            f"{refused} is a mount point, which no run folder can replace; give one below it, out={given}/run"
        )
    if len(os.fsencode(path.name)) > LONGEST_NAME:
        raise UsageError(f"{refused} is longer than {LONGEST_NAME} bytes; give a shorter name")
    return path


@contextlib.contextmanager
def held(folder):
    """Prevent other processes from starting or ending a run in `folder` during this block, if its file system has locks."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def refuse_what_is_there(run):
    """Raise AlreadyComplete or UsageError unless the place is free, an empty folder, or holds the same run and redo is set.

    With redo a damaged run is moved to NAME.damaged.
    """
    given, out = f"out={one_line(run.parameters.out, LONGEST_SHOWN)}", run.out
    if not out.exists():
        return
    if not out.is_dir():
        raise UsageError(f"{given} is a file; give the name of a folder")
    if not any(out.iterdir()):
        return
    problem = damage(out)
    if problem and run.parameters.redo:
        set_aside(out)
        return
    if problem:
        raise UsageError(
            f"{given} holds a damaged run: {problem}; redo=1 makes the run again and keeps the damaged one"
        )
    if stored_digest(out) is None:
        raise UsageError(f"{given} holds something other than a complete run; give another out= or move it away")
    if (study := stored_family(out)) not in (None, run.family):
        raise UsageError(f"{given} holds a run of the study {study}; give another out= or move it away")
    if stored_digest(out) != run.parameters.digest():
        raise UsageError(f"{given} holds a run of other parameters{difference(run)}; give another out= or move it away")
    if not run.parameters.redo:
        raise AlreadyComplete(f"{out} is there already, a complete run of these parameters (redo=1 makes it again)")


def refuse_at_work(run):
    """Raise UsageError if another process is writing a run for the same place."""
    if any(is_alive(part) for part in hidden_ones(run.out, "part")):
        raise UsageError(
            f"another run is writing out={one_line(run.parameters.out, LONGEST_SHOWN)}; give another out=, or wait for it"
        )


def set_aside(out):
    """Rename a damaged run to NAME.damaged; return that name."""
    aside = free_name(out, "damaged")
    os.rename(out, aside)
    return aside


def stored_digest(path):
    """Return the digest of the parameters of the complete run in the folder `path`; None if there is no such run."""
    try:
        if run_file.attribute(path / run_file.NAME, "state") == "complete" and summary_file.read(path) is not None:
            return run_file.attribute(path / run_file.NAME, "digest")
    except (OSError, ValueError):
        pass
    return None


def stored_family(path):
    """Return the family, the study or that of which it is a preset, of the run in the folder `path`; None in older folders."""
    return run_file.attribute(path / run_file.NAME, "family")


def damage(path):
    """Return a description of the damage of the finished run in the folder `path`; None if it is intact or not a finished run.

    The whole `run.h5` is read, since only this finds all damage.
    """
    if not (path / run_file.NAME).is_file():
        return None
    name = run_file.NAME
    try:
        if run_file.read_attribute(path / name, "state") != "complete":
            return None
        run_file.read_through(path / name)
        name = summary_file.NAME
        summary_file.read(path)
    except UNREADABLE as error:
        return f"{path / name} cannot be read ({one_line(error)})"
    return None


def difference(run):
    """Return a description of the first parameter in which the stored run differs: " (period=4.0 there, …)"."""
    stored = run_file.parameters_in(run.out / run_file.NAME)
    for key, value in run.parameters.identity().items():
        if key not in run.parameters.__fields__:  # the content of a file that a parameter names
            continue
        there, asked = values_of(stored.get(key)), "auto" if value is None else value
        if asked not in there:
            return f" ({key}={there[0]} there, {key}={asked} asked for)"
    return " (a file that they name has changed)"


def values_of(stored):
    """Return a list: the value of a parameter in a run folder, and also "auto" if the value was derived for `auto`."""
    if stored is None:
        return ("nothing",)
    return (stored.value, "auto") if stored.auto else (stored.value,)


def take_lock(part):
    """Return an open, locked file, which shows that this process works in the folder `part`."""
    lock = open(part / ".lock", "w")
    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    return lock


def is_alive(part):
    """True if a process still holds the lock of an unfinished folder."""
    try:
        with open(part / ".lock") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except OSError:
        return True
    return False


def hidden(out, kind):
    """Return this process's name for a folder beside `out` of the `kind` "part" (unfinished), "old" or "gone"."""
    return out.with_name(f".{out.name}.{kind}-{os.getpid()}")


def hidden_ones(out, kind):
    """Return the folders of that `kind` beside `out`, from all processes."""
    name = re.compile(rf"\.{re.escape(out.name)}\.{kind}-\d+")
    return sorted(path for path in out.parent.iterdir() if name.fullmatch(path.name) and path.is_dir())


def free_name(out, ending):
    """Return the first of NAME.ending, NAME.ending-2, … that does not exist."""
    names = (out.with_name(f"{out.name}.{ending}{suffix}") for suffix in [""] + [f"-{n}" for n in range(2, 10000)])
    return next(name for name in names if not os.path.lexists(name))


def take_place(path, out, digest):
    """Rename the complete folder `path` to `out`; it replaces an older run of the same parameters, but nothing else.

    If the place cannot be taken, the run is kept as NAME.complete, and UsageError says so.
    """
    whole_files.sync_tree(path)
    old = hidden(out, "old")
    try:
        if out.is_dir() and any(out.iterdir()):
            if stored_digest(out) != digest:
                raise FileExistsError(0, "another process made it meanwhile")
            os.rename(out, old)
        os.rename(path, out)
    except OSError as error:
        if old.exists() and not out.exists():
            os.rename(old, out)
        kept = free_name(out, "complete")
        os.rename(path, kept)
        raise UsageError(
            f"{out} cannot be replaced ({error.strerror}); this run is complete and kept in {kept}"
        ) from None
    whole_files.sync(out.parent)
    if old.exists():
        remove(old, out)


def remove(folder, out):
    """Remove a folder beside `out`; after a kill the next call removes the rest."""
    whole_files.discard(folder, hidden(out, "gone"))
