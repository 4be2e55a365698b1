"""What the runs of a campaign will cost, from the report's estimate and from the runs that are there already."""

import math
import statistics

from ..run_place import read_summary
from .plan import report_module


def in_words(folder, plan, todo, cores):
    """Return in one line what the runs `todo` will cost, or why nobody knows."""
    if not todo:
        return "nothing is left to run"
    estimate = estimator(plan)
    measured = ratios(folder, plan, todo, estimate or alike)
    if not measured and not estimate:
        return "what they cost is known once one of them is done"
    factor = statistics.median(measured) if measured else 1.0
    seconds = [factor * (estimate or alike)(run.parameters.dict()) for run in todo]
    basis = f"as {len(measured)} runs that are there took" if measured else "estimated, packings aside"
    wall = max(sum(seconds) / cores, max(seconds))
    return f"about {duration(sum(seconds))} of processor time, {duration(wall)} on {cores} cores ({basis})"


def estimator(plan):
    """Return the report's function from parameters to core-seconds; None if it has none."""
    return getattr(report_module(plan.report), "expected_core_seconds", None) if plan.report else None


def alike(_parameters):
    """Stand for an estimate where there is none: all runs cost the same."""
    return 1.0


def ratios(folder, plan, todo, estimate):
    """Return the measured over the estimated cost of each run that is there already."""
    left = {run.name for run in todo}
    done = [run for run in plan.runs if run.name not in left]
    taken = [(run, read_summary(folder / "runs" / run.name).get("wall_s")) for run in done]
    return [seconds / estimate(run.parameters.dict()) for run, seconds in taken if seconds]


def duration(seconds):
    """Return a duration in words: "40 s", "12 min", "3.5 h", "12 days"."""
    for unit, size in (("days", 86400), ("h", 3600), ("min", 60)):
        if seconds >= 2 * size:
            number = seconds / size
            return f"{number:.1f} {unit}" if number < 10 else f"{number:.0f} {unit}"
    return f"{math.ceil(seconds)} s"
