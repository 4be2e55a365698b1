"""The figures of a Magnus campaign, numbered as in the paper."""

import numpy as np

from .. import fields, figures
from ..campaign.plots import COLOURS, canvas, draw_curves, draw_points, look, share_y
from ..campaign.runs import at, curve, quantity
from ..figures import BLACK, GREY
from .claims import by_phi, over_no_spin
from .model import saturated_lift_to_drag
from .runs import by_angle, fields_over_repeats


def against_speed(campaign, rows):
    """Fig. 2: D and N against V0, no spin."""
    figure, ((left, right),) = canvas(1, 2, width=2 * figures.COLUMN_WIDTH, height=2.4)
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


def lift_against_spin(campaign, rows):
    """Fig. 3: L/D against Ω, a panel for each Φ, a line for each V0."""
    groups = list(by_phi(rows))
    figure, axes = canvas(1, len(groups), width=2 * figures.COLUMN_WIDTH, height=2.3)
    for panel, (phi, group) in zip(axes[0], groups):
        draw_curves(panel, group, "v0", "spin_ratio", "lift_to_drag", "V0 = {:g} m/s")
        panel.axhline(0, color=GREY, linewidth=0.6)
        panel.set_title(f"Φ = {phi:g}")
        spin_axis(panel, rows["spin_ratio"].max())
    share_y(axes[0])
    axes[0, 0].set_ylabel("L/D")
    axes[0, 0].legend()
    return figure


def drag_against_spin(campaign, rows):
    """Fig. 5: D_Ω/D_0 and N_Ω/N_0 against Ω."""
    groups = list(by_phi(rows))
    figure, axes = canvas(2, len(groups), width=2 * figures.COLUMN_WIDTH, height=3.6)
    for column, (phi, group) in zip(axes.T, groups):
        for panel, name in zip(column, ("drag", "contacts")):
            for k, (v0, one_speed) in enumerate(group.groupby("v0", sort=True)):
                spins = sorted(one_speed["spin_ratio"].unique())
                points = [over_no_spin(one_speed, name, spin) for spin in spins]
                draw_points(panel, spins, points, **look(k, f"V0 = {v0:g} m/s"))
            panel.axhline(1, color=GREY, linewidth=0.6)
            spin_axis(panel, rows["spin_ratio"].max())
        column[0].set_title(f"Φ = {phi:g}")
    axes[0, 0].set_ylabel("D$_Ω$/D$_0$")
    axes[1, 0].set_ylabel("N$_Ω$/N$_0$")
    axes[0, 0].legend()
    return figure


def forces_by_angle(campaign, rows):
    """Fig. 6: F_N/D_0, F_T/(μ F_N) and N_θ/N by angle."""
    figure, ((left, middle, right),) = canvas(1, 3, width=2 * figures.COLUMN_WIDTH, height=2.3)
    still = quantity(at(rows, spin_ratio=0), "drag").value
    for k, (spin, group) in enumerate(rows.groupby("spin_ratio", sort=True)):
        found = by_angle(campaign, group)
        theta, names = found[0].theta, ("normal", "tangential", "contacts")
        normal, tangential, contacts = (np.mean([getattr(one, name) for one in found], axis=0) for name in names)
        style = dict(look(k, f"Ω = {spin:g}"), markersize=2.5, linewidth=0.7)
        left.plot(theta / np.pi, normal / still, **style)
        busy = normal > 1e-3 * normal.max()
        middle.plot(theta[busy] / np.pi, tangential[busy] / (group["mu"].iloc[0] * normal[busy]), **style)
        right.plot(theta / np.pi, contacts / contacts.sum(), **style)
    for panel, label in ((left, "F$_N$/D$_0$"), (middle, "F$_T$/(μ F$_N$)"), (right, "N$_θ$/N")):
        panel.set(xlabel="θ/π", ylabel=label, xlim=(-1, 1))
        for side in (-0.5, 0.5):
            panel.axvline(side, color=GREY, linewidth=0.6)
    middle.set_ylim(-1.1, 1.1)
    right.legend(loc="upper left", fontsize=6, handlelength=1.2)
    return figure


def around_intruder(campaign, rows):
    """Fig. 7: speed with streamlines, area fraction and granular temperature around the body."""
    spins = sorted(rows["spin_ratio"].unique())
    figure, axes = canvas(3, len(spins), width=2 * figures.COLUMN_WIDTH, height=4.4)
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
            figures.draw_disk(panel, (0, 0), group["intruder_diameter"].iloc[0] / 2, spin=spin)
    return figure


def lift_against_friction(campaign, rows):
    """Fig. 8: L∞/D∞ against μ with Eq. 9 and, from the measured κ of each point, Eq. 15."""
    figure, ((axes,),) = canvas(1, 1, width=1.6 * figures.COLUMN_WIDTH, height=2.8)
    largest = float(rows["mu"].max())
    axes.plot([0, largest], [0, largest], "--", color=BLACK, linewidth=0.8, label="Eq. 9: L$_∞$/D$_∞$ = μ")
    axes.plot([], [], color=GREY, linewidth=0.8, label="Eq. 15, measured κ")
    for k, (phi, group) in enumerate(by_phi(rows)):
        draw_points(axes, *curve(group, "mu", "lift_to_drag"), linestyle="", **look(k, f"Φ = {phi:g}"))
        mu, kappa = curve(group[group["mu"] > 0], "mu", "kappa")
        model = [saturated_lift_to_drag(found.value, m) for m, found in zip(mu, kappa)]
        axes.plot(mu, model, color=COLOURS[k % 6], linewidth=0.8)
    axes.set(xlabel="friction coefficient μ", ylabel="L$_∞$/D$_∞$")
    axes.legend()
    return figure
