"""Writes and reads the parts of `run.h5`: description of the run, parameters, constants, provenance, frames, groups.

`run_data` handles the file during a run, and its time series. postproc/README.md documents the layout.
"""

from typing import NamedTuple

import h5py
import numpy as np

from .run_data import UNREADABLE

NAME, ABOUT = "run.h5", "about.h5"  # in a run folder; during a run its `About` is in a separate file
PARTS_OF_FRAME = ("contacts", "intruder")


class Described(NamedTuple):
    """A number or word with its unit and meaning; `auto` is true if it is the derived value of a key that is `auto`."""

    value: object
    unit: str
    meaning: str
    auto: bool = False


class About(NamedTuple):
    """Description of a run: attributes of the file (state, study, family, digest, …), parameters, constants, provenance.

    Parameters and constants are {name: Described}, provenance {name: plain value}, `observables` {name: what the study measures}.
    """

    attributes: dict
    parameters: dict
    constants: dict
    provenance: dict
    observables: dict


def opened(path, growing=False):
    """Open an HDF5 file for reading; set `growing` if a run may still write to it."""
    return h5py.File(path, "r", libver="latest", swmr=True) if growing else h5py.File(path, "r")


# ---- description of a run --------------------------------------------------------------------------------------------


def write_about(file, about):
    """Write an `About` into an open HDF5 file."""
    file.attrs.update(about.attributes)
    for name, (value, unit, meaning, auto) in about.parameters.items():
        dataset = file.require_group("parameters").create_dataset(name, data="auto" if value is None else value)
        dataset.attrs.update(auto=auto, unit=unit, meaning=meaning)
    for name, (value, unit, meaning, _) in about.constants.items():
        dataset = file.require_group("constants").create_dataset(name, data=value)
        dataset.attrs.update(unit=unit, meaning=meaning)
    file.require_group("provenance").attrs.update(about.provenance)
    file.require_group("observables").attrs.update(about.observables)


def read_about(file):
    """Return the `About` in an open HDF5 file; KeyError if there is none. Older files hold no constants or observables."""
    return About(
        {name: plain(value) for name, value in file.attrs.items()},
        {name: described(dataset) for name, dataset in file["parameters"].items()},
        {name: described(dataset) for name, dataset in file.get("constants", {}).items()},
        {name: plain(value) for name, value in file["provenance"].attrs.items()},
        {name: plain(value) for name, value in (file["observables"].attrs.items() if "observables" in file else ())},
    )


def described(dataset):
    """Return a scalar dataset as `Described`."""
    attributes = dataset.attrs
    meaning, auto = plain(attributes.get("meaning", "")), bool(attributes.get("auto", False))
    return Described(plain(dataset[()]), plain(attributes.get("unit", "-")), meaning, auto)


def read_attribute(path, name):
    """Return an attribute of the file `path`, which may be growing, as text; raises one of UNREADABLE if there is none."""
    with opened(path, growing=True) as file:
        return str(file.attrs[name])


def attribute(path, name):
    """Return an attribute of the file `path`, which may be growing, as text; None if there is none."""
    try:
        return read_attribute(path, name)
    except UNREADABLE:
        return None


def parameters_in(path):
    """Return {key: Described} of the parameters in the file `path`; empty if it cannot be read."""
    try:
        with opened(path, growing=True) as file:
            return {name: described(dataset) for name, dataset in file["parameters"].items()}
    except UNREADABLE:
        return {}


def read_through(path):
    """Read every dataset of the file `path`, since only this finds all damage; raises one of UNREADABLE."""

    def read(_name, item):
        """Read a dataset; return None, because any other value ends h5py's visit."""
        if isinstance(item, h5py.Dataset):
            item[()]

    with opened(path) as file:
        file.visititems(read)


# ---- frames and other groups -----------------------------------------------------------------------------------------


def frame_group(number):
    """Return the name of the group of a frame; frames are counted from 1."""
    return f"frames/{number:04d}"


def frame_arrays(grains, contacts, intruder):
    """Return the arrays of a frame's group: those of the grains by NAME, the others as contacts/NAME and intruder/NAME."""
    parts = zip(PARTS_OF_FRAME, (contacts, intruder))
    inner = {f"{part}/{name}": array for part, columns in parts for name, array in columns.items()}
    return {**grains, **inner}


def read_frame(group):
    """Return (t, grains, contacts, intruder, period) of a frame's HDF5 group; period is 0 if an older version stored none."""
    contacts, intruder = (arrays_in(group.get(part, {})) for part in PARTS_OF_FRAME)
    return float(group.attrs["t"]), arrays_in(group), contacts, intruder, plain(group.attrs.get("period", 0.0))


def arrays_in(group):
    """Return {name: array} of the datasets in a group; an empty dict is allowed in place of a group."""
    return {name: item[()] for name, item in group.items() if isinstance(item, h5py.Dataset)}


def groups_in(group):
    """Return the sorted names of the groups in a group; an empty dict is allowed in place of a group."""
    return sorted(name for name, item in group.items() if isinstance(item, h5py.Group))


def arrays_listed(file):
    """Return [(group, name, shape, unit)] of all arrays outside the groups of single numbers; only the first frame is listed."""
    found = []

    def look(path, item):
        group, _, name = path.rpartition("/")
        told = group.split("/")[0] in ("parameters", "constants", "series", "")
        later_frame = group.startswith("frames/") and not group.startswith(frame_group(1))
        if isinstance(item, h5py.Dataset) and not told and not later_frame:
            found.append((group, name, item.shape, plain(item.attrs.get("unit", ""))))

    file.visititems(look)
    return found


def labels_in(group):
    """Return ({dataset: unit}, {attribute: value}) of a group; text has no unit."""
    units = {name: item.attrs["unit"] for name, item in group.items() if "unit" in item.attrs}
    return units, {name: plain(value) for name, value in group.attrs.items()}


def plain(value):
    """Return an HDF5 scalar as a Python number or text; an array is returned unchanged."""
    value = value.item() if isinstance(value, np.generic) else value
    return value.decode() if isinstance(value, bytes) else value
