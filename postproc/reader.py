"""Open a run folder: parameters, provenance, time series, frames of the bed and the intruder, as NumPy arrays with units."""

import contextlib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..base.numbers import with_error
from ..runs import run_data, run_file, summary_file
from . import quantities

GRAIN, BASE, BEAD = 0, 1, 2  # values of a frame's `role`
INTRUDER = -1  # in a contact's `i` or `j`; what is below stands for flat walls


class RunError(Exception):
    """A folder cannot be read as a run; the message is one line that says why."""


@dataclass(frozen=True)
class Frame:
    """The bed at time `t`: dicts of arrays by name, one entry per disk or contact, as `quantities` explains them.

    `grains` are grains and base, `contacts` those of this moment, `intruder` the driven body's disks with its `centre`;
    `period` is the box's in x, which begins at 0; 0 where it does not repeat. Spheres have columns along z too, and
    `period` is an array (3,).
    """

    t: float
    grains: dict
    contacts: dict
    intruder: dict = field(default_factory=dict)
    period: float = 0.0

    @property
    def axes(self):
        """The axes of the frame's places: "xy" of disks, "xyz" of spheres."""
        return "xyz" if "z" in self.grains else "xy"

    @property
    def periods(self):
        """Period of the box along each axis, (D,), 0 where it does not repeat."""
        given = np.atleast_1d(np.asarray(self.period, dtype=float))
        return np.append(given, np.zeros(len(self.axes)))[: len(self.axes)]

    def along_axes(self, columns, name="{}"):
        """Return columns of vectors as an array (n, D): `name` says how they are called, "v{}" for vx, vy, vz."""
        return np.column_stack([columns[name.format(axis)] for axis in self.axes])

    @property
    def role(self):
        """Role of each grain, (N,) of GRAIN, BASE or BEAD; all GRAIN where the run did not store it."""
        return self.grains.get("role", np.zeros(len(self.grains["x"]), dtype=int))

    @property
    def speed(self):
        """Speed of each grain, (N,)."""
        return np.linalg.norm(self.along_axes(self.grains, "v{}"), axis=1)

    def disks(self):
        """Return all disks, grains and base first, then those of the driven body with the role BEAD: a dict of arrays.

        Where the run did not store ids they are the rows.
        """
        grains = {"id": np.arange(len(self.grains["x"])), **self.grains, "role": self.role}
        beads = {name: self.intruder[name] for name in grains if name in self.intruder}
        if not beads:
            return grains
        beads["role"] = np.full(len(beads["x"]), BEAD)
        return {name: np.concatenate([column, beads[name]]) for name, column in grains.items()}

    def contact_ends(self):
        """Return where the lines of the contacts begin and end, two arrays (n, D).

        They join the centre of i with that image of j's centre which touches it. A side that is no disk of the frame (a
        flat wall) has the contact point in its centre's place.
        """
        c = self.contacts
        point, centres = self.along_axes(c, "p{}"), self.along_axes(self.disks())
        rows = {id_: row for row, id_ in enumerate(self.intruder.get("id", ()), start=len(self.grains["x"]))}
        ends = []
        for side in ("i", "j"):
            row, ids = np.array(c[side], dtype=int), c.get(f"id_{side}", np.full(len(point), INTRUDER))
            of_body = row == INTRUDER
            row[of_body] = [rows.get(id_, INTRUDER) for id_ in ids[of_body]]
            ends.append(np.where((row < 0)[:, None], point, centres[np.maximum(row, 0)]))
        return tuple(self.beside(end, point) for end in ends)

    def beside(self, places, point):
        """Return that image of places (n, D) which is next to points (n, D)."""
        lengths = np.where(self.periods > 0, self.periods, np.inf)
        winds = np.round((places - point) / lengths)
        return places - self.periods * winds

    def place(self, points, beads):
        """Return points (n, 2) of the driven body, about its centroid at the start, where they are now; disks only.

        `beads` (m, 2) are its disks about the centroid at the start, in the order of `intruder`: what has become of them
        tells the turn, of a single disk its `angle`.
        """
        now = np.column_stack([self.intruder["x"], self.intruder["y"]])
        then, middle = beads - beads.mean(axis=0), now.mean(axis=0)
        (x, y), (x0, y0) = (now - middle).T, then.T
        angle = self.intruder.get("angle", np.arctan2(np.sum(x0 * y - y0 * x), np.sum(x0 * x + y0 * y)))
        cos, sin = np.cos(angle), np.sin(angle)
        return (np.asarray(points) - beads.mean(axis=0)) @ np.array([[cos, sin], [-sin, cos]]) + middle

    def place_solid(self, points):
        """Return points (n, 3) about the origin of a driven solid among spheres where they are now."""
        w, *axis = self.intruder["turn"]
        once = np.cross(axis, points)
        return points + 2 * (w * once + np.cross(axis, once)) + self.intruder["centre"]


