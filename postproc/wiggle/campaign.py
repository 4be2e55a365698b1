"""Report of a wiggle campaign: Figs. 2, 5, 6, 8, 9 to 11 and 14 and Table 1 of Tripura et al., drives and scenes compared."""

from ..campaign.planned import PlannedFigure, Report
from . import claims, period_claims, plots

TITLE = "Wiggle: bodies shaken sideways that rise or sink"
SWEEPS = {
    "periods": "several shapes, amplitudes up to 5 and periods with 1 and its neighbours, two seeds or more",
    "amplitudes": "a few shapes, a period that rises, amplitudes from 0.5 to 5",
    "phases": "one amplitude, a few shapes and periods",
    "friction": "a few shapes and periods, several mu",
    "drive": "both values of drive, a few periods",
    "fields": "fields=1, one period, disk, tall and triangle",
    "mass": "a few shapes and periods, several intruder_mass",
    "scene": "scenes by width, height, depth, lid, lid_pressure and dt_factor, the largest of them the paper's",
}


def no_claims(_campaign, _rows):
    """A figure that is there to be looked at."""
    return []


FIGURES = (
    PlannedFigure(
        "scene",
        "scene",
        "The scene: bed, lid and time step",
        "Rise rate in each scene beside the paper's own, the first (grey: one standard error). A lid weighs what the bed"
        " that is left out weighs.",
        claims.scene_claims,
        plots.of_scenes,
    ),
    PlannedFigure(
        "fig2",
        "phases",
        "Fig. 2: height against time",
        "Height over the start; one repeat each.",
        no_claims,
        plots.heights,
    ),
    PlannedFigure(
        "fig5",
        "periods",
        "Fig. 5: rise rate against period",
        "Rise rate against period for each shape and amplitude, with the cavity model (dashed, Eq. 3.17; dotted, T_rise)."
        " Paper: nothing moves at A ≤ 1, sinking is fastest at T = 1, V_y has a maximum in T. The model leaves the panels.",
        period_claims.period_claims,
        plots.against_period,
    ),
    PlannedFigure(
        "table1",
        "periods",
        "Table 1: the first period that rises",
        "At A = 5 d, where a line from the last period that sinks to the next crosses zero; a triangle is a bound: it never rose"
        " up to there (up), or rose from there on (down).",
        period_claims.table_claims,
        plots.first_periods,
    ),
    PlannedFigure(
        "fig14",
        "periods",
        "Fig. 14: rise rate over period and amplitude",
        "Red rises, blue sinks. Paper: OS1 rises fastest, then OS3, OS2, OS4; OS5 sinks or barely moves.",
        period_claims.order_and_triangle_claims,
        plots.colour_map,
    ),
    PlannedFigure(
        "amplitude",
        "amplitudes",
        "The smallest amplitude that moves a body",
        "Rise rate against amplitude; dotted, A_min = d/2 of the cavity model. Taken where V_y reaches a tenth of its largest.",
        period_claims.amplitude_claims,
        plots.against_amplitude,
    ),
    PlannedFigure(
        "fig6",
        "friction",
        "Fig. 6: rise rate against friction",
        "Rise rate against the friction coefficient. Paper: it grows with friction, up to the 0.5 that it goes to.",
        claims.friction_claims,
        plots.against_friction,
    ),
    PlannedFigure(
        "fig8",
        "phases",
        "Fig. 8: rise rate by phase",
        "Rise rate in the twentieth parts of a cycle; dotted where the body turns. Paper: V_y grows as it moves out and falls"
        " as it moves back, so that it is largest where it turns.",
        claims.phase_claims,
        plots.against_phase,
    ),
    PlannedFigure(
        "fig9",
        "fields",
        "Figs. 9 to 11: fields around the body",
        "Area fraction, speed of the mean velocity and pressure of the contacts (Eq. 3.4) by phase, by Gaussian"
        " coarse-graining (w = 1 d, cut at 3 w). Paper: a wake behind,"
        " the pressure in front.",
        claims.field_claims,
        plots.around_body,
    ),
    PlannedFigure(
        "mass",
        "mass",
        "The mass of the body",
        "The paper gives all shapes one mass and does not say which; read as that of a disk of 7 d and the grains' density.",
        claims.mass_claims,
        plots.against_mass,
    ),
    PlannedFigure(
        "drive",
        "drive",
        "Two readings of the drive",
        "The text gives the velocity as A sin(2πt/T) and uses A as the amplitude of the displacement.",
        period_claims.drive_claims,
        plots.of_drives,
    ),
)

REPORT = Report("wiggle", TITLE, SWEEPS, FIGURES, pooled=("rise_rate",))
