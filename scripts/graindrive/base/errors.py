"""The errors that end a run early: a request that cannot be met, an engine that stops the run, a signal."""

import errno
import os

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # no room on the disk, in the quota, in a file


class UsageError(Exception):
    """The user's request cannot be met; the message is one line: the value received, the rule, the way out."""

    exit_code = 2


class EngineError(RuntimeError):
    """An engine stopped the run, as GrainLoop's guards do; the message is the engine's line, and no traceback is needed."""


class Interrupted(BaseException):
    """A signal asked the run to stop; this is not an `Exception`, so that no study catches it by accident.

    `signal_number` is the signal's number [-]; the exit code is 128 + that, as in a shell.
    """

    def __init__(self, signal_number):
        super().__init__(f"stopped by signal {signal_number}")
        self.signal_number = int(signal_number)
        self.exit_code = 128 + self.signal_number


def is_full(error):
    """True if an error says that the disk, the quota or a file is full; engines and HDF5 say so only in their text."""
    words = [os.strerror(number) for number in FULL]
    return getattr(error, "errno", None) in FULL or any(word in str(error) for word in words)


def one_line(value, limit=60):
    """Return `value` as text on one line of at most `limit` characters, for use in messages."""
    text = " ".join("".join(c if c.isprintable() else " " for c in str(value)).split())
    return text if len(text) <= limit else text[: limit - 1] + "…"
