"""What a command builds and installs, and the tree that `cmake --install` makes."""

import json
import os
import subprocess
from pathlib import Path

import pytest

import graindrive

ROOT = Path(__file__).resolve().parents[2]
WITHOUT_GOOGLETEST = ["-DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON", "-DPython3_EXECUTABLE=/usr/bin/python3"]


def called(*command, **options):
    """Run a command; return the finished process with its text."""
    return subprocess.run(command, capture_output=True, text=True, timeout=1200, **options)


def test_a_run_needs_no_googletest_and_tests_say_what_they_need(tmp_path):
    configure = ["cmake", "-G", "Ninja", "-S", ROOT, "-B", tmp_path, *WITHOUT_GOOGLETEST]
    with_tests = called(*configure, "-DGRAINDRIVE_TESTS=ON")
    assert (
        with_tests.returncode != 0
        and "libgtest-dev" in with_tests.stderr
        and "GRAINDRIVE_TESTS=OFF" in with_tests.stderr
    )
    without = called(*configure, "-DGRAINDRIVE_TESTS=OFF")
    assert without.returncode == 0, without.stderr
    needed = called("ninja", "-C", tmp_path, "-n", "_engines", "all").stdout
    assert "graindrive_module_objects.dir" in needed and "_test.dir" not in needed and "_bench.dir" not in needed


@pytest.mark.slow
def test_an_installed_tree_runs_its_studies_wherever_it_is_moved(tmp_path):
    build = Path(graindrive.__path__[1]).parents[1]
    installed = called("cmake", "--install", build, "--prefix", tmp_path / "first")
    assert installed.returncode == 0, installed.stderr
    command = (tmp_path / "first").rename(tmp_path / "moved") / "bin" / "graindrive"
    surroundings = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    listed = called(command, "run", cwd=tmp_path, env=surroundings)
    assert "wiggle_triangle" in listed.stdout
    done = called(command, "run", "wiggle", "scale=smoke", "time=1", "out=run", cwd=tmp_path, env=surroundings)
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["steps"] > 0 and summary["n_grains"] > 0
