"""Report of a lift campaign: figures of Guillard, Forterre, Pouliquen, Phys. Fluids 26, 043301 (2014), and RFT on trial."""

from ..campaign.planned import PlannedFigure, Report
from . import plots, rft_report
from .claims import box_claims, depth_claims, diameter_claims, speed_claims, stress_claims

TITLE = "Lift: drag and lift on a cylinder in a bed of spheres"
SWEEPS = {
    "depth": "several depths, by depth and by lid_density, with bulk_gravity 0 and 1",
    "stress": "several lid_density, each with bulk_gravity 0 and 1",
    "fields": "a few runs with fields=1",
    "speed": "three speeds",
    "diameter": "several cylinder_diameter, deep",
    "box": "two sizes of the box at the same depth, for one or more lid_density",
    "plates": "shape= plates of tilts all around, at one depth",
    "growth": "two of the plates, of opposite tilts, at another depth",
    "halves": "shape= half-cylinders, at the depth of the plates",
    "cylinder": "the cylinder at several depths, with bulk_gravity=1",
}


def no_claims(_campaign, _rows):
    """A figure to look at."""
    return []


FIGURES = (
    PlannedFigure(
        "fig8",
        "depth",
        "Fig. 8: drag and lift against depth",
        "Drag over P_0 D L and lift over buoyancy against the effective depth. Paper: C_d ≈ 10, with and without weight in the"
        " bulk; lift saturates near 30 buoyancies, and is nothing without weight in the bulk.",
        depth_claims,
        plots.against_depth,
    ),
    PlannedFigure(
        "fig11",
        "stress",
        "Figs. 11 and 12: stress by angle",
        "Normal stress by angle from the direction of travel, and what weight in the bulk adds to it over ρgD.",
        stress_claims,
        plots.stress_by_angle,
    ),
    PlannedFigure(
        "fig9",
        "fields",
        "Figs. 9 and 13: fields around the cylinder",
        "Pressure over P_0, and speed over U_0 with streamlines in the cylinder's frame.",
        no_claims,
        plots.around_body,
    ),
    PlannedFigure(
        "speed",
        "speed",
        "U_0: drag against speed",
        "The paper does not give U_0; drag must not depend on it.",
        speed_claims,
        plots.against("speed", "$U_0$ [m/s]", "drag_coefficient", "$C_d$"),
    ),
    PlannedFigure(
        "fig5",
        "diameter",
        "Fig. 5: lift against diameter",
        "Lift over buoyancy against D/d. Paper: it falls towards 20.",
        diameter_claims,
        plots.against("cylinder_diameter", "$D/d$", "lift_over_buoyancy", "lift over buoyancy"),
    ),
    PlannedFigure(
        "box",
        "box",
        "The box: lift against its width",
        "The same cylinder under the same weight in a wider, broader and deeper box: what the smaller one changes.",
        box_claims,
        plots.against("width", "width [$d$]", "lift_over_buoyancy", "lift over buoyancy", by="lid_density"),
    ),
    PlannedFigure(
        "rft",
        "plates",
        "Resistive-force theory on trial",
        "Stress on plates by tilt; drag and lift on half-cylinders; drag and lift on the cylinder against depth. Lines are sums"
        " over the leading surface, with bands of one standard error from the plates'. Published form: all stress is"
        " proportional to depth. Split form: only what is odd (lift) or even (drag) in the tilt grows with depth.",
        rft_report.rft_claims,
        rft_report.draw,
    ),
)

REPORT = Report("lift", TITLE, SWEEPS, FIGURES, pooled=("lift_over_buoyancy", "drag_coefficient"))
