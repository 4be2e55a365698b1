"""Runs a scene in blocks, samples it after each, and keeps checkpoints: a run goes on as if never interrupted (`scene.load`)."""

import contextlib
import sys

import numpy as np

from . import progress, scene
from .errors import EngineError, UsageError, one_line

SCENE = "scene.checkpoint"


class Track:
    """Rows that a study needs again when it goes on: dicts of numbers and arrays, kept in checkpoints."""

    FILE = "track.npz"

    def __init__(self, folder):
        self.columns = {}
        if folder.resumed:
            with np.load(folder.resumed["folder"] / self.FILE) as file:
                self.columns = {name: list(file[name]) for name in file.files}

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def append(self, row):
        """Add a row, a dict of numbers and arrays with the same names every time."""
        for name, value in row.items():
            self.columns.setdefault(name, []).append(value)

    def arrays(self):
        """Return {name: array of shape (rows, …)}."""
        return {name: np.array(column) for name, column in self.columns.items()}

    def save(self, folder):
        """Write all rows into a checkpoint's folder."""
        np.savez(folder / self.FILE, **self.arrays())


class Frames:
    """Pictures that `picture()` takes at given `steps` (whole numbers); a resumed run takes those that it lacks."""

    def __init__(self, folder, steps, picture):
        self.folder, self.picture, self.last = folder, picture, None
        self.due = sorted({int(step) for step in steps})[folder.frames :]

    def take_if_due(self, done):
        """Take a picture if one is due by the step `done`."""
        if self.due and done >= self.due[0]:
            self.take(done)

    def take_what_is_left(self, done):
        """Take one picture more if the run ended at `done`, before all were due."""
        if self.due and done != self.last:
            self.take(done)

    def take(self, done):
        """Take the next picture, of the time that `done` steps make."""
        from yade import O

        self.last = done
        self.due.pop(0)
        self.folder.frame(done * O.dt, *self.picture())


def load_stage(folder, names):
    """Put the scene from which a resumed run goes on into YADE; return the facts of its `stage` by these names.

    UsageError for a scene that this version cannot go on from; the remains stay as they are.
    """
    try:
        scene.load(folder.resumed["folder"] / SCENE)
    except RuntimeError as error:
        remains = folder.resumed["remains"]
        raise UsageError(
            f"the scene in {remains} cannot be gone on from ({one_line(error, 200)}); remove {remains.name} or move it away"
            " to start anew"
        ) from None
    return {name: folder.resumed[name] for name in names}


@contextlib.contextmanager
def overlap_advice(keys):
    """Add to the message of a guard that stopped grains which overlap too far which `keys` of the study may help."""
    try:
        yield
    except EngineError as error:
        if "overlap" not in str(error):
            raise
        raise EngineError(f"{error}; what may help: {keys}") from None


def announce(folder, *, grains, dt, ratio, unit, also=""):
    """Say of how many grains and of what time step a run is, with words that are `also` known, and note it in its folder."""
    folder.note(dt=dt, dt_over_critical=ratio, n_grains=grains)
    print(f"{grains} grains,{also} dt = {dt:.3g} {unit}, dt/dt_crit = {ratio:.3g}", file=sys.stderr)


def run_sampled(folder, steps, block, sample, *, track, frames, stage, grains, label):
    """Run `steps` steps from the start of the run, calling `sample(done)` after every `block`; return the steps done.

    A true answer of `sample` ends the run. A run that was not resumed is sampled at 0 too. `frames` are taken at their own
    steps, inside of blocks too, and once more at the end if that came early. A checkpoint of the scene, the `track` and the
    facts `stage` is written every `checkpoint_seconds`. Steps and rate go to the folder's provenance.
    """
    first = folder.resumed["step"] if folder.resumed else 0
    checkpoints = progress.Every(folder.parameters.checkpoint_seconds)

    def save(place):
        scene.save(place / SCENE)
        track.save(place)

    def after_block(done):
        ended = sample(first + done)
        frames.take_if_due(first + done)
        if checkpoints.due():
            folder.checkpoint(save, first + done, **stage)
        return ended

    if not folder.resumed:
        sample(0)
        frames.take_if_due(0)
    pauses = [due - first for due in frames.due]
    timing = progress.run_blocks(
        steps - first,
        block,
        after_block,
        grains=grains,
        label=label,
        pauses=pauses,
        on_pause=lambda done: frames.take_if_due(first + done),
    )
    frames.take_what_is_left(first + timing.steps)
    folder.note(steps=first + timing.steps, particle_steps_per_second=timing.particle_steps_per_second)
    return first + timing.steps


def block_means(binner):
    """Return the means of a ContactForceBinner on a body among disks since it was last cleared, as a dict, and clear it.

    fx, fy, normal_x (of the normal forces alone) [N], torque [N m], contacts, slipping; variances of the instantaneous
    values within the block, fx_var, fy_var [N^2], contacts_var; by angle, shape (bins,): normal, tangential [N],
    contacts_by_angle, slipping_by_angle. UsageError on a GrainLoop of spheres, whose forces have a third component.
    """
    loop = scene.fast_loop()
    if loop and loop.dimensions == 3:
        raise UsageError(
            "block_means records forces in the plane, and this scene is one of spheres; read the binner's own force,"
            " torque, ... (x, y, z)"
        )
    force, variance = binner.force, binner.forceVariance
    row = dict(
        fx=force[0],
        fy=force[1],
        normal_x=binner.normalForceOnBody[0],
        torque=binner.torque[2],
        contacts=binner.contactNumber,
        slipping=binner.slippingNumber,
        fx_var=variance[0],
        fy_var=variance[1],
        contacts_var=binner.contactNumberVariance,
        normal=binner.normalForce,
        tangential=binner.tangentialForce,
        contacts_by_angle=binner.contacts,
        slipping_by_angle=binner.slippingContacts,
    )
    binner.clear()
    return row
