"""The claims of Tripura et al. on shape, period and amplitude, tested on the runs of a campaign: Figs. 5, 14 and Table 1.

Where the paper says "negligible" or "mostly" a tolerance is our reading of it; it stands in the claim's rule.
"""

import numpy as np

from ..campaign.verdicts import Agrees, above, below
from ..measured import UNKNOWN
from . import runs
from .cavity_model import smallest_amplitude
from .claims import claim
from .runs import by_shape, of_shape

RISE_ORDER = ("disk", "tall", "square", "wide", "triangle")  # section 3.2
OBSERVED = {"disk": (2.5, 3), "square": (3, 4), "tall": (3, 4), "wide": (2, 3), "triangle": (4, 5)}  # Table 1, A = 5 d
TABLE_1_AMPLITUDE = 5.0
SMALL_AMPLITUDE = 1.0  # up to which the paper sees no motion
SIGNS_AMPLITUDE = 3.0  # of which the text gives signs of V_y
SIGNS_SHAPES = RISE_ORDER[:4]
TURN = 2.0  # period between sinking and rising there


# ---- Fig. 5 and Table 1 ----------------------------------------------------------------------------------------------


def period_claims(_campaign, rows):
    """Nothing moves at small A; sinking is fastest at T = 1; the rise rate has a maximum in T."""
    claims = []
    for shape, group in by_shape(rows):
        claims += [small_amplitudes(shape, group)] if group["amplitude"].min() <= SMALL_AMPLITUDE else []
        for amplitude, of_amplitude in group[group["amplitude"] > SMALL_AMPLITUDE].groupby("amplitude"):
            where = f"{shape}, A {amplitude:g}"
            claims += [fastest_sinking(where, of_amplitude), non_monotonic(where, of_amplitude)]
        at_three = group[group["amplitude"] == SIGNS_AMPLITUDE]
        claims += signs(shape, at_three) if shape in SIGNS_SHAPES and len(at_three) else []
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
    return claim(rows, text, "Fig. 5", "≈ 0", slow / fastest, below(runs.NEGLIGIBLE))


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


def signs(shape, rows):
    """At A = 3 d disk, square and rectangles sink at T = 1 and rise at all periods above 2."""
    sinking, rising = rows[rows["period"] == 1], rows[rows["period"] > TURN]
    fastest = min(runs.rates(sinking)[1], key=lambda m: m.value, default=UNKNOWN)
    slowest = min(runs.rates(rising)[1], key=lambda m: m.value - 2 * m.error, default=UNKNOWN)
    where = f"{shape}, A {SIGNS_AMPLITUDE:g}"
    return [
        claim(sinking, f"{where}: it sinks at T = 1; V_y", "Fig. 5, section 3.2", "< 0", fastest, below(0)),
        claim(rising, f"{where}: it rises at T > 2; the least V_y", "Fig. 5, section 3.2", "> 0", slowest, above(0)),
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
