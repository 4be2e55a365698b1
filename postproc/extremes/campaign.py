"""Report of the extremes: every case with its number, the one expected and the bound, and figures of those with a curve."""

from functools import partial

import numpy as np

from .. import figures
from ..campaign.claims import claim_on
from ..campaign.planned import PlannedFigure, Report
from ..campaign.plots import MARKERS
from ..campaign.verdicts import Agrees
from ..figures import BLACK, BLUE, GREEN, GREY, VERMILLION, plt
from ..measured import Measured

SWEEP = "cases"
COLOURS = {"right": GREEN, "guard": BLUE, "bound": BLACK, "wrong": VERMILLION}
LEAST = 1e-6  # part of a bound below which points stand at the edge
# How a run's settings are named beside its claim.
claim = partial(claim_on, dict(case=("", ""), precision=("", ""), loop=("loop", "")))


def ordered(rows):
    """Return the rows by loop, precision and case."""
    return rows.sort_values(["loop", "precision", "case"], kind="stable")


def outcome_claims(_campaign, rows):
    """One claim a run: its number is the expected one within the bound."""
    found = []
    for _, row in ordered(rows).iterrows():
        one = rows[rows["run"] == row["run"]]
        rule = Agrees(float(row["expected"]), float(row["bound"]), float(row["bound"]))
        text = f"**{row['outcome']}**: {row['sentence']}"
        found.append(
            claim(one, text, row["source"], f"{row['expected']:.6g}", Measured(float(row["measured"]), 0.0), rule)
        )
    return found


def label(row):
    """Return the curve's name in a panel of one kind of case: 2D or 3D, single precision, YADE's loop."""
    dimensions = row["case"][-2:].upper()
    return dimensions + ", single" * (row["precision"] == "single") + ", YADE's loop" * (row["loop"] == "yade")


def draw_outcomes(_campaign, rows):
    """How much of its bound each case uses up."""
    groups = [group for _, group in ordered(rows).groupby(["loop", "precision"], sort=False)]
    longest = max(len(group) for group in groups)
    figure, panels = plt.subplots(
        1, len(groups), figsize=(3.8 * len(groups), 0.115 * longest + 1.0), layout="constrained", squeeze=False
    )
    for axes, group in zip(panels[0], groups):
        part = np.maximum(group["error_over_bound"].astype(float), LEAST)
        for place, (size, (_, row)) in enumerate(zip(part, group.iterrows())):
            axes.plot(size, place, "o", markersize=2.5, color=COLOURS[row["outcome"]])
        axes.axvline(1, color=VERMILLION, linewidth=0.7)
        first = group.iloc[0]
        axes.set_title(f"loop={first['loop']}, {first['precision']}", fontsize=7)
        axes.set_yticks(range(len(group)), group["meaning"], fontsize=4.5)
        axes.set(xscale="log", xlim=(LEAST / 2, 10), ylim=(longest - 0.5, -0.5))
        axes.set_xlabel("error / bound", fontsize=7)
    handles = [plt.Line2D([], [], marker="o", linestyle="", markersize=3, color=c, label=w) for w, c in COLOURS.items()]
    panels[0][-1].legend(handles=handles, loc="lower left", fontsize=6)
    return figure


def runs_of(campaign, rows, start):
    """Yield (row, trials) of the runs whose case begins so."""
    for _, row in ordered(rows).iterrows():
        if row["case"].startswith(start):
            yield row, campaign.run(row["run"]).group("trials")


def draw_steps(campaign, rows):
    """The largest stable step of a pair over theory, and as a share of the contact's duration, by law and direction."""
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(2 * figures.COLUMN_WIDTH, 2.6), layout="constrained", sharey=True
    )
    names = {}
    for row, trials in runs_of(campaign, rows, "step_"):
        if "share" not in trials:
            continue
        place = names.setdefault(row["case"].removeprefix("step_").replace("_", " "), len(names))
        place += 0.15 if row["loop"] == "grain" else -0.15
        looks = dict(linestyle="", markersize=3.5, color=BLUE if row["loop"] == "grain" else VERMILLION)
        for k, (ratio, share) in enumerate(zip(trials["ratio"], trials["share"])):
            mark = dict(marker=MARKERS[k], markerfacecolor="none" if row["loop"] == "grain" else looks["color"])
            left.plot(ratio, place, **looks, **mark)
            right.plot(share, place, **looks, **mark)
    left.set_yticks(range(len(names)), names, fontsize=6)
    left.set(xlabel="largest step over theory", xlim=(0.98, 1.02))
    left.axvline(1, color=BLACK, linewidth=0.7)
    right.set(xlabel="largest step over π√(m/k)", xlim=(0, 0.7))
    for loop, colour in (
        ("GrainLoop's check, overlap 0.1 R", BLUE),
        ("motion on YADE's loop, 0.001 R and less", VERMILLION),
    ):
        right.plot(
            [], [], "s", color=colour, markersize=3.5, label=loop, markerfacecolor="none" if colour == BLUE else colour
        )
    for k, direction in enumerate(("against the normal", "sliding")):
        right.plot([], [], MARKERS[k], color=GREY, markersize=3.5, label=direction)
    right.set_ylim(-1.6, len(names) - 0.5)
    right.legend(fontsize=5, loc="lower center", ncol=2)
    return figure


