"""The figures of a drum campaign, numbered as in the paper: open symbols are grains, closed ones the continuum."""

import numpy as np
from matplotlib.patches import Circle

from .. import figures
from ..campaign.plots import COLOURS, MARKERS, canvas, draw_points, from_zero, share_y
from ..figures import BLACK, GREY
from .claims import NAMES, PAPERS_FRACTION, fitted, modelled
from .figure import draw_surface, frame_drum, in_squares
from .flow import surface_of
from .runs import MODELS, by_diameter, by_speed, curve_of, drum, equal_froude, field_of, mean_profile, of_model


def look(k, model, label):
    """Return colour, marker and label of the k-th series: open for grains, closed for the continuum."""
    colour = COLOURS[k % 6]
    face = "white" if model == "dem" else colour
    return dict(color=colour, marker=MARKERS[k % 6], markerfacecolor=face, markersize=3, linewidth=0, label=label)


def label_of(model, text):
    """Return the label of a series: the continuum's has its name, so that each legend entry stands once."""
    return text if model == "dem" else f"{text}, continuum"


def velocity_maps(campaign, rows):
    """Fig. 2: velocities of grains and continuum in the smallest drum at its middle speed."""
    diameter, group = next(by_diameter(rows))
    speeds = sorted(group["angular_velocity"].unique())
    same = group[group["angular_velocity"] == speeds[len(speeds) // 2]]
    shown = {model: field_of(campaign, same, model) for model in MODELS}
    shown = {model: field.within(diameter) for model, field in shown.items() if field}
    count = max(1, len(shown))
    figure, axes = canvas(1, count, width=count * figures.COLUMN_WIDTH, height=3.1)
    figure.get_layout_engine().set(h_pad=0.12)  # room for the titles above panels of fixed aspect
    for k, (model, field) in enumerate(shown.items()):
        panel, radius = axes[0, k], diameter / 2
        panel.add_patch(Circle((0, 0), radius, facecolor="none", edgecolor=BLACK, linewidth=0.8))
        edge = max(4.8, radius / 16)
        x, y, v_x, v_y = in_squares(field, edge)
        scale = 0.25 * same["angular_velocity"].iloc[0] * diameter / edge
        panel.quiver(x, y, v_x, v_y, angles="xy", scale_units="xy", scale=scale, color=COLOURS[0], width=0.003)
        draw_surface(panel, surface_of(field, diameter), field, radius, COLOURS[1])
        frame_drum(panel, radius)
        panel.set_title(f"{NAMES[model]}, D = {diameter:g} d, Fr = {float(same['froude'].iloc[0]):.3g}")
    return figure


def profiles(campaign, rows):
    """Fig. 3: u(z), a panel for each D, a colour for each speed, with rigid rotation."""
    drums = list(by_diameter(rows))
    figure, axes = canvas(1, len(drums), width=2 * figures.COLUMN_WIDTH, height=2.6)
    for panel, (diameter, group) in zip(axes[0], drums):
        for k, (_, omega, same) in enumerate(by_speed(group)):
            for model in MODELS:
                found = mean_profile(campaign, same, model)
                if found:
                    kept = found.z < diameter / 2
                    style = look(k, model, label_of(model, f"Ω = {omega:.3g}"))
                    panel.errorbar(found.z[kept], found.u[kept], np.nan_to_num(found.u_err[kept]), **style)
            panel.plot([0, diameter / 2], [0, -omega * diameter / 2], color=COLOURS[k % 6], linewidth=0.7)
        panel.axhline(0, color=GREY, linewidth=0.6)
        panel.set(xlabel="z [d]", title=f"D = {diameter:g} d", xlim=(-0.05 * diameter, diameter / 2))
        panel.legend(fontsize=6)
    axes[0, 0].set_ylabel("u [√(g d)]")
    return figure


def collapse(campaign, rows):
    """Fig. 5: u/(ΩD) against z/D, a panel for each Fr, a colour for each D."""
    groups = list(equal_froude(rows))
    figure, axes = canvas(1, max(1, len(groups)), width=2 * figures.COLUMN_WIDTH, height=2.6)
    for panel, (same, group) in zip(axes[0], groups):
        for k, diameter in enumerate(sorted(group["drum_diameter"].unique())):
            for model in MODELS:
                found = mean_profile(campaign, drum(group, diameter), model)
                if found:
                    z, u, error = found.scaled
                    style = look(k, model, label_of(model, f"D = {diameter:g} d"))
                    panel.errorbar(z, u, np.nan_to_num(error), **style)
        panel.plot([0, 0.5], [0, -0.5], color=BLACK, linewidth=0.8)
        panel.set(xlabel="z/D", title=same, xlim=(-0.05, 0.5))
        panel.legend()
    share_y(axes[0])
    axes[0, 0].set_ylabel("u/(ΩD)")
    return figure


def thickness(_campaign, rows):
    """Figs. 4 and 6: h against Ω, h/D against Fr with the fit; and the angle of the surface, which the paper does not give."""
    figure, ((left, middle, right),) = canvas(1, 3, width=2 * figures.COLUMN_WIDTH, height=2.5)
    draw_by_diameter(middle, rows, "froude", "thickness_over_diameter")
    draw_by_diameter(left, rows, "angular_velocity", "thickness_over_diameter", times_diameter=True)
    draw_by_diameter(right, rows, "froude", "surface_angle_deg")
    froude = np.linspace(0, float(rows["froude"].max()), 2) if len(rows) else np.zeros(2)
    for (model, chosen, _), line in zip(modelled(rows, "thickness_over_diameter"), ("--", "-")):
        slope, intercept = fitted(chosen, model)
        middle.plot(froude, intercept.value + slope.value * froude, line, color=BLACK, linewidth=0.8)
    left.set(xlabel="Ω [√(g/d)]", ylabel="h [d]")
    middle.set(xlabel="Fr", ylabel="h/D")
    right.set(xlabel="Fr", ylabel="angle of the surface [degrees]")
    for panel in (left, middle, right):
        panel.locator_params(axis="x", nbins=4)
        from_zero(panel)
    middle.legend(fontsize=6)
    return figure


def draw_by_diameter(axes, rows, key, name, times_diameter=False):
    """Draw a quantity against `key`, a colour for each D, open for grains and closed for the continuum."""
    for k, (diameter, group) in enumerate(by_diameter(rows)):
        for model, _, _ in modelled(group, name):
            x, points = curve_of(group, model, key, name)
            if times_diameter:
                points = [type(m)(m.value * diameter, m.error * diameter) for m in points]
            draw_points(axes, x, points, **look(k, model, label_of(model, f"D = {diameter:g} d")))


def fractions(campaign, rows):
    """Fig. 8: solid fraction against z/D, for each D its middle speed."""
    figure, ((axes,),) = canvas(1, 1, width=1.6 * figures.COLUMN_WIDTH, height=2.6)
    for k, (diameter, group) in enumerate(by_diameter(of_model(rows, "dem", "packing_fraction")[0])):
        speeds = sorted(group["angular_velocity"].unique())
        found = mean_profile(campaign, group[group["angular_velocity"] == speeds[len(speeds) // 2]], "dem")
        if found:
            kept = found.z < found.diameter / 2
            axes.plot(found.z[kept] / diameter, found.fraction[kept], **look(k, "dem", f"D = {diameter:g} d"))
    axes.axhline(PAPERS_FRACTION, color=BLACK, linewidth=0.8)
    axes.set(xlabel="z/D", ylabel="solid fraction φ", ylim=(0, 1), xlim=(-0.05, 0.5))
    axes.legend()
    return figure


def surfaces(_campaign, rows):
    """Fig. 9: z of the surface over D against Fr."""
    figure, ((axes,),) = canvas(1, 1, width=1.6 * figures.COLUMN_WIDTH, height=2.3)
    draw_by_diameter(axes, rows, "froude", "surface_over_diameter")
    axes.axhline(0, color=GREY, linewidth=0.6)
    axes.set(xlabel="Fr", ylabel="z$_{surface}$/D", ylim=(-0.1, 0.1))
    axes.legend()
    return figure
