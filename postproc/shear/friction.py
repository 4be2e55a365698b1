"""mu(I) at constant pressure: the constants of the dense flow beside those of Oba, Otsuki 2025 (appendix B)."""

import json

import numpy as np
from scipy.stats import chi2

from .. import figures
from ..campaign.plots import canvas, draw_points, look
from ..campaign.runs import at, curve
from ..campaign.verdicts import Agrees, below
from ..figures import BLACK, GREY, ORANGE
from ..measured import exactly
from .points import PRINTED, ROUNDING, claim, law_of, points_of, up_to
from .rheology import DENSEST_GAS, friction_law

SUMMARY = "summary.json"
SOURCE = "Oba, Otsuki 2025, app. B"
SIGNIFICANT = 0.95  # of chi^2: points that the law explains lie below


def claims(_campaign, rows):
    """The three constants of the dense flow against the drum paper's, where the law holds, whether pressures were reached."""
    dense = up_to(rows, DENSEST_GAS)
    law = law_of(dense)
    words = f"of μ(I) at constant pressure, I ≤ {DENSEST_GAS:g}"
    return [
        claim(dense, f"μ_s {words}", SOURCE, "0.246", law.mu_s, Agrees(PRINTED["mu_s"], ROUNDING, 0.02)),
        claim(dense, f"μ_2 {words}", SOURCE, "0.401", law.mu_2, Agrees(PRINTED["mu_2"], ROUNDING, 0.1)),
        claim(dense, f"I_0 {words}", SOURCE, "0.133", law.i_0, Agrees(PRINTED["i_0"], ROUNDING, 0.1)),
        explained(dense, law),
        explained(rows, law_of(rows)),
        held_pressure(rows),
    ]


def explained(rows, law):
    """The law explains the points of these runs: chi^2 over the degrees of freedom."""
    largest = rows["inertial_number"].max()
    freedom = max(1, rows["inertial_number"].nunique() - 3)
    text = f"one law fits all points up to I = {largest:g}; χ²/f, bound: 95 % quantile"
    rule = below(round(float(chi2.ppf(SIGNIFICANT, freedom)) / freedom, 2))
    return claim(rows, text, "Jop, Forterre, Pouliquen 2006", "≈ 1", exactly(law.chi_squared), rule)


def held_pressure(rows):
    """Runs that are too short, most of all at large I, have not come to their pressure: p/P that is furthest from 1."""
    inertial, pressure = curve(rows, "inertial_number", "mean_pressure")
    ratios = [p / float(rows["pressure"].iloc[0]) for p in pressure]
    worst = max(range(len(ratios)), key=lambda k: abs(ratios[k].value - 1))
    text = f"come to their pressure; p/P furthest from 1, at I = {inertial[worst]:g}"
    return claim(
        at(rows, inertial_number=inertial[worst]), text, "this study", "1", ratios[worst], Agrees(1, 0.02, 0.05)
    )


def draw(campaign, rows):
    """mu(I) with our fits and the drum paper's law; the constants of the dense flow go to the campaign's summary.json."""
    law, of_all = law_of(up_to(rows, DENSEST_GAS)), law_of(rows)
    (campaign.folder / SUMMARY).write_text(json.dumps(law.as_summary(), indent=1) + "\n")
    figure, ((axes,),) = canvas(1, 1, width=1.4 * figures.COLUMN_WIDTH, height=2.6)
    inertial, points = points_of(rows, "stress_ratio")
    draw_points(axes, inertial, points, **{**look(0, "shear runs"), "linestyle": "none"})
    draw_law(axes, inertial, law, f"fit up to {DENSEST_GAS:g}", color=BLACK)
    draw_law(axes, inertial, of_all, "fit of all", color=ORANGE)
    line = reach(inertial)
    axes.plot(line, friction_law(line, **PRINTED), "--", color=GREY, linewidth=0.8, label="drum paper, φ = 0.825")
    axes.set(xscale="log", xlabel="inertial number I", ylabel="μ = τ/p", ylim=(0, None))
    axes.legend()
    return figure


def reach(inertial):
    """Return values of I for a line through the points."""
    return np.geomspace(inertial.min() / 1.5, inertial.max() * 1.5, 200)


def draw_law(axes, inertial, law, words, **style):
    """Draw a `FrictionLaw` with its constants and chi^2 in the legend."""
    constants = f"μ$_s$ {law.mu_s}, μ$_2$ {law.mu_2},\nI$_0$ {law.i_0}, χ²/f = {law.chi_squared:.1f}"
    line = reach(inertial)
    axes.plot(line, law(line), linewidth=0.8, label=f"{words}:\n{constants}", **style)
