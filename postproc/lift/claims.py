"""The claims of Guillard, Forterre, Pouliquen, Phys. Fluids 26, 043301 (2014), tested on the runs of a campaign.

Where the paper says "of order" or reads off a figure, a tolerance is our reading of it; it stands in the claim's rule.
"""

from functools import partial

import numpy as np

from ..campaign.claims import claim_on
from ..campaign.runs import curve, over_repeats, quantity
from ..campaign.verdicts import Agrees, above, below
from ..measured import UNKNOWN, mean_of

DEEP = 12.0  # h~/D from which on the paper's lift is saturated
FRONT = 1.0  # rad about the front

claim = partial(claim_on, dict(lid_density=("ρ*/ρ_g", ""), depth=("h", " d"), cylinder_diameter=("D", " d")))


def with_weight(rows):
    """Return the rows of runs with gravity in the bulk."""
    return rows[rows["bulk_gravity"].astype(bool)]


def without_weight(rows):
    """Return the rows of runs with gravity on the lid alone."""
    return rows[~rows["bulk_gravity"].astype(bool)]


# ---- Fig. 8: drag and lift against depth -----------------------------------------------------------------------------


def depth_claims(_campaign, rows):
    """C_d near 10 at every depth, with and without weight; lift saturates with weight, and is nothing without."""
    heavy, light = with_weight(rows), without_weight(rows)
    deep, shallow = heavy[heavy["depth_over_d"] >= DEEP], heavy[heavy["depth_over_d"] < DEEP]
    claims = [
        claim(
            heavy,
            "C_d with weight in the bulk",
            "Fig. 8(a)",
            "≈ 10",
            quantity(heavy, "drag_coefficient"),
            Agrees(10, 3, 2),
        ),
        claim(light, "C_d without", "Fig. 8(a)", "≈ 10", quantity(light, "drag_coefficient"), Agrees(10, 3, 2)),
    ]
    ratio = (
        quantity(deep, "drag_coefficient") / quantity(light, "drag_coefficient")
        if len(deep) and len(light)
        else UNKNOWN
    )
    claims.append(claim(rows, "C_d with weight over that without, deep", "Fig. 8(a)", "1", ratio, Agrees(1, 0.1, 0.2)))
    lift, none = quantity(deep, "lift_over_buoyancy"), quantity(light, "lift_over_buoyancy")
    claims += [
        claim(deep, f"lift over buoyancy at h~/D ≥ {DEEP:g}", "Fig. 8(b)", "≈ 30", lift, Agrees(30, 5, 5)),
        claim(light, "lift over buoyancy without weight in the bulk", "Fig. 8(b)", "0", none, Agrees(0, 2, 10)),
    ]
    if len(shallow) and len(deep):
        rise = lift - quantity(shallow[shallow["depth_over_d"] == shallow["depth_over_d"].min()], "lift_over_buoyancy")
        claims.append(claim(heavy, "lift deep less lift at the least depth", "Fig. 8(b)", "> 0", rise, above(0)))
    return claims


# ---- Figs. 11, 12: stress by angle -----------------------------------------------------------------------------------


def stress_claims(campaign, rows):
    """A peak of 15 P_0 in front, almost nothing behind; sigma_t a tenth of sigma_n; Eq. 4 too weak; the rest one curve."""
    heavy, light = with_weight(rows), without_weight(rows)
    shares, local = (
        quantity(rows, "tangential_share"),
        over_repeats(light["local_pressure_lift"]) if len(light) else UNKNOWN,
    )
    difference = asymmetry(campaign, rows)
    peak, rear = quantity(light, "peak_stress_over_pressure"), over_repeats(light["rear_stress_over_pressure"])
    return [
        claim(light, "largest σ_n over P_0 without weight", "Fig. 11", "≈ 15", peak, Agrees(15, 3, 3)),
        claim(light, "σ_n behind over P_0 without weight", "Fig. 11(c)", "≈ 0", rear, below(0.5)),
        claim(rows, "Σ|σ_t| over Σσ_n", "Fig. 11(a)", "≈ 0.1", shares, Agrees(0.1, 0.05, 0.05)),
        claim(light, "lift over buoyancy by Eq. 4", "section IV", "≈ 3.6", local, Agrees(3.6, 1, 1)),
        claim(
            heavy,
            "σ_n − σ_n(g = 0) over ρgD below less above, in front",
            "Fig. 12",
            "> 0",
            difference,
            above(0),
        ),
    ]


def asymmetry(campaign, rows):
    """Return the mean over depths of (sigma_n - sigma_n(g=0))/(rho g D) at 0 < theta < 1 less that at -1 < theta < 0."""
    found = []
    for _, theta, difference in differences(campaign, rows):
        front = np.abs(theta) < FRONT
        found.append(difference[front & (theta > 0)].mean() - difference[front & (theta < 0)].mean())
    return over_repeats(found) if found else UNKNOWN


def differences(campaign, rows):
    """Yield (h~/D, theta, (sigma_n - sigma_n(g=0))/(rho g D)) for each run with weight.

    sigma_n(g=0) is the mean over the runs without weight of sigma_n over P_0, times the run's own P_0: they scale.
    """
    bare = [
        stress(campaign, name)[1] / pressure
        for name, pressure in zip(without_weight(rows)["run"], without_weight(rows)["pressure"])
    ]
    if not bare:
        return
    for _, row in with_weight(rows).iterrows():
        theta, normal = stress(campaign, row["run"])
        unit = row["pressure"] / row["depth_over_d"]  # rho g D
        yield row["depth_over_d"], theta, (normal - np.mean(bare, axis=0) * row["pressure"]) / unit


def stress(campaign, name):
    """Return theta and the normal stress [Pa] of a run."""
    found = campaign.run(name).group("angular")
    return found["theta"], found["normal_stress"]


# ---- U_0 and D -------------------------------------------------------------------------------------------------------


def speed_claims(_campaign, rows):
    """Drag does not depend on U_0: at half and at twice the middle speed it is the same."""
    speed, drag = curve(rows, "speed", "drag_coefficient")
    if len(speed) < 3:
        return []
    ratio = drag[-1] / mean_of(drag[:-1])
    text = f"C_d at U_0 = {speed[-1]:g} m/s over that at the slower ones"
    return [claim(rows, text, "section II A", "1", ratio, Agrees(1, 0.1, 0.1))]


def diameter_claims(_campaign, rows):
    """Lift over buoyancy falls with D/d."""
    diameter, lift = curve(rows, "cylinder_diameter", "lift_over_buoyancy")
    if len(diameter) < 2:
        return []
    text = f"lift over buoyancy at D = {diameter[0]:g} d less that at {diameter[-1]:g} d"
    return [claim(rows, text, "Fig. 5", "> 0", lift[0] - lift[-1], above(0))]


# ---- The box ---------------------------------------------------------------------------------------------------------


def box_claims(_campaign, rows):
    """Drag and lift in the smaller box over those in the larger one, for each lid."""
    claims = []
    for lid, group in rows.groupby("lid_density"):
        for name, words in (("drag_coefficient", "C_d"), ("lift_over_buoyancy", "lift")):
            width, value = curve(group, "width", name)
            if len(width) < 2:
                continue
            text = f"lid {lid:g} ρ_g: {words} in a box {width[0]:g} d wide over that in one of {width[-1]:g} d"
            claims.append(claim(group, text, "our own check", "1", value[0] / value[-1], Agrees(1, 0.1, 0.2)))
    return claims
