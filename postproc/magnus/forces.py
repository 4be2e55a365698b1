"""Drag, lift and angular distributions of a body driven through a channel, averaged over its steady state with errors."""

from dataclasses import dataclass

import numpy as np

from .. import quantities
from ..statistics import block_mean, ratio_mean, steady_start
from . import model

# Series of the Magnus study: block means of the forces of the grains on the body, and variances within a block.
UNITS = quantities.units(
    "series",
    "t travel phi x fx fy normal_x torque contacts slipping fx_var fy_var contacts_var",
    quantities.SI,
)
BY_ANGLE = quantities.units("angular", "normal tangential contacts_by_angle slipping_by_angle", quantities.SI)


@dataclass(frozen=True)
class SteadyState:
    """Means over the steady state: `start` [d] of travel, number of `blocks`, `summary` of quantities with errors.

    `angular` holds, by angle from the velocity, shape (bins,): theta [rad], and normal, tangential [N] (counter-clockwise),
    contacts_by_angle, slipping_by_angle [-], mobilised = F_T/(mu F_N), each with its standard error NAME_err. mobilised may
    exceed 1: a contact that parts may pull by its damping, F_N < 0, and slip at mu|F_N|, which lowers the sum of F_N and not
    that of F_T. The model's Eqs 9 to 15 take the sums as they are, and so do we. `resolved` says whether the series is
    steady and long enough for the error of L/D to be believed.
    """

    start: float
    blocks: int
    resolved: bool
    summary: dict
    angular: dict

    def is_good_to(self, error, fewest):
        """True when the standard error of L/D is at most `error`, is believed and rests on `fewest` blocks."""
        return self.resolved and self.blocks >= fewest and self.summary["lift_to_drag_err"] <= error


def drag_and_lift(series, spin_ratio):
    """Return drag (along -V) and lift (along -omega x V; along -y where there is no spin) of a body that moves along x [N]."""
    return -np.asarray(series["fx"]), -np.asarray(series["fy"]) * (-1 if spin_ratio < 0 else 1)


def steady_window(series, settle):
    """Return (slice of the steady state, whether it is one): after `settle` [d] of travel, later if drag or contacts drift."""
    least = int(np.searchsorted(series["travel"], settle, side="right"))
    found = [steady_start(series[name][least:]) for name in ("fx", "contacts")]
    return slice(least + max(cut for cut, _ in found), len(series["travel"])), all(steady for _, steady in found)


def steady_state(series, settle, mu, spin_ratio):
    """Return the `SteadyState` of block means with the names of `UNITS` (n,) and `BY_ANGLE` (n, bins)."""
    window, steady = steady_window(series, settle)
    kept = {name: np.asarray(series[name])[window] for name in (*UNITS, *BY_ANGLE)}
    drag, lift = drag_and_lift(kept, spin_ratio)
    means = dict(drag=block_mean(drag), lift=block_mean(lift), contacts=block_mean(kept["contacts"]))
    means.update(phi=block_mean(kept["phi"]))  # it changes where walls are free
    means.update(torque=block_mean(kept["torque"]), lift_to_drag=ratio_mean(lift, drag))
    means.update(slipping_share=ratio_mean(kept["slipping"], kept["contacts"]))
    means.update(shares(kept, drag))
    summary = {}
    for name, mean in means.items():
        summary.update({name: mean.value, f"{name}_err": mean.error})
    summary.update(fluctuations(kept), **models(summary, mu))
    summary.update(
        steady=int(steady), steady_from=float(kept["travel"][0]), steady_travel=float(np.ptp(kept["travel"]))
    )
    angular = dict(theta=(angles_of(kept["normal"].shape[1]), "rad"), **by_angle(kept, mu))
    return SteadyState(summary["steady_from"], len(drag), steady and means["lift_to_drag"].resolved, summary, angular)


def angles_of(bins):
    """Return the centres of equal bins over (-pi, pi) [rad]."""
    return (np.arange(bins) + 0.5) * 2 * np.pi / bins - np.pi


def shares(kept, drag):
    """Return the means of kappa = sum F_N cos(theta)/D (Eq. 14) and of the contacts' share in |theta| < pi/2.

    The sum is the drag of the normal forces, contact by contact: with bins' middle angles it comes out 1 % too small.
    """
    theta = angles_of(kept["normal"].shape[1])
    front = kept["contacts_by_angle"][:, np.abs(theta) < np.pi / 2].sum(axis=1)
    return dict(kappa=ratio_mean(-kept["normal_x"], drag), front_share=ratio_mean(front, kept["contacts"]))


def fluctuations(kept):
    """Return standard deviations of the instantaneous force and contact number: within blocks and between them."""
    names = dict(drag_std="fx", lift_std="fy", contacts_std="contacts")
    return {key: float(np.sqrt(np.mean(kept[f"{name}_var"]) + np.var(kept[name]))) for key, name in names.items()}


def models(summary, mu):
    """Return L/D by Eqs 9 and 15 of the model, the latter with the measured kappa and its error."""
    slope = mu + 1 / mu if mu > 0 else 0.0
    return dict(
        model_symmetric=model.symmetric_lift_to_drag(mu),
        model_kappa=float(model.saturated_lift_to_drag(summary["kappa"], mu)),
        model_kappa_err=summary["kappa_err"] * slope,
    )


def by_angle(kept, mu):
    """Return {name: (means by angle, unit)} and their errors {name_err: …}; mobilised is NaN where nothing pressed."""
    found = {name: [block_mean(column) for column in kept[name].T] for name in BY_ANGLE}
    found["mobilised"] = [ratio_mean(t, mu * n) for t, n in zip(kept["tangential"].T, kept["normal"].T)]
    arrays = {}
    for name, means in found.items():
        unit = BY_ANGLE.get(name, "-")
        arrays[name] = (np.array([m.value for m in means]), unit)
        arrays[f"{name}_err"] = (np.array([m.error for m in means]), unit)
    return arrays
