"""Report of a shear campaign: mu(I) and phi(I), and the constants of Oba, Otsuki 2025 (appendix B) beside our own."""

import json
from functools import partial

import numpy as np

from .. import figures
from ..campaign.claims import claim_on
from ..campaign.planned import PlannedFigure, Report
from ..campaign.plots import canvas, draw_points, look
from ..campaign.runs import at, curve
from ..campaign.verdicts import Agrees, below
from ..figures import BLACK, GREY
from .rheology import SLOWEST_GAS, fitted, friction_law, straight_line

PRINTED = dict(mu_s=0.246, mu_2=0.401, i_0=0.133)  # at phi = 0.825
ROUNDING = 0.0005  # of the printed numbers
SUMMARY = "summary.json"

claim = partial(
    claim_on,
    dict(
        inertial_number=("I", ""),
        grains=("", " disks"),
        friction=("μ_p", ""),
        restitution=("e", ""),
        pressure=("P", " ρgd"),
    ),
)


def friction_points(rows):
    """Return (I (n,), mu (n,) as `Measured`) of the runs, repeats joined: each I is the mean of what the repeats have."""
    key, ratio = curve(rows, "inertial_number", "stress_ratio")
    _, inertial = curve(rows, "inertial_number", "flow_inertial_number")
    return np.array([i.value for i in inertial]), ratio


def law_of(rows):
    """Return the `FrictionLaw` of a sweep."""
    return fitted(*friction_points(rows))


def friction_claims(_campaign, rows):
    """The three constants against the drum paper's."""
    law = law_of(rows)
    source = "Oba, Otsuki 2025, app. B"
    return [
        claim(rows, "μ_s of μ(I)", source, "0.246", law.mu_s, Agrees(PRINTED["mu_s"], ROUNDING, 0.02)),
        claim(rows, "μ_2 of μ(I)", source, "0.401", law.mu_2, Agrees(PRINTED["mu_2"], ROUNDING, 0.04)),
        claim(rows, "I_0 of μ(I)", source, "0.133", law.i_0, Agrees(PRINTED["i_0"], ROUNDING, 0.05)),
        held_pressure(rows),
    ]


def held_pressure(rows):
    """Runs that are too short, most of all at large I, have not come to their pressure: p/P that is furthest from 1."""
    inertial, pressure = curve(rows, "inertial_number", "mean_pressure")
    ratios = [p / float(rows["pressure"].iloc[0]) for p in pressure]
    worst = max(range(len(ratios)), key=lambda k: abs(ratios[k].value - 1))
    text = f"come to their pressure; p/P furthest from 1, at I = {inertial[worst]:g}"
    return claim(
        at(rows, inertial_number=inertial[worst]), text, "this study", "1", ratios[worst], Agrees(1, 0.02, 0.05)
    )


def draw_friction(campaign, rows, claims):
    """mu(I) with our fit and the drum paper's law; the constants go to the campaign's summary.json."""
    law = law_of(rows)
    (campaign.folder / SUMMARY).write_text(json.dumps(law.as_summary(), indent=1) + "\n")
    figure, ((axes,),) = canvas(1, 1, claims, width=1.4 * figures.COLUMN_WIDTH, height=2.6)
    inertial, points = friction_points(rows)
    draw_points(axes, inertial, points, **{**look(0, "shear runs"), "linestyle": "none"})
    line = np.geomspace(inertial.min() / 1.5, inertial.max() * 1.5, 200)
    words = f"fit: {law.mu_s.value:.3f}, {law.mu_2.value:.3f}, {law.i_0.value:.3f}, χ²/f = {law.chi_squared:.1f}"
    axes.plot(line, law(line), color=BLACK, linewidth=0.8, label=words)
    axes.plot(line, friction_law(line, **PRINTED), "--", color=GREY, linewidth=0.8, label="drum paper, φ = 0.825")
    axes.set(xscale="log", xlabel="inertial number I", ylabel="μ = τ/p", ylim=(0, None))
    axes.legend()
    return figure


def slow_part(rows):
    """Return the runs whose I is at most `SLOWEST_GAS`."""
    return rows[rows["inertial_number"] <= SLOWEST_GAS]


