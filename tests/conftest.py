"""What all tests here share."""

import signal


def pytest_configure():
    """Let Ctrl-C reach the programs under test: started in the background, a shell has it ignored, and children inherit that."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
