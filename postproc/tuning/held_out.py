"""The report of books on trial: how often a run chosen by its accuracy lies within it, and how well its cost was foretold."""

import numpy as np
from scipy import stats

from ...base.whole_files import write_text
from ...accuracy.words import in_words
from .. import figures
from ..campaign.plots import COLOURS, MARKERS

NEAR = 0.2  # of the cost: what a prediction should be within


def write_report(folder, points, words):
    """Write `report.md`, its figure and `table.csv` of a list of `Point`s; `words` say by which command, code and processor."""
    name = folder.resolve().name
    (folder / "figures").mkdir(parents=True, exist_ok=True)
    with figures.plt.rc_context(figures.STYLE):
        figures.save_as(drawn(points), folder / "figures", f"{name}-points")
    write_text(folder / "report.md", "\n\n".join(parts(name, points, words)) + "\n")
    return folder / "report.md"


def drawn(points):
    """Return the figure: error over what was asked for, and the cost over what was foretold, by study."""
    figure, (left, right) = figures.plt.subplots(1, 2, figsize=(2 * figures.COLUMN_WIDTH, 2.6), layout="constrained")
    for k, study in enumerate(dict.fromkeys(p.study for p in points)):
        own = [p for p in points if p.study == study]
        style = dict(color=COLOURS[k % 6], marker=MARKERS[k % 6], linestyle="none", markersize=4, label=study)
        left.plot([100 * p.asked for p in own], [100 * max(p.error, 1e-4) for p in own], **style)
        right.plot([p.predicted for p in own], [p.measured for p in own], **style)
    draw_equality(left, "as asked for")
    draw_equality(right, "as foretold", NEAR)
    left.set(xlabel="error asked for [%]", ylabel="error that came out [%]")
    right.set(xlabel="core-seconds foretold", ylabel="core-seconds taken")
    left.legend(fontsize=6)
    right.legend(fontsize=6)
    return figure


def draw_equality(axes, words, near=0.0):
    """Draw the line on which y is x, named by `words`, on logarithmic axes, and the band within the part `near` of it."""
    axes.set(xscale="log", yscale="log")
    ends = np.array(axes.get_xlim())
    axes.plot(ends, ends, color=figures.GREY, linewidth=0.8, label=words)
    if near:
        low, high = ends / (1 + near), ends * (1 + near)
        label = f"within {100 * near:.0f} %"
        axes.fill_between(ends, low, high, color=figures.GREY, alpha=0.3, linewidth=0, label=label)
    axes.set_xlim(ends)
    for axis in (axes.xaxis, axes.yaxis):
        figures.number_logarithmic(axis)


def parts(name, points, words):
    """Return the paragraphs of the report."""
    within, near = sum(p.holds for p in points), sum(abs(p.measured / p.predicted - 1) <= NEAR for p in points)
    low, high = confidence_interval(within, len(points))
    saved = sum(p.measured for p in points) / sum(p.reference for p in points)
    return [
        f"## Accuracy on trial: scenes that no tuning saw (`{name}`)",
        words,
        f"{within} of {len(points)} runs lie within the error that was asked for; at 90 % confidence between {100 * low:.0f} and"
        f" {100 * high:.0f} % of all such runs do (Clopper, Pearson 1934), 90 % are promised. They took {saved:.2f} of the"
        f" references' processor time; {near} of {len(points)} predictions of it are within {100 * NEAR:.0f} %.",
        f"![Accuracy on trial](figures/{name}-points.png)",
        "Left: error of the headline against the reference run of the same scene and seed, and the error asked for; below the"
        " line it holds. Right: processor time.",
        table(points),
    ]


def confidence_interval(good, tries):
    """Return the shares between which the true one lies at 90 %, of `good` in `tries`.

    C. J. Clopper, E. S. Pearson, Biometrika 26, 404 (1934).
    """
    low = stats.beta.ppf(0.05, good, tries - good + 1) if good else 0.0
    high = stats.beta.ppf(0.95, good + 1, tries - good) if good < tries else 1.0
    return float(low), float(high)


def table(points):
    """Return the points as a Markdown table."""
    heading = "study scene observable asked taken error holds core-s,_foretold of_the_reference".split()
    lines = ["| " + " | ".join(word.replace("_", " ") for word in heading) + " |", "|---" * len(heading) + "|"]
    for p in points:
        scene = " ".join(
            f"{key}={value:g}" if isinstance(value, float) else f"{key}={value}" for key, value in p.scene.items()
        )
        cells = [p.study, scene, p.observable, f"{100 * p.asked:.2g} %", in_words(p.taken), f"{100 * p.error:.2g} %"]
        cells += [
            "yes" if p.holds else "**no**",
            f"{p.measured:.3g}, {p.predicted:.3g}",
            f"{p.measured / p.reference:.2f}",
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)
