"""What all figures share: size of a paper's column, colours that colour-blind readers can tell apart, PNG and PDF."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy as np  # noqa: E402
from matplotlib.collections import EllipseCollection, LineCollection  # noqa: E402

from ..base.whole_files import written  # noqa: E402

COLUMN_WIDTH = 3.4  # inches: one column of a two-column journal
# Okabe and Ito's palette, https://jfly.uni-koeln.de/color/
BLACK, ORANGE, SKY, GREEN, BLUE, VERMILLION, GREY = "#000000 #E69F00 #56B4E9 #009E73 #0072B2 #D55E00 #BBBBBB".split()
PURPLE = "#CC79A7"

STYLE = {
    "font.size": 8,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
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
    """Write NAME.png and NAME.pdf into `folder`, each in one step, and close the figure."""
    for ending in ("png", "pdf"):
        with written(Path(folder) / f"{name}.{ending}") as temporary:
            figure.savefig(temporary, format=ending, metadata={"CreationDate": None} if ending == "pdf" else None)
    plt.close(figure)


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
