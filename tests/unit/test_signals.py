"""Stop signals raise one exception: at once, or after a protected block; not if they were ignored from the start."""

import os
import signal
import subprocess
import sys

import pytest

from graindrive.base import signals
from graindrive.base.errors import Interrupted


@pytest.mark.parametrize("number", signals.STOP_SIGNALS)
def test_a_signal_raises_at_once_and_handlers_come_back(number):
    inherited = signal.signal(
        number, signal.SIG_DFL
    )  # under nohup and in the background some signals are ignored from the start
    try:
        with pytest.raises(Interrupted) as caught, signals.handled():
            os.kill(os.getpid(), number)
            pytest.fail("the line after the signal was reached")
        assert caught.value.exit_code == 128 + number and signal.getsignal(number) is signal.SIG_DFL
    finally:
        signal.signal(number, inherited)


def test_a_protected_block_ends_before_the_signal_takes_effect():
    done = []
    with pytest.raises(Interrupted), signals.handled():
        with signals.deferred():
            with signals.deferred():
                os.kill(os.getpid(), signal.SIGTERM)
                done.append("inner")
            done.append("outer")
        pytest.fail("the signal must be raised at the end of the outer block")
    assert done == ["inner", "outer"]


def test_an_error_in_a_protected_block_is_not_hidden():
    with pytest.raises(OSError, match="^of the block$"), signals.handled():
        with signals.deferred():
            raise OSError("of the block")
    with signals.handled():
        signals.check()


def test_a_study_does_not_swallow_it_by_accident():
    with pytest.raises(Interrupted), signals.handled():
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        except Exception:
            pytest.fail("an `except Exception` must not catch it")


def test_ignored_signals_stay_ignored():
    before, went_on = signal.signal(signal.SIGHUP, signal.SIG_IGN), False
    try:
        with signals.handled():
            os.kill(os.getpid(), signal.SIGHUP)
            signals.check()
            went_on = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
        assert went_on and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_second_ctrl_c_after_the_run_s_end_leaves_no_traceback():
    late = "import atexit, os, signal; atexit.register(lambda: os.kill(os.getpid(), signal.SIGINT))"
    usual = "signal.signal(signal.SIGINT, signal.default_int_handler)"
    program = f"{late}; {usual}; from graindrive.commands import headless; headless.end(130)"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    ended = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)
    assert ended.returncode == 130 and "KeyboardInterrupt" not in ended.stderr
