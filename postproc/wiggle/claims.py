"""The claims of Tripura et al. on friction, phase and fields, and our own on masses and scenes, tested on a campaign's runs."""

from functools import partial

import numpy as np
from scipy.special import ndtr

from ..campaign.claims import claim_on
from ..campaign.runs import curve, over_repeats, quantity
from ..campaign.verdicts import Agrees, above, below
from ..measured import UNKNOWN, Measured, polynomial_through
from . import runs
from .runs import RATE, by_shape, of_shapes

PRESSURE = "contact_pressure"  # Eqs. 3.3 and 3.4 hold contacts alone

claim = partial(claim_on, dict(shape=("", ""), amplitude=("A", ""), period=("T", ""), mu=("μ", "")))


# ---- Figs. 6, 8, and what the paper leaves open ----------------------------------------------------------------------


def by_shape_and_period(rows):
    """Yield ("shape, T period", its rows)."""
    for shape, of_one in by_shape(rows):
        for period, group in of_one.groupby("period"):
            yield f"{shape}, T {period:g}", group


def friction_claims(_campaign, rows):
    """V_y grows with friction: the slope of V_y against mu, for each shape and period."""
    claims = []
    for where, group in by_shape_and_period(rows):
        slope = polynomial_through(*curve(group, "mu", RATE), 1)[0]
        text = f"{where}: friction speeds the rise; slope of V_y against μ"
        claims.append(claim(group, text, "Fig. 6", "> 0", slope, above(0)))
    return claims


def phase_claims(campaign, rows):
    """V_y swings twice a cycle: what the two halves of that swing are, and whether it turns V_y over."""
    claims = []
    for where, group in by_shape_and_period(rows):
        shape, (_, points) = group["shape"].iloc[0], runs.phase_curve(campaign, group)
        turning, moving_out = (runs.phase_sum(campaign, group, weights) for weights in swings(len(points)))
        text = f"{where}: V_y is largest where it turns; cos(2ωt) part of V_y, from turns to centre"
        claims.append(claim(group, text, "Fig. 8, section 3.3", "> 0", turning, above(0)))
        text = f"{where}: it climbs while it moves out; sin(2ωt) part of V_y"
        claims.append(claim(group, text, "Fig. 8, section 3.3", "> 0", moving_out, above(0)))
        if shape == "disk":
            both = swing_size(turning, moving_out) - abs(quantity(group, RATE))
            text = f"{where}: it rises and sinks within each cycle; amplitude of the swing less |V_y|"
            claims.append(claim(group, text, "section 3.3", "> 0", both, above(0)))
        if shape == "triangle":
            text = f"{where}: V_y is negative at most phases; share of them"
            claims.append(claim(group, text, "Fig. 8(e), section 3.3", "> 0.5", share_below_zero(points), above(0.5)))
    return claims


def share_below_zero(points):
    """Return which share of `Measured` numbers is negative, each counted by how likely it is, as `Measured`."""
    values, errors = np.array([(m.value, m.error) for m in points]).T
    likely = ndtr(-values / errors)
    return Measured(float(likely.mean()), float(np.sqrt(np.sum(likely * (1 - likely))) / len(points)))


def swings(parts):
    """Return the weights (parts,) that give the amplitudes of -cos(2wt) and of sin(2wt), both of V_y averaged in parts."""
    angle = 4 * np.pi * (np.arange(parts) + 0.5) / parts
    smoothed = np.sinc(2 / parts)  # of either wave, by the mean over a part
    return -2 * np.cos(angle) / parts / smoothed, 2 * np.sin(angle) / parts / smoothed


def swing_size(a, b):
    """Return the amplitude of a wave from those of its two parts, as `Measured`, error to first order."""
    size = float(np.hypot(a.value, b.value))
    return Measured(size, float(np.hypot(a.value * a.error, b.value * b.error) / size)) if size else UNKNOWN


def mass_claims(_campaign, rows):
    """Whether V_y depends on the body's mass, which the paper does not give: V_y of the heaviest less that of the lightest."""
    claims = []
    for where, group in by_shape_and_period(rows):
        masses, points = curve(group, "intruder_mass", RATE)
        if len(masses) < 2:
            continue
        text = f"{where}: the mass does not matter; V_y at a mass of {masses[-1]:.3g} less that at {masses[0]:.3g}"
        claims.append(claim(group, text, "section 2", "0", points[-1] - points[0], Agrees(0, 0.01, 0.02)))
    return claims


