"""YADE's loop as a `March`: it runs in the background, is open to signals, and what its engines throw is heard."""

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
    """The scene that stands in YADE, under either loop; `grains` is the number that its rate counts.

    `advance` raises EngineError with what an engine raised, `Interrupted` on a signal, RuntimeError if something else paused
    the loop.
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
        """Run YADE's loop for so many steps."""
        advance(steps)

    def save(self, folder):
        """Write the whole scene into a checkpoint's folder."""
        scene.save(folder / SCENE)

    def load(self, folder):
        """Put the scene of a checkpoint into YADE; RuntimeError with the reason where that cannot be."""
        scene.load(folder / SCENE)


def advance(steps):
    """Run YADE's loop for `steps` steps.

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
    signals.check()
    if O.iter < target:
        _listener.raise_what_it_heard()
        ask_engines()
        raise RuntimeError(f"an engine failed, or something paused YADE's loop, at step {O.iter} of {target}")


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
