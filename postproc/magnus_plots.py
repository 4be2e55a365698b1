"""The figures of a Magnus campaign, numbered as in the paper; each has its claims and verdicts below the axes."""

import numpy as np

from . import fields, figures
from .figures import BLACK, BLUE, GREEN, GREY, ORANGE, SKY, VERMILLION, plt
from .magnus_claims import by_phi, over_no_spin
from .magnus_model import saturated_lift_to_drag
from .magnus_runs import at, by_angle, curve, fields_over_repeats, quantity
from .magnus_wake import INTRUDER_RADIUS
from .verdicts import Verdict

COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, SKY, BLACK)
MARKERS = "osD^vP"
LINE_INCHES = 0.135  # height of a line of the caption
VERDICT_COLOURS = {Verdict.REPRODUCED: GREEN, Verdict.NOT_REPRODUCED: VERMILLION, Verdict.NOT_DECIDED: "#666666"}


def canvas(rows, columns, claims, *, width, height):
    """Return (figure, axes (rows, columns)) with room for the claims below; `width`, `height` of the axes in inches."""
    room = LINE_INCHES * (len(claims) + 1.5)
    figure, axes = plt.subplots(rows, columns, figsize=(width, height + room), squeeze=False)
    figure.set_layout_engine("constrained", rect=(0, room / (height + room), 1, height / (height + room)))
    for line, claim in enumerate(claims):
        y = LINE_INCHES * (len(claims) - line) / (height + room)
        text, colour = f"{claim.text} (paper: {claim.expected}): {claim.number}", VERDICT_COLOURS[claim.verdict]
        figure.text(0.99, y, claim.verdict.value, fontsize=6, color=colour, weight="bold", ha="right")
        figure.text(0.01, y, text, fontsize=6)
    return figure, axes


def draw_points(axes, x, points, **options):
    """Draw `Measured` points with error bars of one standard error."""
    values, errors = np.array([(m.value, m.error) for m in points]).reshape(-1, 2).T
    errors = np.where(np.isfinite(errors), errors, 0)
    axes.errorbar(x, values, errors, **{"markersize": 3, "capsize": 1.5, "linewidth": 0.7, **options})


def draw_curves(axes, rows, by, key, name, label):
    """Draw a quantity against `key`, one line for each value of `by`."""
    for k, (value, group) in enumerate(rows.groupby(by, sort=True)):
        x, points = curve(group, key, name)
        draw_points(axes, x, points, color=COLOURS[k % 6], marker=MARKERS[k % 6], label=label.format(value))


def against_speed(campaign, rows, claims):
    """Fig. 2: D and N against V0, no spin."""
    figure, ((left, right),) = canvas(1, 2, claims, width=2 * figures.COLUMN_WIDTH, height=2.4)
    draw_curves(left, rows, "phi", "v0", "drag", "Φ = {:g}")
    draw_curves(right, rows, "phi", "v0", "contacts", "Φ = {:g}")
    v0 = np.array([rows["v0"].min(), rows["v0"].max()])
    scale = rows["drag"].max() / v0[1] ** 2
    left.plot(v0, 0.4 * scale * v0**2, "--", color=BLACK, linewidth=0.7, label="slope 2")
    left.set(xscale="log", yscale="log", xlabel="V0 [m/s]", ylabel="drag D [N]")
    plain_ticks(left, sorted(rows["v0"].unique()))
    right.set(xlabel="V0 [m/s]", ylabel="contacts N", xlim=(0, None), ylim=(0, None))
    left.legend()
    return figure


def spin_axis(axes, largest):
    """Draw the spin ratio, up to `largest`, on an axis that is linear up to 1 and logarithmic beyond."""
    axes.set_xscale("symlog", linthresh=1, linscale=0.7)
    axes.set_xlim(0, 1.15 * max(largest, 1.0))
    plain_ticks(axes, [0, 0.5, 1, 2, 5, 10, 20])
    axes.set_xlabel("spin ratio Ω")


def plain_ticks(axes, ticks):
    """Label these values on a logarithmic x axis, as they are, and no others."""
    low, high = axes.get_xlim()
    axes.set_xticks([t for t in ticks if low <= t <= high], [f"{t:g}" for t in ticks if low <= t <= high])
    axes.set_xticks([], minor=True)


def lift_against_spin(campaign, rows, claims):
    """Fig. 3: L/D against Ω, a panel for each Φ, a line for each V0."""
    groups = list(by_phi(rows))
    figure, axes = canvas(1, len(groups), claims, width=2 * figures.COLUMN_WIDTH, height=2.3)
    for panel, (phi, group) in zip(axes[0], groups):
        draw_curves(panel, group, "v0", "spin_ratio", "lift_to_drag", "V0 = {:g} m/s")
        panel.axhline(0, color=GREY, linewidth=0.6)
        panel.set_title(f"Φ = {phi:g}")
        spin_axis(panel, rows["spin_ratio"].max())
    share_y(axes[0])
    axes[0, 0].set_ylabel("L/D")
    axes[0, 0].legend()
    return figure


def share_y(axes):
    """Give all axes the range that holds them all."""
    low, high = zip(*(panel.get_ylim() for panel in axes))
    for panel in axes:
        panel.set_ylim(min(low), max(high))


