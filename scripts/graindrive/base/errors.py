"""The ways in which a run ends early: a request that cannot be met, an engine that stops it, a signal."""

import errno
import os

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # no room on the disk, in the quota, in a file


class UsageError(Exception):
    """What was asked for cannot be done; the message is one line: what was given, what is allowed, the way out."""

    exit_code = 2


class EngineError(RuntimeError):
    """An engine stopped the run, as GrainLoop's guards do; the message is the engine's, one line that needs no traceback."""


class Interrupted(BaseException):
    """A signal asked the run to stop; not an `Exception`, so that no study swallows it by accident.

    `signal_number` is the signal's number [-]; the exit code is 128 + that, as in a shell.
    """

    def __init__(self, signal_number):
        super().__init__(f"stopped by signal {signal_number}")
        self.signal_number = int(signal_number)
        self.exit_code = 128 + self.signal_number


def is_full(error):
    """True if an error says that a file could not grow; engines and HDF5 tell it in their text alone."""
    words = [os.strerror(number) for number in FULL]
    return getattr(error, "errno", None) in FULL or any(word in str(error) for word in words)


def one_line(value, limit=60):
    """Return `value` as text on one line of at most `limit` characters, for use in messages."""
    text = " ".join("".join(c if c.isprintable() else " " for c in str(value)).split())
    return text if len(text) <= limit else text[: limit - 1] + "…"
