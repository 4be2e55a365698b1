"""A report without a paper's claims: every observable against every key that was varied, as figures and as a table."""

from dataclasses import dataclass
from numbers import Real
from urllib.parse import quote

import numpy as np

from .. import figures, quantities
from ..measured import Measured
from .plots import COLOURS, MARKERS, draw_points
from .runs import measurements
from .what_was_run import number, settings, table_of

MOST_LABELS = 12  # curves of a panel that a legend can name
PANEL = (2.2, 2.2)  # width and height of a panel's axes [inches]
LEGEND_WIDTH = 1.4  # [inches]
BREADTH = 0.5  # of the step from word to word, over which the curves stand side by side
LOGARITHMIC_FROM = 30  # ratio of the largest to the smallest value from which a key's axis is logarithmic
HOW = (
    "Values are means over seeds. Their error is the standard error by the scatter of the seeds, or that by the runs' own "
    "errors if it is larger: two or three seeds may lie together by chance."
)


@dataclass(frozen=True)
class Shown:
    """An observable as a report shows it: its `name`, its `unit`, its `meaning`."""

    name: str
    unit: str
    meaning: str


def as_markdown(campaign, observables=()):
    """Return the report of a `Campaign` as Markdown; draws its figures.

    `observables` have name, unit and meaning, as a study's `Observable`s; without any all quantities that have an error are
    shown.
    """
    shown = observables or measured_with_errors(campaign)
    plan = campaign.plan
    parts = [f"## Runs of {plan['study']} (`{plan['name']}`)", settings(campaign), HOW]
    sweeps = list(dict.fromkeys(sweep for sweeps in campaign.table["sweeps"] for sweep in sweeps.split()))
    with figures.plt.rc_context(figures.STYLE):
        return "\n\n".join(parts + [part for sweep in sweeps for part in sweep_parts(campaign, sweep, shown)]) + "\n"


def measured_with_errors(campaign):
    """Return a `Shown` for every quantity of the runs' summaries that has an error."""
    table = campaign.table
    units = campaign.units(table["run"].iloc[0])
    names = [name.removesuffix("_err") for name in table if name.endswith("_err")]
    return [Shown(name, units.get(name, "-"), quantities.meaning_of("summary", name)) for name in names]


def column_of(table, name):
    """Return the column that holds a quantity, NAME_measured where a key has its name; None if no run has it."""
    return next((column for column in (f"{name}_measured", name) if column in table), None)


# ---- a sweep ---------------------------------------------------------------------------------------------------------


def sweep_parts(campaign, sweep, shown):
    """Return the paragraphs on one sweep: its table, and a figure of each observable that its runs have; draws the figures."""
    rows = campaign.sweep(sweep)
    lacking = [f"`{observable.name}`" for observable in shown if not values_of(rows, observable.name)]
    shown = [observable for observable in shown if values_of(rows, observable.name)]
    keys = [key for key in campaign.varied(rows) if key != "seed"]
    units = campaign.units(rows["run"].iloc[0])
    parts = [f"### Sweep `{sweep}`", table_of_values(rows, keys, units, shown)]
    if lacking and len(rows):
        parts.append(f"No run of this sweep gives a number of {', '.join(lacking)}.")
    if not keys:
        return parts + ["No key but the seed varies, so there is nothing to draw against."]
    for observable in shown:
        name = f"{campaign.plan['name']}-{sweep}-{observable.name}"
        figures.save_as(drawn(rows, keys, units, observable), campaign.folder / "figures", name)
        parts += [f"![{observable.name}](figures/{quote(name)}.png)", caption(keys, observable)]
    return parts


def table_of_values(rows, keys, units, shown):
    """Return a Markdown table with a line for each setting of the keys: values, number of runs, observables with errors."""
    heading = [*(with_unit(key, units.get(key)) for key in keys), "runs", *(with_unit(o.name, o.unit) for o in shown)]
    lines = [
        [*map(number, setting), len(group), *(in_cell(over_seeds(group, o.name)) for o in shown)]
        for setting, group in groups(rows, keys)
    ]
    return table_of(heading, lines)


def in_cell(measured):
    """Return a `Measured` in words, a dash where there is no value."""
    return str(measured) if np.isfinite(measured.value) else "–"


def with_unit(name, unit):
    """Return a name with its unit as on an axis: "drag [N]"."""
    return f"{name} [{unit}]" if unit and unit != "-" else name


