"""Estimates the cost of a campaign's runs from the study's estimate and from the complete runs."""

import statistics

from ..runs import summary_file
from ..study import duration


def in_words(folder, plan, todo, cores):
    """Return a line on the cost of the runs `todo`, or on why it is unknown."""
    if not todo:
        return "nothing is left to run"
    cost = plan.study.cost
    estimate = cost.core_seconds if cost else alike
    measured = ratios(folder, plan, todo, estimate)
    if not measured and not cost:
        return "their cost is known only after one of them is complete"
    factor = statistics.median(measured) if measured else 1.0
    seconds = [factor * estimate(run.parameters) for run in todo]
    work = f"{sum(cost.work(run.parameters) for run in todo):.2g} {cost.unit}, " if cost else ""
    basis = f"from {len(measured)} complete runs" if measured else "estimated, without packings"
    wall = max(sum(seconds) / cores, max(seconds))
    return f"{work}about {duration(sum(seconds))} of processor time, {duration(wall)} on {cores} cores ({basis})"


def alike(_parameters):
    """Replace a missing estimate: all runs cost the same."""
    return 1.0


def ratios(folder, plan, todo, estimate):
    """Return the measured over the estimated cost of each complete run."""
    left = {run.name for run in todo}
    done = [run for run in plan.runs if run.name not in left]
    taken = [(run, summary_file.read(folder / "runs" / run.name).get("wall_s")) for run in done]
    return [seconds / estimate(run.parameters) for run, seconds in taken if seconds]
