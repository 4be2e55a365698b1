"""What the runs of a campaign will cost, from the study's estimate and from the runs that are there already."""

import statistics

from ..runs import summary_file
from ..study import duration


def in_words(folder, plan, todo, cores):
    """Return in one line what the runs `todo` will cost, or why nobody knows."""
    if not todo:
        return "nothing is left to run"
    cost = plan.study.cost
    estimate = cost.core_seconds if cost else alike
    measured = ratios(folder, plan, todo, estimate)
    if not measured and not cost:
        return "what they cost is known once one of them is done"
    factor = statistics.median(measured) if measured else 1.0
    seconds = [factor * estimate(run.parameters) for run in todo]
    work = f"{sum(cost.work(run.parameters) for run in todo):.2g} {cost.unit}, " if cost else ""
    basis = f"as {len(measured)} runs that are there took" if measured else "estimated, packings aside"
    wall = max(sum(seconds) / cores, max(seconds))
    return f"{work}about {duration(sum(seconds))} of processor time, {duration(wall)} on {cores} cores ({basis})"


def alike(_parameters):
    """Stand for an estimate where there is none: all runs cost the same."""
    return 1.0


def ratios(folder, plan, todo, estimate):
    """Return the measured over the estimated cost of each run that is there already."""
    left = {run.name for run in todo}
    done = [run for run in plan.runs if run.name not in left]
    taken = [(run, summary_file.read(folder / "runs" / run.name).get("wall_s")) for run in done]
    return [seconds / estimate(run.parameters) for run, seconds in taken if seconds]
