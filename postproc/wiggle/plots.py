"""The figures of a wiggle campaign, numbered as in the paper."""

import itertools
from functools import partial

import numpy as np
from matplotlib.colors import TwoSlopeNorm

from .. import figures
from ..campaign.plots import COLOURS, canvas, draw_points, look, rows_of_panels, share_y
from ..campaign.runs import curve, quantity
from ..figures import BLACK, GREY, VERMILLION
from ..measured import UNKNOWN, Limit
from . import runs
from .cavity_model import smallest_amplitude
from .claims import scenes_of
from .period_claims import OBSERVED, TABLE_1_AMPLITUDE
from .runs import RATE, by_shape, title

RATE_LABEL = r"$V_y$  [$\sqrt{gd}$]"
PERIOD_LABEL = r"$T$  [$\sqrt{d/g}$]"


def panels(groups, *, height=1.9, columns=3):
    """Return (figure, one axes per group, in rows of `columns`)."""
    return rows_of_panels(len(groups), width=2 * figures.COLUMN_WIDTH, height=height, columns=columns)


def lines_by_shape(rows, key, label, points_of, xlabel):
    """Return (figure, axes, groups): a panel for each shape, in it `points_of(its rows)` for each value of `key`."""
    groups = [(title(shape), group) for shape, group in by_shape(rows)]
    return *lines_in(groups, key, label, points_of, xlabel), groups


def lines_in(groups, key, label, points_of, xlabel, *, height=1.9):
    """Return (figure, axes): a panel for each of `groups`, (title, rows), in it `points_of(its rows)` for each `key`."""
    figure, axes = panels(groups, height=height)
    values = sorted(set().union(*(group[key] for _, group in groups)))  # one look for a value in all panels
    for panel, (name, group) in zip(axes, groups):
        for value, of_one in group.groupby(key, sort=True):
            draw_points(panel, *points_of(of_one), **look(values.index(value), label.format(value)))
        name_panel(panel, name, xlabel)
    return figure, axes


def against_period(campaign, rows):
    """Fig. 5: V_y against T, a panel for each shape, a line for each amplitude, with the cavity model."""
    figure, axes, groups = lines_by_shape(rows, "amplitude", "A = {:g} d", runs.rates, PERIOD_LABEL)
    for panel, (shape, group) in zip(axes, groups):  # last, in the range of the data, which it leaves
        draw_model(panel, runs.model_of(group), group["period"].max())
    place = next((spare for spare in figure.axes if not spare.axison), axes[0])
    place.legend(
        *axes[0].get_legend_handles_labels(), handlelength=1.2, loc="center" if place is not axes[0] else "best"
    )
    return figure


def draw_model(panel, model, longest):
    """Draw V_y of the cavity model, Eq. 3.17, and a line at its T_rise."""
    periods, (low, high) = np.linspace(0.05, longest, 400), panel.get_ylim()
    panel.plot(periods, model.rise_rate(periods), "--", color=BLACK, linewidth=0.7, label="cavity model")
    panel.axvline(model.first_rising_period, color=GREY, linewidth=0.5, linestyle=":")
    panel.set_ylim(low, high)


