"""The report of a tuning: `report.md` with sentences and a table, `table.csv`, and the figure of error against cost."""

import math

import pandas as pd

from ...accuracy.effects import CONFIDENCE
from ...accuracy.words import in_words, shown
from ...base.numbers import with_error
from ...base.whole_files import write_text
from .. import figures
from ..campaign.plots import COLOURS, MARKERS

ERROR_FLOOR = 1e-3  # of the figure: an error of 0 has no place on a logarithmic axis


def write_report(folder, search, book):
    """Write table, figure and `report.md` of a `Search` whose runs are there, and its `Book`; return the last written."""
    rows = table_of(search)
    write_text(folder / "table.csv", rows.to_csv(index=False))
    with figures.plt.rc_context(figures.STYLE):
        (folder / "figures").mkdir(exist_ok=True)
        figures.save_as(drawn(search, rows), folder / "figures", f"{folder.name}-levers")
    write_text(folder / "report.md", "\n\n".join(parts(search, book, rows)) + "\n")
    return folder / "report.md"


def table_of(search):
    """Return a row for each setting: its words, verdict, cost and its share of the reference's, memory, effects in percent."""
    trials = search.trials
    rows = []
    for setting in trials.settings:
        row = dict(setting=in_words(setting), verdict="reference" if not setting else verdict_of(search, setting))
        row["runs"] = len(trials.of(setting))
        row["core_seconds"] = trials.cost(setting)
        row["cost_share"] = trials.cost(setting) / trials.cost(())
        row["steps"] = work_of(trials, setting)
        row["runs_to_target"] = trials.effect(setting, search.observable).runs_for(search.target, CONFIDENCE)
        row["memory_MB"] = max(outcome.memory for outcome in trials.of(setting).values())
        for observable in trials.study.observables:
            effect = trials.effect(setting, observable.name)
            if effect.runs:
                row[f"{observable.name}_bias_percent"] = 100 * effect.bias
                row[f"{observable.name}_interval_percent"] = 100 * effect.interval(CONFIDENCE)
                row[f"{observable.name}_bound_percent"] = 100 * effect.bound(CONFIDENCE)
        rows.append(row)
    return pd.DataFrame(rows)


def verdict_of(search, setting):
    """Return what the search says of a setting, as it does on the lever's ladder where the setting has one lever."""
    if len(setting) == 1:
        (key, value) = setting[0]
        return dict(search.walk(key)).get(value, search.judge(setting))
    return search.judge(setting)


def work_of(trials, setting):
    """Return the mean work of a setting's runs by the study's estimate; nan where it has none."""
    cost = trials.study.cost
    outcomes = list(trials.of(setting).values())
    return sum(cost.work(o.parameters) for o in outcomes) / len(outcomes) if cost else math.nan


def pareto(rows, name):
    """Return the rows that no other beats in both cost and bound on the observable `name`, cheapest first."""
    front, least = [], math.inf
    for _, row in rows.sort_values("core_seconds").iterrows():
        if row.get(f"{name}_bound_percent", math.inf) < least:
            least = row[f"{name}_bound_percent"]
            front.append(row)
    return pd.DataFrame(front)


def drawn(search, rows):
    """Return the figure: bias with its interval and one run's bound on the headline, against cost; the Pareto front as a line."""
    name = search.observable
    figure, axes = figures.plt.subplots(figsize=(2 * figures.COLUMN_WIDTH, 3.4), layout="constrained")
    keys = list(search.ladders)
    for k, key in enumerate([*keys, "together"]):
        chosen = [i for i, setting in enumerate(search.trials.settings) if belongs(setting, key)]
        if chosen:
            draw_lever(axes, rows.iloc[chosen], search.trials, name, k, key, chosen)
    reference = rows.iloc[0]
    axes.axvline(reference["core_seconds"], color=figures.GREY, linewidth=0.6)
    axes.axhline(100 * search.target, color=figures.GREY, linewidth=0.6, linestyle=":")
    front = pareto(rows, name)
    if len(front):
        axes.step(
            front["core_seconds"],
            front[f"{name}_bound_percent"],
            where="post",
            color=figures.BLACK,
            linewidth=0.7,
            label="one run's error, 90 %: best at the cost",
        )
    axes.set(xscale="log", yscale="log", xlabel="core-seconds of a run", ylabel=f"change of {name} [%]")
    figures.number_logarithmic(axes.xaxis)
    figures.number_logarithmic(axes.yaxis)
    axes.annotate(
        "reference", (reference["core_seconds"], axes.get_ylim()[1]), fontsize=6, rotation=90, va="top", ha="right"
    )
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=6, frameon=False)
    return figure


def belongs(setting, key):
    """True if a setting moves the lever `key` alone, or several where `key` is "together"."""
    return len(setting) > 1 if key == "together" else [k for k, _ in setting] == [key]


