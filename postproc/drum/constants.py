"""Whether the continuum meets the grains better with other constants of mu(I): u(z) of grains beside that of several sets."""

import numpy as np

from .. import figures
from ..campaign.planned import PlannedFigure
from ..campaign.plots import rows_of_panels, share_y
from ..campaign.verdicts import below
from ..figures import BLACK
from ..measured import Measured
from .claims import CONSISTENT, claim
from .plots import look
from .runs import by_speed, mean_profile, of_model, scaled_difference

KEYS = ["static_friction", "dynamic_friction", "inertial_scale"]
SWEEP = f"grains, and model=continuum with several {', '.join(KEYS)}, at one drum and some speeds"


def in_words(constants):
    """Return constants of mu(I) in words."""
    return "μ_s {:g}, μ_2 {:g}, I_0 {:g}".format(*constants)


def by_constants(campaign, rows):
    """Yield (D, Omega, the grains' `MeanProfile`, {constants: the continuum's, its rows}) of each drum and speed with both."""
    for diameter, omega, same in by_speed(rows):
        grains, fluid = of_model(same, "dem", "")[0], of_model(same, "continuum", "")[0]
        measured = mean_profile(campaign, grains, "dem") if len(grains) else None
        found = {
            key: (mean_profile(campaign, group, "continuum"), group) for key, group in fluid.groupby(KEYS, sort=True)
        }
        if measured and found:
            yield diameter, omega, measured, {key: pair for key, pair in found.items() if pair[0]}


def constants_claims(campaign, rows):
    """The norm of the difference of grains and continuum for each set of constants and speed."""
    claims = []
    for diameter, omega, grains, fluids in by_constants(campaign, rows):
        for constants, (fluid, group) in fluids.items():
            text = f"D {diameter:g}, Ω {omega:.3g}, {in_words(constants)}: grains and continuum have one u(z)"
            found = Measured(*scaled_difference(grains, fluid))
            claims.append(claim(group, text, "Fig. 3", "≈ 0", found, below(CONSISTENT)))
    return claims


def draw(campaign, rows):
    """u/(Omega D) against z/D, a panel for each speed: grains open, a colour for each set of constants."""
    groups = list(by_constants(campaign, rows))
    figure, axes = rows_of_panels(len(groups), width=2 * figures.COLUMN_WIDTH, height=2.4)
    for panel, (diameter, omega, grains, fluids) in zip(axes, groups):
        z, u, error = grains.scaled
        panel.errorbar(z, u, np.nan_to_num(error), **look(0, "dem", "grains"))
        for k, (constants, (fluid, _)) in enumerate(fluids.items(), start=1):
            z, u, error = fluid.scaled
            panel.errorbar(z, u, np.nan_to_num(error), **look(k, "continuum", in_words(constants)))
        panel.plot([0, 0.5], [0, -0.5], color=BLACK, linewidth=0.8)
        panel.set(xlabel="z/D", title=f"D = {diameter:g} d, Fr = {omega**2 * diameter / 2:.3g}", xlim=(-0.05, 0.5))
    if groups:
        axes[-1].legend(fontsize=5)
    share_y(axes)
    axes[0].set_ylabel("u/(ΩD)")
    return figure


FIGURE = PlannedFigure(
    "constants",
    "constants",
    "Constants of μ(I)",
    "u/(ΩD) against z/D: grains (open), and the continuum with the paper's constants of μ(I) and with those of our shear cell at"
    " constant pressure up to I = 0.2.",
    constants_claims,
    draw,
)
