"""Report of a Magnus campaign: Figs. 2, 3, 5, 6, 7 and 8 of Kumar, Dhiman, Reddy, Phys. Rev. E 99, 012902 (2019)."""

from ..campaign.planned import PlannedFigure, Report
from . import plots
from .claims import angle_claims, drag_claims, friction_claims, lift_claims, speed_claims
from .wake import wake_claims

TITLE = "Magnus effect: drag and lift on a spinning disk"
SWEEPS = {
    "speed": "several phi and v0, spin_ratio 0",
    "spin": "several phi and spin_ratio, 0 among them, perhaps several v0",
    "angles": "one phi, several spin_ratio with 0 and 1 among them, three seeds or more",
    "fields": "one phi, spin_ratio 0, 1, 10, fields=1, three seeds or more",
    "friction": "several phi and mu, one large spin_ratio",
}

FIGURES = (
    PlannedFigure(
        "fig2",
        "speed",
        "Fig. 2: drag and contacts against speed",
        "Mean drag and mean number of contacts of an intruder without spin against its speed. Paper: D ∝ V0², N linear when"
        " dilute.",
        speed_claims,
        plots.against_speed,
    ),
    PlannedFigure(
        "fig3",
        "spin",
        "Fig. 3: lift over drag against spin",
        "Lift over drag against the spin ratio Ω = ωR/V0; lift counts along −ω×V. Paper: zero at Ω = 0, steepest near 1,"
        " then flat.",
        lift_claims,
        plots.lift_against_spin,
    ),
    PlannedFigure(
        "fig5",
        "spin",
        "Fig. 5: drag and contacts against spin",
        "Drag and contacts over their values without spin. Paper: drag constant when dilute, rising when dense; fewer"
        " contacts at large Ω.",
        drag_claims,
        plots.drag_against_spin,
    ),
    PlannedFigure(
        "fig6",
        "angles",
        "Fig. 6: forces and contacts by angle",
        "Normal force, tangential force over its limit, and contacts by angle from V, in 24 bins; θ counts"
        " counter-clockwise for ω > 0 and F_T > 0 opposes the spin. Paper: contacts in front only, all of them slipping at"
        " large Ω.",
        angle_claims,
        plots.forces_by_angle,
    ),
    PlannedFigure(
        "fig7",
        "fields",
        "Fig. 7: fields around the intruder",
        "Velocity relative to the intruder with streamlines, area fraction, granular temperature; V along +x, ω > 0. Paper:"
        " the wake has an empty core, widens and bends with spin; grains are hottest on the advancing side at Ω = 10, on"
        " the retreating side at Ω = 1.",
        wake_claims,
        plots.around_intruder,
    ),
    PlannedFigure(
        "fig8",
        "friction",
        "Fig. 8: lift over drag against friction",
        "Saturated lift over drag against friction, with the model: Eq. 9 (dilute) and Eq. 15 with the measured"
        " κ = ΣF_N cos θ/D∞.",
        friction_claims,
        plots.lift_against_friction,
    ),
)

REPORT = Report("magnus", TITLE, SWEEPS, FIGURES)
