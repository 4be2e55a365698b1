"""The figure of one rounding run: distance from the truth against time by number type, and averages with their errors."""

import numpy as np

from ..figures import BLACK, BLUE, COLUMN_WIDTH, GREEN, GREY, ORANGE, PURPLE, STYLE, VERMILLION, plt, save, set_title
from ..reader import Run
from .averages import AVERAGED
from .distances import PREDICTED

COLOURS = dict(float128=GREEN, longdouble=PURPLE, yade_double=ORANGE, double=BLUE, single=VERMILLION)
LABELS = dict(
    float128="YADE, 113 bits",
    longdouble="YADE, 64 bits",
    yade_double="YADE, 53 bits",
    double="GrainLoop double",
    single="GrainLoop single",
)


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone."""
    run = Run(path)
    averaged = bool(run.group("averages"))
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(
            1 + averaged * 2, 1, figsize=(COLUMN_WIDTH, 2.8 + 3.6 * averaged), layout="constrained"
        )
        axes = np.atleast_1d(axes)
        p = run.parameters
        set_title(figure, [f"{p['scene']} scene", f"{p['grains']} disks", f"seed {p['seed']}"])
        draw_distances(axes[0], run)
        if averaged:
            draw_averages(axes[1], run)
            draw_velocities(axes[2], run)
        save(figure, path)


def draw_distances(axes, run):
    """Draw the distances of all types; the line at which a run predicts no more belongs to chaos alone."""
    chaotic = run.parameters["scene"] == "chaotic"
    for name, colour in COLOURS.items():
        distance = run.series[f"distance_{name}"]
        shown = distance > 0
        axes.plot(run.series["t"][shown], distance[shown], color=colour, linewidth=0.8, label=LABELS[name])
    if chaotic:
        axes.axhline(PREDICTED, color=GREY, linewidth=0.6)
    axes.set(yscale="log", xlabel=r"$t$  [$t_0$]", ylabel=r"distance from 150 digits  [$d$]")
    axes.set(xscale="linear" if chaotic else "log")
    axes.legend(ncols=1, fontsize=6, loc="lower right" if chaotic else "center right")


def draw_averages(axes, run):
    """Draw each average over that of YADE's 64 bits, less 1, with error bars."""
    names = [name for name in COLOURS if f"kinetic_energy_{name}" in run.summary]
    for column, name in enumerate(names):
        for k, quantity in enumerate(AVERAGED):
            reference = run.summary[f"{quantity}_longdouble"]
            value, error = run.summary[f"{quantity}_{name}"], run.summary[f"{quantity}_{name}_err"]
            place, options = k + 0.15 * (column - 1), dict(color=COLOURS[name], marker="o", markersize=3, linewidth=0.8)
            axes.errorbar(place, 100 * (value / reference - 1), 100 * error / reference, **options)
    axes.axhline(0, color=GREY, linewidth=0.6)
    axes.set_xticks(range(len(AVERAGED)), [name.replace("_", " ") for name in AVERAGED])
    axes.set(ylabel="mean over that\nof 64 bits, less 1  [%]")


def draw_velocities(axes, run):
    """Draw the velocities' distribution and Maxwell's."""
    found = run.group("velocities")
    line = np.linspace(-3, 3, 200)
    axes.plot(line, np.exp(-(line**2) / 2) / np.sqrt(2 * np.pi), color=BLACK, linewidth=0.6, label="Maxwell")
    for name, colour in COLOURS.items():
        if name in found:
            axes.errorbar(
                found["velocity"],
                found[name],
                found[f"{name}_err"],
                color=colour,
                marker=".",
                markersize=3,
                linestyle="none",
                elinewidth=0.6,
                label=LABELS[name],
            )
    axes.set(xlabel=r"$v_x/\langle v_x^2\rangle^{1/2}$", ylabel="density", yscale="log")
    axes.legend(fontsize=6, loc="lower center")