def draw_lever(axes, rows, trials, name, k, key, chosen):
    """Draw the biases of one lever's settings with their intervals, each with its value beside it."""
    bias = rows[f"{name}_bias_percent"].abs().clip(lower=100 * ERROR_FLOOR)
    half = rows[f"{name}_interval_percent"]
    low = (bias - half).clip(lower=100 * ERROR_FLOOR)
    style = dict(
        color=COLOURS[k % len(COLOURS)], marker=MARKERS[k % len(MARKERS)], markersize=3.5, linewidth=0.7, capsize=1.5
    )
    axes.errorbar(
        rows["core_seconds"],
        bias,
        [bias - low, half],
        linestyle="-" if key != "together" else "none",
        label=key,
        **style,
    )
    for (_, row), place, number in zip(rows.iterrows(), bias, chosen):
        words = "all" if key == "together" else shown(trials.settings[number][0][1])
        axes.annotate(
            words,
            (row["core_seconds"], place),
            fontsize=5,
            color=style["color"],
            xytext=(2, 2),
            textcoords="offset points",
        )


def parts(search, book, rows):
    """Return the paragraphs of the report."""
    trials, best = search.trials, search.chosen()
    lines = [
        sentence(search, row, setting) for row, setting in zip(rows.to_dict("records"), trials.settings) if setting
    ]
    return [
        f"## Levers of {trials.study.name}: what each changes and costs (`{trials.folder.name}`)",
        f"`{book.command}`; code {book.code_version}, on {book.cpu}; {len(trials.outcomes)} runs,"
        f" {trials.spent:.0f} core-seconds."
        f" Scenes: {book.in_words()}. Reference: {in_words(sorted(trials.reference.items()))}.",
        f"{reference_sentence(search, rows)} Chosen: {in_words(best)}, at"
        f" {share(trials.cost(best) / trials.cost(()))} of its cost.",
        f"![error against cost](figures/{trials.folder.name}-levers.png)",
        "Points: bias with its 90 % interval, from runs of the same scene and seed. Line: the size below which one more run's"
        " difference from the reference lies in nine of ten cases, for the best setting at each cost.",
        "\n".join(f"- {line}" for line in lines) or "No lever could be varied.",
        *[f"`{in_words(t.setting)}` fails: {words}" for t, words in trials.failed.items()],
        seeds_sentence(search, rows),
        markdown(search, rows),
    ]


def reference_sentence(search, rows):
    """Return what a run at the reference costs, and how far one lies from the mean."""
    effect, first = search.trials.effect((), search.observable), rows.iloc[0]
    return (
        f"A run at the reference takes {first['core_seconds']:.0f} core-seconds and {first['memory_MB']:.0f} MB;"
        f" its {search.observable} scatters by {100 * effect.spread:.2g} %."
    )


def seeds_sentence(search, rows):
    """Return the cheapest way to the target by the mean over seeds: which setting, how many runs, at what cost."""
    known = rows[rows["runs_to_target"].map(math.isfinite)]
    if not len(known):
        return f"By what was measured no number of seeds brings the mean of {search.observable} to {100 * search.target:g} %."
    best = known.loc[(known["runs_to_target"] * known["core_seconds"]).idxmin()]
    runs, seconds = int(best["runs_to_target"]), best["runs_to_target"] * best["core_seconds"]
    return (
        f"{search.observable} to {100 * search.target:g} % at {100 * CONFIDENCE:.0f} % confidence is cheapest as the mean of"
        f" {runs} run{'s' * (runs > 1)}, each with another seed, of {best['setting']}: {seconds:.0f} core-seconds."
    )


def sentence(search, row, setting):
    """Return one setting in plain words: what it changes, what it costs, and what the search says of it."""
    effect = search.trials.effect(setting, search.observable)
    return (
        f"{row['setting']} changes {search.observable} by {with_error(100 * effect.bias, 100 * effect.interval(CONFIDENCE))} %"
        f" and costs {share(row['cost_share'])} of the reference: {row['verdict']} ({effect.runs} runs)"
    )


def share(value):
    """Return a share of a cost in words."""
    return f"{value:.2g}" if math.isfinite(value) else "an unknown part"


def markdown(search, rows):
    """Return the table of all observables: bias with its interval, and one run's bound, in percent."""
    names = [o.name for o in search.trials.study.observables if f"{o.name}_bias_percent" in rows]
    heading = ["setting", "core-s", "MB", "runs", *names]
    lines = ["| " + " | ".join(heading) + " |", "|---" * len(heading) + "|"]
    for row in rows.to_dict("records"):
        cells = [row["setting"], f"{row['core_seconds']:.3g}", f"{row['memory_MB']:.0f}", str(row["runs"])]
        cells += [cell(row, name) for name in names]
        lines.append("| " + " | ".join(cells) + " |")
    return "Change in % with its 90 % interval, in brackets one run's bound:\n\n" + "\n".join(lines)


def cell(row, name):
    """Return bias, interval and bound of one observable in a cell."""
    bias, half, bound = (row.get(f"{name}_{part}_percent", math.nan) for part in ("bias", "interval", "bound"))
    if not math.isfinite(bias):
        return "-"
    return f"{with_error(bias, half)} ({bound:.2g})" if math.isfinite(half) else f"{bias:.2g}"
