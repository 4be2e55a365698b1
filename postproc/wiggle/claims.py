"""The claims of Tripura et al. on friction, phase and fields, and our own on drives and scenes, tested on a campaign's runs."""

from functools import partial

import numpy as np

from ..campaign.claims import claim_on
from ..campaign.runs import curve, over_repeats, quantity
from ..campaign.verdicts import Agrees, above, below
from ..measured import polynomial_through
from . import runs
from .runs import RATE, by_shape

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
    """The disk climbs on its way out and not on its way back, twice a cycle."""
    claims = []
    for where, group in by_shape_and_period(rows):
        _, points = runs.phase_curve(campaign, group)
        quarter = len(points) // 4
        first, second, third, fourth = (runs.mean_over(points[k * quarter : (k + 1) * quarter]) for k in range(4))
        gained = runs.mean_over([first, third]) - runs.mean_over([second, fourth])
        text = f"{where}: it climbs while it moves out; V_y moving out less V_y moving back"
        claims.append(claim(group, text, "Fig. 8, section 3.3", "> 0", gained, above(0)))
    return claims


def drive_claims(_campaign, rows):
    """The two readings of the drive: where A is the amplitude of velocity, displacements are A T/2π."""
    claims = []
    for period, group in rows.groupby("period"):
        by_form = {form: quantity(of_form, RATE) for form, of_form in group.groupby("drive")}
        if {"displacement", "velocity"} <= set(by_form):
            change = by_form["displacement"] - by_form["velocity"]
            text = f"T {period:g}: the reading of the drive does not matter; V_y by displacement less V_y by velocity"
            claims.append(claim(group, text, "Fig. 1 against section 3.3", "0", change, Agrees(0, 0.01, 0.02)))
    return claims


def scene_claims(_campaign, rows):
    """Each scene beside the one with most grains: how much V_y changes with the bed, the lid and the time step."""
    claims = []
    for period, group in rows.groupby("period"):
        scenes = scenes_of(group)
        _, full = scenes[0]
        for name, scene in scenes[1:]:
            change = quantity(scene, RATE) - quantity(full, RATE)
            text = f"T {period:g}, {name}: V_y less that of the first scene"
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


def field_claims(campaign, rows):
    """At mid-stroke to the right: fewer grains behind the body, and the pressure in front of it."""
    claims = []
    for shape, group in by_shape(rows):
        wake = beside_difference(campaign, group, "area_fraction")
        text = f"{shape}: a wake behind it at phase 0; area fraction on the left less that on the right"
        claims.append(claim(group, text, "Figs. 9-11(a)", "< 0", wake, below(0)))
        pressure = beside_difference(campaign, group, "pressure")
        text = f"{shape}: the pressure is in front at phase 0; pressure on the left less that on the right"
        claims.append(claim(group, text, "Figs. 9-11(k)", "< 0", pressure, below(0)))
    return claims


def beside_difference(campaign, rows, name):
    """Return the mean of a field within 3 d left of the body less that right of it, at the first phase, over repeats."""
    half = float(np.ptp(campaign.run(rows["run"].iloc[0]).group("intruder")["outline"][:, 0])) / 2
    values = []
    for field in runs.field_runs(campaign, rows):
        level, near = np.abs(field.y) < 2, (np.abs(field.x) > half + 0.5) & (np.abs(field.x) < half + 3.5)
        beside = field.map(name, 0)
        left, right = (np.nanmean(beside[np.ix_(level, near & side)]) for side in (field.x < 0, field.x > 0))
        values.append(left - right)
    return over_repeats(values)
