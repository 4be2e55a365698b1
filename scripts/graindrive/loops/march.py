"""What a run is to the run folder, the progress line, checkpoints and campaigns: something that marches on in steps."""

from typing import Protocol


class March(Protocol):
    """Anything that goes on in equal steps and can be saved and loaded: YADE's loop, a continuum solver, an oscillator.

    After `load` of what `save` wrote, the march must go on with the same bits as if it had never stopped; then resumed
    runs equal runs in one go. `size` is how much work one step is, in `unit` less its "-steps": grains for
    "particle-steps", cells for "cell-steps". A march whose size is 0 counts steps alone.
    """

    unit: str
    size: float

    @property
    def time(self):
        """Model time now, in the study's unit."""

    def advance(self, steps):
        """Go on by so many steps; raises what stops it."""

    def save(self, folder):
        """Write into an empty folder (a Path) all that is needed to go on."""

    def load(self, folder):
        """Take up what `save` wrote; RuntimeError with the reason where that cannot be."""
