"""What all tests here share."""

import os
import signal

from hypothesis import settings

# No test is timed; on a checking machine the same examples every time, elsewhere new ones.
settings.register_profile("house", deadline=None, derandomize="CI" in os.environ)
settings.load_profile("house")


def pytest_configure():
    """Let Ctrl-C reach the programs under test: started in the background, a shell has it ignored, and children inherit that."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
