"""Stresses, area fraction and velocity profile of a homogeneous shear, averaged over its steady flow with errors."""

from dataclasses import dataclass

import numpy as np

from .. import quantities
from ..statistics import block_mean, ratio_mean, steady_start

# Series of the shear study: means over the steps between two rows.
UNITS = quantities.units(
    "series",
    "t strain shear_stress mean_pressure contact_sxx contact_sxy contact_syx contact_syy kinetic_sxx kinetic_sxy"
    " kinetic_syx kinetic_syy phi coordination growth height",
    quantities.GRAIN,
)


@dataclass(frozen=True)
class SteadyFlow:
    """Means over the steady flow: `start`, the strain that it begins at; `summary` of quantities with errors; `profile`."""

    start: float
    summary: dict
    profile: dict


def steady_window(series, settle):
    """Return (slice of the steady flow, whether it is one): after the strain `settle`, later if tau or phi drift."""
    least = int(np.searchsorted(series["strain"], settle, side="right"))
    found = [steady_start(series[name][least:]) for name in ("shear_stress", "phi")]
    return slice(least + max(cut for cut, _ in found), len(series["strain"])), all(steady for _, steady in found)


def steady_flow(series, settle, shear_rate):
    """Return the `SteadyFlow` of series with the names of `UNITS` (n,) and `profile` (n, bins) [sqrt(g d)], in d, rho, g.

    mu = tau/p and the shares are ratios of means (delta method); I = shear_rate d sqrt(rho/p) with the mean p. The profile
    is the mean of v_x against the mean flow by height; `profile_deviation` is its root mean square over the velocity
    difference of the two sides, less what its noise from row to row explains.
    """
    window, steady = steady_window(series, settle)
    kept = {name: np.asarray(values)[window] for name, values in series.items()}
    tau, p = kept["shear_stress"], kept["mean_pressure"]
    means = {name: block_mean(kept[name]) for name in ("shear_stress", "mean_pressure", "phi", "coordination")}
    means["stress_ratio"] = ratio_mean(tau, p)
    difference = kept["contact_sxx"] + kept["kinetic_sxx"] - kept["contact_syy"] - kept["kinetic_syy"]
    means["normal_stress_difference"] = ratio_mean(difference, p)
    means["kinetic_pressure_share"] = ratio_mean((kept["kinetic_sxx"] + kept["kinetic_syy"]) / 2, p)
    means["kinetic_shear_share"] = ratio_mean(-kept["kinetic_sxy"], tau)
    summary = {name: mean.value for name, mean in means.items()}
    summary.update({f"{name}_err": mean.error for name, mean in means.items()})
    pressure = means["mean_pressure"]
    inertial = float(shear_rate / np.sqrt(pressure.value)) if pressure.value > 0 else float("nan")
    relative = pressure.error / (2 * pressure.value) if pressure.value > 0 else float("nan")
    summary.update(flow_inertial_number=inertial, flow_inertial_number_err=inertial * relative)
    profile = mean_profile(kept["profile"])
    across = shear_rate * float(kept["height"].mean())
    deviation = float(np.sqrt(np.mean(profile["vx"] ** 2))) / across
    noise = float(np.sqrt(np.mean(profile["vx_err"] ** 2))) / across
    summary.update(profile_deviation=deviation, profile_deviation_err=noise)
    start = float(kept["strain"][0])
    summary.update(shear_rate=shear_rate, steady=int(steady), steady_from_strain=start)
    return SteadyFlow(start, summary, profile)


def mean_profile(rows):
    """Return `height` (bins,), middles over the cell's height, `vx` and `vx_err` of profiles (n, bins)."""
    bins = rows.shape[1]
    means = [block_mean(column) for column in rows.T]
    return dict(
        height=(np.arange(bins) + 0.5) / bins,
        vx=np.array([mean.value for mean in means]),
        vx_err=np.array([mean.error for mean in means]),
    )