def drag_against_spin(campaign, rows, claims):
    """Fig. 5: D_Ω/D_0 and N_Ω/N_0 against Ω."""
    groups = list(by_phi(rows))
    figure, axes = canvas(2, len(groups), claims, width=2 * figures.COLUMN_WIDTH, height=3.6)
    for column, (phi, group) in zip(axes.T, groups):
        for panel, name in zip(column, ("drag", "contacts")):
            for k, (v0, one_speed) in enumerate(group.groupby("v0", sort=True)):
                spins = sorted(one_speed["spin_ratio"].unique())
                points = [over_no_spin(one_speed, name, spin) for spin in spins]
                draw_points(panel, spins, points, color=COLOURS[k % 6], marker=MARKERS[k % 6], label=f"V0 = {v0:g} m/s")
            panel.axhline(1, color=GREY, linewidth=0.6)
            spin_axis(panel, rows["spin_ratio"].max())
        column[0].set_title(f"Φ = {phi:g}")
    axes[0, 0].set_ylabel("D$_Ω$/D$_0$")
    axes[1, 0].set_ylabel("N$_Ω$/N$_0$")
    axes[0, 0].legend()
    return figure


def forces_by_angle(campaign, rows, claims):
    """Fig. 6: F_N/D_0, F_T/(μ F_N) and N_θ/N by angle."""
    figure, ((left, middle, right),) = canvas(1, 3, claims, width=2 * figures.COLUMN_WIDTH, height=2.3)
    still = quantity(at(rows, spin_ratio=0), "drag").value
    for k, (spin, group) in enumerate(rows.groupby("spin_ratio", sort=True)):
        found = by_angle(campaign, group)
        theta, names = found[0].theta, ("normal", "tangential", "contacts")
        normal, tangential, contacts = (np.mean([getattr(one, name) for one in found], axis=0) for name in names)
        look = dict(color=COLOURS[k % 6], marker=MARKERS[k % 6], markersize=2.5, linewidth=0.7, label=f"Ω = {spin:g}")
        left.plot(theta / np.pi, normal / still, **look)
        busy = normal > 1e-3 * normal.max()
        middle.plot(theta[busy] / np.pi, tangential[busy] / (group["mu"].iloc[0] * normal[busy]), **look)
        right.plot(theta / np.pi, contacts / contacts.sum(), **look)
    for panel, label in ((left, "F$_N$/D$_0$"), (middle, "F$_T$/(μ F$_N$)"), (right, "N$_θ$/N")):
        panel.set(xlabel="θ/π", ylabel=label, xlim=(-1, 1))
        for side in (-0.5, 0.5):
            panel.axvline(side, color=GREY, linewidth=0.6)
    middle.set_ylim(-1.1, 1.1)
    right.legend()
    return figure


def around_intruder(campaign, rows, claims):
    """Fig. 7: speed with streamlines, area fraction and granular temperature around the body."""
    spins = sorted(rows["spin_ratio"].unique())
    figure, axes = canvas(3, len(spins), claims, width=2 * figures.COLUMN_WIDTH, height=4.4)
    for column, spin in zip(axes.T, spins):
        group = at(rows, spin_ratio=spin)
        found = fields_over_repeats(campaign, group)
        warm = float(np.nanquantile(found.map("temperature"), 0.99))
        fields.draw_map(column[0], found, "speed", vmin=0, vmax=1.5)
        fields.draw_streamlines(column[0], found, density=0.7)
        fields.draw_map(column[1], found, "area_fraction", vmin=0, vmax=0.9)  # grains pile up before it
        fields.draw_map(column[2], found, "temperature", vmin=0, vmax=warm)
        column[0].set_title(f"Ω = {spin:g}")
        for panel in column:
            panel.add_patch(
                plt.Circle((0, 0), INTRUDER_RADIUS, facecolor="white", edgecolor=BLACK, linewidth=0.8, zorder=3)
            )
    return figure


def lift_against_friction(campaign, rows, claims):
    """Fig. 8: L∞/D∞ against μ with Eq. 9 and, from the measured κ of each point, Eq. 15."""
    figure, ((axes,),) = canvas(1, 1, claims, width=1.6 * figures.COLUMN_WIDTH, height=2.8)
    largest = float(rows["mu"].max())
    axes.plot([0, largest], [0, largest], "--", color=BLACK, linewidth=0.8, label="Eq. 9: L$_∞$/D$_∞$ = μ")
    axes.plot([], [], color=GREY, linewidth=0.8, label="Eq. 15, measured κ")
    for k, (phi, group) in enumerate(by_phi(rows)):
        look = dict(color=COLOURS[k % 6], marker=MARKERS[k % 6], linestyle="", label=f"Φ = {phi:g}")
        draw_points(axes, *curve(group, "mu", "lift_to_drag"), **look)
        mu, kappa = curve(group[group["mu"] > 0], "mu", "kappa")
        model = [saturated_lift_to_drag(found.value, m) for m, found in zip(mu, kappa)]
        axes.plot(mu, model, color=COLOURS[k % 6], linewidth=0.8)
    axes.set(xlabel="friction coefficient μ", ylabel="L$_∞$/D$_∞$")
    axes.legend()
    return figure
