"""The claims of Tripura et al. on shape, period, amplitude and drive, tested on a campaign's runs: Figs. 5, 14 and Table 1.

Where the paper says "negligible" or "mostly" a tolerance is our reading of it; it stands in the claim's rule.
"""

import numpy as np

from ..campaign.runs import quantity
from ..campaign.verdicts import Agrees, above, below
from ..measured import UNKNOWN
from . import runs
from .cavity_model import smallest_amplitude
from .claims import claim
from .runs import RATE, by_shape, of_shapes

RISE_ORDER = ("disk", "tall", "square", "wide", "triangle")  # section 3.2
SINK_ORDER = ("triangle", "wide", "square", "tall")  # section 3.2, fastest first
OBSERVED = {"disk": (2.5, 3), "square": (3, 4), "tall": (3, 4), "wide": (2, 3), "triangle": (4, 5)}  # Table 1, A = 5 d
TABLE_1_AMPLITUDE = 5.0
SMALL_AMPLITUDE = 1.0  # up to which the paper sees no motion
SIGNS_AMPLITUDE = 3.0  # of which the text gives signs of V_y
MIDDLE = 4.0  # period near the maximum of V_y, from which it falls to the longest
HARDLY = 0.25  # of the disk's rise: our reading of "barely"


def period_claims(_campaign, rows):
    """Nothing moves at small A; sinking is fastest at T = 1; the rise rate has a maximum in T."""
    claims = []
    for shape, group in by_shape(rows):
        claims += [small_amplitudes(shape, group)] if group["amplitude"].min() <= SMALL_AMPLITUDE else []
        for amplitude, of_amplitude in group[group["amplitude"] > SMALL_AMPLITUDE].groupby("amplitude"):
            where = f"{shape}, A {amplitude:g}"
            claims += [fastest_sinking(where, of_amplitude), non_monotonic(where, of_amplitude)]
        at_three = group[group["amplitude"] == SIGNS_AMPLITUDE]
        claims += signs(shape, at_three) if shape in RISE_ORDER and len(at_three) else []
    return claims


def table_claims(_campaign, rows):
    """Table 1: the first period that rises at A = 5 d, as the paper saw it and by its model."""
    rows = rows[rows["amplitude"] == TABLE_1_AMPLITUDE]
    return [c for shape, group in by_shape(rows) if shape in OBSERVED for c in first_rising(shape, shape, group)]


def order_and_triangle_claims(_campaign, rows):
    """Which shape rises and sinks faster than which, that A speeds the rise, and that the triangle sinks."""
    large = rows[rows["amplitude"] > SMALL_AMPLITUDE]
    claims = []
    for amplitude, group in large.groupby("amplitude"):
        claims += order_claims(f"A {amplitude:g}", group) + triangle_claims(f"A {amplitude:g}", group)
    return claims + amplitude_order_claims(large)


def small_amplitudes(shape, rows):
    """No motion for A <= 1: the fastest there over the fastest at larger amplitudes."""
    small, large = rows[rows["amplitude"] <= SMALL_AMPLITUDE], rows[rows["amplitude"] > SMALL_AMPLITUDE]
    fastest = max(
        (runs.largest_motion(g) for _, g in large.groupby("amplitude")), key=lambda m: m.value, default=UNKNOWN
    )
    slow = max((runs.largest_motion(g) for _, g in small.groupby("amplitude")), key=lambda m: m.value, default=UNKNOWN)
    text = f"{shape}: nothing moves at A ≤ 1; largest |V_y| there over that at larger A"
    return claim(rows, text, "Fig. 5", "≈ 0", slow / fastest, below(runs.NEGLIGIBLE))


def fastest_sinking(where, rows):
    """V_y has its minimum at T = 1: it is lower there than at the nearest periods below and above."""
    periods, points = runs.rates(rows)
    k = int(np.searchsorted(periods, 1))
    inside = 0 < k < len(periods) - 1 and periods[k] == 1
    differences = [points[k - 1] - points[k], points[k + 1] - points[k]] if inside else []
    least = min(differences, key=lambda m: m.value, default=UNKNOWN)
    text = f"{where}: sinking is fastest at T = 1; V_y at the periods beside it, less V_y there, the smaller"
    return claim(rows, text, "Fig. 5, section 4", "> 0", least, above(0))


def non_monotonic(where, rows):
    """V_y has a maximum in T beyond the fastest sinking: it is lower at the longest period than in the middle."""
    longest = rows["period"].max()
    less = runs.rate_at(rows, MIDDLE) - runs.rate_at(rows, longest) if longest > MIDDLE else UNKNOWN
    text = f"{where}: V_y falls again at long periods; V_y at T = {MIDDLE:g} less that at the longest, {longest:g}"
    return claim(rows[rows["period"] >= MIDDLE], text, "Fig. 5", "> 0", less, above(0))


def signs(shape, rows):
    """At A = 3 d disk, square and rectangles sink at T = 1 and rise at all periods above 2; the triangle always sinks."""
    where, source = f"{shape}, A {SIGNS_AMPLITUDE:g}", "Fig. 5, section 3.2"
    if shape == "triangle":
        text = f"{where}: it sinks at every period; the largest V_y"
        return [claim(rows, text, "section 3.1", "< 0", runs.fastest_rise(rows), below(0))]
    rising = rows[rows["period"] > runs.TURN]
    text = f"{where}: it rises at T > {runs.TURN:g}; the least V_y"
    return [
        claim(rows, f"{where}: it sinks at T = 1; V_y", source, "< 0", runs.rate_at(rows, 1), below(0)),
        claim(rising, text, source, "> 0", runs.least_rate(rising), above(0)),
    ]


