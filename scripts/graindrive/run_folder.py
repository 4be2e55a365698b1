"""The run folder: written under a hidden name, renamed when complete, saved under a telling name when it ends early."""

import fcntl
import json
import math
import os
import shutil
import sys
import time
from pathlib import Path

import numpy as np

from . import exports, run_data, run_remains, signals
from .errors import Interrupted, UsageError, one_line
from .postproc import quantities
from .provenance import provenance

LONGEST_NAME = 230  # bytes; a file system takes 255, and NAME.interrupted-2 or .NAME.part-PID must fit
CONTRACT = ("particle_steps_per_second", "steps", "n_grains", "wall_s", "dt_over_critical")


class RunFolder:
    """Context in which one run writes its data; `path` is the folder while it grows, `out` its name when complete.

    On entry `out` is checked and its neighbour `.NAME.part-PID` made; nothing is ever overwritten. A good end writes
    `run.h5` and `summary.json`, calls `figure(path)`, exports what is asked for and renames the folder to `out`.
    A UsageError removes it; a
    signal keeps what was measured as `NAME.interrupted`, any other failure as `NAME.failed`. Entering raises UsageError
    if `out` cannot be used, AlreadyComplete if the same run is there.
    """

    def __init__(self, parameters, *, study, figure=None):
        self.parameters, self.study, self.figure = parameters, study, figure
        self.out = place_of(parameters.out)
        self.path = self.out.with_name(f".{self.out.name}.part-{os.getpid()}")
        self.provenance, self.summary, self.units = provenance(parameters, study), {}, {}
        self.series, self.frames, self.lock, self.made = None, 0, None, []
        self.resumed, self.start, self.wall_before = None, time.monotonic(), 0.0

    def declare_series(self, **units):
        """Name the time series and their units, once, before the first `append`."""
        if self.series is not None:
            raise ValueError("the series are declared already")
        first = None
        if self.resumed:
            first, _ = run_data.read_series(self.path / "resumed.h5", self.resumed["rows"])
        with signals.deferred():
            self.series = run_data.SeriesWriter(self.path / "run.h5", units, first)

    def append(self, **columns):
        """Add to every series one number, or a 1D array of numbers."""
        with signals.deferred():
            self.series.append(**columns)

    def frame(self, t, grains, contacts=None, intruder=None, period=0.0):
        """Store a picture of the bed at time `t` (see `picture.Picture`): dicts of 1D arrays, and the box's period in x."""
        parts = {"contacts": contacts or {}, "intruder": intruder or {}}
        inner = {f"{part}/{name}": array for part, columns in parts.items() for name, array in columns.items()}
        self.write(f"frames/{self.frames + 1:04d}", {**grains, **inner}, t=float(t), period=float(period))
        self.frames += 1

    def write(self, group, arrays, **attributes):
        """Store a dict of arrays, or of (array, unit), as an HDF5 group (`intruder`); once per group.

        Names that `postproc.quantities` knows get their units from there.
        """
        system = self.parameters.unit_system
        arrays = quantities.labelled(group, arrays, system)
        attributes = quantities.with_units(group, attributes, system)
        with signals.deferred():
            run_data.write_item(self.path / "items", group, arrays, attributes)

    def note(self, **facts):
        """Add facts to the provenance: dt, dt_over_critical, n_grains, steps, particle_steps_per_second …"""
        self.provenance.update(facts)

    def summarize(self, **found):
        """Add quantities, and their standard errors as NAME_err, to summary.json.

        Their units come from `postproc.quantities`; (value, unit) says one that stands elsewhere or differs.
        """
        for name, value in found.items():
            value, self.units[name] = value if isinstance(value, tuple) else (value, None)
            self.summary.update(plain({name: value}))

    @property
    def wall_s(self):
        """Wall time of the run so far [s], of a resumed one with what led to the checkpoint from which it went on."""
        return self.wall_before + time.monotonic() - self.start

    def checkpoint(self, save, step, **facts):
        """Have `save(folder)` write all that is needed to go on from `step`; it replaces the older checkpoint.

        `facts` are plain values; with resume=1 they come back in `resumed`, with the checkpoint's `folder` and `step`.
        """
        if self.series is not None:
            self.series.flush()
        rows = self.series.rows if self.series is not None else 0
        facts = {**facts, "step": step, "rows": rows, "frames": self.frames, "wall_s": self.wall_s}
        facts["digest"] = self.parameters.digest()
        with signals.deferred():
            run_remains.write_checkpoint(self.path, save, facts)

    def __enter__(self):
        try:
            with signals.deferred():
                try:
                    run_remains.look_around(self)
                    self.make_part()
                    exports.check(self.parameters.exports)
                except OSError as error:
                    raise UsageError(
                        f"out={one_line(self.parameters.out)} cannot be written ({error.strerror or type(error).__name__});"
                        " give out= a folder that you may write to"
                    ) from None
                if self.parameters.resume:
                    self.resume()
        except BaseException:
            self.close()
            self.remove_part()
            raise
        return self

    def make_part(self):
        """Make the folder to write in, hold its lock and say in it what run it is."""
        for parent in reversed([p for p in self.path.parents if not p.exists()]):
            parent.mkdir()
            self.made.append(parent)
        self.path.mkdir()
        self.lock = open(self.path / ".lock", "w")
        fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        run_data.write_file(self.path / "about.h5", lambda file: self.describe(file, "running"))

    def resume(self):
        """Take over the checkpoint of an interrupted run of the same parameters, if there is one."""
        self.resumed = run_remains.adopt(self.path, self.out, self.parameters.digest())
        if self.resumed is None:
            print(f"{self.study}: no interrupted run of these parameters to resume; starting anew", file=sys.stderr)
        else:
            self.frames, self.wall_before = self.resumed["frames"], self.resumed.get("wall_s", 0.0)
            print(
                f"{self.study}: going on from step {self.resumed['step']} of {self.resumed['remains']}", file=sys.stderr
            )

    def remove_part(self):
        """Remove the folder to write in, and those parents that were made for it and are empty."""
        shutil.rmtree(self.path, ignore_errors=True)
        for parent in reversed(self.made):
            if any(parent.iterdir()):
                break
            parent.rmdir()

    def __exit__(self, kind, error, _traceback):
        with signals.deferred():
            if kind is None:
                try:
                    self.complete()
                except BaseException:
                    if self.path.exists():
                        self.keep("failed")
                    raise
            elif issubclass(kind, UsageError):
                self.close()
                self.remove_part()
            else:
                self.keep("interrupted" if issubclass(kind, (Interrupted, KeyboardInterrupt)) else "failed")

    def complete(self):
        """Finish all files and give the folder its right name."""
        self.finish_data("complete")
        facts = {key: self.provenance.get(key, math.nan) for key in CONTRACT}
        own = {name: unit for name, unit in self.units.items() if unit is not None}
        told = quantities.with_units("summary", {**plain(facts), **self.summary}, self.parameters.unit_system, own)
        text = json.dumps(told, indent=2, allow_nan=False)
        (self.path / "summary.json").write_text(text + "\n")
        if self.figure is not None:
            self.figure(self.path)
        exports.write(self.path, self.parameters.exports)
        self.close()
        run_remains.clear_work_files(self.path)
        run_remains.take_place(self.path, self.out, self.parameters.digest())
        if self.resumed:
            shutil.rmtree(self.resumed["remains"])

    def keep(self, ending):
        """Save what was measured as NAME.`ending`; remove the folder if nothing was."""
        measured = self.resumed or self.frames or (self.series is not None and self.series.rows)
        if not measured and not any(self.path.glob("checkpoint-*")):
            self.close()
            self.remove_part()
            return
        try:
            self.finish_data(ending)
        except (OSError, RuntimeError) as error:  # a full disk: what stands there now is all that there is
            print(
                f"{self.study}: the data so far are in {self.path}, unfinished: {one_line(error, 200)}", file=sys.stderr
            )
            return
        self.close()
        run_remains.clear_work_files(self.path, keep_checkpoint=True)
        kept = run_remains.free_name(self.out, ending)
        os.rename(self.path, kept)
        print(f"{self.study}: the data so far are kept in {kept}", file=sys.stderr)

    def finish_data(self, state):
        """Make the one plain `run.h5` of all that was written; `state` says how the run ended."""
        self.provenance["wall_s"] = self.wall_s
        if self.series is not None:
            self.series.close()
        series = self.path / "run.h5" if self.series is not None else None
        items = sorted((self.path / "items").glob("*.h5")) + list(self.path.glob("resumed.h5"))
        run_data.merge(self.path / "run.h5", series, items, lambda file: self.describe(file, state))

    def describe(self, file, state):
        """Write parameters with units, and provenance, into an open HDF5 file."""
        file.attrs.update(state=state, study=self.study, digest=self.parameters.digest())
        for key, value in self.parameters.taken().items():
            dataset = file.require_group("parameters").create_dataset(key, data="auto" if value is None else value)
            dataset.attrs["auto"] = getattr(self.parameters, key) is None
            dataset.attrs["unit"] = self.parameters.unit(key)
            dataset.attrs["meaning"] = self.parameters.__fields__[key].field_info.description or ""
        file.require_group("provenance").attrs.update(self.provenance)

    def close(self):
        """Close the files that are open for writing, and let go of the lock."""
        if self.series is not None:
            self.series.close()
        if self.lock is not None:
            self.lock.close()


def place_of(out):
    """Return the absolute path of the run folder that `out` names; UsageError where it can name none."""
    given = f"out={one_line(out)}"
    try:
        place = Path(out).expanduser().absolute()
    except RuntimeError:
        raise UsageError(
            f"{given} begins with ~ and the name of no user; give another path, or ./~… for such a name"
        ) from None
    if place.name in ("", ".."):
        raise UsageError(f"{given} is not the name of a run folder; give one below it")
    if (length := len(os.fsencode(place.name))) > LONGEST_NAME:
        raise UsageError(
            f"{given} is a name of {length} bytes; at most {LONGEST_NAME} are possible, give a shorter one"
        )
    return place


def plain(quantities):
    """Return a flat dict with NumPy's numbers as Python's, and None for what is not finite."""
    flat = {}
    for key, value in quantities.items():
        value = value.item() if isinstance(value, (np.generic, np.ndarray)) else value
        flat[key] = None if isinstance(value, float) and not math.isfinite(value) else value
        if not isinstance(flat[key], (str, int, float, type(None))):
            raise TypeError(f"summary quantity {key} must be a number or a word, got {type(value).__name__}")
    return flat
