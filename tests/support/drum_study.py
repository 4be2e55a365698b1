"""The drum study as a module, its runs in this process, and what two of them must share to the last bit."""

import importlib
import json
from pathlib import Path

import h5py
import numpy as np

from graindrive.commands import killtest
from graindrive.postproc.reader import Run
from graindrive.runs.run_folder import RunFolder

STUDIES = Path(__file__).resolve().parents[2] / "studies"


def module(monkeypatch, cache):
    """Return the study as a module, in this process, with its drums in the folder `cache`."""
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(cache))
    monkeypatch.syspath_prepend(str(STUDIES))
    return importlib.import_module("drum")


def carry_out(drum, out, **keys):
    """Run the study with these keys into the folder `out`; return it as a Run."""
    p = drum.DrumParameters(**{**keys, "out": str(out)})
    with RunFolder(p, study="drum") as folder:
        drum.run(p, folder)
    return Run(out)


def contents(path):
    """Return the arrays of run.h5 and the numbers of summary.json of a run, without those that depend on its speed."""
    arrays = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and not name.startswith(("parameters", "provenance", "constants")):
            arrays[name] = item[()]

    with h5py.File(Path(path) / "run.h5") as file:
        file.visititems(visit)
    summary = json.loads((Path(path) / "summary.json").read_text())
    return arrays, {key: value for key, value in summary.items() if key not in killtest.TIMED}


def assert_same(one, other):
    """Assert that two runs have the same results to the last bit."""
    (arrays, summary), (others, other_summary) = contents(one), contents(other)
    assert arrays.keys() == others.keys()
    assert {name: str(value) for name, value in summary.items()} == {n: str(v) for n, v in other_summary.items()}
    for name, values in arrays.items():
        assert np.array_equal(values, others[name], equal_nan=np.asarray(values).dtype.kind == "f"), name
