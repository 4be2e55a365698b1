"""Writes and reads `summary.json`, a flat dict: quantity → value, NAME_err → its standard error, NAME_unit → its unit."""

import json
from pathlib import Path

from ..base import whole_files

NAME = "summary.json"


def write(folder, quantities):
    """Write a flat dict of plain values into a run folder, whole or not at all."""
    whole_files.write_text(Path(folder) / NAME, json.dumps(quantities, indent=2, allow_nan=False) + "\n")


def read(folder):
    """Return the dict in a run folder's summary.json; raises OSError or ValueError if there is none."""
    summary = json.loads((Path(folder) / NAME).read_text(encoding="utf-8"))
    if not isinstance(summary, dict):
        raise ValueError("it holds no quantities")
    return summary


def parted(summary):
    """Split the dict that `read` returns into (quantities, {quantity: unit})."""
    units = {key.removesuffix("_unit"): value for key, value in summary.items() if key.endswith("_unit")}
    return {key: value for key, value in summary.items() if not key.endswith("_unit")}, units