class Run:
    """A run folder, complete, interrupted or still growing; raises RunError if `path` is none of these.

    `study` is the name of the study, `family` that of the study of which it is a preset. `parameters` and `provenance` are
    dicts of plain values, `constants` those of the study as numbers (empty in folders of older versions), `series` maps names
    to 1D arrays of one length, `units` the names of series and parameters to their units, `meanings` those of parameters,
    `observables` maps what the study measures to its meaning (empty in older folders). `summary` is the content of
    summary.json. A folder that is still being written shows its series and parameters, but no frames.
    """

    def __init__(self, path):
        self.path = Path(path)
        try:
            with run_file.opened(self.path / run_file.NAME, growing=True) as file:
                self.series, self.units = run_data.series_in(file)
                merged = "state" in file.attrs
            name = run_file.NAME if merged else run_file.ABOUT
            with run_file.opened(self.path / name, growing=True) as file:
                about = run_file.read_about(file)
                self.frame_names = sorted(file.get("frames", {}), key=int)
            self.study, self.state = about.attributes["study"], about.attributes["state"]
        except FileNotFoundError:
            raise RunError(f"{path} is not a run folder: it holds no run.h5") from None
        except run_data.UNREADABLE as error:
            raise RunError(f"{path} cannot be read as a run: {' '.join(str(error).split())}") from None
        self.family = about.attributes.get("family", self.study)
        self.parameters = {name: stored.value for name, stored in about.parameters.items()}
        self.constants = {name: stored.value for name, stored in about.constants.items()}
        self.units.update({name: stored.unit for name, stored in about.parameters.items()})
        self.meanings = {name: stored.meaning for name, stored in about.parameters.items()}
        self.observables = about.observables
        self.provenance = about.provenance

    def __repr__(self):
        return f"Run({str(self.path)!r}: {self.study}, {self.state})"

    @property
    def summary(self):
        """Content of summary.json as a dict; empty for a run that did not end well."""
        file = self.path / summary_file.NAME
        try:
            return summary_file.read(self.path) if file.exists() else {}
        except (OSError, ValueError) as error:
            raise RunError(f"{file} cannot be read: {' '.join(str(error).split())}") from None

    @contextlib.contextmanager
    def opened(self):
        """Open run.h5 for a block; RunError where it cannot be read."""
        try:
            with run_file.opened(self.path / run_file.NAME) as file:
                yield file
        except run_data.UNREADABLE as error:
            raise RunError(f"{self.path / 'run.h5'} cannot be read: {' '.join(str(error).split())}") from None

    def frame(self, number=-1):
        """Return the `Frame` with this place in the order of time; -1 is the last. Raises RunError if there is none."""
        if not -len(self.frame_names) <= number < len(self.frame_names):
            raise RunError(f"{self.path} holds {len(self.frame_names)} frames; there is no frame {number}")
        with self.opened() as file:
            return Frame(*run_file.read_frame(file["frames"][self.frame_names[number]]))

    def group(self, name):
        """Return the datasets of another group (`intruder`, `fields/…`) as a dict of arrays; empty if it is not there."""
        with self.opened() as file:
            return run_file.arrays_in(file.get(name, {}))

    def names(self, name):
        """Return the names of the groups below another group (`fields`), sorted; empty if it is not there."""
        with self.opened() as file:
            return run_file.groups_in(file.get(name, {}))

    def labels(self, name):
        """Return ({dataset: unit}, {attribute: value}) of another group; both empty if it is not there."""
        with self.opened() as file:
            return run_file.labels_in(file[name]) if name in file else ({}, {})

    def contents(self):
        """Return what the run holds as a pandas DataFrame: where, name, value or size, unit, meaning; a row for each name.

        Parameters, quantities of the summary with their errors, series, and the arrays of all groups of run.h5, of the frames
        those of the first. Meanings are those of the study's observables, else those of `quantities`; other names have none.
        """
        import pandas as pd  # a third of a second that no other reading needs

        rows = [
            ("parameters", name, value, self.units[name], self.meanings[name])
            for name, value in self.parameters.items()
        ]
        values, units = summary_file.parted(self.summary)
        for name, value in values.items():
            if not name.endswith("_err"):
                error = values.get(f"{name}_err")
                told = value if error is None else with_error(value, error)
                meaning = self.observables.get(name) or quantities.meaning_of("summary", name)
                rows.append(("summary", name, told, units.get(name, ""), meaning))
        rows += [
            ("series", name, f"({len(column)},)", self.units.get(name, ""), quantities.meaning_of("series", name))
            for name, column in self.series.items()
        ]
        with self.opened() as file:
            rows += [
                (group, name, str(shape), unit, quantities.meaning_of(group, name))
                for group, name, shape, unit in run_file.arrays_listed(file)
            ]
        return pd.DataFrame(rows, columns=["where", "name", "value", "unit", "meaning"])

    def at(self, t, *names):
        """Return the named series at time `t`, interpolated linearly."""
        return [float(np.interp(t, self.series["t"], self.series[name])) for name in names]
