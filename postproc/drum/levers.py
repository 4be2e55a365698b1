"""What the continuum's levers change and cost: u(z), layer and angle at values of each, against its finest."""

from dataclasses import dataclass

import numpy as np

from .. import figures
from ..campaign.planned import PlannedFigure
from ..campaign.plots import COLOURS, MARKERS, canvas, draw_points
from ..campaign.runs import quantity
from ..campaign.verdicts import below
from ..figures import GREY
from ..measured import Measured
from .claims import claim
from .runs import by_speed, mean_profile, of_model, scaled_difference

FINEST = dict(
    continuum_dt=min, cells=max, largest_viscosity=max, tolerance=min
)  # which of a lever's values is the finest
SYMBOLS = dict(continuum_dt="dt", cells="cells", largest_viscosity="η_max", tolerance="tolerance")
WITHIN = 0.01  # of u(z), in the L2 norm
SWEEP = "of model=continuum at one drum, one lever at a time: " + ", ".join(FINEST)


@dataclass(frozen=True)
class Setting:
    """A lever at one `value` beside its finest: its `error` of u(z), h/D, angle [degrees] (`Measured`), `seconds` of a core."""

    lever: str
    value: float
    error: Measured
    thickness: Measured
    angle: Measured
    seconds: float


def usual(rows):
    """Return {lever: the value that most of the rows have}."""
    return {lever: rows[lever].mode().iloc[0] for lever in FINEST}


def rows_of(rows, lever):
    """Return the rows in which all other levers have their usual value."""
    for other, value in usual(rows).items():
        if other != lever:
            rows = rows[rows[other] == value]
    return rows


def settings(campaign, rows):
    """Yield the `Setting`s of each lever with two values or more, its finest last, in the smallest drum at its lowest speed."""
    rows, _ = of_model(rows, "continuum", "")
    _, _, rows = next(by_speed(rows), (None, None, rows))
    for lever, best in FINEST.items() if len(rows) else ():
        same = rows_of(rows, lever)
        values = sorted(same[lever].unique(), reverse=best is min)
        profiles = {value: mean_profile(campaign, same[same[lever] == value], "continuum") for value in values}
        values = [value for value in values if profiles[value]]
        for value in values if len(values) > 1 else ():
            there = same[same[lever] == value]
            error = scaled_difference(profiles[values[-1]], profiles[value])
            found = (quantity(there, name) for name in ("thickness_over_diameter", "surface_angle_deg"))
            yield Setting(
                lever, float(value), Measured(*error), *found, quantity(there, "continuum_core_seconds").value
            )


def cheapest(of_lever):
    """Return the `Setting` of least seconds whose error of u(z) is at most `WITHIN`, the finest among them."""
    return min((s for s in of_lever if s.error.value <= WITHIN), key=lambda s: s.seconds)


def by_lever(campaign, rows):
    """Return {lever: its `Setting`s}."""
    found = {}
    for setting in settings(campaign, rows):
        found.setdefault(setting.lever, []).append(setting)
    return found


def lever_claims(campaign, rows):
    """A row for each value but the finest of a lever: does it keep u(z) within `WITHIN` of the finest?"""
    claims = []
    for lever, found in by_lever(campaign, rows).items():
        best, finest = cheapest(found), found[-1]
        for one in found[:-1]:
            text = f"error of u(z), {SYMBOLS[lever]} = {one.value:g} against {finest.value:g}:"
            text += f" {one.seconds:.0f} s, {finest.seconds:.0f} s" + (
                "; the cheapest within 1 %" if one is best else ""
            )
            same = rows_of(rows, lever)
            claims.append(claim(same[same[lever] == one.value], text, "ours", "≤ 0.01", one.error, below(WITHIN)))
    return claims


def draw(campaign, rows):
    """Error of u(z), h/D and angle against the seconds of a core, a colour for each lever, its values beside the points."""
    figure, ((left, middle, right),) = canvas(1, 3, width=2 * figures.COLUMN_WIDTH, height=2.6)
    for k, (lever, found) in enumerate(by_lever(campaign, rows).items()):
        style = dict(color=COLOURS[k % 6], marker=MARKERS[k % 6], linewidth=0.6, label=SYMBOLS[lever])
        seconds = np.array([one.seconds for one in found])
        draw_points(left, seconds[:-1], [one.error for one in found[:-1]], **style)
        for axes, name in ((middle, "thickness"), (right, "angle")):
            draw_points(axes, seconds, [getattr(one, name) for one in found], **style)
        for one in found[:-1]:
            left.annotate(f"{one.value:g}", (one.seconds, one.error.value), fontsize=5, color=COLOURS[k % 6])
    left.axhline(WITHIN, color=GREY, linewidth=0.6)
    left.set(ylabel="error of u(z)", yscale="log")
    middle.set(ylabel="h/D")
    right.set(ylabel="angle of the surface [degrees]")
    for axes in (left, middle, right):
        axes.set(xlabel="seconds of one core", xscale="log")
    if middle.has_data():
        middle.legend(fontsize=6)
    return figure


FIGURE = PlannedFigure(
    "levers",
    "levers",
    "The continuum's levers",
    "How far u(z) (z > 0), h/D and the surface's angle are from those at the finest value of the same lever (dt and tolerance the"
    " smallest, cells and η_max the largest), other levers at their defaults, against the cost. Numbers beside points are values"
    " of the lever; in brackets, the finest.",
    lever_claims,
    draw,
)
