"""The claims of the Magnus paper's Fig. 7: an empty core, a wake that widens and bends, and where grains are hottest.

All in the intruder's frame, V along +x and omega > 0, lengths in d, y positive on the side that the paper calls advancing
(0 < θ < π/2, section IV). Each repeat gives one number; their scatter is the error.
"""

import numpy as np

from .magnus_runs import at, names, over_repeats
from .measured import UNKNOWN
from .verdicts import Claim, above, below

INTRUDER_RADIUS = 2.5  # [d]
SOURCE = "Fig. 7"


def wake_claims(campaign, rows):
    """Return the claims on the fields of the spin ratios 0, 1 and 10 of a sweep."""
    still, slow, fast = (at(rows, spin_ratio=s) for s in (0, 1, 10))
    core = over_runs(campaign, rows, core_fraction)
    wider = over_runs(campaign, fast, wake_width) - over_runs(campaign, still, wake_width)
    bent = over_runs(campaign, fast, wake_centre)
    hot_fast, hot_slow = (over_runs(campaign, r, hottest_side) for r in (fast, slow))

    def claim(chosen, text, expected, measured, rule):
        spins = ", ".join(f"{s:g}" for s in sorted(chosen["spin_ratio"].unique()))
        where = f"Φ {rows['phi'].iloc[0]:g}, V0 {rows['v0'].iloc[0]:g} m/s, Ω {spins}, {len(chosen)} runs"
        return Claim(text, SOURCE, expected, measured, rule, where, names(chosen))

    return [
        claim(rows, "the wake has an empty core; φ/Φ there", "≈ 0", core, below(0.1)),
        claim(fast, "spin widens the wake; width at Ω 10 less width at Ω 0 [d]", "> 0", wider, above(0)),
        claim(fast, "the wake bends along ω×V; its centre at Ω 10 [d]", "> 0", bent, above(0)),
        claim(fast, "Ω 10: grains are hottest on the advancing side; sin θ there", "> 0", hot_fast, above(0)),
        claim(slow, "Ω 1: grains are hottest on the retreating side; sin θ there", "< 0", hot_slow, below(0)),
    ]


def over_runs(campaign, rows, number):
    """Return the mean of `number(phi of the packing, fields)` over runs, as `Measured`; unknown without runs."""
    if not len(rows):
        return UNKNOWN
    values = [number(phi, campaign.run(name).group("fields")) for name, phi in zip(rows["run"], rows["phi"])]
    return over_repeats(values) if np.all(np.isfinite(values)) else UNKNOWN


def core_fraction(phi, field):
    """Return the area fraction within half a grain's distance of the line behind the intruder, over the packing's."""
    behind = (field["x"] < -INTRUDER_RADIUS - 0.2) & (field["x"] > -2 * INTRUDER_RADIUS)
    middle = np.abs(field["y"]) < 0.5
    return float(np.mean(field["phi"][np.ix_(middle, behind)]) / phi)


def wake_width(phi, field):
    """Return the mean width [d], over the columns of `depletion`, of the area that the wake lacks."""
    y, depth = depletion(phi, field)
    return float(np.mean(depth.sum(axis=0)) * (y[1] - y[0]))


def wake_centre(phi, field):
    """Return the mean y [d] of the area that the wake lacks."""
    y, depth = depletion(phi, field)
    return float(np.sum(y[:, None] * depth) / np.sum(depth)) if depth.sum() > 0 else float("nan")


def depletion(phi, field):
    """Return y and 1 − φ/Φ, not below 0, within four radii of the axis, from one to two radii behind the intruder."""
    behind = (field["x"] < -2 * INTRUDER_RADIUS) & (field["x"] > -3 * INTRUDER_RADIUS)
    near = np.abs(field["y"]) < 4 * INTRUDER_RADIUS
    return field["y"][near], np.clip(1 - field["phi"][np.ix_(near, behind)] / phi, 0, None)


def hottest_side(phi, field):
    """Return sin θ of the hottest bin that is at least a tenth full, within two radii; bins averaged over 0.5 d."""
    x, y = np.meshgrid(field["x"], field["y"])
    weight = np.where(np.isfinite(field["temperature"]), field["phi"], 0.0)
    heat = smoothed(np.nan_to_num(field["temperature"]) * weight, field["x"])
    weight = smoothed(weight, field["x"])
    distance = np.hypot(x, y)
    counted = (weight > 0.1 * phi) & (distance > INTRUDER_RADIUS) & (distance < 2 * INTRUDER_RADIUS)
    if not counted.any():
        return float("nan")
    place = np.argmax(np.where(counted, heat / np.maximum(weight, 1e-300), -np.inf))
    return float(y.flat[place] / distance.flat[place])


def smoothed(values, x):
    """Return a field averaged over squares of 0.5 d."""
    from scipy.ndimage import uniform_filter

    return uniform_filter(values, size=max(1, round(0.5 / (x[1] - x[0]))), mode="nearest")
