"""What figures of campaigns share: a canvas with claims and verdicts below its axes, points with error bars, curves."""

import numpy as np

from ..figures import BLACK, BLUE, GREEN, ORANGE, SKY, VERMILLION, plt
from .runs import curve
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
        text, colour = f"{claim.text} (expected: {claim.expected}): {claim.number}", VERDICT_COLOURS[claim.verdict]
        figure.text(0.99, y, claim.verdict.value, fontsize=6, color=colour, weight="bold", ha="right")
        figure.text(0.01, y, text, fontsize=6)
    return figure, axes


def look(k, label):
    """Return colour, marker and label of the k-th curve of a panel."""
    return dict(color=COLOURS[k % 6], marker=MARKERS[k % 6], label=label)


def draw_points(axes, x, points, **options):
    """Draw `Measured` points with error bars of one standard error."""
    values, errors = np.array([(m.value, m.error) for m in points]).reshape(-1, 2).T
    errors = np.where(np.isfinite(errors), errors, 0)
    axes.errorbar(x, values, errors, **{"markersize": 3, "capsize": 1.5, "linewidth": 0.7, **options})


def draw_curves(axes, rows, by, key, name, label):
    """Draw a quantity against `key`, one line for each value of `by`."""
    for k, (value, group) in enumerate(rows.groupby(by, sort=True)):
        x, points = curve(group, key, name)
        draw_points(axes, x, points, **look(k, label.format(value)))


def share_y(axes):
    """Give all axes the range that holds them all."""
    low, high = zip(*(panel.get_ylim() for panel in axes))
    for panel in axes:
        panel.set_ylim(min(low), max(high))
