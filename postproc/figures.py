"""What all figures share: size of a paper's column, colours that colour-blind readers can tell apart, PNG and PDF."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy as np  # noqa: E402
from matplotlib.collections import EllipseCollection, LineCollection  # noqa: E402
from matplotlib.patches import Circle, FancyArrowPatch, Polygon  # noqa: E402
from matplotlib.ticker import LogLocator, StrMethodFormatter  # noqa: E402

from ..base.whole_files import written  # noqa: E402
from . import legends  # noqa: E402

COLUMN_WIDTH = 3.4  # inches: one column of a two-column journal
# Okabe and Ito's palette, https://jfly.uni-koeln.de/color/
BLACK, ORANGE, SKY, GREEN, BLUE, VERMILLION, GREY = "#000000 #E69F00 #56B4E9 #009E73 #0072B2 #D55E00 #BBBBBB".split()
PURPLE = "#CC79A7"
TITLE_SHARE = 0.96  # of a figure's width, that a line of its title may fill
BAR_GAP, BAR_WIDTH = 0.02, 0.035  # of a panel's width: a colour bar's distance from it and its width

STYLE = {
    "font.size": 8,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "legend.edgecolor": "none",
    "legend.framealpha": 0.85,
    "legend.borderaxespad": 0.3,
    "legend.handlelength": 1.4,
    "axes.linewidth": 0.6,
    "lines.linewidth": 0.9,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "savefig.dpi": 300,
    "pdf.fonttype": 42,
}


def save(figure, folder):
    """Write `figure.png` and `figure.pdf` into `folder`, each in one step, and close the figure."""
    save_as(figure, folder, "figure")


def save_as(figure, folder, name):
    """Write NAME.png and NAME.pdf into `folder`, each in one step, and close the figure; legends move off the data first."""
    legends.settle(figure)
    for ending in ("png", "pdf"):
        with written(Path(folder) / f"{name}.{ending}") as temporary:
            figure.savefig(temporary, format=ending, metadata={"CreationDate": None} if ending == "pdf" else None)
    plt.close(figure)


def number_logarithmic(axis):
    """Write plain numbers (20, 50, 100) at a logarithmic axis whose limits are set: in a short range each digit has one."""
    low, high = axis.get_view_interval()
    axis.set_minor_locator(LogLocator(subs=(2, 5) if high > 12 * low else range(2, 10)))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(StrMethodFormatter("{x:g}"))


def set_title(figure, parts):
    """Set a figure's title, `parts` with commas between, in as many lines as the figure's width asks for."""
    text, lines = figure.suptitle("", fontsize=8), [""]
    renderer, width = figure.canvas.get_renderer(), figure.bbox.width
    for k, part in enumerate(filter(None, parts)):
        longer = f"{lines[-1]}, {part}" if k else part
        text.set_text(longer)
        if k and text.get_window_extent(renderer).width > TITLE_SHARE * width:
            lines[-1] += ","
            lines.append(part)
        else:
            lines[-1] = longer
    text.set_text("\n".join(lines))


def colour_bar(axes, mappable, label, **options):
    """Draw the colour bar of `mappable` beside a panel, exactly as tall as the panel; return it.

    It is a part of the panel: `axes.clear()` takes it away. `options` go to matplotlib's colorbar, extend="max" …
    """
    beside = axes.inset_axes([1 + BAR_GAP, 0, BAR_WIDTH, 1])
    bar = axes.figure.colorbar(mappable, cax=beside, label=label, **options)
    beside.minorticks_off()
    return bar


def draw_body(axes, corners, *, zorder=3):
    """Draw a body as itself: white, with the polygon of its corners (n, 2) as a bold outline."""
    return axes.add_patch(Polygon(corners, facecolor="white", edgecolor=BLACK, linewidth=0.8, zorder=zorder))


def draw_disk(axes, centre, radius, *, angle=None, spin=0.0, zorder=3):
    """Draw a disk about `centre` (2,); if it turns, with a mark at its `angle` [rad] and an arrow the way of its `spin`."""
    axes.add_patch(Circle(centre, radius, facecolor="white", edgecolor=BLACK, linewidth=0.8, zorder=zorder))
    if angle is not None:
        rim = np.array(centre) + radius * np.array([np.cos(angle), np.sin(angle)])
        axes.plot(*np.column_stack([centre, rim]), color=BLACK, linewidth=0.8, zorder=zorder + 0.1)
    draw_spin(axes, centre, 0.55 * radius, spin, zorder=zorder + 0.1)


def draw_spin(axes, centre, radius, spin, *, zorder=3.1):
    """Draw an arrow along two thirds of a circle about `centre`, counter-clockwise for spin > 0; nothing for 0."""
    if not spin:
        return
    angle = np.radians(np.linspace(-60, 180, 40)[:: 1 if spin > 0 else -1])
    x, y = centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)
    axes.plot(x[:-3], y[:-3], color=VERMILLION, linewidth=0.8, zorder=zorder)
    head = dict(arrowstyle="-|>", mutation_scale=5, color=VERMILLION, linewidth=0, shrinkA=0, shrinkB=0)
    axes.add_patch(FancyArrowPatch((x[-6], y[-6]), (x[-1], y[-1]), zorder=zorder, **head))


def draw_grains(axes, x, y, r, *, values=None, colour=GREY, **options):
    """Draw grains as circles of their true size: (n,) centres and radii [d], coloured by `values` or all alike."""
    circles = EllipseCollection(
        2 * r,
        2 * r,
        np.zeros_like(r),
        offsets=np.column_stack([x, y]),
        units="xy",
        offset_transform=axes.transData,
        **options,
    )
    circles.set(rasterized=len(x) > 3000, linewidth=0)
    if values is None:
        circles.set_facecolor(colour)
    else:
        circles.set_array(values)
    return axes.add_collection(circles)


def draw_chains(axes, start, end, force, *, colour=BLACK, pulling=PURPLE, widest=1.2, faintest=0.12):
    """Draw contacts as lines (n, 2) to (n, 2) whose width grows with the size of the force (n,); weak ones are left out.

    `colour` is that of contacts that push (force > 0), `pulling` that of the others. `widest` is the width [pt] at the
    99.5 % quantile of the size, above which it no longer grows; lines below the fraction `faintest` of it are not drawn.
    """
    size = np.abs(force)
    width = widest * np.clip(size / max(np.quantile(size, 0.995), 1e-300), 0, 1) if len(size) else np.zeros(0)
    kept = width > faintest * widest
    colours = np.where(np.asarray(force)[kept] < 0, pulling, colour)
    lines = LineCollection(np.stack([start[kept], end[kept]], axis=1), linewidths=width[kept], colors=colours)
    lines.set(capstyle="round", rasterized=kept.sum() > 3000)
    return axes.add_collection(lines)
