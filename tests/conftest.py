"""Fixtures and settings that all tests share."""

import os
import signal

import pytest
from hypothesis import settings

# Hypothesis has no time limit; it uses the same examples every time in continuous integration, elsewhere new ones.
settings.register_profile("house", deadline=None, derandomize="CI" in os.environ)
settings.load_profile("house")


def pytest_configure():
    """Let Ctrl-C reach the programs under test. A shell ignores it for programs in the background, and children inherit that."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def figures_drawn(monkeypatch):
    """Assert of every figure that the test saves that no legend hides data; return the list of the names of those seen."""
    import free_legends
    from graindrive.postproc import figures

    close, seen = figures.plt.close, []

    def look(figure="all"):
        if (
            figure == "all"
        ):  # pyplot calls this itself when it chooses its backend, before the first figure of a process
            return close(figure)
        hidden = free_legends.hidden(figure)
        assert not hidden, f"legends over data in {hidden}"
        seen.append(figure)
        return close(figure)

    monkeypatch.setattr(figures.plt, "close", look)
    return seen
