"""The data of a run while it grows: files that are readable at any moment, and their union `run.h5` at the end.

Time series go to an HDF5 file in single-writer-multiple-reader mode, which stays consistent whenever the process dies;
everything else (frames, fields) is a file of its own, renamed into place when whole. `merge` makes of them one plain
HDF5 file. The layout is documented in postproc/README.md.
"""

import os
import time
from pathlib import Path

import h5py
import numpy as np

CHUNK_ROWS = 4096
FLUSH_SECONDS = 1.0

unwritten = []  # writers whose file could not be closed: HDF5 crashes when such a file is let go of


class SeriesWriter:
    """Appends rows to the equally long time series of one file.

    `units` maps each series to its unit; `first` holds rows to begin with, a dict of 1D arrays.
    """

    def __init__(self, path, units, first=None):
        self.file = h5py.File(path, "w", libver="latest")
        group = self.file.create_group("series")
        for name, unit in units.items():
            options = dict(shape=(0,), maxshape=(None,), chunks=(CHUNK_ROWS,), dtype="f8")
            group.create_dataset(name, **options).attrs["unit"] = unit
        self.file.swmr_mode = True
        self.group, self.waiting, self.rows, self.waiting_rows = group, {name: [] for name in units}, 0, 0
        self.last_flush = time.monotonic()
        if first and len(first[next(iter(units))]):
            self.append(**first)

    def append(self, **columns):
        """Add one row of numbers, or many rows as 1D arrays of one length; every series must be given."""
        if set(columns) != set(self.waiting):
            raise ValueError(f"series are {', '.join(self.waiting)}; got {', '.join(columns)}")
        arrays = {name: np.atleast_1d(np.asarray(values, dtype="f8")) for name, values in columns.items()}
        lengths = {array.shape for array in arrays.values()}
        if len(lengths) != 1 or len(next(iter(lengths))) != 1:
            raise ValueError(f"series must be 1D and equally long, got shapes {sorted(lengths)}")
        for name, array in arrays.items():
            self.waiting[name].append(array)
        self.waiting_rows += len(array)
        self.rows += len(array)
        if self.waiting_rows >= CHUNK_ROWS or time.monotonic() - self.last_flush > FLUSH_SECONDS:
            self.flush()

    def flush(self):
        """Hand all rows to the operating system: after this they survive the death of the process."""
        for name, parts in self.waiting.items():
            if parts:
                dataset, new = self.group[name], np.concatenate(parts)
                start = self.rows - self.waiting_rows
                dataset.resize((self.rows,))
                dataset[start:] = new
                dataset.flush()
                parts.clear()
        self.waiting_rows, self.last_flush = 0, time.monotonic()

    def close(self):
        """Flush and close; a second call does nothing."""
        if self.file:
            try:
                self.flush()
                self.file.close()
            except Exception:
                unwritten.append(self)
                raise


def files_stay_open():
    """True if HDF5 holds a file that it could not close, as on a full disk."""
    return bool(unwritten) or h5py.h5f.get_obj_count(h5py.h5f.OBJ_ALL, h5py.h5f.OBJ_FILE) > 0


def write_item(folder, name, arrays, attributes=None):
    """Write the arrays of one group (`frames/0001`) into a file of its own below `folder`, whole or not at all.

    `arrays` maps dataset names (with / for subgroups) to an array or to (array, unit); `attributes` is a dict.
    """
    path = Path(folder) / (name.replace("/", "%") + ".h5")
    path.parent.mkdir(exist_ok=True)
    write_file(path, lambda file: write_group(file.create_group(name), arrays, attributes))


def write_group(group, arrays, attributes=None):
    """Write arrays, or (array, unit) pairs, as datasets of an HDF5 group, compressed where that pays."""
    for name, content in arrays.items():
        array, unit = content if isinstance(content, tuple) else (content, None)
        array = np.asarray(array)
        options = dict(compression="gzip", compression_opts=1, shuffle=True) if array.size > 1000 else {}
        dataset = group.create_dataset(name, data=array, **options)
        if unit is not None:
            dataset.attrs["unit"] = unit
    for name, value in (attributes or {}).items():
        group.attrs[name] = value


def read_series(path, rows=None):
    """Return ({name: 1D array}, {name: unit}) of a series file, also one that a dead process left behind.

    `rows` cuts the series; without it they are as long as the shortest, since death may strike between two of them.
    """
    with h5py.File(path, "r", libver="latest", swmr=True) as file:
        group = file.get("series", {})
        units = {name: dataset.attrs["unit"] for name, dataset in group.items()}
        rows = min([len(dataset) for dataset in group.values()], default=0) if rows is None else rows
        return {name: dataset[:rows] for name, dataset in group.items()}, units


def merge(target, series, items, describe):
    """Write one plain HDF5 file `target` of a series file and item files, in one step; `describe(file)` adds the rest.

    `series` is a path or None, `items` a list of paths in the order to copy; what two of them hold is copied once.
    """

    def fill(file):
        if series is not None:
            copy_series(file.create_group("series"), series)
        for path in items:
            with h5py.File(path, "r") as source:
                copy_missing(source, file)
        describe(file)

    write_file(target, fill)


def write_file(target, fill):
    """Write the HDF5 file `target`, whole or not at all, with what `fill(file)` puts into it."""
    temporary = target.with_suffix(".tmp")
    with h5py.File(temporary, "w") as file:
        fill(file)
    with open(temporary, "rb") as written:
        os.fsync(written.fileno())
    os.replace(temporary, target)


def copy_series(group, path):
    """Copy the series of a file into an HDF5 group, compressed and still appendable."""
    arrays, units = read_series(path)
    for name, array in arrays.items():
        options = dict(maxshape=(None,), chunks=(CHUNK_ROWS,), compression="gzip", compression_opts=1, shuffle=True)
        group.create_dataset(name, data=array, **options).attrs["unit"] = units[name]


def copy_missing(source, target):
    """Copy datasets and groups of one HDF5 group into another that lacks them, with their attributes."""
    for name in source:
        if name in target and isinstance(source[name], h5py.Group):
            copy_missing(source[name], target[name])
        elif name not in target:
            source.copy(name, target)