def amplitude_claims(_campaign, rows):
    """The smallest amplitude that moves a body: above 1 d in the paper's runs, above d/2 by its model."""
    claims = []
    for shape, group in by_shape(rows):
        for period, of_period in group.groupby("period"):
            smallest = runs.smallest_moving_amplitude(of_period)
            text = f"{shape}, T {period:g}: the smallest amplitude that moves it"
            claims += [
                claim(of_period, f"{text}, runs", "Fig. 5", "> 1", smallest, above(SMALL_AMPLITUDE)),
                claim(
                    of_period, f"{text}, cavity model", "below Eq. 3.17", "> 0.5", smallest, above(smallest_amplitude())
                ),
            ]
    return claims


def first_rising(where, shape, rows):
    """The first rising period beside Table 1, as observed and by the model."""
    found, (low, high) = runs.first_rising_period(rows), OBSERVED[shape]
    model = runs.model_of(rows).first_rising_period
    observed = Agrees((low + high) / 2, (high - low) / 2, 1.0)
    return [
        claim(rows, f"{where}: first period that rises, observed", "Table 1", f"{low:g} to {high:g}", found, observed),
        claim(
            rows,
            f"{where}: first period that rises, cavity model",
            "Eq. 3.14",
            f"{model:.2f}",
            found,
            Agrees(model, 0.5, 1.0),
        ),
    ]


def order_claims(where, rows):
    """OS1 > OS3 > OS2 > OS4 > OS5 by the rise at T > 2; OS5 > OS4 > OS2 > OS3 by sinking at T = 1."""
    rising = rows[rows["period"] > runs.TURN]
    sinking = rows[rows["period"] == 1]
    claims = []
    for faster, slower in pairs_in(rising, RISE_ORDER):
        more = runs.mean_rise(of_shapes(rising, faster)) - runs.mean_rise(of_shapes(rising, slower))
        text = f"{where}: {faster} rises faster than {slower}; difference of mean V_y at T > {runs.TURN:g}"
        claims.append(claim(of_shapes(rising, faster, slower), text, "section 3.2", "> 0", more, above(0)))
    for faster, slower in pairs_in(sinking, SINK_ORDER):
        more = runs.rate_at(of_shapes(sinking, slower), 1) - runs.rate_at(of_shapes(sinking, faster), 1)
        text = f"{where}: {faster} sinks faster than {slower}; difference of V_y at T = 1"
        claims.append(claim(of_shapes(sinking, faster, slower), text, "section 3.2", "> 0", more, above(0)))
    return claims


def pairs_in(rows, order):
    """Return the neighbours in an order of shapes of which both have runs."""
    there = set(rows["shape"])
    return [pair for pair in zip(order, order[1:]) if there.issuperset(pair)]


def triangle_claims(where, rows):
    """The triangle sinks or barely rises where the disk rises fastest, and mostly sinks."""
    triangle, disk = of_shapes(rows, "triangle"), of_shapes(rows, "disk")
    if triangle.empty or disk.empty:
        return []
    periods, points = runs.rates(disk)
    fastest = periods[int(np.argmax([m.value for m in points]))]
    ratio = runs.rate_at(triangle, fastest) / runs.rate_at(disk, fastest)
    text = f"{where}: the triangle sinks or barely rises where the disk is fastest, T = {fastest:g}; its V_y over the disk's"
    mostly = f"{where}: the triangle mostly sinks; mean V_y over the periods"
    return [
        claim(of_shapes(rows, "triangle", "disk"), text, "Fig. 5(e)", f"< {HARDLY:g}", ratio, below(HARDLY)),
        claim(triangle, mostly, "Fig. 5(e), section 4", "< 0", runs.mean_over(runs.rates(triangle)[1]), below(0)),
    ]


def amplitude_order_claims(rows):
    """The disk rises faster at a larger amplitude."""
    disk = of_shapes(rows[rows["period"] > runs.TURN], "disk")
    claims = []
    for small, large in zip(amplitudes := sorted(disk["amplitude"].unique()), amplitudes[1:]):
        both = [disk[disk["amplitude"] == amplitude] for amplitude in (small, large)]
        common = set(both[0]["period"]) & set(both[1]["period"])
        slow, fast = (runs.mean_rise(group[group["period"].isin(common)]) for group in both)
        text = f"disk: it rises faster at A {large:g} than at A {small:g}; difference of mean V_y at T > {runs.TURN:g}"
        claims.append(claim(disk, text, "Fig. 5(a), section 3.2", "> 0", fast - slow, above(0)))
    return claims


# ---- two readings of the drive ---------------------------------------------------------------------------------------


def drive_claims(_campaign, rows):
    """Whether it matters of what A is the amplitude (of a velocity, displacements are A T/2π), and which reading fits Table 1."""
    claims = []
    for (shape, amplitude, period), group in rows.groupby(["shape", "amplitude", "period"]):
        by_form = {form: quantity(of_form, RATE) for form, of_form in group.groupby("drive")}
        if {"displacement", "velocity"} <= set(by_form):
            change = by_form["displacement"] - by_form["velocity"]
            where = f"{shape}, A {amplitude:g}, T {period:g}"
            text = f"{where}: the reading of the drive does not matter; V_y by displacement less V_y by velocity"
            claims.append(claim(group, text, "Fig. 1 against section 3.3", "0", change, Agrees(0, 0.01, 0.02)))
    at_table_1 = rows[rows["amplitude"] == TABLE_1_AMPLITUDE]
    for (shape, form), group in at_table_1.groupby(["shape", "drive"]):
        if shape in OBSERVED:
            claims.append(first_rising(f"{shape}, A of the {form}", shape, group)[0])
    return claims
