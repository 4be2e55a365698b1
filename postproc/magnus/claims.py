"""The claims of Kumar, Dhiman, Reddy, Phys. Rev. E 99, 012902 (2019), tested on the runs of a campaign.

Where the paper says "roughly", "almost" or "weakly" a tolerance is our reading of it; it stands in the claim's rule.
"""

from functools import partial

import numpy as np

from ..campaign.claims import claim_on
from ..campaign.runs import at, curve, over_repeats, quantity
from ..campaign.verdicts import Agrees, above, below
from ..measured import UNKNOWN, Measured, exactly, mean_of, polynomial_through, power_of, steepest_place
from .model import saturated_lift_to_drag
from .runs import by_angle

DILUTE, DENSE = 0.5, 0.8  # area fractions below and above which the paper speaks of dilute and dense systems
PRINTED_KAPPA = {0.352: 0.95, 0.818: 0.90}  # section IV, at mu = 0.5
KAPPA_ROUNDING = 0.005

claim = partial(claim_on, dict(phi=("Φ", ""), v0=("V0", " m/s"), spin_ratio=("Ω", ""), mu=("μ", "")))


def by_phi(rows):
    """Yield (phi, its rows) for the area fractions of a sweep."""
    for phi, group in rows.groupby("phi", sort=True):
        yield float(phi), group


# ---- Fig. 2: no spin -------------------------------------------------------------------------------------------------


def speed_claims(_campaign, rows):
    """D ∝ V0² with nothing left at V0 = 0; N linear in V0 when dilute, bent when dense."""
    claims = []
    for phi, group in by_phi(rows):
        claims += [drag_power(phi, group), drag_at_rest(phi, group)]
        claims += [contacts_bend(phi, group)] if phi < DILUTE or phi > DENSE else []
    return claims


def drag_power(phi, rows):
    """The slope of log D against log V0."""
    slope = power_of(*curve(rows, "v0", "drag"))
    return claim(rows, f"Φ {phi:g}: log D against log V0 has slope 2", "Fig. 2(a)", "2", slope, Agrees(2, 0.1, 0.2))


def drag_at_rest(phi, rows):
    """D0 of Eq. 3, over the smallest drag of the sweep: if it mattered anywhere, it would there."""
    v0, drag = curve(rows, "v0", "drag")
    _, at_rest = polynomial_through(v0**2, drag, 1)
    text = f"Φ {phi:g}: D0 of Eq. 3 is nothing, over D at the lowest speed"
    return claim(rows, text, "Eq. 3", "0", at_rest / exactly(drag[0].value), Agrees(0, 0.1, 0.2))


def contacts_bend(phi, rows):
    """The quadratic part of N(V0) at the largest speed, over N there: zero for a straight line, negative if N lags."""
    v0, contacts = curve(rows, "v0", "contacts")
    bend = polynomial_through(v0, contacts, 2)[0] / exactly(contacts[-1].value / v0[-1] ** 2)
    if phi < DILUTE:
        text = f"Φ {phi:g}: N is linear in V0; quadratic part over N at the highest speed"
        return claim(rows, text, "Fig. 2(b)", "0", bend, Agrees(0, 0.1, 0.2))
    text = f"Φ {phi:g}: N lags behind a straight line; quadratic part over N at the highest speed"
    return claim(rows, text, "Fig. 2(b)", "< 0", bend, below(0))


# ---- Fig. 3: lift over drag ------------------------------------------------------------------------------------------


def lift_claims(_campaign, rows):
    """L/D: zero without spin, along −ω×V with it, steepest near Ω = 1, flat at last."""
    return [claim_ for phi, group in by_phi(rows) for claim_ in lift_claims_at(phi, group)]


