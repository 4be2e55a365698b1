"""The continuum solver as a `March`, and averages of its fields."""

import time
import zipfile

import numpy as np

from ..base import signals
from ..base.errors import EngineError

CHUNK = 20  # steps between two checks for signals
STATE = "flow.npz"  # file of a checkpoint


class FlowMarch:
    """A `TwoPhaseFlow` that advances in steps; `size` is its number of cells, `seconds` the processor time of its steps [s].

    `advance` raises EngineError with the solver's message and `advice`, `Interrupted` on a signal. After `load` the flow
    continues with the same bits.
    """

    unit = "cell-steps"

    def __init__(self, flow, advice=""):
        self.flow, self.advice = flow, advice
        self.seconds = 0.0

    @property
    def size(self):
        """Number of cells [-]."""
        return self.flow.fraction.size

    @property
    def time(self):
        """Time since the flow began, in the units of its keywords."""
        return self.flow.time

    def advance(self, steps):
        """Advance by `steps` steps."""
        while steps > 0:
            signals.check()
            some = min(steps, CHUNK)
            start = time.process_time()
            try:
                self.flow.advance(some)
            except RuntimeError as error:
                raise EngineError("; ".join(filter(None, (str(error), self.advice)))) from None
            self.seconds += time.process_time() - start
            steps -= some

    def save(self, folder):
        """Write the flow's state into a checkpoint's folder."""
        np.savez(folder / STATE, seconds=self.seconds, **self.flow.state())

    def load(self, folder):
        """Load what `save` wrote; RuntimeError with the reason if this is impossible."""
        try:
            with np.load(folder / STATE) as file:
                state = {name: file[name] if file[name].ndim else file[name].item() for name in file.files}
            self.seconds = state.pop("seconds")
            self.flow.restore(state)
        except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
            raise RuntimeError(f"{STATE} does not hold this flow: {error}") from None


def centres(low, spacing, count):
    """Return the centres of `count` cells from `low` on, (count,)."""
    return low + (np.arange(count) + 0.5) * spacing


class FieldMeans:
    """Means of a flow's fields over blocks of samples, (blocks, ny, nx): fraction, fraction times velocity, pressure, ill-posed.

    `add(block, flow)` takes a sample. `save` and `load` keep them in a checkpoint's folder.
    """

    FILE = "means.npz"

    def __init__(self, blocks, shape):
        self.samples = np.zeros(blocks, dtype=int)
        self.sums = {name: np.zeros((blocks, *shape)) for name in ("fraction", "pressure", "ill_posed")}
        self.sums["flux"] = np.zeros((blocks, *shape, 2))

    def add(self, block, flow):
        """Add the present fields of the flow to a block, 0 … blocks - 1."""
        fraction = flow.fraction
        self.samples[block] += 1
        self.sums["fraction"][block] += fraction
        self.sums["pressure"][block] += flow.pressure
        self.sums["ill_posed"][block] += flow.ill_posed
        self.sums["flux"][block] += fraction[..., None] * flow.velocity

    def mean(self, name):
        """Return the blocks' means of one field; those without a sample are nan."""
        sums = self.sums[name]
        with np.errstate(invalid="ignore"):
            return sums / self.samples.reshape(-1, *[1] * (sums.ndim - 1))

    @property
    def velocity(self):
        """Velocity of the dense fluid, weighted with its fraction, (blocks, ny, nx, 2); nan where there was no dense fluid."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.sums["flux"] / np.where(self.sums["fraction"] > 0, self.sums["fraction"], np.nan)[..., None]

    def save(self, folder):
        """Write all sums into a checkpoint's folder."""
        np.savez(folder / self.FILE, samples=self.samples, **self.sums)

    def load(self, folder):
        """Load what `save` wrote."""
        with np.load(folder / self.FILE) as file:
            self.samples = file["samples"]
            self.sums = {name: file[name] for name in self.sums}
