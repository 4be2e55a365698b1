"""The claims of Tripura et al. on rise and sink of wiggling bodies, tested on the runs of a campaign.

Where the paper says "negligible" or "mostly" a tolerance is our reading of it; it stands in the claim's rule.
"""

from functools import partial

import numpy as np

from ..campaign.claims import claim_on
from ..campaign.runs import curve, over_repeats, quantity
from ..campaign.verdicts import Agrees, above, below
from ..measured import UNKNOWN, polynomial_through
from . import runs
from .runs import RATE, by_shape, of_shape

RISE_ORDER = ("disk", "tall", "square", "wide", "triangle")  # section 3.2
OBSERVED = {"disk": (2.5, 3), "square": (3, 4), "tall": (3, 4), "wide": (2, 3), "triangle": (4, 5)}  # Table 1, A = 5 d
TABLE_1_AMPLITUDE = 5.0
SMALL_AMPLITUDE = 1.0  # up to which the paper sees no motion

claim = partial(claim_on, dict(shape=("", ""), amplitude=("A", ""), period=("T", ""), mu=("μ", "")))


# ---- Fig. 5 and Table 1 ----------------------------------------------------------------------------------------------


def period_claims(_campaign, rows):
    """Nothing moves at small A; sinking is fastest at T = 1; the rise rate has a maximum in T."""
    claims = []
    for shape, group in by_shape(rows):
        claims += [small_amplitudes(shape, group)] if group["amplitude"].min() <= SMALL_AMPLITUDE else []
        for amplitude, of_amplitude in group[group["amplitude"] > SMALL_AMPLITUDE].groupby("amplitude"):
            where = f"{shape}, A {amplitude:g}"
            claims += [fastest_sinking(where, of_amplitude), non_monotonic(where, of_amplitude)]
    return claims


def table_claims(_campaign, rows):
    """Table 1: the first period that rises at A = 5 d, as the paper saw it and by its model."""
    rows = rows[rows["amplitude"] == TABLE_1_AMPLITUDE]
    return [c for shape, group in by_shape(rows) if shape in OBSERVED for c in first_rising(shape, group)]


def order_and_triangle_claims(_campaign, rows):
    """Which shape rises faster than which, and that the triangle hardly does."""
    return order_claims(rows) + triangle_claims(rows)


def small_amplitudes(shape, rows):
    """No motion for A <= 1: the fastest there over the fastest at larger amplitudes."""
    small, large = rows[rows["amplitude"] <= SMALL_AMPLITUDE], rows[rows["amplitude"] > SMALL_AMPLITUDE]
    fastest = max(
        (runs.largest_motion(g) for _, g in large.groupby("amplitude")), key=lambda m: m.value, default=UNKNOWN
    )
    slow = max((runs.largest_motion(g) for _, g in small.groupby("amplitude")), key=lambda m: m.value, default=UNKNOWN)
    text = f"{shape}: nothing moves at A ≤ 1; largest |V_y| there over that at larger A"
    return claim(rows, text, "Fig. 5", "≈ 0", slow / fastest, below(0.1))


def fastest_sinking(where, rows):
    """V_y has its minimum at T = 1: it is lower there than at the nearest periods below and above."""
    periods, points = runs.rates(rows)
    k = int(np.searchsorted(periods, 1))
    inside = 0 < k < len(periods) - 1 and periods[k] == 1
    differences = [points[k - 1] - points[k], points[k + 1] - points[k]] if inside else []
    least = min(differences, key=lambda m: m.value - 2 * m.error, default=UNKNOWN)
    text = f"{where}: sinking is fastest at T = 1; V_y at the periods beside it, less V_y there, the smaller"
    return claim(rows, text, "Fig. 5, section 4.2", "> 0", least, above(0))


def non_monotonic(where, rows):
    """V_y has a maximum in T beyond the fastest sinking: it is lower at the longest period."""
    rising = rows[rows["period"] > 1]
    less = runs.fastest_rise(rising) - runs.rates(rising)[1][-1] if rising["period"].nunique() > 1 else UNKNOWN
    text = f"{where}: V_y has a maximum in T > 1; fastest rise less that at the longest period"
    return claim(rising, text, "Fig. 5", "> 0", less, above(0))


def first_rising(shape, rows):
    """The first rising period beside Table 1, as observed and by the model."""
    found, (low, high) = runs.first_rising_period(rows), OBSERVED[shape]
    model = runs.model_of(rows).first_rising_period
    observed = Agrees((low + high) / 2, (high - low) / 2, 1.0)
    return [
        claim(rows, f"{shape}: first period that rises, observed", "Table 1", f"{low:g} to {high:g}", found, observed),
        claim(
            rows,
            f"{shape}: first period that rises, cavity model",
            "Eq. 3.14",
            f"{model:.2f}",
            found,
            Agrees(model, 0.5, 1.0),
        ),
    ]


def order_claims(rows):
    """OS1 > OS3 > OS2 > OS4 > OS5, by the fastest rise over the periods."""
    claims = []
    for amplitude, group in rows[rows["amplitude"] > SMALL_AMPLITUDE].groupby("amplitude"):
        for faster, slower in zip(RISE_ORDER, RISE_ORDER[1:]):
            pair = group[group["shape"].isin([faster, slower])]
            if pair["shape"].nunique() == 2:
                more, less = (runs.fastest_rise(of_shape(pair, shape)) for shape in (faster, slower))
                text = f"A {amplitude:g}: {faster} rises faster than {slower}; difference of the fastest rises"
                claims.append(claim(pair, text, "section 3.2", "> 0", more - less, above(0)))
    return claims


def triangle_claims(rows):
    """The triangle sinks or barely rises, at any period."""
    claims = []
    for amplitude, group in rows[rows["amplitude"] > SMALL_AMPLITUDE].groupby("amplitude"):
        triangle, disk = of_shape(group, "triangle"), of_shape(group, "disk")
        if len(triangle) and len(disk):
            ratio = runs.fastest_rise(triangle) / runs.fastest_rise(disk)
            text = f"A {amplitude:g}: the triangle sinks or barely rises; its fastest rise over the disk's"
            claims.append(claim(triangle, text, "Fig. 5(e), section 4.1", "< 0.1", ratio, below(0.1)))
            mean = runs.mean_over(runs.rates(triangle)[1])
            text = f"A {amplitude:g}: the triangle mostly sinks; mean V_y over the periods"
            claims.append(claim(triangle, text, "Fig. 5(e)", "< 0", mean, below(0)))
    return claims


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
