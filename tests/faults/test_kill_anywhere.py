"""A run that is killed, or finds the disk full, at any of its changes of the file system can be resumed to a complete run."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

SUPPORT = Path(__file__).parents[1] / "support"


@pytest.fixture(scope="module")
def killer(tmp_path_factory):
    """The compiled library that kills a process at its n-th change."""
    library = tmp_path_factory.mktemp("killer") / "kill_at.so"
    source = SUPPORT / "kill_at.cpp"
    subprocess.run(["g++", "-shared", "-fPIC", "-O1", "-o", library, source, "-ldl"], check=True, timeout=120)
    return library


def carry_out(killer, folder, scenario, every):
    """Run a scenario of kill_anywhere.py; return what it prints."""
    command = [sys.executable, SUPPORT / "kill_anywhere.py", folder, scenario, str(every)]
    environment = {**os.environ, "LD_PRELOAD": str(killer), "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    done = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.parametrize(
    "scenario, every", [("plain", 4), ("interrupted", 7), ("resumed", 7), ("redo", 17), ("vtk", 29)]
)
def test_no_kill_loses_a_row_leaves_litter_or_wedges_the_run(killer, tmp_path, scenario, every):
    """A run makes some 130 changes. EVERY only saves time: with 1 all of them are tried."""
    found = carry_out(killer, tmp_path, scenario, every)
    assert found["failures"] == [] and found["kills"] > 5


def test_a_full_disk_is_a_clear_line_and_exit_code_1_wherever_it_strikes(killer, tmp_path):
    found = carry_out(killer, tmp_path, "full", 2500)
    assert found["failures"] == [] and found["codes"] == [0, 1], found
    assert found["runs"] > 5
