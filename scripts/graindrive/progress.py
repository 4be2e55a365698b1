"""Drive YADE's loop in blocks of steps, showing rate and time left, open to signals and to engines' errors."""

import atexit
import threading
import time
from dataclasses import dataclass

from . import signals
from .errors import EngineError, UsageError
from .progress_line import ProgressLine


@dataclass(frozen=True)
class Timing:
    """What a sequence of steps cost: `seconds` is the time in YADE's loop, without the callbacks between blocks."""

    steps: int
    seconds: float
    grains: int

    @property
    def particle_steps_per_second(self):
        """Grains times steps over seconds [1/s]; NaN when nothing was run."""
        return self.grains * self.steps / self.seconds if self.seconds > 0 else float("nan")


MOST_STEPS = 1e10  # the papers' longest runs take 1e8


def require_feasible(steps):
    """UsageError for a run that would not end in a lifetime, saying how many steps it would take and the way out."""
    if not steps <= MOST_STEPS:
        raise UsageError(
            f"the run would take {steps:.3g} steps, more than {MOST_STEPS:.0e}; raise dt_factor or shorten the run"
        )


def run_blocks(total_steps, block, on_block=None, *, grains=0, label="run", pauses=(), on_pause=None, aim=None):
    """Run YADE `total_steps` steps, calling `on_block(steps_done)` after every `block` steps; return the `Timing`.

    At `pauses`, numbers of steps that lie inside blocks, `on_pause(steps_done)` is called. A true answer of `on_block` ends
    the run early. `grains` is the number of grains [-] that the rate counts. For a run that ends early as a rule, the
    `Calming` `aim` says how far it is; it measures before `on_block` is called. Raises EngineError with what an engine raised,
    `Interrupted` on a signal, RuntimeError if something else paused the loop, UsageError for more than 1e10 steps.
    """
    if total_steps < 0 or block < 1:
        raise ValueError(f"steps must be >= 0 and block >= 1, got {total_steps} and {block}")
    require_feasible(total_steps)
    done, seconds = 0, 0.0
    with ProgressLine(total_steps, grains, label, aim) as line:
        while done < total_steps:
            end = min(done + block, total_steps)
            for pause in sorted({step for step in pauses if done < step < end}):
                seconds += advance(pause - done)
                done = pause
                on_pause(done)
            seconds += advance(end - done)
            done = end
            line.update(done)
            if on_block is not None and on_block(done):
                break
    return Timing(done, seconds, grains)


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


def advance(steps):
    """Run YADE's loop for `steps` steps and return the seconds that it took.

    `O.run(n, True)` looks only every 40 ms whether the loop has ended and holds signals back all the while; short
    sleeps cost at most 2 % of the block's time and let a signal through at once.
    """
    from yade import O

    signals.check()
    target, start = O.iter + steps, time.perf_counter()
    O.run(steps)
    _listener.listen()
    try:
        while O.running:
            time.sleep(min(max(0.02 * (time.perf_counter() - start), 5e-5), 0.01))
    except BaseException:
        O.pause()
        while O.running:
            time.sleep(1e-4)
        raise
    seconds = time.perf_counter() - start
    signals.check()
    if O.iter < target:
        _listener.raise_what_it_heard()
        ask_engines()
        raise RuntimeError(f"an engine failed, or something paused YADE's loop, at step {O.iter} of {target}")
    return seconds


def ask_engines():
    """Call every engine in this thread, where what the failing one throws is heard: the step was not finished.

    For a failure so early that nobody was waiting yet. The scene is lost either way; what was measured is kept.
    """
    from yade import O

    for engine in O.engines:
        if not engine.dead:
            engine()


class LoopListener:
    """Waits in a thread of its own for YADE's loop to end, the only way to learn what an engine threw there.

    YADE hands an engine's exception to whoever is inside `O.wait()` when the loop ends, and to nobody afterwards. One
    wait may span many blocks; an engine that fails before the wait has begun has to be asked again.
    """

    def __init__(self):
        self.thread, self.error = None, None

    def listen(self):
        """Start waiting, unless an earlier wait still goes on."""
        if self.thread is None or not self.thread.is_alive():
            self.error = None
            self.thread = threading.Thread(target=self._wait, daemon=True)
            self.thread.start()

    def _wait(self):
        from yade import O

        try:
            O.wait()
        except Exception as error:
            self.error = error

    def leave(self):
        """Let the wait end: it sleeps for 40 ms, and Python would abort if it ended in that time."""
        if self.thread is not None:
            self.thread.join(timeout=1)

    def raise_what_it_heard(self):
        """Raise what an engine threw, if that was heard."""
        self.thread.join()
        if self.error is not None:
            raise EngineError(str(self.error)) from None


_listener = LoopListener()
atexit.register(_listener.leave)
