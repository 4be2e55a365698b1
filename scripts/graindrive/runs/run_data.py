"""The data of a running run: files that are readable at any moment, and `run.h5`, which combines them at the end.

Time series go to an HDF5 file in single-writer-multiple-reader mode, which stays consistent whenever the process dies;
every frame and every field is a separate file, renamed into place when complete. `merge` combines them into one plain
HDF5 file. `SeriesWriter.sum` and `item_sum` are checksums of the written data, with which a checkpoint recognises its data.
The layout is documented in postproc/README.md.
"""

import hashlib
import time
from pathlib import Path

import h5py
import numpy as np

from ..base import whole_files

UNREADABLE = (
    OSError,
    RuntimeError,
    KeyError,
    ValueError,
)  # errors of h5py for files that are truncated, damaged or not HDF5
CHUNK_ROWS = 4096
ROOM = 2**17  # bytes for the names and indices of a series file
FLUSH_SECONDS = 1.0

unwritten = []  # files that could not be closed; they are kept here because HDF5 crashes when such a file is released


def new_sum(content=b""):
    """Return a checksum to be updated with bytes; its hexdigest has 32 characters."""
    return hashlib.blake2b(content, digest_size=16)


class SeriesWriter:
    """Appends rows to the equally long time series of one file.

    `units` maps each series to its unit; `first` holds the first rows, a dict of 1D arrays. The file gets its name when it is
    readable and holds the first rows. `rows` counts all rows appended, `sum` is the checksum of the flushed ones.
    """

    def __init__(self, path, units, first=None):
        self.path, temporary = whole_files.beside(path), whole_files.beside(path)
        self.units, self.rows = dict(units), 0
        self.reserve()  # HDF5 crashes on a full disk, so it may write only into reserved space
        self.file = h5py.File(temporary, "w", libver="latest")
        self.reserve()
        group = self.file.create_group("series")
        for name, unit in units.items():
            options = dict(shape=(0,), maxshape=(None,), chunks=(CHUNK_ROWS,), dtype="f8")
            group.create_dataset(name, **options).attrs["unit"] = unit
        self.file.swmr_mode = True
        self.group, self.waiting, self.waiting_rows = group, {name: [] for name in units}, 0
        self.sums = {name: new_sum() for name in units}
        self.last_flush = time.monotonic()
        if first and len(first[next(iter(units))]):
            self.append(**first)
        self.flush()
        self.path = Path(path)
        whole_files.put_in_place(temporary, self.path)

    def reserve(self):
        """Reserve space on the disk for all rows; OSError if there is not enough, and the file is then unchanged."""
        chunks = len(self.units) * (self.rows // CHUNK_ROWS + 2)
        whole_files.reserve(self.path, int(1.02 * chunks * CHUNK_ROWS * 8) + ROOM)

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
        """Pass all rows to the operating system: after this they survive a kill of the process."""
        if self.waiting_rows:
            self.reserve()
        for name, parts in self.waiting.items():
            if parts:
                dataset, new = self.group[name], np.concatenate(parts)
                start = self.rows - self.waiting_rows
                dataset.resize((self.rows,))
                dataset[start:] = new
                dataset.flush()
                self.sums[name].update(new.tobytes())
                parts.clear()
        self.waiting_rows, self.last_flush = 0, time.monotonic()

    def sync(self):
        """Flush all rows to the disk: after this they survive a power failure too."""
        self.flush()
        whole_files.sync(self.path)

    @property
    def sum(self):
        """Checksum of all flushed rows with their names and units; `series_sum` returns the same for rows read back."""
        return combined_sum(self.sums, self.units)

    def close(self):
        """Flush and close; a second call does nothing."""
        if self.file:
            try:
                self.flush()
            finally:
                close(self.file)


def close(file):
    """Close an HDF5 file; if it cannot be written, it is kept open until the process ends."""
    try:
        file.close()
    except Exception:
        unwritten.append(file)
        raise


def series_sum(series, units):
    """Return the checksum of {name: 1D array} of one length, with their units."""
    return combined_sum({name: new_sum(np.ascontiguousarray(array)) for name, array in series.items()}, units)


def combined_sum(sums, units):
    """Return one checksum that combines those of several series."""
    lines = [f"{name} {units[name]} {sums[name].hexdigest()}\n" for name in sorted(sums)]
    return new_sum("".join(lines).encode()).hexdigest()


def item_sum(group):
    """Return the checksum of an HDF5 group: names, types, shapes, contents and attributes of all its members."""
    total = new_sum()
    for name in sorted(group):
        inside = group[name]
        total.update(f"{name} {attributes_of(inside)} ".encode())
        total.update(item_sum(inside).encode() if isinstance(inside, h5py.Group) else content_of(inside))
    total.update(attributes_of(group).encode())
    return total.hexdigest()


def content_of(dataset):
    """Return type, shape and contents of a dataset as bytes; for text, which HDF5 stores elsewhere, the text itself."""
    array = np.asarray(dataset[()])
    plain = repr(array.tolist()).encode() if array.dtype.hasobject else np.ascontiguousarray(array).tobytes()
    return f"{array.dtype.str} {array.shape} ".encode() + plain


def attributes_of(item):
    """Return the attributes of a group or dataset as text, sorted by name."""
    return repr([(name, np.asarray(item.attrs[name]).tolist()) for name in sorted(item.attrs)])


def files_stay_open():
    """True if HDF5 could not close some file, for example because the disk is full."""
    return bool(unwritten) or h5py.h5f.get_obj_count(h5py.h5f.OBJ_ALL, h5py.h5f.OBJ_FILE) > 0


def write_item(folder, name, arrays, attributes=None):
    """Write the arrays of one group (`frames/0001`) into a separate file below `folder`, whole or not at all.

    `arrays` maps dataset names (with / for subgroups) to an array or to (array, unit); `attributes` is a dict. Returns the
    item's checksum.
    """
    path = Path(folder) / (name.replace("/", "%") + ".h5")
    path.parent.mkdir(exist_ok=True)
    sums = []

    def fill(file):
        write_group(file.create_group(name), arrays, attributes)
        sums.append(item_sum(file[name]))

    write_file(path, fill)
    return sums[0]


def write_group(group, arrays, attributes=None):
    """Write arrays, or (array, unit) pairs, as datasets of an HDF5 group; large ones are compressed."""
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
    """Return ({name: 1D array}, {name: unit}) of a series file, which may come from a killed process.

    `rows` limits the length; without it all series are cut to the shortest, since a kill may come between two writes.
    """
    with h5py.File(path, "r", libver="latest", swmr=True) as file:
        return series_in(file, rows)


def series_in(file, rows=None):
    """Return the same as `read_series`, for an open file."""
    group = file.get("series", {})
    units = {name: dataset.attrs.get("unit", "-") for name, dataset in group.items()}
    rows = min([len(dataset) for dataset in group.values()], default=0) if rows is None else rows
    return {name: dataset[:rows] for name, dataset in group.items()}, units


def merge(target, series, items, describe):
    """Combine a series file and item files into one plain HDF5 file `target`, in one step; `describe(file)` adds the rest.

    `series` is a path or None, `items` a list of paths in the order to copy; content of several files is copied once.
    """

    def fill(file):
        if series is not None:
            write_series(file.create_group("series"), *read_series(series))
        for path in items:
            with h5py.File(path, "r") as source:
                copy_missing(source, file)
        describe(file)

    write_file(target, fill)


def write_file(target, fill):
    """Write the HDF5 file `target`, whole or not at all, with what `fill(file)` puts into it."""
    with whole_files.written(target) as temporary, whole_files.Patient(temporary) as raw:
        file = h5py.File(raw, "w")
        try:
            fill(file)
        finally:
            close(file)
            raw.raise_error()


def rows_in(path):
    """Return the number of complete rows of series in a file; -1 if the file cannot be read."""
    try:
        with h5py.File(path, "r", libver="latest", swmr=True) as file:
            return min([len(dataset) for dataset in file.get("series", {}).values()], default=0)
    except UNREADABLE:
        return -1


def write_series(group, series, units):
    """Write series into an HDF5 group, compressed and still appendable."""
    for name, array in series.items():
        options = dict(maxshape=(None,), chunks=(CHUNK_ROWS,), compression="gzip", compression_opts=1, shuffle=True)
        group.create_dataset(name, data=array, **options).attrs["unit"] = units[name]


def copy_missing(source, target):
    """Copy datasets and groups of one HDF5 group into another that lacks them, with their attributes."""
    for name in source:
        if name in target and isinstance(source[name], h5py.Group):
            copy_missing(source[name], target[name])
        elif name not in target:
            source.copy(name, target)