def caption(keys, observable):
    """Return the sentence below a figure."""
    meaning = f": {observable.meaning}" if observable.meaning else ""
    return f"`{with_unit(observable.name, observable.unit)}`{meaning}; against {', '.join(f'`{key}`' for key in keys)}."


def groups(rows, keys):
    """Return [(setting, rows)] of the runs that share their values of `keys`; one with the setting () where there are none."""
    if not keys:
        return [((), rows)]
    settings_of = rows[keys].astype(object).apply(tuple, axis=1)
    return [(setting, rows[[s == setting for s in settings_of]]) for setting in dict.fromkeys(settings_of)]


def values_of(rows, name):
    """Return a quantity of each run that has it, a list of `Measured`."""
    column = column_of(rows, name)
    return measurements(rows.assign(**{name: rows[column]}), name) if column else []


def over_seeds(rows, name):
    """Return a quantity of runs that differ in their seeds alone, as `Measured`.

    The error is the larger of the scatter's, s/sqrt(n), and that of the runs' own errors, sqrt(sum of e^2)/n; the scatter of a
    few seeds may be small by chance. A single run has its own error.
    """
    found = values_of(rows, name)
    if len(found) == 1:
        return found[0]
    values, errors = np.array([(m.value, m.error) for m in found]).reshape(-1, 2).T
    if not len(values):
        return Measured(float("nan"), float("nan"))
    by_scatter, by_runs = values.std(ddof=1) / np.sqrt(len(values)), np.sqrt(np.sum(errors**2)) / len(values)
    return Measured(float(values.mean()), float(np.fmax(by_scatter, by_runs)))  # errors may be unknown, nan


# ---- a figure --------------------------------------------------------------------------------------------------------


def drawn(rows, keys, units, observable):
    """Return the figure of one observable: a panel for each key, in it a curve for each setting of the other keys."""
    curves = [groups(rows, [other for other in keys if other != key]) for key in keys]
    named = any(1 < len(found) <= MOST_LABELS for found in curves)
    width = len(keys) * (PANEL[0] + LEGEND_WIDTH * named) + 0.6
    figure, (panels,) = figures.plt.subplots(
        1, len(keys), figsize=(width, PANEL[1]), squeeze=False, layout="constrained"
    )
    for axes, key, found in zip(panels, keys, curves):
        places = places_of(axes, rows[key])
        for k, (setting, group) in enumerate(found):
            label = ", ".join(f"{other} {number(v)}" for other, v in zip((o for o in keys if o != key), setting))
            look = dict(color=COLOURS[k % 6], marker=MARKERS[(k + k // 6) % 6], label=label)
            if are_words(rows[key]):  # nothing lies between words, so no line; curves stand side by side
                beside = BREADTH * (k - (len(found) - 1) / 2) / len(found)
                draw_curve(axes, group, key, observable.name, lambda v: places(v) + beside, linestyle="none", **look)
            else:
                draw_curve(axes, group, key, observable.name, places, **look)
        axes.set(xlabel=with_unit(key, units.get(key)), ylabel=with_unit(observable.name, observable.unit))
        if 1 < len(found) <= MOST_LABELS and axes.containers:  # beside the axes, where no data are
            axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1), borderaxespad=0, frameon=False)
    return figure


def draw_curve(axes, rows, key, name, places, **look):
    """Draw a quantity against a key at `places(value)`; settings without a value, and curves without any, are left out."""
    points = [(places(value), over_seeds(group, name)) for (value,), group in groups(rows, [key])]
    points = sorted((point for point in points if np.isfinite(point[1].value)), key=lambda point: point[0])
    if points:
        draw_points(axes, [x for x, _ in points], [measured for _, measured in points], **look)


def are_words(column):
    """True if one of a key's values is a word or a switch."""
    return not all(isinstance(value, Real) and not isinstance(value, (bool, np.bool_)) for value in column)


def places_of(axes, column):
    """Return the function from a key's value to its place on the axis, whose scale and marks are set here.

    Numbers stand at their value, on a logarithmic axis where they are positive and span a factor of 30; if one value is a
    word or a switch, all stand side by side in the order of their names.
    """
    values = list(dict.fromkeys(column))
    if not are_words(values):
        if min(values) > 0 and max(values) >= LOGARITHMIC_FROM * min(values):
            axes.set_xscale("log")
        return float
    words = sorted(map(number, values))
    axes.set_xticks(range(len(words)), words)
    axes.set_xlim(-0.5, len(words) - 0.5)
    return lambda value: words.index(number(value))