def lift_claims_at(phi, rows):
    """The four claims of Fig. 3 for one area fraction."""
    spin, ratio = curve(rows, "spin_ratio", "lift_to_drag")
    fast = [r for s, r in zip(spin, ratio) if s >= 1]
    weakest = min(fast, key=lambda r: r.value - 2 * r.error) if fast else UNKNOWN
    still, spun, last = at(rows, spin_ratio=0), rows[rows["spin_ratio"] >= 1], rows[rows["spin_ratio"] >= spin[-2:][0]]
    flat = ratio[-1] / ratio[-2] if len(spin) > 1 and spin[-2] > 1 else UNKNOWN

    def one(chosen, text, *rest):
        return claim(chosen, f"Φ {phi:g}: {text}", *rest)

    no_lift, steepest = quantity(still, "lift_to_drag"), steepest_place(spin, ratio)
    flatness = f"L/D saturates; L/D at Ω {spin[-1]:g} over that at {spin[-2:][0]:g}"
    return [
        one(still, "L/D is zero without spin", "Fig. 3", "0", no_lift, Agrees(0, 0.0, 0.05)),
        one(spun, "the lift points along −ω×V; the least L/D at Ω ≥ 1", "Figs. 3, 4", "> 0", weakest, above(0)),
        one(rows, "L/D rises fastest near Ω = 1; Ω there", "Fig. 3", "≈ 1", steepest, Agrees(1, 0.5, 1.0)),
        one(last, flatness, "Fig. 3", "1", flat, Agrees(1, 0.1, 0.15)),
    ]


# ---- Fig. 5: drag and contacts against spin --------------------------------------------------------------------------


def drag_claims(_campaign, rows):
    """D_Ω/D_0 constant when dilute, rising when dense; N_Ω/N_0 falling at large Ω."""
    claims = []
    for phi, group in by_phi(rows):
        fastest = group["spin_ratio"].max()
        drag, contacts = (over_no_spin(group, name, fastest) for name in ("drag", "contacts"))
        group = group[group["spin_ratio"].isin([0, fastest])]
        if phi < DILUTE:
            text, rule = f"Φ {phi:g}: spin leaves D as it is; D/D_0 at Ω {fastest:g}", Agrees(1, 0.1, 0.15)
            claims.append(claim(group, text, "Fig. 5", "1", drag, rule))
        if phi > DENSE:
            text = f"Φ {phi:g}: spin raises D; D/D_0 at Ω {fastest:g}"
            claims.append(claim(group, text, "Fig. 5", "> 1", drag, above(1)))
        text = f"Φ {phi:g}: spin lowers N; N/N_0 at Ω {fastest:g}"
        claims.append(claim(group, text, "Fig. 5", "< 1", contacts, below(1)))
    return claims


def over_no_spin(rows, name, spin):
    """Return the quantity at a spin ratio over that without spin, averaged over the speeds of the sweep."""
    ratios = []
    for _, group in rows.groupby("v0"):
        still = at(group, spin_ratio=0)
        if len(still) and len(at(group, spin_ratio=spin)):
            ratios.append(quantity(at(group, spin_ratio=spin), name) / quantity(still, name))
    n = len(ratios)
    return (
        Measured(sum(r.value for r in ratios) / n, float(np.hypot.reduce([r.error for r in ratios]) / n))
        if n
        else UNKNOWN
    )


# ---- Fig. 6: by angle ------------------------------------------------------------------------------------------------


def angle_claims(campaign, rows):
    """Contacts in front only; all slipping at large Ω, against the spin from Ω = 1 on."""
    fastest = rows["spin_ratio"].max()
    fast, unit = at(rows, spin_ratio=fastest), at(rows, spin_ratio=1)
    front = [quantity(group, "front_share") for _, group in rows.groupby("spin_ratio")]
    least, slipping = min(front, key=lambda share: share.value), mean_of([slip(*one) for one in pairs(campaign, fast)])
    text, slip_text = (
        "contacts are almost only in |θ| < π/2; least share of N",
        f"contacts slip at Ω {fastest:g}; ΣF_T/(μ ΣF_N)",
    )
    claims = [
        claim(rows, text, "Fig. 6(c)", "≈ 1", least, above(0.95)),
        claim(fast, slip_text, "Fig. 6(b)", "1", slipping, Agrees(1, 0.05, 0.1)),
    ]
    if len(unit):
        share = over_repeats([against_spin(found) for found, _ in pairs(campaign, unit)])
        text = "most of the front is pushed against the spin at Ω 1; share of ΣF_N in |θ| < π/2 where F_T > 0"
        claims.append(claim(unit, text, "Figs. 4, 6(b)", "> 0.5", share, above(0.5)))
    return claims


