"""Report of a drum campaign: Figs. 2 to 6, 8 and 9 of Oba, Otsuki (2025); Fig. 7, the rheology, is the shear study's."""

from ..campaign.planned import PlannedFigure, Report
from . import claims, constants, levers, plots

TITLE = "Drum: the layer that flows down a turning drum"
SWEEPS = {
    "profiles": "a few drum_diameter and angular_velocity, model=both for the comparison",
    "thickness": "several drum_diameter and froude from 1e-4 to 1e-2",
    "collapse": "several drum_diameter at one froude or two",
    "constants": constants.SWEEP,
    "levers": levers.SWEEP,
}


def no_claims(_campaign, _rows):
    """A figure that is there to be looked at."""
    return []


FIGURES = (
    PlannedFigure(
        "fig2",
        "profiles",
        "Fig. 2: velocities in the drum",
        "Mean velocities, with the free surface (red) and the line that gives its angle (black).",
        no_claims,
        plots.velocity_maps,
    ),
    PlannedFigure(
        "fig3",
        "profiles",
        "Fig. 3: velocity across the layer",
        "Velocity u down the slope against depth z below the axis on the line normal to the surface: open symbols grains, closed"
        " ones continuum, lines −Ωz. Paper: both models agree, and deep down the bed turns with the drum.",
        claims.profile_claims,
        plots.profiles,
    ),
    PlannedFigure(
        "fig5",
        "collapse",
        "Fig. 5: the same Froude number, other drums",
        "u/(ΩD) against z/D. Paper: one curve for all D at equal Fr.",
        claims.collapse_claims,
        plots.collapse,
    ),
    PlannedFigure(
        "fig6",
        "thickness",
        "Figs. 4 and 6: thickness of the layer",
        "Depth h at which u = 0, against Ω and over D against Fr with straight lines through all points (dashed: grains),"
        " and the angle of the surface. Paper: h/D = H0 + H1 Fr, printed H0 = 1.1, which lies outside of the drum and is read as"
        " 0.11, and H1 = 1.2.",
        claims.thickness_claims,
        plots.thickness,
    ),
    PlannedFigure(
        "fig8",
        "thickness",
        "Fig. 8: solid fraction",
        "Solid fraction against depth, at each drum's middle speed. Paper: 0.825 in the static part (line), less in the layer.",
        claims.fraction_claims,
        plots.fractions,
    ),
    PlannedFigure(
        "fig9",
        "thickness",
        "Fig. 9: place of the surface",
        "z of the free surface on the line through the axis, over D. Paper: close to 0 at all Fr.",
        claims.surface_claims,
        plots.surfaces,
    ),
    constants.FIGURE,
    levers.FIGURE,
)

REPORT = Report("drum", TITLE, SWEEPS, FIGURES)
