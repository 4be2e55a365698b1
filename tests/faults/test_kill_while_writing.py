"""A writer that is killed at any moment, without a pause between its writes, leaves complete data."""

import random
import subprocess
import sys
import time

import h5py
import numpy as np

from graindrive.runs.run_data import merge, read_series

WRITER = """
import sys
import numpy as np
from graindrive.runs import run_data
series = run_data.SeriesWriter("series.h5", {"t": "s", "x": "d"})
print("writing", flush=True)
for k in range(10**9):
    rows = np.arange(50 * k, 50 * (k + 1))
    series.append(t=rows, x=rows)
    series.flush()
    run_data.write_item("items", f"frames/{k:04d}", {"x": np.full(3000, k)})
"""


def test_series_and_frames_are_whole_whenever_the_writer_dies(tmp_path):
    chance = random.Random(1)
    for attempt in range(8):
        folder = tmp_path / str(attempt)
        folder.mkdir()
        writer = subprocess.Popen([sys.executable, "-c", WRITER], cwd=folder, stdout=subprocess.PIPE)
        assert writer.stdout.readline() == b"writing\n"
        time.sleep(chance.uniform(0.05, 0.4))
        writer.kill()
        writer.communicate()
        series, _ = read_series(folder / "series.h5")
        assert np.array_equal(series["t"], np.arange(len(series["t"]))) and np.array_equal(series["t"], series["x"])
        merge(folder / "run.h5", folder / "series.h5", sorted((folder / "items").glob("*.h5")), lambda file: None)
        with h5py.File(folder / "run.h5") as file:
            assert len(series["t"]) >= 50 * len(file["frames"]), "rows were written before the frame"
            for name, frame in file["frames"].items():
                assert np.array_equal(frame["x"], np.full(3000, int(name)))
