"""Rows of a campaign's table chosen by their keys, and their quantities over repeats, as numbers with errors."""

from numbers import Real

import numpy as np

from ..measured import Measured, mean_of


def quantity(rows, name):
    """Return a quantity of summary.json, averaged over the rows of a table (repeats), as `Measured`."""
    return mean_of(measurements(rows, name))


def measurements(rows, name):
    """Return a quantity of each row that has it, a list of `Measured`."""
    errors = rows[f"{name}_err"] if f"{name}_err" in rows else [np.nan] * len(rows)
    pairs = zip(rows[name], errors) if name in rows else []
    return [Measured(float(v), as_error(e)) for v, e in pairs if is_number(v)]


def is_number(value):
    """True for a finite number; a table holds None or NaN where a run has no value, and words."""
    return isinstance(value, (Real, np.bool_)) and bool(np.isfinite(float(value)))


def as_error(value):
    """Return a standard error out of a table, NaN where there is none."""
    return float(value) if is_number(value) else float("nan")


def curve(rows, key, name):
    """Return (values of `key`, rising, the quantity `name` at each as `Measured`)."""
    groups = list(rows.groupby(key, sort=True))
    return np.array([value for value, _ in groups], dtype=float), [quantity(group, name) for _, group in groups]


def at(rows, **keys):
    """Return the rows whose keys have these values."""
    chosen = np.ones(len(rows), dtype=bool)
    for key, value in keys.items():
        chosen &= np.isclose(rows[key].astype(float), value)
    return rows[chosen]


def names(rows):
    """Return the names of the runs."""
    return tuple(rows["run"])


def over_repeats(values):
    """Return the mean over repeats (runs,) of a number that each run gives without an error, as `Measured`."""
    return mean_of([Measured(float(v), float("nan")) for v in values])