def scene_claims(_campaign, rows):
    """Each scene beside the one with most grains: how much V_y changes with the bed, the lid and the time step."""
    claims = []
    for (amplitude, period), group in rows.groupby(["amplitude", "period"]):
        scenes = scenes_of(group)
        _, full = scenes[0]
        for name, scene in scenes[1:]:
            change = quantity(scene, RATE) - quantity(full, RATE)
            text = f"A {amplitude:g}, T {period:g}, {name}: V_y less that of the first scene"
            claims.append(claim(scene, text, "this study", "0", change, Agrees(0, 0.02, 0.04)))
    return claims


SCENE_KEYS = ("width", "height", "depth", "lid", "lid_pressure", "dt_factor")


def scenes_of(rows):
    """Return [(name, rows)] of the scenes in the table, the one with most grains and the smallest step first."""
    groups = [(scene_name(dict(zip(SCENE_KEYS, keys))), group) for keys, group in rows.groupby(list(SCENE_KEYS))]
    return sorted(groups, key=lambda g: (-g[1]["n_grains"].max(), g[1]["dt_factor"].max(), g[0]))


def scene_name(keys):
    """Return a scene in words: "120 × 90 d, depth 50 d + lid of grains 46.2, dt × 5"."""
    lid = f" + lid ({keys['lid']}) {keys['lid_pressure']:g}" if keys["lid_pressure"] else ""
    return f"{keys['width']:g} × {keys['height']:g} d, depth {keys['depth']:g} d{lid}, dt × {keys['dt_factor']:g}"


# ---- Figs. 9 to 11 ---------------------------------------------------------------------------------------------------


TURNED, BACK = 5, 10  # phases 10 phi/pi: just turned at the right, and at the centre on the way back


def field_claims(campaign, rows):
    """A wake behind the body and the pressure in front of it, on both ways; which wakes are larger."""
    claims = []
    wakes = {}
    for shape, group in by_shape(rows):
        source = "section 3.4, Figs. 9-11"
        behind = beside(campaign, group, "area_fraction", 0)
        text = f"{shape}: a wake behind it at phase 0; area fraction on the left less that on the right"
        claims.append(claim(group, text, source, "< 0", over_repeats(behind), below(0)))
        for phase, way, rule, sign in ((0, "right", below(0), "< 0"), (BACK, "left", above(0), "> 0")):
            pressure = beside(campaign, group, PRESSURE, phase)
            text = f"{shape}: the pressure is in front as it moves {way}; pressure on the left less that on the right"
            claims.append(claim(group, text, source, sign, over_repeats(pressure), rule))
        wakes[shape] = beside(campaign, group, "area_fraction", TURNED)
        text = f"{shape}: its wake is larger where it turned than at the centre; area fraction, left less right, difference"
        claims.append(claim(group, text, source, "< 0", over_repeats(wakes[shape] - behind), below(0)))
    if {"disk", "tall"} <= wakes.keys():
        larger = over_repeats(wakes["tall"]) - over_repeats(wakes["disk"])
        text = (
            "the wake of the tall rectangle is larger than the disk's; area fraction, left less right, where they turn"
        )
        claims.append(claim(of_shapes(rows, "disk", "tall"), text, "section 3.4", "< 0", larger, below(0)))
    return claims


def beside(campaign, rows, name, phase):
    """Return the mean of a field within 3 d left of the body less that right of it at a phase, of each repeat (runs,)."""
    outline = campaign.run(rows["run"].iloc[0]).group("intruder")["outline"]
    differences = []
    for field in runs.field_runs(campaign, rows):
        left, right = sides(outline, field.x, field.y)
        values = field.map(name, min(phase, len(field.samples) - 1))
        differences.append(np.nanmean(values[left]) - np.nanmean(values[right]))
    return np.array(differences)


def sides(outline, x, y):
    """Return masks (ny, nx) of what lies 0.5 d to 3.5 d left, and right, of a polygon (n, 2), about its middle height."""
    low, high = outline[:, 1].min(), outline[:, 1].max()
    masks = np.zeros((2, len(y), len(x)), dtype=bool)
    for row in np.flatnonzero(np.abs(y - (low + high) / 2) < (high - low) / 4):
        left, right = crossings(outline, y[row])
        masks[0, row], masks[1, row] = (x > left - 3.5) & (x < left - 0.5), (x > right + 0.5) & (x < right + 3.5)
    return masks


def crossings(outline, height):
    """Return the least and the largest x at which a polygon (n, 2) crosses a height within it."""
    a, b = outline, np.roll(outline, -1, axis=0)
    crossed = (a[:, 1] - height) * (b[:, 1] - height) < 0
    along = (height - a[crossed, 1]) / (b[crossed, 1] - a[crossed, 1])
    x = a[crossed, 0] + along * (b[crossed, 0] - a[crossed, 0])
    return x.min(), x.max()
