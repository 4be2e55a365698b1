"""What the report of a drum campaign takes from its runs: profiles across the layer and fields, averaged over repeats."""

from dataclasses import dataclass

import numpy as np

from ..campaign.runs import at, curve
from ..reader import RunError
from .blocks import read
from .flow import SURFACE_LEVEL, norm

MODELS = tuple(SURFACE_LEVEL)  # grains first


@dataclass(frozen=True)
class MeanProfile:
    """The profile of one drum at one speed, over repeats: `z`, `u`, `u_err`, `fraction` (n,), the drum's `diameter`, `omega`."""

    z: np.ndarray
    u: np.ndarray
    u_err: np.ndarray
    fraction: np.ndarray
    diameter: float
    omega: float

    @property
    def scaled(self):
        """(z/D, u/(Omega D), its error) where there is a velocity within the drum, each (m,)."""
        kept = np.isfinite(self.u) & (self.z < self.diameter / 2)
        scale = self.omega * self.diameter
        return self.z[kept] / self.diameter, self.u[kept] / scale, self.u_err[kept] / scale


def of_model(rows, model, name):
    """Return (rows that ran a model, the name under which they hold a quantity of it).

    With model=both the grains' numbers bear plain names, the continuum's their model's.
    """
    if model == "dem":
        return rows[rows["model"].isin(["dem", "both"])], name
    alone, both = rows[rows["model"] == model], rows[rows["model"] == "both"]
    return (alone, name) if len(alone) else (both, f"continuum_{name}")


def curve_of(rows, model, key, name):
    """Return (values of `key`, the quantity of a model at each as `Measured`), as `curve` does."""
    chosen, name = of_model(rows, model, name)
    return curve(chosen, key, name)


def by_diameter(rows):
    """Yield (D, its rows) for the drums of a sweep."""
    for diameter, group in rows.groupby("drum_diameter", sort=True):
        yield float(diameter), group


def by_speed(rows):
    """Yield (D, Omega, their rows) for the drums and speeds of a sweep."""
    for diameter, group in by_diameter(rows):
        for omega, same in group.groupby("angular_velocity", sort=True):
            yield diameter, float(omega), same


def mean_profile(campaign, rows, model):
    """Return the `MeanProfile` of a model over runs of one drum at one speed; None if none of them has it.

    Errors add in squares over the repeats.
    """
    found = []
    for name in rows["run"]:
        arrays = campaign.run(name).group(f"depth/{model}")
        if "u" in arrays:
            found.append(arrays)
    if not found:
        return None
    u, error, fraction = (np.array([arrays[name] for arrays in found]) for name in ("u", "u_err", "fraction"))
    diameter, omega = (float(rows[key].iloc[0]) for key in ("drum_diameter", "angular_velocity"))
    mean_error = np.sqrt(np.sum(error**2, axis=0)) / len(found)
    return MeanProfile(found[0]["z"], u.mean(axis=0), mean_error, fraction.mean(axis=0), diameter, omega)


def scaled_difference(one, other):
    """Return (L2 norm of the difference of u/(Omega D) of two `MeanProfile`s at equal z/D over that of the first, its error).

    From the axis to the wall, where both have a velocity. The error is that of the norm to first order in those of the points;
    their noise adds to the norm itself.
    """
    (z, u, error), (z_other, u_other, error_other) = one.scaled, other.scaled
    kept = (z > 0) & (z >= z_other.min()) & (z <= z_other.max())
    z, u, error = z[kept], u[kept], error[kept]
    away = np.interp(z, z_other, u_other) - u
    spread = np.hypot(error, np.interp(z, z_other, error_other))
    size, length = norm(away), norm(u)
    return size / length, norm(away / size * spread) / length if size > 0 else 0.0


def field_of(campaign, rows, model):
    """Return the mean `FlowField` of a model in the first run that stored it; None without one."""
    for name in rows["run"]:
        try:
            return read(campaign.run(name), model).mean()
        except RunError:
            continue
    return None


def equal_froude(rows):
    """Yield (Fr and, where a sweep has several, I_0 in words, the rows) of those at which a sweep has two drums or more."""
    keys = [rows["froude"].astype(float).round(9), rows["inertial_scale"].astype(float)]
    for (froude, scale), group in rows.groupby(keys, sort=True):
        if group["drum_diameter"].nunique() > 1:
            told = f", I_0 {scale:g}" if rows["inertial_scale"].nunique() > 1 else ""
            yield f"Fr {froude:.3g}{told}", group


def drum(rows, diameter):
    """Return the rows of one drum."""
    return at(rows, drum_diameter=diameter)
