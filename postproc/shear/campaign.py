"""Report of a shear campaign: mu(I) and phi(I) beside Oba, Otsuki 2025 (appendix B) and da Cruz et al. (2005)."""

import numpy as np

from .. import figures
from ..campaign.planned import PlannedFigure, Report
from ..campaign.plots import canvas, draw_points, look
from ..campaign.runs import at, curve
from ..campaign.verdicts import Agrees, below
from ..figures import BLACK
from . import da_cruz, friction, held_area
from .points import DISK, claim, up_to
from .rheology import LAST_STRAIGHT, straight_line


def fraction_claims(_campaign, rows):
    """phi falls with I."""
    slow = up_to(rows, LAST_STRAIGHT)
    inertial, phi = curve(slow, "inertial_number", "phi")
    _, slope = straight_line(inertial, phi)
    text = f"φ falls with I; slope dφ/dI of a straight line up to I = {LAST_STRAIGHT:g}"
    return [claim(slow, text, "the dilatancy law of dense flows", "< 0", slope, below(0))]


def draw_fraction(campaign, rows):
    """phi(I) and contacts of a grain."""
    figure, ((left, right),) = canvas(1, 2, width=2 * figures.COLUMN_WIDTH, height=2.4)
    inertial, phi = curve(rows, "inertial_number", "phi")
    slow_i, slow_phi = curve(up_to(rows, LAST_STRAIGHT), "inertial_number", "phi")
    first, slope = straight_line(slow_i, slow_phi)
    draw_points(left, inertial, phi, **{**look(0, "shear runs"), "linestyle": "none"})
    line = np.geomspace(inertial.min(), LAST_STRAIGHT, 100)
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


def draw_stiffness(campaign, rows):
    """mu and phi against k_n/P."""
    figure, ((left, right),) = canvas(1, 2, width=2 * figures.COLUMN_WIDTH, height=2.2)
    for panel, name, label in ((left, "stress_ratio", "μ = τ/p"), (right, "phi", "area fraction φ")):
        pressure, points = curve(rows, "pressure", name)
        stiffness = float(rows["stiffness"].iloc[0]) * DISK
        draw_points(panel, stiffness / pressure, points, **look(0, ""))
        panel.set(xscale="log", xlabel="$k_n/P$", ylabel=label)
    return figure


REPORT = Report(
    "shear",
    "Homogeneous shear: the friction law μ(I) and the area fraction",
    {
        "rheology": "eight values of inertial_number or more, from 1e-3 to 0.5, two seeds or more",
        "stiffness": "one inertial_number, two pressures or more, two seeds or more",
        "constant": "area_fraction=0.825, seven values of shear_rate, two seeds or more",
        "soft": "one inertial_number, pressures at which phi passes 0.825, two seeds or more",
        "da_cruz": "friction 0.4, restitution 0.1, k_n/P = 1e4, four values of inertial_number from 0.01 to 0.2",
    },
    (
        PlannedFigure(
            "mu",
            "rheology",
            "μ(I)",
            "Shear stress over pressure against the inertial number, at constant pressure. Lines: weighted least squares of"
            " μ_s + (μ_2 − μ_s)/(I_0/I + 1), up to I = 0.2 and over all points; dashes: Oba, Otsuki 2025, who hold φ = 0.825."
            " Beyond I = 0.2 grains collide in pairs: φ falls fast, μ stops to grow, and no constants fit all points."
            " The constants that count, in summary.json, are those up to 0.2; on an incline they give the velocity of grains"
            " (`tests/analytic/test_grains_on_an_incline.py`).",
            friction.claims,
            friction.draw,
        ),
        PlannedFigure(
            "held_area",
            "constant",
            "μ(I) at the drum paper's area fraction",
            "Why the drum paper's μ_2 is lower. Its runs hold φ = 0.825. Slow flow at constant pressure has φ = 0.82, and at"
            " I = 0.1 0.79: at 0.825 the disks are jammed, and what makes room for the flow is that they are pressed into each"
            " other. Then k_n/p is not large, and falls as I grows; stiffer grains do not change that, as p grows with k_n. Soft"
            " grains have less friction at equal I. At constant pressure the pressures are those of a drum and grains are stiff."
            " Right: at one I, with softer and softer grains at constant pressure, φ and μ come to what they are at constant φ,"
            " to 2 % of μ. The paper does not say in words which I it fits; our runs at φ = 0.825 reach I = 0.006 to 0.25.",
            held_area.claims,
            held_area.draw,
        ),
        PlannedFigure(
            "da_cruz",
            "da_cruz",
            "The dense flow of da Cruz et al.",
            "μ and φ against I = γ̇ √(m/P), m the mean mass of a disk, as there; disks of their friction, restitution and k_n/P,"
            " and the drum's. Dashes: μ = 0.25 + 1.1 I and φ = 0.81 − 0.3 I (da Cruz, Emam, Prochnow, Roux, Chevoir, PRE 72,"
            " 021309 (2005), friction 0.4; the four numbers as they are quoted, not checked against the print). Lines are fitted"
            ' left of the dots. Tolerances are our reading of "≈".',
            da_cruz.claims,
            da_cruz.draw,
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
