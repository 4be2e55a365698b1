"""Two threads in YADE's loop give the physics of one, up to the order in which forces are added."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

PROGRAM = """
import json, sys
sys.path[:0] = {paths!r}
from disks import engine, everything, run, shaken_bed
shaken_bed()
run({steps})
drives = [engine(label) for label in ("shake", "spin", "drum")]
json.dump(dict(bodies=everything().tolist(), work=[d.work for d in drives], force=[list(d.force) for d in drives],
               bins=list(engine("bins").normalForce), threads={threads_expression}), open({out!r}, "w"))
"""


def bed(threads, steps, tmp_path, program):
    out = tmp_path / f"{program}-{threads}.json"
    text = PROGRAM.format(
        paths=[str(Path(__file__).parents[2] / "tests" / "support"), *sys.path],
        steps=steps,
        out=str(out),
        threads_expression="__import__('yade').O.numThreads",
    )
    script = tmp_path / f"bed{threads}.py"
    script.write_text(text)
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "HOME": str(tmp_path)}
    if program == "yade":
        command = ["yade", "-n", "-x", f"-j{threads}", str(script)]
    else:
        command = [sys.executable, str(script)]
    result = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert out.exists(), result.stdout + result.stderr
    return json.loads(out.read_text())


@pytest.mark.parametrize("program", ["yade", "python"])
def test_two_threads_give_the_physics_of_one(tmp_path, program):
    if program == "yade" and shutil.which("yade") is None:
        pytest.skip("needs the yade program")
    if (os.cpu_count() or 1) < 2:
        pytest.skip("needs two processors")
    # 1,500 steps (0.3 s): contacts and slip, but too short for chaos to lift round-off (1e-16) by more than three digits.
    one, two = (bed(threads, 1500, tmp_path, program) for threads in (1, 2))
    assert (one["threads"], two["threads"]) == (1, 2)
    assert len(one["bodies"]) > 60
    assert max(map(abs, one["work"])) > 0.1
    for name, scale in (("bodies", 10), ("work", 100), ("bins", 100), ("force", 1000)):
        numbers = [np.hstack([np.ravel(row) for row in run[name]]) for run in (one, two)]
        np.testing.assert_allclose(*numbers, rtol=0, atol=1e-12 * scale)
