"""The claims of the Magnus paper's Fig. 7: an empty core, a wake that widens and bends, and where grains are hottest.

All in the intruder's frame, V along +x and omega > 0, lengths in d, y positive on the side that the paper calls advancing
(0 < θ < π/2, section IV). Each repeat gives one number; their scatter is the error. The distances that numbers are taken at
count in radii of the body, half of its key intruder_diameter.
"""

import numpy as np
from scipy.ndimage import uniform_filter

from ..campaign.runs import at, names, over_repeats
from ..campaign.verdicts import Claim, above, below
from ..measured import UNKNOWN
from .figure import fields_of

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
    """Return the mean of `number(phi of the packing, radius of the body [d], Fields)` over runs; unknown without runs."""
    runs = zip(rows["run"], rows["phi"], rows["intruder_diameter"])
    values = [number(phi, diameter / 2, fields_of(campaign.run(name))) for name, phi, diameter in runs]
    return over_repeats(values) if values and np.all(np.isfinite(values)) else UNKNOWN


def core_fraction(phi, radius, found):
    """Return the area fraction within 0.5 d of the axis, from the body to one radius behind it, over the packing's."""
    behind = (found.x < -radius - 0.2) & (found.x > -2 * radius)
    middle = np.abs(found.y) < 0.5
    return float(np.mean(found.map("area_fraction")[np.ix_(middle, behind)]) / phi)


def wake_width(phi, radius, found):
    """Return the mean width [d], over the columns of `depletion`, of the area that the wake lacks."""
    y, depth = depletion(phi, radius, found)
    return float(np.mean(depth.sum(axis=0)) * (y[1] - y[0]))


def wake_centre(phi, radius, found):
    """Return the mean y [d] of the area that the wake lacks; nan if it lacks none."""
    y, depth = depletion(phi, radius, found)
    return float(np.sum(y[:, None] * depth) / np.sum(depth)) if depth.sum() > 0 else float("nan")


def depletion(phi, radius, found):
    """Return y (n,) and 1 - local over mean area fraction, not below 0, (n, m): within four radii of the axis, from one to
    two radii behind the body.
    """
    behind = (found.x < -2 * radius) & (found.x > -3 * radius)
    near = np.abs(found.y) < 4 * radius
    return found.y[near], np.clip(1 - found.map("area_fraction")[np.ix_(near, behind)] / phi, 0, None)


def hottest_side(phi, radius, found):
    """Return sin(theta) of the hottest place within two radii, of averages over 0.5 d that are a tenth full or more."""
    x, y = np.meshgrid(found.x, found.y)
    temperature = found.map("temperature")
    weight = np.where(np.isfinite(temperature), found.map("area_fraction"), 0.0)
    size = max(1, round(0.5 / (found.x[1] - found.x[0])))
    heat = uniform_filter(np.nan_to_num(temperature) * weight, size, mode="nearest")
    weight = uniform_filter(weight, size, mode="nearest")
    distance = np.hypot(x, y)
    counted = (weight > 0.1 * phi) & (distance > radius) & (distance < 2 * radius)
    if not counted.any():
        return float("nan")
    place = np.argmax(np.where(counted, heat / np.maximum(weight, 1e-300), -np.inf))
    return float(y.flat[place] / distance.flat[place])
