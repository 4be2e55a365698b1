"""What stands where a run folder is to go: complete runs, runs at work, remains of killed ones, checkpoints."""

import fcntl
import glob
import json
import os
import shutil
import sys

import h5py

from . import run_data
from .errors import UsageError


class AlreadyComplete(Exception):
    """The run folder is there already and holds a complete run of the same parameters."""


def look_around(run):
    """Check the place of a `RunFolder`; raises AlreadyComplete or UsageError, and keeps what killed runs left."""
    refuse_what_is_there(run)
    pattern = f".{run.out.name}.part-"
    siblings = [p for p in run.out.parent.iterdir() if p.name.startswith(pattern)] if run.out.parent.is_dir() else []
    for part in siblings:
        if is_alive(part):
            raise UsageError(f"another run is writing out={run.parameters.out}; give another out=, or wait for it")
        kept = recover(part, run.out)
        if kept:
            print(f"{run.study}: a killed run left data for this folder; they are kept in {kept}", file=sys.stderr)


def refuse_what_is_there(run):
    """Raise unless the place is free, an empty folder, or (with redo) holds the same run."""
    given = f"out={run.parameters.out}"
    if not run.out.exists():
        return
    if not run.out.is_dir():
        raise UsageError(f"{given} is a file; give the name of a folder")
    if not any(run.out.iterdir()):
        return
    if stored_digest(run.out) is None:
        raise UsageError(f"{given} holds something else than a complete run; give another out= or move it away")
    if stored_digest(run.out) != run.parameters.digest():
        raise UsageError(f"{given} holds a run of other parameters{difference(run)}; give another out= or move it away")
    if not run.parameters.redo:
        raise AlreadyComplete(f"{run.out} is there already, a complete run of these parameters (redo=1 runs it again)")


def stored_digest(path):
    """Return the digest of the parameters of the complete run in folder `path`; None if there is no such run."""
    try:
        with h5py.File(path / "run.h5", "r") as file:
            return str(file.attrs["digest"]) if file.attrs["state"] == "complete" else None
    except (OSError, KeyError):
        return None


def difference(run):
    """Return in words the first parameter in which the stored run differs: " (period=4.0 there)"."""
    with h5py.File(run.out / "run.h5", "r") as file:
        for key, value in run.parameters.identity().items():
            if key not in run.parameters.__fields__:  # what a file that a parameter names holds
                continue
            there, asked = stored_value(file, key), "auto" if value is None else value
            if asked not in there:
                return f" ({key}={there[0]} there, {key}={asked} asked for)"
    return " (a file that they name has changed)"


def stored_value(file, key):
    """Return the value of a parameter in an open `run.h5`; behind it "auto" where it was taken for that."""
    if f"parameters/{key}" not in file["/"]:
        return ("nothing",)
    dataset = file[f"parameters/{key}"]
    value = dataset.asstr()[()] if h5py.check_string_dtype(dataset.dtype) else dataset[()]
    return (value, "auto") if dataset.attrs.get("auto", False) else (value,)


def is_alive(part):
    """True if a process still holds the lock of a folder being written."""
    try:
        with open(part / ".lock") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except OSError:
        return True
    return False


def recover(part, out):
    """Make what a killed process left in `part` into NAME.interrupted; return its path, None if it held no data."""
    series = part / "run.h5" if (part / "run.h5").exists() else None
    items = sorted((part / "items").glob("*.h5"))
    if series is None and not items:
        shutil.rmtree(part, ignore_errors=True)
        return None
    if series is None or not is_merged(series):
        items += [p for p in (part / "resumed.h5", part / "about.h5") if p.exists()]
        run_data.merge(part / "run.h5", series, items, lambda file: copy_attributes(part / "about.h5", file))
    clear_work_files(part, keep_checkpoint=True)
    kept = free_name(out, "interrupted")
    os.rename(part, kept)
    return kept


def is_merged(path):
    """True for a finished `run.h5`, False for a file of series alone."""
    with h5py.File(path, "r", libver="latest", swmr=True) as file:
        return "state" in file.attrs


def copy_attributes(about, file):
    """Give an open HDF5 file the root attributes of `about.h5`, and the state of a run that did not end."""
    if about.exists():
        with h5py.File(about, "r") as source:
            file.attrs.update(source.attrs)
    file.attrs["state"] = "interrupted"


def clear_work_files(path, keep_checkpoint=False):
    """Remove from a run's folder what its `run.h5` now holds, the lock and, if not kept, the checkpoints."""
    shutil.rmtree(path / "items", ignore_errors=True)
    for name in ("resumed.h5", "about.h5", ".lock", "run.tmp"):
        (path / name).unlink(missing_ok=True)
    for folder in () if keep_checkpoint else path.glob("checkpoint-*"):
        shutil.rmtree(folder)


def free_name(out, ending):
    """Return the first of NAME.ending, NAME.ending-2, … that does not exist."""
    names = (out.with_name(f"{out.name}.{ending}{suffix}") for suffix in [""] + [f"-{n}" for n in range(2, 10000)])
    return next(name for name in names if not name.exists())


def take_place(path, out, digest):
    """Rename the complete folder `path` to `out`; an older run of the same parameters gives way, nothing else does."""
    if out.is_dir() and any(out.iterdir()):
        if stored_digest(out) != digest:
            kept = free_name(out, "complete")
            os.rename(path, kept)
            raise UsageError(f"{out} was made by someone else meanwhile; this run is complete in {kept}")
        old = out.with_name(f".{out.name}.old-{os.getpid()}")
        os.rename(out, old)
        os.rename(path, out)
        shutil.rmtree(old)
        return
    os.rename(path, out)


def write_checkpoint(path, save, facts):
    """Have `save(folder)` write a checkpoint below `path`; it replaces the older one once it is whole."""
    temporary = path / "checkpoint.tmp"
    shutil.rmtree(temporary, ignore_errors=True)
    temporary.mkdir()
    save(temporary)
    (temporary / "checkpoint.json").write_text(json.dumps(facts))
    older = list(path.glob("checkpoint-*"))
    os.rename(temporary, path / f"checkpoint-{facts['step']:012d}")
    for folder in older:
        shutil.rmtree(folder)


def adopt(path, out, digest):
    """Copy the furthest checkpoint of the same parameters, with its data, into `path`; return its facts or None."""
    found = []
    for remains in out.parent.glob(f"{glob.escape(out.name)}.*"):
        for file in remains.glob("checkpoint-*/checkpoint.json"):
            facts = json.loads(file.read_text())
            if facts["digest"] == digest:
                found.append((facts["step"], remains, file.parent.name, facts))
    if not found:
        return None
    _, remains, checkpoint, facts = max(found, key=lambda f: f[0])
    shutil.copytree(remains / checkpoint, path / checkpoint)
    shutil.copy(remains / "run.h5", path / "resumed.h5")
    with h5py.File(path / "resumed.h5", "r+") as file:
        for group in ("parameters", "provenance"):
            file.pop(group, None)
        for frame in [name for name in file.get("frames", {}) if int(name) > facts["frames"]]:
            del file["frames"][frame]
    return {**facts, "folder": path / checkpoint, "remains": remains}
