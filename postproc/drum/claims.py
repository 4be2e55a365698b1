"""The claims of Oba, Otsuki (2025) on flows in drums, tested on the runs of a campaign, of grains and of the continuum.

Where the paper says "coincides", "consistent" or "slightly" a tolerance is our reading of it; it stands in the claim's rule.
"""

import itertools
from functools import partial

import numpy as np

from ..campaign.claims import claim_on
from ..campaign.runs import quantity
from ..campaign.verdicts import Agrees, above, below
from ..measured import Measured, mean_of, polynomial_through
from .runs import MODELS, by_speed, curve_of, drum, equal_froude, mean_profile, of_model, scaled_difference

NAMES = {"dem": "grains", "continuum": "continuum"}
CONSISTENT = 0.1  # of u in the L2 norm: what we take "quantitatively consistent" and "data consolidation" to be
RIGID = 0.05  # of Omega z
PAPERS_FRACTION = 0.825
PAPERS_INTERCEPT, PAPERS_SLOPE = 0.11, 1.2  # of h/D against Fr; printed is 1.1, more than the drum's radius

claim = partial(claim_on, dict(drum_diameter=("D", " d"), froude=("Fr", ""), model=("", "")))


def modelled(rows, name):
    """Yield (model, its rows, the quantity's name there) for the models that the rows have."""
    for model in MODELS:
        chosen, known = of_model(rows, model, name)
        if len(chosen) and known in chosen and chosen[known].notna().any():
            yield model, chosen, known


# Fig. 3 ---------------------------------------------------------------------------------------------------------------


def profile_claims(campaign, rows):
    """Grains and continuum have the same u(z); deep down it is that of rigid rotation."""
    claims = []
    for diameter, omega, same in by_speed(rows):
        claims += difference_claims(campaign, diameter, omega, same)
    for model, chosen, name in modelled(rows, "rigid_deviation"):
        groups = [quantity(same, name) for _, _, same in by_speed(chosen)]
        worst = max(groups, key=lambda found: found.value)
        text = f"{NAMES[model]}: u = −Ωz in the static part; largest deviation of all D and Ω, over Ωz"
        claims.append(claim(chosen, text, "Fig. 3", "≈ 0", worst, below(RIGID)))
    return claims


def difference_claims(campaign, diameter, omega, rows):
    """The norm of the difference of both models at one speed, from runs of both or from runs of each."""
    both = rows[rows["model"] == "both"]
    if len(both):
        rows, found = both, quantity(both, "dem_continuum_difference")
    else:
        profiles = [mean_profile(campaign, rows[rows["model"] == model], model) for model in MODELS]
        if None in profiles:
            return []
        found = Measured(*scaled_difference(*profiles))
    text = f"D {diameter:g}, Ω {omega:.3g}: grains and continuum have one u(z); norm of the difference over that of u"
    return [claim(rows, text, "Fig. 3", "≈ 0", found, below(CONSISTENT))]


# Fig. 4, 6 ------------------------------------------------------------------------------------------------------------


def thickness_claims(_campaign, rows):
    """h/D = a + b Fr; h grows with D."""
    claims = []
    for model, chosen, name in modelled(rows, "thickness_over_diameter"):
        slope, intercept = fitted(chosen, model)
        who = NAMES[model]
        text = f"{who}: h/D at Fr → 0, a of h/D = a + b Fr (printed: 1.1)"
        claims.append(claim(chosen, text, "Eq. 59, Fig. 6", "0.11", intercept, Agrees(PAPERS_INTERCEPT, 0.01, 0.02)))
        text = f"{who}: h/D rises with Fr; b of h/D = a + b Fr"
        claims.append(claim(chosen, text, "Eq. 59, Fig. 6", "1.2", slope, Agrees(PAPERS_SLOPE, 0.4, 0.8)))
        text = f"{who}: h/D rises slightly with Fr; b of h/D = a + b Fr"
        claims.append(claim(chosen, text, "section IV", "> 0", slope, above(0)))
    return claims


def fitted(rows, model):
    """Return (b, a) of h/D = a + b Fr through all drums and speeds of a model."""
    froude, thickness = [], []
    for _, _, same in by_speed(rows):
        fr, found = curve_of(same, model, "froude", "thickness_over_diameter")
        froude += list(fr)
        thickness += found
    return polynomial_through(np.array(froude), thickness, 1)


# Fig. 5 ---------------------------------------------------------------------------------------------------------------


def collapse_claims(campaign, rows):
    """At equal Fr u/(Omega D) against z/D is the same for all D: each drum's against that of the largest."""
    claims = []
    for same, group in equal_froude(rows):
        *smaller, largest = sorted(group["drum_diameter"].unique())
        for model, size in itertools.product(MODELS, smaller):
            one, other = (mean_profile(campaign, drum(group, d), model) for d in (largest, size))
            if one and other:
                found = Measured(*scaled_difference(one, other))
                text = f"{NAMES[model]}, {same}: D {size:g} and {largest:g} have one u/(ΩD); norm of the difference"
                pair = group[group["drum_diameter"].isin([size, largest])]
                claims.append(claim(pair, text, "Eq. 56, Fig. 5", "≈ 0", found, below(CONSISTENT)))
    return claims


# Figs. 8, 9 -----------------------------------------------------------------------------------------------------------


def fraction_claims(_campaign, rows):
    """The solid fraction of the static part."""
    chosen, name = of_model(rows, "dem", "packing_fraction")
    found = mean_of([quantity(same, name) for _, _, same in by_speed(chosen)])
    text = "grains: solid fraction in the static part, mean over all D and Ω"
    return [claim(chosen, text, "appendix C, Fig. 8", "0.825", found, Agrees(PAPERS_FRACTION, 0.005, 0.01))]


def surface_claims(_campaign, rows):
    """The free surface passes through the axis."""
    claims = []
    for model, chosen, name in modelled(rows, "surface_over_diameter"):
        groups = [quantity(same, name) for _, _, same in by_speed(chosen)]
        farthest = max(groups, key=lambda found: abs(found.value))
        text = f"{NAMES[model]}: surface through the axis; z_surface/D where farthest"
        claims.append(claim(chosen, text, "appendix D, Fig. 9", "≈ 0", farthest, Agrees(0, 0.01, 0.01)))
    return claims
