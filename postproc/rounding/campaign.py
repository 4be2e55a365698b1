"""Report of a rounding campaign: one Lyapunov rate for all numbers, what a bit buys, averages that agree, regular drift."""

from functools import partial

import numpy as np

from .. import figures
from ..campaign.claims import claim_on
from ..campaign.planned import PlannedFigure, Report
from ..campaign.plots import canvas
from ..campaign.runs import measurements, over_repeats, quantity
from ..campaign.verdicts import Agrees, Between, above
from ..measured import Measured, mean_of
from ..reader import Run
from .averages import AVERAGED
from .distances import growth_rate
from .figure import COLOURS, LABELS

BITS = dict(float128=113, longdouble=64, yade_double=53, double=53)
claim = partial(claim_on, dict(scene=("", ""), grains=("", " disks"), dt_factor=("dt", " of the study's")))
SOURCE = "this study"


def rate_of(campaign, rows, name):
    """Return the Lyapunov rate that the runs' distances with the numbers `name` grow by, over the repeats, as `Measured`."""
    series = [Run(campaign.folder / "runs" / path).series for path in rows["run"]]
    return mean_of([growth_rate(one["t"], one[f"distance_{name}"]) for one in series])


def rate_claims(campaign, rows):
    """All numbers see one Lyapunov rate, and a bit more predicts ln 2 over it longer."""
    reference = rate_of(campaign, rows, "float128")
    claims = [claim(rows, "differences grow: Lyapunov rate [1/t_0], 113 bits", SOURCE, "> 0", reference, above(0))]
    for name in ("longdouble", "double", "single"):
        ratio = rate_of(campaign, rows, name) / reference
        text = f"the rate with {LABELS[name]} over that with 113 bits"
        claims.append(claim(rows, text, "one scene, one rate", "1", ratio, Agrees(1, 0.05, 0.4)))
    text = "time that one more bit predicts, 53 to 113 bits, over ln 2/rate"
    per_bit = time_per_bit(rows)
    if len(per_bit):
        worth = over_repeats(per_bit) / (Measured(np.log(2), 0.0) / reference)
        claims.append(claim(rows, text, "exp(rate t) from 2^-bits", "1", worth, Agrees(1, 0.05, 0.4)))
    return claims


def time_per_bit(rows):
    """Return, of each run that has both, the horizons' difference between 113 and 53 bits over the bits [t_0]."""
    both = rows[["horizon_float128", "horizon_double"]].astype(float).dropna()
    return ((both["horizon_float128"] - both["horizon_double"]) / (BITS["float128"] - BITS["double"])).to_numpy()


def over_64_bits(rows, key, name):
    """Return an average with the numbers `name` over that with 64 bits of the same run, the mean over the repeats."""
    return mean_of(
        [quantity(run, f"{key}_{name}") / quantity(run, f"{key}_longdouble") for _, run in rows.groupby("run")]
    )


def average_claims(_campaign, rows):
    """Averages over chaos are the same whatever the numbers."""
    claims = []
    for name in ("double", "single"):
        for key in AVERAGED:
            ratio = over_64_bits(rows, key, name)
            text = f"{key.replace('_', ' ')} with {LABELS[name]} over that with 64 bits"
            claims.append(claim(rows, text, "averages outlive trajectories", "1", ratio, Agrees(1, 0, 0.02)))
    return claims


def regular_claims(_campaign, rows):
    """Regular differences grow by a power of time, and stay small."""
    claims = []
    for name in ("longdouble", "double", "single"):
        order = quantity(rows, f"drift_order_{name}")
        text = f"power of time of the drift, {LABELS[name]}"
        claims.append(claim(rows, text, "random or steady roundings", "0 to 2", order, Between(-0.2, 2.0)))
    for name, bits in (("longdouble", 64), ("double", 53)):
        ratio = np.log2(over_repeats([m.value for m in measurements(rows, f"drift_{name}")]).value) + bits
        text = f"bits lost at the end, {LABELS[name]}: log2 of the distance over 2^-{bits} d"
        claims.append(claim(rows, text, SOURCE, "< 16", Measured(float(ratio), 0.0), Between(-np.inf, 16)))
    return claims


def draw_runs(campaign, rows, *, chaotic):
    """Draw the distances of all runs against time."""
    figure, ((axes,),) = canvas(1, 1, width=1.6 * figures.COLUMN_WIDTH, height=3.0)
    for number, path in enumerate(rows["run"]):
        run = Run(campaign.folder / "runs" / path)
        for name, colour in COLOURS.items():
            distance = run.series[f"distance_{name}"]
            shown = distance > 0
            label = LABELS[name] if number == 0 else None
            axes.plot(run.series["t"][shown], distance[shown], color=colour, linewidth=0.7, label=label)
    axes.set(yscale="log", xlabel="$t$  [$t_0$]", ylabel="distance from 150 digits  [$d$]")
    axes.set(xscale="linear" if chaotic else "log")
    axes.legend(loc="lower right" if chaotic else "best")
    return figure


def draw_averages(campaign, rows):
    """Draw each average over that of 64 bits, less 1, with error bars."""
    figure, ((axes,),) = canvas(1, 1, width=1.4 * figures.COLUMN_WIDTH, height=2.4)
    for column, name in enumerate(("double", "single")):
        for k, key in enumerate(AVERAGED):
            ratio = over_64_bits(rows, key, name)
            place, options = k + 0.2 * (column - 0.5), dict(
                color=COLOURS[name], marker="o", markersize=3, linewidth=0.8
            )
            axes.errorbar(place, 100 * (ratio.value - 1), 100 * ratio.error, label=LABELS[name] * (k == 0), **options)
    axes.axhline(0, color=figures.GREY, linewidth=0.6)
    axes.set_xticks(range(len(AVERAGED)), [key.replace("_", " ") for key in AVERAGED])
    axes.set(ylabel="mean over that\nof 64 bits, less 1  [%]")
    axes.legend()
    return figure


REPORT = Report(
    "rounding",
    "Rounding: how numbers of different length drift apart, and what averages keep",
    {
        "chaotic": "scene=chaotic with averages, three seeds or more",
        "regular": "scene=regular, two seeds or more",
    },
    (
        PlannedFigure(
            "distances",
            "chaotic",
            "Chaos: trajectories part",
            "Root mean square distance of the disks from the run with 150 digits, against time; one line a run. All numbers see"
            " the same rate, and shorter ones only begin higher.",
            rate_claims,
            partial(draw_runs, chaotic=True),
        ),
        PlannedFigure(
            "averages",
            "chaotic",
            "Chaos: averages stay",
            "Kinetic energy of a disk, pressure by motion and contacts, and <v^4>/<v^2>^2, over a window in which trajectories"
            " have nothing in common any more, over the same with 64 bits, less 1.",
            average_claims,
            draw_averages,
        ),
        PlannedFigure(
            "regular",
            "regular",
            "A regular scene",
            "The same distance of disks that swing in wells of their own.",
            regular_claims,
            partial(draw_runs, chaotic=False),
        ),
    ),
)
