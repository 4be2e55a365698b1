"""Runs a `March` in blocks, samples it after each block and writes checkpoints, so that an interrupted run can continue."""

import contextlib
import sys

import numpy as np

from . import progress
from ..base.errors import EngineError, UsageError, one_line


class Track:
    """Rows that a study needs again after a resume: dicts of numbers and arrays, stored in checkpoints."""

    FILE = "track.npz"

    def __init__(self, folder):
        self.columns = {}
        if folder.resumed:
            with np.load(folder.resumed["folder"] / self.FILE) as file:
                self.columns = {name: list(file[name]) for name in file.files}

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def append(self, row):
        """Add a row, a dict of numbers and arrays; all rows have the same names."""
        for name, value in row.items():
            self.columns.setdefault(name, []).append(value)

    def arrays(self):
        """Return {name: array of shape (rows, …)}."""
        return {name: np.array(column) for name, column in self.columns.items()}

    def save(self, folder):
        """Write all rows into a checkpoint's folder."""
        np.savez(folder / self.FILE, **self.arrays())


class Frames:
    """Pictures that `picture()` takes at given `steps` (whole numbers); a resumed run takes the missing ones.

    `picture()` returns the arguments of `RunFolder.frame` after the time.
    """

    def __init__(self, folder, steps, picture):
        self.folder, self.picture, self.last = folder, picture, None
        self.due = sorted({int(step) for step in steps})[self.taken() :]

    def taken(self):
        """Return the number of pictures in the folder; a resumed run may have some at its start."""
        return self.folder.frames

    def store(self, t):
        """Store a picture at the time `t` in the folder."""
        self.folder.frame(t, *self.picture())

    def take_if_due(self, done, t):
        """Take a picture if one is due by the step `done`, at the time `t`."""
        if self.due and done >= self.due[0]:
            self.take(done, t)

    def take_what_is_left(self, done, t):
        """Take one more picture if the run ended early, at the step `done` and the time `t`, before all pictures were due."""
        if self.due and done != self.last:
            self.take(done, t)

    def take(self, done, t):
        """Take the next picture, after `done` steps, at the time `t`."""
        self.last = done
        self.due.pop(0)
        self.store(t)


class FieldFrames(Frames):
    """Pictures of a continuum's fields, like `Frames` for grains: `picture()` returns a dict of arrays.

    They are stored as the groups `flow_frames/0001` … of the run folder, each with its time as the attribute `t`.
    """

    GROUP = "flow_frames"

    def taken(self):
        return sum(name.startswith(f"{self.GROUP}/") for name in self.folder.items)

    def store(self, t):
        self.folder.write(f"{self.GROUP}/{self.taken() + 1:04d}", self.picture(), t=float(t))


def load_stage(folder, march, names=()):
    """Load the checkpoint of a resumed run of `folder` into a `March`; return those facts of its `stage` that `names` lists.

    UsageError for a checkpoint that this version cannot continue; the remains are left unchanged.
    """
    try:
        march.load(folder.resumed["folder"])
    except RuntimeError as error:
        remains = folder.resumed["remains"]
        raise UsageError(
            f"the scene in {remains} cannot be continued ({one_line(error, 200)}); remove {remains.name} or move it away"
            " to start anew"
        ) from None
    return {name: folder.resumed[name] for name in names}


@contextlib.contextmanager
def overlap_advice(keys):
    """Add advice to the error of the overlap guard: `keys` of the study that may help."""
    try:
        yield
    except EngineError as error:
        if "overlap" not in str(error):
            raise
        raise EngineError(f"{error}; what may help: {keys}") from None


def announce(folder, *, grains, dt, ratio, unit, also=""):
    """Print the number of grains and the time step of a run, with the further text `also`; note both in its folder."""
    folder.note(dt=dt, dt_over_critical=ratio, n_grains=grains)
    print(f"{grains} grains,{also} dt = {dt:.3g} {unit}, dt/dt_crit = {ratio:.3g}", file=sys.stderr)


def run_sampled(folder, march, steps, block, sample, *, label, track=None, frames=None, stage=None, before=0):
    """Run a `March` up to step `steps` of the run and call `sample(done)` after every `block`; return the steps done.

    If `sample` returns true, the run ends. A new run is sampled at step 0 too; in a resumed run the march must have loaded the
    checkpoint (`load_stage`). `frames` are taken at their own steps, also inside blocks, and once more at the end if the run
    ends early. A checkpoint of the march, the `track` and the facts `stage` is written every `checkpoint_seconds`. Steps and
    rate go to the folder's provenance. In a run of several parts, `before` is the number of steps of the earlier parts:
    checkpoints count them, and a checkpoint with fewer steps belongs to an earlier part.
    """
    resumed = bool(folder.resumed) and folder.resumed["step"] > before
    first, stage = folder.resumed["step"] - before if resumed else 0, stage or {}
    frames = frames or Frames(folder, (), None)
    checkpoints = progress.Every(folder.parameters.checkpoint_seconds)

    def save(place):
        march.save(place)
        if track is not None:
            track.save(place)

    def after_block(done):
        ended = sample(first + done)
        frames.take_if_due(first + done, march.time)
        if checkpoints.due():
            folder.checkpoint(save, before + first + done, **stage)
        return ended

    if not resumed:
        sample(0)
        frames.take_if_due(0, march.time)
    timing = progress.run_blocks(
        march,
        steps - first,
        block,
        after_block,
        label=label,
        pauses=[due - first for due in frames.due],
        on_pause=lambda done: frames.take_if_due(first + done, march.time),
    )
    frames.take_what_is_left(first + timing.steps, march.time)
    note_rate(folder, march, first + timing.steps, timing.work_per_second)
    return first + timing.steps


def note_rate(folder, march, steps, rate):
    """Note in the folder the number of steps and the work per second; for grains under the name used there."""
    folder.note(steps=steps)
    if march.unit == "particle-steps":
        folder.note(particle_steps_per_second=rate)
    else:
        folder.note(work_per_second=rate, work_unit=march.unit)
