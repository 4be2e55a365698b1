"""Let something march in blocks of steps, showing rate and time left, open to signals."""

import time
from dataclasses import dataclass

from ..base import signals
from ..base.errors import UsageError
from .progress_line import ProgressLine


@dataclass(frozen=True)
class Timing:
    """What a sequence of steps cost: `seconds` is the time in the march, without the callbacks between blocks.

    `size` is the work of one step.
    """

    steps: int
    seconds: float
    size: float

    @property
    def work_per_second(self):
        """Work over seconds [1/s], of a scene of grains particle-steps; NaN when nothing was run."""
        return self.size * self.steps / self.seconds if self.seconds > 0 else float("nan")


MOST_STEPS = 1e10  # the papers' longest runs take 1e8


def require_feasible(steps, way_out="raise dt_factor or shorten the run"):
    """UsageError for a run that would not end in a lifetime, saying how many steps it would take and the `way_out`."""
    if not steps <= MOST_STEPS:
        raise UsageError(f"the run would take {steps:.3g} steps, more than {MOST_STEPS:.0e}; {way_out}")


def run_blocks(march, total_steps, block, on_block=None, *, label="run", pauses=(), on_pause=None, aim=None):
    """Have a `March` go `total_steps` steps, calling `on_block(steps_done)` after every `block`; return the `Timing`.

    At `pauses`, numbers of steps that lie inside blocks, `on_pause(steps_done)` is called. A true answer of `on_block` ends
    the run early. For a run that ends early as a rule, the `Calming` `aim` says how far it is; it measures before
    `on_block` is called. Raises what `march.advance` raises, `Interrupted` on a signal, UsageError for more than 1e10 steps.
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
    """Have a march go on by so many steps, unless a signal asks to stop before or after; return the seconds that took."""
    signals.check()
    start = time.perf_counter()
    march.advance(steps)
    seconds = time.perf_counter() - start
    signals.check()
    return seconds


class Every:
    """Says `due` once in so many seconds of wall time, the first time after that many."""

    def __init__(self, seconds):
        self.seconds, self.last = seconds, time.monotonic()

    def due(self):
        """True if `seconds` have passed since it last was."""
        now = time.monotonic()
        if now - self.last < self.seconds:
            return False
        self.last = now
        return True