def first_periods(campaign, rows):
    """Table 1: the first rising period of each shape, measured, as the paper saw it (bars), and by the cavity model."""
    figure, ((axes,),) = canvas(1, 1, width=2 * figures.COLUMN_WIDTH, height=2.3)
    groups = list(by_shape(rows[rows["amplitude"] == TABLE_1_AMPLITUDE]))
    places = np.arange(len(groups))
    for place, (shape, _) in zip(places, groups):
        if shape in OBSERVED:
            axes.plot([place, place], OBSERVED[shape], color=GREY, linewidth=7, solid_capstyle="butt", zorder=1)
    model = [runs.model_of(group).first_rising_period for _, group in groups]
    axes.plot(places, model, "_", color=VERMILLION, markersize=16, label="cavity model, Eq. 3.14")
    found = [runs.first_rising_period(group) for _, group in groups]
    numbers = [(place, m) for place, m in zip(places, found) if not isinstance(m, Limit)]
    draw_points(axes, *zip(*numbers or [(0, UNKNOWN)]), fmt="o", color=BLACK, label="measured")
    for place, limit in ((place, m) for place, m in zip(places, found) if isinstance(m, Limit)):
        axes.plot(place, limit.value, "^" if limit.side == ">" else "v", color=BLACK, markersize=5, fillstyle="none")
    axes.plot([], [], color=GREY, linewidth=7, label="observed in the paper")
    axes.set_xticks(places, [title(shape).replace(", ", "\n") for shape, _ in groups])
    axes.set(ylabel=f"first rising {PERIOD_LABEL}", xlim=(-0.6, len(groups) - 0.4), ylim=(0, None))
    axes.legend(loc="lower right")
    return figure


def name_panel(panel, name, xlabel):
    """Set title, labels and a line at zero."""
    panel.axhline(0, color=GREY, linewidth=0.5, zorder=0)
    panel.set(title=name, xlabel=xlabel, ylabel=RATE_LABEL)


def colour_map(campaign, rows):
    """Fig. 14: V_y over (T, A), a panel for each shape, one scale of colours for all."""
    groups = list(by_shape(rows))
    figure, axes = panels(groups)
    largest = max(np.nanmax(np.abs(rows[RATE].astype(float))), 1e-12)
    for panel, (shape, group) in zip(axes, groups):
        table = group.assign(rate=group[RATE].astype(float)).pivot_table(
            index="amplitude", columns="period", values="rate"
        )
        norm = TwoSlopeNorm(0, -largest, largest)
        places = np.arange(table.shape[1]), np.arange(table.shape[0])
        image = panel.imshow(table.to_numpy(), cmap="RdBu_r", norm=norm, origin="lower", aspect="auto")
        panel.set_facecolor(GREY)  # not measured
        panel.set_xticks(places[0], [f"{t:g}" for t in table.columns])
        panel.set_yticks(places[1], [f"{a:g}" for a in table.index])
        panel.set(title=title(shape), xlabel=PERIOD_LABEL, ylabel="$A$  [$d$]")
    figure.colorbar(image, ax=list(axes), label=RATE_LABEL)
    return figure


def against(rows, key, xlabel):
    """Return (figure, axes): V_y against a key of the study, a panel for each shape, a line for each period."""
    figure, axes, _ = lines_by_shape(rows, "period", "T = {:g}", partial(curve, key=key, name=RATE), xlabel)
    axes[0].legend()
    return figure, axes


def against_amplitude(campaign, rows):
    """V_y against A, with the cavity model's A_min."""
    figure, axes = against(rows, "amplitude", "$A$  [$d$]")
    for panel in axes:
        panel.axvline(smallest_amplitude(), color=GREY, linewidth=0.5, linestyle=":")
    return figure


def against_mass(campaign, rows):
    """V_y against the body's mass."""
    return against(rows, "intruder_mass", r"mass of the body  [$\rho d^2$]")[0]


def against_friction(campaign, rows):
    """Fig. 6: V_y against mu, one range for all shapes."""
    figure, axes = against(rows, "mu", "friction coefficient μ")
    share_y(axes)
    return figure


def against_phase(campaign, rows):
    """Fig. 8: V_y by phase, a panel for each shape, a line for each period."""

    def points_of(of_one):
        phases, points = runs.phase_curve(campaign, of_one)
        return 20 * phases, points

    figure, axes, _ = lines_by_shape(rows, "period", "T = {:g}", points_of, "phase 10φ/π")
    for panel, turn in itertools.product(axes, (5, 15)):
        panel.axvline(turn, color=GREY, linewidth=0.5, linestyle=":")
    axes[0].legend()
    return figure


