"""Report of a Magnus campaign: Figs. 2, 3, 5, 6, 7 and 8 of Kumar, Dhiman, Reddy, Phys. Rev. E 99, 012902 (2019)."""

import numpy as np

from . import figures, magnus_plots
from .magnus_claims import angle_claims, drag_claims, friction_claims, lift_claims, speed_claims
from .magnus_wake import wake_claims
from .results import Section

TITLE = "Magnus effect: drag and lift on a spinning disk"
SWEEPS = {
    "speed": "several phi and v0, spin_ratio 0",
    "spin": "several phi and spin_ratio, 0 among them, perhaps several v0",
    "angles": "one phi, several spin_ratio with 0 and 1 among them, three seeds or more",
    "fields": "one phi, spin_ratio 0, 1, 10, fields=1, three seeds or more",
    "friction": "several phi and mu, one large spin_ratio",
}
RATES = ((0.352, 0.818), (450e6, 180e6))  # area fraction, particle-steps per second of one core (README)
TIME_STEP, DIAMETER = 2e-6, 0.02  # of the study [s], [m]


def report(campaign):
    """Draw the figures that the campaign's runs allow, into its folder `figures`; return their `Section`s."""
    return [section for make in FIGURES for section in make(campaign)]


def expected_core_seconds(parameters):
    """Return what a run costs one core [s], packing aside, from its grains, its steps and the rates above.

    Rates between are interpolated and stay the same beyond, and the walls of frozen disks are not counted.
    """
    phi, area = parameters["phi"], parameters["width"] * parameters["height"]
    grains = phi * area / (np.pi / 4)
    time = (parameters["travel"] + parameters.get("settle_travel", 0.0)) * DIAMETER / parameters["v0"]
    steps = time / (TIME_STEP * parameters["dt_factor"])
    return float(grains * steps / np.interp(phi, *RATES))


def section(campaign, sweep, title, name, caption, claims, draw):
    """Return a list of one `Section` with its figure drawn; empty if the sweep has no runs yet."""
    rows = campaign.sweep(sweep)
    if rows.empty:
        return []
    tested = tuple(claims(rows))
    with figures.plt.rc_context(figures.STYLE):
        figures.save_as(draw(campaign, rows, tested), campaign.folder / "figures", f"{campaign.plan['name']}-{name}")
    return [Section(title, name, caption, tested)]


def speeds(campaign):
    """Fig. 2."""
    caption = "Mean drag and mean number of contacts of an intruder without spin against its speed. Paper: D ∝ V0², N linear when dilute."
    return section(
        campaign, "speed", "Fig. 2: drag and contacts against speed", "fig2", caption, speed_claims, magnus_plots.against_speed
    )


def lifts(campaign):
    """Fig. 3."""
    caption = "Lift over drag against the spin ratio Ω = ωR/V0; lift counts along −ω×V. Paper: zero at Ω = 0, steepest near 1, then flat."
    return section(
        campaign, "spin", "Fig. 3: lift over drag against spin", "fig3", caption, lift_claims, magnus_plots.lift_against_spin
    )


def drags(campaign):
    """Fig. 5."""
    caption = "Drag and contacts over their values without spin. Paper: drag constant when dilute, rising when dense; fewer contacts at large Ω."
    return section(
        campaign, "spin", "Fig. 5: drag and contacts against spin", "fig5", caption, drag_claims, magnus_plots.drag_against_spin
    )


def angles(campaign):
    """Fig. 6."""
    caption = (
        "Normal force, tangential force over its limit, and contacts by angle from V, in 24 bins; θ counts counter-clockwise for ω > 0 and "
        "F_T > 0 opposes the spin. Paper: contacts in front only, all of them slipping at large Ω."
    )
    return section(
        campaign,
        "angles",
        "Fig. 6: forces and contacts by angle",
        "fig6",
        caption,
        lambda rows: angle_claims(campaign, rows),
        magnus_plots.by_angle,
    )


def flows(campaign):
    """Fig. 7."""
    caption = (
        "Velocity relative to the intruder with streamlines, area fraction, granular temperature; V along +x, ω > 0. Paper: the wake has an "
        "empty core, widens and bends with spin; grains are hottest on the advancing side at Ω = 10, on the retreating side at Ω = 1."
    )
    return section(
        campaign,
        "fields",
        "Fig. 7: fields around the intruder",
        "fig7",
        caption,
        lambda rows: wake_claims(campaign, rows),
        magnus_plots.around_intruder,
    )


def frictions(campaign):
    """Fig. 8."""
    caption = "Saturated lift over drag against friction, with the model: Eq. 9 (dilute) and Eq. 15 with the measured κ = ΣF_N cos θ/D∞."
    return section(
        campaign,
        "friction",
        "Fig. 8: lift over drag against friction",
        "fig8",
        caption,
        friction_claims,
        magnus_plots.lift_against_friction,
    )


FIGURES = (speeds, lifts, drags, angles, flows, frictions)
