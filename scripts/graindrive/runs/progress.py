"""Runs a `March` in blocks of steps, shows its rate and the time left, and reacts to signals."""

import time
from dataclasses import dataclass

from ..base import signals
from ..base.errors import UsageError
from .progress_line import ProgressLine


@dataclass(frozen=True)
class Timing:
    """The cost of a sequence of steps: `seconds` is the time in the march, without the callbacks between blocks.

    `size` is the work of one step.
    """

    steps: int
    seconds: float
    size: float

    @property
    def work_per_second(self):
        """Work over seconds [1/s], for grains in particle-steps; NaN if no step was run."""
        return self.size * self.steps / self.seconds if self.seconds > 0 else float("nan")


MOST_STEPS = 1e10  # the papers' longest runs take 1e8


def require_feasible(steps, way_out="raise dt_factor or shorten the run"):
    """Raise UsageError for a run of more than `MOST_STEPS` steps, with their number and the `way_out`."""
    if not steps <= MOST_STEPS:
        raise UsageError(f"the run would take {steps:.3g} steps, more than {MOST_STEPS:.0e}; {way_out}")


def run_blocks(march, total_steps, block, on_block=None, *, label="run", pauses=(), on_pause=None, aim=None):
    """Advance a `March` by `total_steps` steps and call `on_block(steps_done)` after every `block`; return the `Timing`.

    At `pauses`, numbers of steps inside blocks, `on_pause(steps_done)` is called. If `on_block` returns true, the run ends
    early. If a run usually ends early, the `Calming` object `aim` shows its progress instead; it measures before each call of
    `on_block`. Raises what `march.advance` raises, `Interrupted` on a signal, UsageError for more than 1e10 steps.
    """
    if total_steps < 0 or block < 1:
        raise ValueError(f"steps must be >= 0 and block >= 1, got {total_steps} and {block}")
    require_feasible(total_steps)
    done, seconds = 0, 0.0
    with ProgressLine(total_steps, march.size, label, aim, unit=march.unit) as line:
        while done < total_steps:
            end = min(done + block, total_steps)
            for pause in sorted({step for step in pauses if done < step < end}):
                seconds += timed(march, pause - done)
                done = pause
                on_pause(done)
            seconds += timed(march, end - done)
            done = end
            line.update(done)
            if on_block is not None and on_block(done):
                break
    return Timing(done, seconds, march.size)


def timed(march, steps):
    """Advance a march by `steps` steps and return the seconds that this took; a signal before or after is raised."""
    signals.check()
    start = time.perf_counter()
    march.advance(steps)
    seconds = time.perf_counter() - start
    signals.check()
    return seconds


class Every:
    """A timer: `due` is true once per `seconds` of wall time, for the first time after `seconds`."""

    def __init__(self, seconds):
        self.seconds, self.last = seconds, time.monotonic()

    def due(self):
        """True if `seconds` have passed since it was last true."""
        now = time.monotonic()
        if now - self.last < self.seconds:
            return False
        self.last = now
        return True