def fraction_claims(_campaign, rows):
    """phi falls with I."""
    slow = slow_part(rows)
    inertial, phi = curve(slow, "inertial_number", "phi")
    _, slope = straight_line(inertial, phi)
    text = f"φ falls with I; slope dφ/dI of a straight line up to I = {SLOWEST_GAS:g}"
    return [claim(slow, text, "the dilatancy law of dense flows", "< 0", slope, below(0))]


def draw_fraction(campaign, rows, claims):
    """phi(I) and contacts of a grain."""
    figure, ((left, right),) = canvas(1, 2, claims, width=2 * figures.COLUMN_WIDTH, height=2.4)
    inertial, phi = curve(rows, "inertial_number", "phi")
    slow_i, slow_phi = curve(slow_part(rows), "inertial_number", "phi")
    first, slope = straight_line(slow_i, slow_phi)
    draw_points(left, inertial, phi, **{**look(0, "shear runs"), "linestyle": "none"})
    line = np.geomspace(inertial.min(), SLOWEST_GAS, 100)
    left.plot(line, first.value + slope.value * line, color=BLACK, linewidth=0.8, label=f"{first} + ({slope}) I")
    left.set(xscale="log", xlabel="inertial number I", ylabel="area fraction φ")
    left.legend()
    _, contacts = curve(rows, "inertial_number", "coordination")
    draw_points(right, inertial, contacts, **{**look(1, "contacts of a grain"), "linestyle": "none"})
    right.set(xscale="log", xlabel="inertial number I", ylabel="contacts of a grain", ylim=(0, None))
    return figure


def stiffness_claims(_campaign, rows):
    """mu and phi do not depend on k_n/P: the difference of the softest and the hardest grains of the sweep."""
    soft, hard = at(rows, pressure=rows["pressure"].max()), at(rows, pressure=rows["pressure"].min())
    claims = []
    for name, symbol, resolution in (("stress_ratio", "μ", 0.02), ("phi", "φ", 0.006)):
        difference = curve(soft, "pressure", name)[1][0] - curve(hard, "pressure", name)[1][0]
        text = f"{symbol} at P = {rows['pressure'].max():g} less that at P = {rows['pressure'].min():g} ρgd, same I"
        claims.append(claim(rows, text, "grains count as stiff", "0", difference, Agrees(0, 0.0, resolution)))
    return claims


def draw_stiffness(campaign, rows, claims):
    """mu and phi against k_n/P."""
    figure, ((left, right),) = canvas(1, 2, claims, width=2 * figures.COLUMN_WIDTH, height=2.2)
    for panel, name, label in ((left, "stress_ratio", "μ = τ/p"), (right, "phi", "area fraction φ")):
        pressure, points = curve(rows, "pressure", name)
        stiffness = float(rows["stiffness"].iloc[0]) * np.pi / 4
        draw_points(panel, stiffness / pressure, points, **look(0, ""))
        panel.set(xscale="log", xlabel="k_n/P", ylabel=label)
    return figure


REPORT = Report(
    "shear",
    "Homogeneous shear: the friction law μ(I) and the area fraction",
    {
        "rheology": "eight values of inertial_number or more, from 1e-3 to 0.5, two seeds or more",
        "stiffness": "one inertial_number, two pressures or more, two seeds or more",
    },
    (
        PlannedFigure(
            "mu",
            "rheology",
            "μ(I)",
            "Shear stress over pressure against the inertial number, at constant pressure. Line: weighted least squares of"
            " μ_s + (μ_2 − μ_s)/(I_0/I + 1); dashes: Oba, Otsuki 2025, who hold φ = 0.825.",
            friction_claims,
            draw_friction,
        ),
        PlannedFigure(
            "phi",
            "rheology",
            "φ(I)",
            "Area fraction and contacts of a grain against the inertial number.",
            fraction_claims,
            draw_fraction,
        ),
        PlannedFigure(
            "stiffness",
            "stiffness",
            "Stiffness",
            "Friction and area fraction against k_n/P at one I.",
            stiffness_claims,
            draw_stiffness,
        ),
    ),
)
