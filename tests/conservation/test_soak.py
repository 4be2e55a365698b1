"""The soak run, shortened: its ledger closes, kill -9 changes no number, and a ledger that does not close fails."""

import json
import os
import signal

import numpy as np
import pytest

from graindrive.commands import soak

STEPS, BLOCK = 4000, 500


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The summary and the rows of a run that was never stopped."""
    out = tmp_path_factory.mktemp("whole")
    summary = soak.soak(out, STEPS, BLOCK)
    return summary, soak.rows_until(out / "ledger.csv", np.inf)


def test_the_ledger_closes_with_everything_in_the_scene(whole):
    summary, rows = whole
    assert rows.shape == (STEPS // BLOCK, len(soak.COLUMNS)) and summary["passed"]
    # 4000 steps add some 1e5 numbers to the entries, each with a round-off of 1e-16 of the energy exchanged.
    assert summary["closure_worst"] < 1e-12
    last = dict(zip(soak.COLUMNS, rows[-1]))
    assert last["time"] == STEPS * soak.TIME_STEP
    assert last["workOfBodies"] > 0 and last["workOfWalls"] != 0 and last["turnover"] > last["stored"]


def test_a_run_that_was_killed_goes_on_to_the_same_bits(whole, tmp_path):
    child = os.fork()
    if child == 0:
        soak.soak(tmp_path, STEPS, BLOCK, lambda rows: len(rows) == 3 and os.kill(os.getpid(), signal.SIGKILL))
        os._exit(1)
    assert os.WTERMSIG(os.waitpid(child, 0)[1]) == signal.SIGKILL
    with open(tmp_path / "ledger.csv", "a") as file:
        file.write("2.0,1e-15,3")  # a line that the kill has cut off
    summary = soak.soak(tmp_path, STEPS, BLOCK)
    assert summary["steps_before"] == 3 * BLOCK
    assert np.array_equal(soak.rows_until(tmp_path / "ledger.csv", np.inf), whole[1])


def test_a_ledger_that_does_not_close_fails(whole, monkeypatch, tmp_path):
    monkeypatch.setattr(soak, "BOUND", 1e-19)
    with pytest.raises(RuntimeError, match="residual is .* of the turnover, over 1e-19"):
        soak.soak(tmp_path, STEPS, BLOCK)
    assert soak.summary_of(whole[1], STEPS, 75, 1.0)["passed"] is False


def test_drift_is_the_slope_of_the_residual():
    rows = np.zeros((10, len(soak.COLUMNS)))
    rows[:, 0], rows[:, 3] = np.arange(1, 11), 100.0 * np.arange(1, 11)
    rows[:, 2] = 2e-6 * rows[:, 3]
    summary = soak.summary_of(rows, 10, 1, 1.0)
    assert summary["drift"] == pytest.approx(2e-6) and not summary["passed"]


def test_the_command_writes_its_summary(tmp_path, capsys):
    assert soak.main(["--out", str(tmp_path), "--hours", str(0.5 / 3600), "--report", "0.1"]) == 0
    assert json.loads((tmp_path / "summary.json").read_text())["steps"] == 500
    with pytest.raises(SystemExit) as ending:
        soak.main(["--hours", "-1"])
    assert ending.value.code == 2 and "hours" in capsys.readouterr().err
