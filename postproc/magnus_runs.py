"""What the report of a Magnus campaign takes from its runs: quantities over repeats, distributions by angle, fields."""

from dataclasses import dataclass, replace

import numpy as np

from .magnus import fields_of
from .measured import Measured, mean_of


def quantity(rows, name):
    """Return a quantity of summary.json, averaged over the rows of a table (repeats), as `Measured`."""
    errors = rows[f"{name}_err"] if f"{name}_err" in rows else [np.nan] * len(rows)
    pairs = [(v, e) for v, e in zip(rows[name], errors)] if name in rows else []
    return mean_of([Measured(float(v), as_error(e)) for v, e in pairs if is_number(v)])


def is_number(value):
    """True for a finite number; a table holds None or NaN where a run has no value."""
    return value is not None and bool(np.isfinite(float(value)))


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


# ---- distributions by angle ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ByAngle:
    """One run's distributions: theta (bins,) [rad], F_N and F_T [N] and N_theta [-] with standard errors, each (bins,).

    theta counts counter-clockwise from V, for omega > 0. F_N presses the body and F_T > 0 opposes its spin: the signs of
    the paper's Eqs. 5 and 7 (the study stores the tangential force counter-clockwise).
    """

    theta: np.ndarray
    normal: np.ndarray
    normal_err: np.ndarray
    tangential: np.ndarray
    tangential_err: np.ndarray
    contacts: np.ndarray

    @property
    def front(self):
        """Which bins have |theta| < pi/2."""
        return np.abs(self.theta) < np.pi / 2


def by_angle(campaign, rows):
    """Return the `ByAngle` of each run of `rows`."""
    found = [campaign.run(name).group("angular") for name in rows["run"]]
    return [
        ByAngle(a["theta"], a["normal"], a["normal_err"], -a["tangential"], a["tangential_err"], a["contacts_by_angle"])
        for a in found
    ]


def over_repeats(values):
    """Return the mean over repeats (runs,) of a number that each run gives without an error, as `Measured`."""
    return mean_of([Measured(float(v), float("nan")) for v in values])


# ---- fields ----------------------------------------------------------------------------------------------------------


def fields_over_repeats(campaign, rows):
    """Return the `Fields` around the body, lengths in d, velocities over V0, averaged over the runs of `rows`.

    The runs stand as the phases of one average: frames of all of them count alike.
    """
    found = [fields_of(campaign.run(name)) for name in rows["run"]]
    arrays = {name: np.concatenate([f.arrays[name] for f in found]) for name in found[0].arrays}
    return replace(found[0], samples=np.concatenate([f.samples for f in found]), arrays=arrays)
