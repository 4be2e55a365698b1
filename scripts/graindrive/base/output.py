"""Words on stdout and stderr that nobody has to read: a pipe that closes or a disk that is full does not end a run.

`run_program` runs another Python program that way, from its first line on.
"""

import contextlib
import io
import os
import sys
from pathlib import Path


class Forgiving(io.RawIOBase):
    """A stream of bytes to the file descriptor `descriptor`, which leads nowhere from the first write that fails.

    The descriptor itself is turned to /dev/null then, so that what C++ code and child processes write there goes too.
    """

    def __init__(self, descriptor):
        self.descriptor = descriptor

    def write(self, content):
        """Write bytes; return how many, all of them where nobody takes them."""
        try:
            return os.write(self.descriptor, content)
        except OSError:
            lead_nowhere(self.descriptor)
            return len(content)

    def fileno(self):
        """Return the file descriptor."""
        return self.descriptor

    def isatty(self):
        """True if somebody sits there."""
        return os.isatty(self.descriptor)

    def writable(self):
        """True: it takes everything."""
        return True


def lead_nowhere(descriptor):
    """Turn a file descriptor to /dev/null."""
    with contextlib.suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, descriptor)
        os.close(nowhere)


def forgive():
    """Let stdout and stderr outlive their readers, if they are those that the process was started with."""
    for name, descriptor in (("stdout", 1), ("stderr", 2)):
        stream = getattr(sys, name)
        if stream is not None and stream is getattr(sys, f"__{name}__"):
            try:
                stream.flush()
            except OSError:
                lead_nowhere(descriptor)
            setattr(sys, name, forgiving(descriptor, stream))


def forgiving(descriptor, stream):
    """Return a text stream to a descriptor with the encoding of the old `stream`, written out line by line."""
    raw = io.BufferedWriter(Forgiving(descriptor))
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return io.TextIOWrapper(raw, encoding=encoding, errors="backslashreplace", line_buffering=True)


def run_program():
    """Run the Python program that the next argument names, in `__main__` as Python itself would."""
    forgive()
    del sys.argv[0]
    space = sys.modules["__main__"].__dict__
    space["__file__"] = sys.argv[0]
    exec(compile(Path(sys.argv[0]).read_bytes(), sys.argv[0], "exec"), space)
