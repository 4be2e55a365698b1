"""Find names in a run folder that are not explained: those of summary.json and run.h5 that `quantities` lacks."""

import h5py

from graindrive.postproc import quantities

BESIDE = ("parameters", "constants", "provenance")  # they contain their meanings, or are a list of facts


def unexplained(run):
    """Return the names of a run (reader.Run) that have no line in `quantities`, or a summary quantity without its unit."""
    known = quantities.QUANTITIES
    found = [name for name in run.summary if not name.endswith(("_unit", "_err")) and name not in known["summary"]]
    for name, (unit, meaning) in known["summary"].items():
        if name in run.summary and (not meaning or unit and f"{name}_unit" not in run.summary):
            found.append(f"{name} has no unit or meaning")

    def visit(path, item):
        group, _, name = path.rpartition("/")
        if isinstance(item, h5py.Dataset) and not path.startswith(BESIDE):
            if name.removesuffix("_err") not in known.get(quantities.place_of(group), {}):
                found.append(path)

    with h5py.File(run.path / "run.h5") as file:
        file.visititems(visit)
    return found
