"""YADE's loop as a `March`: it runs in the background, reacts to signals, and reports exceptions of its engines."""

import atexit
import threading
import time
from dataclasses import dataclass

from . import scene
from ..base import signals
from ..base.errors import EngineError

SCENE = "scene.checkpoint"  # file of a checkpoint


@dataclass
class YadeMarch:
    """The present scene of YADE, under either loop; `grains` is the number of grains for the rate.

    `advance` raises EngineError with the message of an engine's exception, `Interrupted` on a signal, RuntimeError if something
    else paused the loop.
    """

    grains: int = 0
    unit = "particle-steps"

    @property
    def size(self):
        """Number of grains [-]."""
        return self.grains

    @property
    def time(self):
        """Steps since the scene was made times the time step."""
        from yade import O

        return O.iter * O.dt

    def advance(self, steps):
        """Run YADE's loop for `steps` steps."""
        advance(steps)

    def save(self, folder):
        """Write the whole scene into a checkpoint's folder."""
        scene.save(folder / SCENE)

    def load(self, folder):
        """Put the scene of a checkpoint into YADE; RuntimeError with the reason if this is impossible."""
        scene.load(folder / SCENE)


def advance(steps):
    """Run YADE's loop for `steps` steps.

    `O.run(n, True)` checks only every 40 ms whether the loop has ended, and blocks signals meanwhile; short
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
    signals.check()
    if O.iter < target:
        _listener.raise_what_it_heard()
        ask_engines()
        raise RuntimeError(f"an engine failed, or something paused YADE's loop, at step {O.iter} of {target}")


def ask_engines():
    """Call every engine in this thread, so that the failing one raises its exception here: the step was not finished.

    This is for a failure so early that the listener was not waiting yet. The scene is lost in any case; measured data are kept.
    """
    from yade import O

    for engine in O.engines:
        if not engine.dead:
            engine()


class LoopListener:
    """Waits in a separate thread for the end of YADE's loop, which is the only way to get an engine's exception.

    YADE passes an engine's exception to a call of `O.wait()` that is active when the loop ends, and drops it otherwise. One
    wait may span many blocks; an engine that fails before the wait has begun must be called again.
    """

    def __init__(self):
        self.thread, self.error = None, None

    def listen(self):
        """Start waiting, unless an earlier wait is still active."""
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
        """Raise the exception of an engine, if there was one."""
        self.thread.join()
        if self.error is not None:
            raise EngineError(str(self.error)) from None


_listener = LoopListener()
atexit.register(_listener.leave)