def draw_far(campaign, rows):
    """Error of an impact against its distance from the origin; energy and place of a bound pair against steps."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(2 * figures.COLUMN_WIDTH, 2.4), layout="constrained")
    for k, (row, trials) in enumerate(runs_of(campaign, rows, "far_")):
        left.plot(
            trials["distance"], np.maximum(trials["error"], 1e-17), MARKERS[k % 6] + "-", markersize=3, label=label(row)
        )
    left.set(xscale="log", yscale="log", xlabel="distance from the origin [d]", ylabel="error of the restitution")
    left.set_title("one impact far from the origin", fontsize=7)
    left.legend(fontsize=5)
    for k, (row, trials) in enumerate(runs_of(campaign, rows, "bound_pair_")):
        for name, line in (("energy", "-"), ("position", ":")):
            size = np.maximum.accumulate(np.abs(trials[name]))
            right.plot(trials["step"], np.maximum(size, 1e-17), line, color=f"C{k}", label=f"{label(row)}: {name}")
    right.set(xscale="log", yscale="log", xlabel="steps", ylabel="largest relative error so far")
    right.set_title("a grain that oscillates on another", fontsize=7)
    right.legend(fontsize=4.5)
    return figure


def draw_friction(campaign, rows):
    """Velocity of the surfaces after an impact against mu; errors of a drum's continuum against its largest viscosity."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(2 * figures.COLUMN_WIDTH, 2.4), layout="constrained")
    for k, (row, trials) in enumerate(runs_of(campaign, rows, "friction_")):
        left.plot(trials["mu"], trials["found"], MARKERS[k % 6], markersize=4, markerfacecolor="none", label=label(row))
        if row["precision"] == "double" and row["loop"] == "grain":
            left.plot(trials["mu"], trials["expected"], "_", color=BLACK, markersize=7)
    left.set_xscale("symlog", linthresh=0.01)
    left.set(xlabel="friction coefficient μ", ylabel="$v_t$ after / $v_n$ before", ylim=(-1.4, 1.4))
    left.legend(fontsize=5)
    for k, (row, trials) in enumerate(runs_of(campaign, rows, "drum_")):
        if "viscosity" in trials:
            sizes = np.maximum(np.abs(trials["error"]), 1e-17)
            right.plot(trials["viscosity"], sizes, MARKERS[k % 6] + "-", markersize=3, label=row["meaning"])
    left.set_title("two grains hit each other obliquely", fontsize=7)
    right.set_title("a drum's continuum", fontsize=7)
    right.set(xscale="log", yscale="log", xlabel="η_max  [m √(g/d)]", ylabel="relative error")
    right.legend(fontsize=5)
    return figure


def no_claims(_campaign, _rows):
    """The claims stand under the first figure."""
    return []


REPORT = Report(
    "extremes",
    "Extremes: the right answer, a guard, or a bound",
    {SWEEP: "any cases, loops and precisions"},
    (
        PlannedFigure(
            "outcomes",
            SWEEP,
            "What was tried, what came out, the bound",
            "How much of its bound every case uses up, on either loop and in either precision; a point right of the line is a"
            " wrong answer. `right`: the closed form's number; `guard`: a check stopped the run where it should and named the"
            " cause; `bound`: the number is that of a limit that users must know. Numbers are ratios, or errors of ratios.",
            outcome_claims,
            draw_outcomes,
        ),
        PlannedFigure(
            "steps",
            SWEEP,
            "Largest stable step by law",
            "Of a pair pressed together, by bisection: where GrainLoop's check lies, and where the motion on YADE's loop grows;"
            " circles against the normal, squares sliding. Its claims stand in the table above, those of crystals too.",
            no_claims,
            draw_steps,
        ),
        PlannedFigure(
            "far",
            SWEEP,
            "Far away and for long",
            "Left: restitution of an impact far from the origin less that at the origin. Right: a pair bound by weight, its"
            " energy and its position less those of leapfrog's own orbit.",
            no_claims,
            draw_far,
        ),
        PlannedFigure(
            "friction",
            SWEEP,
            "Friction from 0 to 10, viscosity from 1e2 to 1e6",
            "Left: two grains whose surfaces meet at v_t = 1.2 v_n, by the velocity v_t with which they part; bars: the closed"
            " form, v_t − 2μ(m/m_t)v_n, or −v_t if they stick."
            " Right: the drum's continuum, all bed (off rigid rotation), all gas (off its spin-up), half full (area of the bed).",
            no_claims,
            draw_friction,
        ),
    ),
)
