"""The figures of a lift campaign, numbered as in the paper."""

import numpy as np

from .. import fields, figures
from ..campaign.plots import canvas, draw_points, from_zero, look
from ..campaign.runs import curve, quantity
from ..figures import BLACK
from .claims import differences, stress, with_weight, without_weight
from .figure import draw_body, fields_of

KINDS = (("normal", "no lid"), ("lid", "lid"), ("no weight", "lid, no weight in the bulk"))


def kind_of(row):
    """Return which of the paper's three runs a row is."""
    return "no weight" if not row["bulk_gravity"] else "lid" if row["lid_density"] > 0 else "normal"


def against_depth(_campaign, rows):
    """Fig. 8: C_d and the lift over the buoyancy against h~/D, for the three kinds of run."""
    figure, ((left, right),) = canvas(1, 2, width=2 * figures.COLUMN_WIDTH, height=2.4)
    kinds = rows.apply(kind_of, axis=1)
    for k, (kind, label) in enumerate(KINDS):
        group = rows[kinds == kind]
        for panel, name in ((left, "drag_coefficient"), (right, "lift_over_buoyancy")):
            points = [quantity(group.iloc[[n]], name) for n in range(len(group))]
            draw_points(panel, group["depth_over_d"], points, linestyle="", **look(k, label))
    left.set(xlabel=r"$\tilde h/D$", ylabel=r"$C_d$")
    from_zero(left)
    right.set(xlabel=r"$\tilde h/D$", ylabel="lift over buoyancy")
    right.axhline(0, color=BLACK, linewidth=0.4)
    left.legend(fontsize=6)
    return figure


def stress_by_angle(campaign, rows):
    """Figs. 11(b, d) and 12: sigma_n over P_0 by angle, with and without weight, and the differences over rho g D."""
    figure, ((left, right),) = canvas(1, 2, width=2 * figures.COLUMN_WIDTH, height=2.4)
    for group, style in ((with_weight(rows), "-"), (without_weight(rows), ":")):
        for k, (_, row) in enumerate(group.sort_values("depth_over_d").iterrows()):
            theta, normal = stress(campaign, row["run"])
            label = rf"$\tilde h/D$ = {row['depth_over_d']:.3g}" if style == "-" else None
            left.plot(theta / np.pi, normal / row["pressure"], style, color=look(k, "")["color"], label=label)
    for k, (depth, theta, difference) in enumerate(sorted(differences(campaign, rows), key=lambda found: found[0])):
        right.plot(theta / np.pi, difference, color=look(k, "")["color"], label=f"{depth:.3g}")
    left.set(xlabel=r"$\theta/\pi$, > 0 below", ylabel=r"$\sigma_n/P_0$; dotted: no weight")
    right.set(xlabel=r"$\theta/\pi$, > 0 below", ylabel=r"$(\sigma_n - \sigma_n^{g=0})/\rho g D$")
    right.axhline(0, color=BLACK, linewidth=0.4)
    left.legend(fontsize=6)
    return figure


def around_body(campaign, rows):
    """Figs. 9 and 13: pressure and speed with streamlines around the body, one column a run."""
    found = [(row, fields_of(campaign.run(row["run"]))) for _, row in rows.iterrows()]
    found = [(row, around) for row, around in found if around is not None]
    figure, axes = canvas(2, max(1, len(found)), width=2 * figures.COLUMN_WIDTH, height=3.6)
    for column, (row, around) in zip(axes.T, found):
        fields.draw_map(column[0], around, "pressure", vmin=0, vmax=3)
        fields.draw_map(column[1], around, "speed", vmin=0, vmax=2)
        fields.draw_streamlines(column[1], around, density=0.7)
        column[0].set_title(f"{kind_of(row)}, {row['depth_over_d']:.3g} D")
        for panel in column:
            draw_body(panel, campaign.run(row["run"]))
    for panel in axes[:, 1:].flat:
        panel.set_ylabel("")  # as in the first column
    return figure


def against(key, label, name, symbol, by=None):
    """Return the function that draws a quantity against a key, a line for each value of the key `by`."""

    def draw(_campaign, rows):
        figure, ((axes,),) = canvas(1, 1, width=1.6 * figures.COLUMN_WIDTH, height=2.4)
        for k, (value, group) in enumerate(rows.groupby(by) if by else [("", rows)]):
            draw_points(axes, *curve(group, key, name), **look(k, f"{by} = {value:g}" if by else None))
        axes.set(xlabel=label, ylabel=symbol)
        from_zero(axes)
        if by:
            axes.legend(fontsize=6)
        return figure

    return draw
