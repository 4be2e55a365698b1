"""Shear at the drum paper's area fraction, where grains are pressed into each other: why its mu(I) lies below ours."""

import numpy as np

from .. import figures
from ..campaign.plots import canvas, draw_points, look
from ..campaign.runs import curve
from ..campaign.verdicts import Agrees, below
from ..figures import BLACK, GREY
from ..measured import Measured
from . import friction
from .points import DISK, PRINTED, ROUNDING, claim, claim_on_area, law_of, points_of
from .rheology import friction_law

SAME = 0.01  # of mu: a fifth of what the softness at phi = 0.825 takes from it at I = 0.1
CLOSE = 0.1  # of mu: what we take "consistent" to be
STIFF = 1000  # k_n/P; at I = 0.1 mu changes by less than 0.01 above it (figure of the stiffness)
RATE = "shear_rate"


def claims(campaign, rows):
    """Constants against the paper's; how soft the grains are; the same mu at constant pressure where grains are as soft."""
    law = law_of(rows, RATE)
    found = []
    for name, symbol, value, resolution in (
        ("mu_s", "μ_s", law.mu_s, 0.02),
        ("mu_2", "μ_2", law.mu_2, 0.05),
        ("i_0", "I_0", law.i_0, 0.05),
    ):
        rule = Agrees(PRINTED[name], ROUNDING, resolution)
        text = f"{symbol} of μ(I) at φ = 0.825"
        found.append(claim_on_area(rows, text, friction.SOURCE, f"{PRINTED[name]:g}", value, rule))
    text = "μ at φ = 0.825 is that of the paper's constants; largest distance over μ"
    found.append(claim_on_area(rows, text, f"{friction.SOURCE}, Fig. 7", "≈ 0", farthest(rows), below(CLOSE)))
    text = "grains are soft at φ = 0.825: largest k_n/p of all rates"
    found.append(claim_on_area(rows, text, "this study", f"< {STIFF}", stiffest(rows), below(STIFF)))
    return found + soft_claims(campaign, rows)


def farthest(rows):
    """Return the largest distance of mu from the paper's law, over mu, as `Measured`."""
    inertial, points = points_of(rows, "stress_ratio", RATE)
    away = [abs(point - law) / point.value for point, law in zip(points, friction_law(inertial, **PRINTED))]
    return max(away, key=lambda found: found.value)


def stiffness_over_pressure(rows, key):
    """Return k_n/p (n,) as `Measured` by a key."""
    _, pressure = curve(rows, key, "mean_pressure")
    stiffness = float(rows["stiffness"].iloc[0]) * DISK
    return [Measured(stiffness / p.value, stiffness * p.error / p.value**2) for p in pressure]


def stiffest(rows):
    """Return the largest k_n/p of the runs, as `Measured`."""
    return max(stiffness_over_pressure(rows, RATE), key=lambda found: found.value)


def soft_claims(campaign, rows):
    """At constant pressure, one I and grains so soft that phi is 0.825, mu is that at constant phi; of stiff grains more."""
    soft, stiff = campaign.sweep("soft"), campaign.sweep("stiffness")
    if soft.empty or stiff.empty:
        return []
    inertial, held = float(soft["inertial_number"].iloc[0]), float(rows["area_fraction"].iloc[0])
    at_held = through(inertial, *(curve(rows, RATE, name)[1] for name in ("flow_inertial_number", "stress_ratio")))
    between = through(held, *(curve(soft, "pressure", name)[1] for name in ("phi", "stress_ratio")))
    text = f"I = {inertial:g}: μ at the constant pressure that gives φ = {held:g}, less μ at constant φ"
    same = claim(soft, text, "the state, not what is held, counts", "0", between - at_held, Agrees(0, 0.0, SAME))
    pressure, hard = curve(stiff, "pressure", "stress_ratio")
    ratio = float(stiff["stiffness"].iloc[0]) * DISK / pressure[0]
    text = f"I = {inertial:g}: soft grains have less friction; μ at φ = {held:g} less that at k_n/P = {ratio:.3g}"
    return [same, claim(stiff, text, "this study", "< 0", at_held - hard[0], below(0))]


def through(place, x, y):
    """Return y (`Measured`) at a place between points x, y (n `Measured`), on the straight line of its two neighbours.

    Unknown where no two neighbours enclose it. Errors of x count by the line's slope.
    """
    for (x0, y0), (x1, y1) in zip(zip(x, y), zip(x[1:], y[1:])):
        if x0.value <= place <= x1.value:
            part, slope = (place - x0.value) / (x1.value - x0.value), (y1.value - y0.value) / (x1.value - x0.value)
            errors = [
                (1 - part) * np.hypot(y0.error, slope * x0.error),
                part * np.hypot(y1.error, slope * x1.error),
            ]
            return Measured(y0.value + part * (y1.value - y0.value), float(np.hypot(*errors)))
    return Measured(float("nan"), float("nan"))


def draw(campaign, rows):
    """mu(I) at constant phi and at constant pressure with the paper's law; k_n/p of both; mu and phi of soft grains at one I."""
    figure, ((left, middle, right),) = canvas(1, 3, width=2.6 * figures.COLUMN_WIDTH, height=2.5)
    inertial, points = points_of(rows, "stress_ratio", RATE)
    of_pressure = campaign.sweep("rheology")
    draw_points(left, inertial, points, **{**look(1, "φ = 0.825"), "linestyle": "none"})
    friction.draw_law(left, inertial, law_of(rows, RATE), "fit", color=BLACK)
    line = friction.reach(inertial)
    left.plot(line, friction_law(line, **PRINTED), "--", color=GREY, linewidth=0.8, label="drum paper, φ = 0.825")
    draw_points(middle, inertial, stiffness_over_pressure(rows, RATE), **look(1, "φ = 0.825"))
    if len(of_pressure):
        slow, ratio = points_of(of_pressure, "stress_ratio")
        draw_points(left, slow, ratio, **{**look(0, "constant pressure"), "linestyle": "none"})
        draw_points(
            middle, slow, stiffness_over_pressure(of_pressure, "inertial_number"), **look(0, "constant pressure")
        )
    left.set(xscale="log", xlabel="inertial number I", ylabel="μ = τ/p", ylim=(0, None))
    middle.set(xscale="log", yscale="log", xlabel="inertial number I", ylabel="$k_n/p$")
    draw_soft(right, campaign)
    left.legend()
    middle.legend()
    return figure


def draw_soft(axes, campaign):
    """mu against phi at one I, from stiff to soft grains."""
    for k, (sweep, words) in enumerate((("stiffness", "k_n/P ≥ 1,571"), ("soft", "softer"))):
        chosen = campaign.sweep(sweep)
        if len(chosen):
            _, phi = curve(chosen, "pressure", "phi")
            _, points = curve(chosen, "pressure", "stress_ratio")
            draw_points(axes, [f.value for f in phi], points, **look(k, words))
    axes.axvline(0.825, color=GREY, linewidth=0.6)
    axes.set(xlabel="φ at I = 0.1 and constant pressure", ylabel="μ = τ/p")
    axes.legend()
