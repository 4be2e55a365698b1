"""Turns Ctrl-C, SIGTERM and SIGHUP into one exception, which is raised at once except while files are being written."""

import contextlib
import signal
import threading

from .errors import Interrupted

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

_pending = None  # number of a signal that has arrived but has not been raised yet
_holds = 0  # number of nested `deferred` blocks


def _receive(number, _frame):
    global _pending
    _pending = number
    if _holds == 0:
        check()


def check():
    """Raise `Interrupted` if a signal asked the run to stop since the last check."""
    global _pending
    if _pending is not None:
        number, _pending = _pending, None
        raise Interrupted(number)


@contextlib.contextmanager
def deferred():
    """Delay signals in this block, for writing files; a signal that arrived is raised at its end."""
    global _holds
    _holds += 1
    try:
        yield
    finally:
        _holds -= 1
    if _holds == 0:
        check()


@contextlib.contextmanager
def handled():
    """Turn stop signals into `Interrupted` in this block; signals ignored from the start (nohup, `&`) stay ignored.

    Only the main thread may set signal handlers; in other threads this does nothing.
    """
    global _pending
    _pending = None
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = {s: signal.getsignal(s) for s in STOP_SIGNALS}
    for number, handler in previous.items():
        if handler is not signal.SIG_IGN:
            signal.signal(number, _receive)
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)