def pairs(campaign, rows):
    """Return (distributions by angle, μ) of each run."""
    return list(zip(by_angle(campaign, rows), rows["mu"]))


def slip(found, mu):
    """Return ΣF_T over μ ΣF_N of all bins, 1 if every contact slips against the spin; errors of the bins in squares."""
    tangential, normal = (
        Measured(float(force.sum()), float(np.hypot.reduce(error)))
        for force, error in ((found.tangential, found.tangential_err), (found.normal, found.normal_err))
    )
    return tangential / normal / exactly(mu)


def against_spin(found):
    """Return the share of the front's normal force in bins whose tangential force opposes the spin."""
    pressing = found.normal * found.front
    return np.sum(pressing * (found.tangential > 0)) / np.sum(pressing)


# ---- Fig. 8: friction ------------------------------------------------------------------------------------------------


def friction_claims(_campaign, rows):
    """L∞/D∞ → μ when dilute, Eq. 15 with the paper's κ otherwise, below μ always, none without friction."""
    claims = []
    for phi, group in by_phi(rows):
        smooth, usual, rough = at(group, mu=0), at(group, mu=0.5), group[group["mu"] > 0]
        if len(smooth):
            lift = quantity(smooth, "lift_to_drag")
            text = f"Φ {phi:g}: no lift without friction; L∞/D∞ at μ 0"
            claims.append(claim(smooth, text, "Fig. 8", "0", lift, Agrees(0, 0.0, 0.05)))
        claims += usual_friction(phi, usual) if len(usual) else []
        if phi < min(PRINTED_KAPPA) and len(rough):
            mu, ratio = curve(rough, "mu", "lift_to_drag")
            worst = max((r / exactly(m) for m, r in zip(mu, ratio)), key=lambda r: abs(r.value - 1))
            text = f"Φ {phi:g}: L∞/D∞ = μ; L∞/(μ D∞) where it is farthest from 1"
            claims.append(claim(rough, text, "Eq. 9, Fig. 8", "≈ 1", worst, Agrees(1, 0.1, 0.15)))
    return claims


def usual_friction(phi, rows):
    """The claims at μ = 0.5: κ and L∞/D∞ as printed, Eq. 15 with the measured κ, and Eq. 16."""
    mu, kappa, lift = 0.5, quantity(rows, "kappa"), quantity(rows, "lift_to_drag")
    claims = []
    if phi in PRINTED_KAPPA:
        printed = PRINTED_KAPPA[phi]
        rounding = (mu + 1 / mu) * KAPPA_ROUNDING
        text, rule = f"Φ {phi:g}: κ as printed", Agrees(printed, KAPPA_ROUNDING, 0.02)
        claims.append(claim(rows, text, "section IV", f"{printed:g}", kappa, rule))
        ratio = saturated_lift_to_drag(printed, mu)
        text, rule = f"Φ {phi:g}: L∞/D∞ by Eq. 15 with the printed κ", Agrees(ratio, rounding, 0.05)
        claims.append(claim(rows, text, "Eq. 15, section IV", f"{ratio:g}", lift, rule))
    if phi > DENSE:
        claims.append(claim(rows, f"Φ {phi:g}: L∞/D∞ < μ", "Eq. 16", "< 0.5", lift, below(mu)))
    model = Measured(float(saturated_lift_to_drag(kappa.value, mu)), (mu + 1 / mu) * kappa.error)
    text = f"Φ {phi:g}: Eq. 15 with the measured κ gives L∞/D∞; the difference"
    return claims + [claim(rows, text, "Eq. 15", "0", lift - model, Agrees(0, 0.02, 0.05))]
