"""Output to stdout and stderr that cannot end a run: a closed pipe or a full disk is ignored.

`run_program` runs another Python program in this way, from its first line on.
"""

import contextlib
import io
import os
import sys
import traceback
from pathlib import Path


class Forgiving(io.RawIOBase):
    """A stream of bytes to the file descriptor `descriptor`, which discards everything after the first write that fails.

    The descriptor itself is then redirected to /dev/null, so that output of C++ code and child processes is discarded too.
    """

    def __init__(self, descriptor):
        self.descriptor = descriptor

    def write(self, content):
        """Write bytes; return their number, also if they were discarded."""
        try:
            return os.write(self.descriptor, content)
        except OSError:
            lead_nowhere(self.descriptor)
            return len(content)

    def fileno(self):
        """Return the file descriptor."""
        return self.descriptor

    def isatty(self):
        """True if the descriptor is a terminal."""
        return os.isatty(self.descriptor)

    def writable(self):
        """True: the stream accepts all bytes."""
        return True


def lead_nowhere(descriptor):
    """Redirect a file descriptor to /dev/null."""
    with contextlib.suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, descriptor)
        os.close(nowhere)


def forgive():
    """Make stdout and stderr ignore failing writes, if they are still those that the process was started with."""
    for name, descriptor in (("stdout", 1), ("stderr", 2)):
        stream = getattr(sys, name)
        if stream is not None and stream is getattr(sys, f"__{name}__"):
            try:
                stream.flush()
            except OSError:
                lead_nowhere(descriptor)
            setattr(sys, name, forgiving(descriptor, stream))


def forgiving(descriptor, stream):
    """Return a line-buffered text stream to a descriptor, with the encoding of the old `stream`."""
    raw = io.BufferedWriter(Forgiving(descriptor))
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return io.TextIOWrapper(raw, encoding=encoding, errors="backslashreplace", line_buffering=True)


def run_program():
    """Run the Python program that the next argument names, as `__main__`, like Python itself."""
    forgive()
    del sys.argv[0]
    space = sys.modules["__main__"].__dict__
    space["__file__"] = sys.argv[0]
    try:
        code = compile(Path(sys.argv[0]).read_bytes(), sys.argv[0], "exec")
    except SyntaxError as error:  # a traceback would show this function alone
        sys.exit("".join(traceback.format_exception_only(error)).rstrip())
    exec(code, space)
