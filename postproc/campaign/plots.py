"""What figures of campaigns share: a canvas, points with error bars, curves. Claims stand in the report, not in figures."""

import numpy as np

from ..figures import BLACK, BLUE, GREEN, ORANGE, SKY, VERMILLION, plt
from .runs import curve

COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, SKY, BLACK)
MARKERS = "osD^vP"


def canvas(rows, columns, *, width, height):
    """Return (figure, axes (rows, columns)) of that size [inches], in one layout."""
    return plt.subplots(rows, columns, figsize=(width, height), squeeze=False, layout="constrained")


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


def rows_of_panels(count, *, width, height, columns=3):
    """Return (figure, `count` axes) in rows of at most `columns`; `height` is a row's [inches]; what is left over stays empty."""
    columns = max(1, min(columns, count))
    lines = max(1, -(-count // columns))
    figure, axes = canvas(lines, columns, width=width, height=height * lines)
    for spare in axes.ravel()[max(1, count) :]:
        spare.set_axis_off()
    return figure, axes.ravel()[: max(1, count)]


def from_zero(axes):
    """Let the y axis of a panel begin at 0, with some room above the data."""
    axes.set_ylim(0, axes.get_ylim()[1] + 0.05 * abs(axes.get_ylim()[1]))


def share_y(axes):
    """Give all axes the range that holds them all, and keep it one if a legend asks for more of it."""
    low, high = zip(*(panel.get_ylim() for panel in axes))
    for panel in axes[1:]:
        panel.sharey(axes[0])
    axes[0].set_ylim(min(low), max(high))