def heights(campaign, rows):
    """Fig. 2: y(t) by means over cycles, a panel for each shape, a line for each period; the first repeat."""
    groups = list(by_shape(rows))
    figure, axes = panels(groups)
    for panel, (shape, group) in zip(axes, groups):
        for k, (period, of_one) in enumerate(group.groupby("period", sort=True)):
            series = campaign.run(of_one["run"].iloc[0]).series
            panel.plot(series["t"], series["y"] - series["y"][0], color=COLOURS[k % 6], label=f"T = {period:g}")
        name_panel(panel, title(shape), r"$t$  [$\sqrt{d/g}$]")
        panel.set_ylabel("$y - y_0$  [$d$]")
    axes[0].legend()
    return figure


def of_drives(campaign, rows):
    """V_y against T for both readings of the drive, a panel for each shape and amplitude."""
    groups = [
        (f"{title(shape)}, A = {amplitude:g}", group)
        for shape, of_one in by_shape(rows)
        for amplitude, group in of_one.groupby("amplitude")
    ]
    figure, axes = lines_in(groups, "drive", "A is of the {}", runs.rates, PERIOD_LABEL, height=2.4)
    axes[0].legend()
    return figure


def of_scenes(campaign, rows):
    """V_y of each scene, a panel for each amplitude and period."""
    groups = list(rows.groupby(["amplitude", "period"], sort=True))
    columns, every = 2, scenes_of(rows)
    names = [name for name, _ in every]
    figure, axes = panels(groups, height=0.8 + 0.2 * len(every), columns=columns)
    for k, (panel, ((amplitude, period), group)) in enumerate(zip(axes, groups)):
        scenes = dict(scenes_of(group))
        found = [quantity(scenes[name], RATE) if name in scenes else UNKNOWN for name in names]
        first, places = found[0], -np.arange(len(names))
        values, errors = np.array([(m.value, m.error) for m in found]).T
        panel.errorbar(values, places, xerr=errors, fmt="o", markersize=3, color=BLACK)
        panel.axvspan(first.value - first.error, first.value + first.error, color=GREY, alpha=0.4, linewidth=0)
        panel.set_yticks(places, names if k % columns == 0 else [""] * len(names))
        panel.set(title=f"A = {amplitude:g}, T = {period:g}", xlabel=RATE_LABEL, ylim=(0.6 - len(names), 0.6))
        panel.locator_params(axis="x", nbins=4)
    return figure


def around_body(campaign, rows):
    """Figs. 9 to 11: area fraction, speed and pressure around the body by phase, rows of panels for each shape."""
    groups, phases = list(by_shape(rows)), (0, 5, 10, 15, 19)
    names = (("area_fraction", "Greys"), ("speed", "viridis"), ("contact_pressure", "inferno"))
    height = 1.35 * 3 * len(groups)
    figure, axes = canvas(3 * len(groups), len(phases), width=2 * figures.COLUMN_WIDTH, height=height)
    for block, (shape, group) in enumerate(groups):
        seen = runs.field_runs(campaign, group)[0]
        outline = campaign.run(group["run"].iloc[0]).group("intruder")["outline"]
        for line, (name, colours) in zip(axes[3 * block : 3 * block + 3], names):
            maps = [seen.map(name, min(k, len(seen.samples) - 1)) for k in phases]
            top = np.nanquantile(maps, 0.995)
            for panel, k, values in zip(line, phases, maps):
                image = panel.pcolormesh(seen.x, seen.y, values, cmap=colours, vmin=0, vmax=top, rasterized=True)
                figures.draw_body(panel, outline)
                panel.set(aspect="equal", xticks=[-10, 0, 10], yticks=[-10, 0, 10])
                panel.label_outer()
            words = name.replace("contact_", "").replace("_", " ")
            line[0].set_ylabel(f"{title(shape)}\n{words}" if name == names[0][0] else words)
            figures.colour_bar(line[-1], image, None, extend="max")
    for panel, k in zip(axes[0], phases):
        panel.set_title(f"10φ/π = {k}")
    return figure
