"""The run folder: written under a hidden name, renamed when complete, kept as NAME.interrupted or NAME.failed otherwise.

`run_remains.py` explains what each state of the folder on disk means for the next call.
"""

import math
import resource
import sys
import time

import numpy as np

from . import checkpoint, run_data, run_file, run_place, run_remains, summary_file
from ..exports import exports
from ..base import signals
from ..base.errors import Interrupted, UsageError, is_full, one_line
from ..postproc import quantities
from .provenance import provenance

CONTRACT = (
    "particle_steps_per_second",
    "steps",
    "n_grains",
    "wall_s",
    "core_seconds",
    "peak_memory",
    "dt_over_critical",
)


class RunFolder:
    """Context in which one run writes its data; `path` is the folder during the run, `out` its name when complete.

    On entry `out` is checked and the folder `.NAME.part-PID` is made beside it; nothing is ever overwritten. A successful end
    writes `run.h5` and `summary.json`, calls `figure(path)`, writes the exports and renames the folder to `out`. A UsageError
    removes the folder; after a signal the data are kept as `NAME.interrupted`, after any other failure as `NAME.failed`.
    Entering raises UsageError if `out` cannot be used, AlreadyComplete if the same run exists. `study` is the study's name,
    `family` the name of the study of which it is a preset, `constants` its {name: Constant}, `observables` its `Observable`s,
    whose units and meanings the run folder keeps.
    """

    def __init__(self, parameters, *, study, figure=None, constants=None, observables=(), family=None):
        self.parameters, self.study, self.figure = parameters, study, figure
        self.constants, self.observables, self.family = constants or {}, observables, family or study
        self.out = run_place.place_of(parameters.out)
        self.path = run_place.hidden(self.out, "part")
        self.provenance, self.summary, self.units = provenance(parameters, study), {}, {}
        self.series, self.frames, self.items, self.lock, self.made = None, 0, {}, None, []
        self.resumed, self.start, self.wall_before = None, time.monotonic(), 0.0
        self.start_processor, self.processor_before = processor_time(), 0.0

    def declare_series(self, **units):
        """Declare the time series and their units, once, before the first `append`."""
        if self.series is not None:
            raise ValueError("the series are declared already")
        first = None
        if self.resumed:
            first, _ = run_data.read_series(self.path / checkpoint.DATA, self.resumed["rows"])
        with signals.deferred():
            self.series = run_data.SeriesWriter(self.path / "run.h5", units, first)

    def append(self, **columns):
        """Add to every series one number, or a 1D array of numbers."""
        with signals.deferred():
            self.series.append(**columns)

    def frame(self, t, grains, contacts=None, intruder=None, period=0.0):
        """Store a picture of the bed at time `t` (see `picture.Picture`): dicts of 1D arrays, and the box's period.

        The period is a number (along x) for disks, and three numbers for spheres, whose `grains` have a column `z`.
        """
        contacts = contacts or {}
        if "z" in grains:
            contacts = quantities.of_spheres(contacts, self.parameters.unit_system)
        self.write(
            run_file.frame_group(self.frames + 1),
            run_file.frame_arrays(grains, contacts, intruder or {}),
            t=float(t),
            period=period if np.ndim(period) else float(period),
        )
        self.frames += 1

    def write(self, group, arrays, **attributes):
        """Store a dict of arrays, or of (array, unit), as an HDF5 group (`intruder`); once per group, and not inside another.

        Names that `postproc.quantities` knows get their units from there.
        """
        system = self.parameters.unit_system
        arrays = quantities.labelled(group, arrays, system)
        attributes = quantities.with_units(group, attributes, system)
        with signals.deferred():
            self.items[group] = run_data.write_item(self.path / "items", group, arrays, attributes)

    def note(self, **facts):
        """Add facts to the provenance: dt, dt_over_critical, n_grains, steps, particle_steps_per_second …"""
        self.provenance.update(facts)

    def summarize(self, **found):
        """Add quantities, and their standard errors as NAME_err, to summary.json.

        Their units come from `postproc.quantities`; give (value, unit) for a unit that is missing there or differs.
        """
        for name, value in found.items():
            value, self.units[name] = value if isinstance(value, tuple) else (value, None)
            self.summary.update(plain({name: value}))

    @property
    def wall_s(self):
        """Wall time of the run so far [s]; in a resumed run it includes the time before the checkpoint."""
        return self.wall_before + time.monotonic() - self.start

    @property
    def core_seconds(self):
        """Processor time of all threads and programs of the run so far [s], including the time before a checkpoint."""
        return self.processor_before + processor_time() - self.start_processor

    def note_cost(self):
        """Note the cost of the run in the provenance: wall time, processor time, and the largest memory of this process."""
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6  # Linux counts KiB
        self.note(wall_s=self.wall_s, core_seconds=self.core_seconds, peak_memory=memory)

    def checkpoint(self, save, step, **facts):
        """Write a checkpoint with `save(folder)`, from which the run can continue at `step`; it replaces the older one.

        `facts` are plain values; with resume=1 they are found in `resumed`, with the checkpoint's `folder` and `step`.
        """
        facts = {**facts, "step": step, "frames": self.frames, "items": self.items}
        facts.update(wall_s=self.wall_s, core_seconds=self.core_seconds)
        facts.update(digest=self.parameters.digest(), code_version=self.provenance["code_version"])
        with signals.deferred():
            if self.series is not None:
                self.series.sync()
            facts["rows"] = self.series.rows if self.series is not None else 0
            facts["series"] = self.series.sum if self.series is not None else run_data.series_sum({}, {})
            checkpoint.write(self.path, save, facts)

    def __enter__(self):
        try:
            with signals.deferred():
                try:
                    self.begin()
                except OSError as error:
                    if is_full(error):
                        raise
                    raise UsageError(
                        f"out={one_line(self.parameters.out)} cannot be written ({error.strerror or one_line(error)});"
                        " give out= a folder that you may write to"
                    ) from None
        except BaseException:
            self.close()
            self.remove_part()
            raise
        return self

    def begin(self):
        """Check `out`, settle the remains of killed runs, then make the folder to write in; with resume=1 fill it."""
        for parent in reversed([p for p in self.out.parents if not p.exists()]):
            parent.mkdir()
            self.made.append(parent)
        with run_place.held(self.out.parent):
            run_remains.settle(self)
            run_place.refuse_what_is_there(self)
            run_place.refuse_at_work(self)
            self.path.mkdir()
            self.lock = run_place.take_lock(self.path)
        run_data.write_file(self.path / "about.h5", lambda file: self.describe(file, "running"))
        exports.check(self.parameters.exports)
        if self.parameters.resume:
            self.resume()

    def resume(self):
        """Copy the checkpoint of an interrupted run of the same parameters, if there is one."""
        self.resumed = run_remains.adopt(self.path, self.out, self.parameters.digest())
        if self.resumed is None:
            self.say("no interrupted run of these parameters to resume; starting anew")
            return
        self.frames, self.wall_before = self.resumed["frames"], self.resumed["wall_s"]
        self.processor_before = self.resumed.get("core_seconds", 0.0)
        self.items = dict(self.resumed["items"])
        self.say(f"going on from step {self.resumed['step']} of {self.resumed['remains']}")
        before, now = self.resumed["code_version"], self.provenance["code_version"]
        if before != now:
            self.note(code_version_before=before)
            self.say(f"version {before} made that run, this is version {now}; the result will come from both")

    def say(self, words):
        """Print a message on stderr, preceded by the name of the study."""
        print(f"{self.study}: {words}", file=sys.stderr)

    def remove_part(self):
        """Remove the folder of this run, if it made one, and those of its parents that were made for it and are empty."""
        if self.lock is not None and self.path.exists():
            run_place.remove(self.path, self.out)
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
        """Finish all files and rename the folder to `out`; nothing can be lost once `run.h5` is complete."""
        self.note_cost()
        facts = {key: self.provenance.get(key, math.nan) for key in CONTRACT}
        own = {observable.name: observable.unit for observable in self.observables}
        own = {**own, **{name: unit for name, unit in self.units.items() if unit is not None}}
        told = quantities.with_units("summary", {**plain(facts), **self.summary}, self.parameters.unit_system, own)
        summary_file.write(self.path, told)
        if lacking := without_value(self.summary):
            self.say(f"the run gives no value of {', '.join(lacking)}: null in summary.json")
        self.finish_data("complete")
        run_remains.draw(self.path, self.out, self.figure, self.parameters.exports)
        with run_place.held(self.out.parent):
            self.close()
            run_remains.take_name(self.path, self.out, self.parameters.digest())

    def keep(self, ending):
        """Keep the data as NAME.`ending`; remove the folder if it holds no data, or no more than the run that it resumed."""
        measured = self.resumed or self.frames or (self.series is not None and self.series.rows)
        if not measured and not checkpoint.folders(self.path):
            self.close()
            self.remove_part()
            return
        try:
            self.note_cost()
            self.finish_data(ending)
        except (OSError, RuntimeError) as error:  # a full disk: the data stay in the unfinished folder
            self.say(f"the data so far are in {self.path}, unfinished: {one_line(error, 200)}")
            return
        with run_place.held(self.out.parent):
            self.close()
            kept = run_remains.keep(self.path, self.out, ending)
        self.say(
            f"the data so far are kept in {kept}"
            if kept
            else "this run got no further than earlier remains, which are kept"
        )

    def finish_data(self, state):
        """Combine all written files into one plain `run.h5`; `state` says how the run ended."""
        if self.series is not None:
            self.series.close()
        series = self.path / "run.h5" if self.series is not None else None
        items = sorted((self.path / "items").glob("*.h5")) + list(self.path.glob(checkpoint.DATA))
        run_data.merge(self.path / "run.h5", series, items, lambda file: self.describe(file, state))

    def describe(self, file, state):
        """Write description, parameters, constants and provenance of the run into an open HDF5 file."""
        attributes = dict(state=state, study=self.study, family=self.family, digest=self.parameters.digest())
        if self.resumed:
            attributes[checkpoint.SOURCE] = self.resumed["remains"].name
        constants = {name: run_file.Described(c.value, c.unit, c.meaning) for name, c in self.constants.items()}
        meanings = {observable.name: observable.meaning for observable in self.observables}
        described = self.parameters_described()
        run_file.write_about(file, run_file.About(attributes, described, constants, self.provenance, meanings))

    def parameters_described(self):
        """Return {key: Described} of the parameters, with the derived values in place of `auto`."""
        p = self.parameters
        meanings = {key: field.field_info.description or "" for key, field in p.__fields__.items()}
        taken = p.taken().items()
        return {key: run_file.Described(v, p.unit(key), meanings[key], getattr(p, key) is None) for key, v in taken}

    def close(self):
        """Close the files that are open for writing, and release the lock."""
        if self.series is not None:
            self.series.close()
        if self.lock is not None:
            self.lock.close()


def processor_time():
    """Return the processor time of this process with all its threads, and of its child processes that have ended [s]."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def without_value(summary):
    """Return the names of quantities that are None, without standard errors, which short runs often lack."""
    return [name for name, value in summary.items() if value is None and not name.endswith("_err")]


def plain(quantities):
    """Return a flat dict with NumPy numbers as Python numbers, and None for numbers that are not finite."""
    flat = {}
    for key, value in quantities.items():
        value = value.item() if isinstance(value, (np.generic, np.ndarray)) else value
        flat[key] = None if isinstance(value, float) and not math.isfinite(value) else value
        if not isinstance(flat[key], (str, int, float, type(None))):
            raise TypeError(f"summary quantity {key} must be a number or a word, got {type(value).__name__}")
    return flat
