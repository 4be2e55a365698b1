"""The figure of one case at an extreme: its number beside the one expected, and its trials."""

import numpy as np

from ..figures import BLACK, BLUE, COLUMN_WIDTH, GREEN, GREY, STYLE, VERMILLION, plt, save, set_title
from ..reader import Run

COLOURS = {"right": GREEN, "guard": BLUE, "bound": BLACK, "wrong": VERMILLION}


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone."""
    run = Run(path)
    found, trials = run.summary, run.group("trials")
    with plt.rc_context(STYLE):
        figure, (axes, below) = plt.subplots(2, 1, figsize=(COLUMN_WIDTH, 3.6), layout="constrained")
        set_title(figure, [f"{run.parameters['case']}: {found['outcome']}"])
        axes.axvspan(found["expected"] - found["bound"], found["expected"] + found["bound"], color=GREY, alpha=0.5)
        axes.axvline(found["expected"], color=BLACK, linewidth=0.7)
        axes.plot(found["measured"], 0, "o", color=COLOURS[found["outcome"]])
        measured = f"{found['measured']:.6g}".replace("-", "−")
        axes.set(title=f"measured {measured}; grey: expected and bound", yticks=[])
        draw_trials(below, trials)
        save(figure, path)


def draw_trials(axes, trials):
    """Draw every column of numbers against the number of the trial."""
    for name, values in trials.items():
        if values.dtype.kind == "f":
            axes.plot(np.arange(len(values)), np.abs(values), "o-", markersize=2.5, label=name)
    if axes.lines:
        axes.set(yscale="log")
        axes.legend()
    axes.set(xlabel="trial", ylabel="size")
