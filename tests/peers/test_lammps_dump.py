"""LAMMPS reads the dump of a run with the same box, positions and velocities, frame by frame."""

import shutil
import subprocess

import numpy as np
import pytest
from made_up_frames import DT, PERIOD, made_up_run

from graindrive.postproc.reader import Run

pytestmark = pytest.mark.skipif(shutil.which("lmp") is None, reason="needs LAMMPS")

SCRIPT = """
units lj
dimension 2
boundary {sides} f p
atom_style sphere
region all block 0 1 0 1 -0.5 0.5
create_box 3 all
read_dump {dump} 0 x y vx vy box yes add keep
pair_style zero 1.0
pair_coeff * *
comm_modify cutoff 1
dump all all custom 1 back.txt id type x y z vx vy vz
dump_modify all sort id format float %.15g
rerun {dump} dump x y vx vy box yes replace yes
"""


@pytest.mark.parametrize("period", [PERIOD, 0.0])
def test_lammps_reads_what_was_written(tmp_path, period):
    run = Run(made_up_run(tmp_path / "run", period=period, export="lammps"))
    script = SCRIPT.format(sides="p" if period else "f", dump=run.path / "frames.lammpstrj")
    (tmp_path / "in.read").write_text(script)
    done = subprocess.run(
        ["lmp", "-in", "in.read", "-log", "none"], cwd=tmp_path, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout[-2000:]
    for k, (step, bounds, rows) in enumerate(snapshots((tmp_path / "back.txt").read_text())):
        disks = run.frame(k).disks()
        x = np.mod(disks["x"], period) if period else disks["x"]
        expected = np.c_[disks["id"] + 1, disks["role"] + 1, x, disks["y"], 0 * x, disks["vx"], disks["vy"], 0 * x]
        assert step == round(2.0 * k / DT) and (not period or bounds[0] == [0, period])
        np.testing.assert_allclose(rows, expected, rtol=1e-11, atol=1e-10)  # 12 digits in the file, of numbers up to 20
    assert k == 2


def snapshots(text):
    """Return (step, bounds, rows) of each snapshot of a dump."""
    found = []
    for part in text.split("ITEM: TIMESTEP\n")[1:]:
        lines = part.splitlines()
        start = next(n for n, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
        bounds = [[float(word) for word in line.split()] for line in lines[start - 3 : start]]
        found.append(
            (int(lines[0]), bounds, np.array([[float(w) for w in line.split()] for line in lines[start + 1 :]]))
        )
    return found
