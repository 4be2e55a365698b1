"""The protocol `March`: the interface of a time loop for the run folder, the progress line, checkpoints and campaigns."""

from typing import Protocol


class March(Protocol):
    """Anything that advances in equal steps and can be saved and loaded: YADE's loop, a continuum solver, an oscillator.

    After `load` the march must continue with the same bits as if it had never stopped; then a resumed run equals an
    uninterrupted one. `size` is the work of one step, in `unit` without its "-steps": grains for
    "particle-steps", cells for "cell-steps". For a march of size 0, steps are counted.
    """

    unit: str
    size: float

    @property
    def time(self):
        """Present model time, in the study's unit."""

    def advance(self, steps):
        """Advance by `steps` steps; raises the error that stops it."""

    def save(self, folder):
        """Write all data that are needed to continue into an empty folder (a Path)."""

    def load(self, folder):
        """Load what `save` wrote; RuntimeError with the reason if this is impossible."""
