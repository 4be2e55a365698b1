"""The drift of a body that is shaken: its mean velocity to its arrest, by phase of the cycle, and how it swings within one."""

from dataclasses import dataclass

import numpy as np

from .statistics import block_mean

SKIPPED = 0.1  # of a run, before averages begin
REST = 0.25  # [d] how far the mean of a cycle may stray from the final height of a body at rest
LONG_REST = 8  # a rest counts if the body would else have gone so many times as far


@dataclass(frozen=True)
class Drift:
    """Mean velocity with standard error over whole cycles, and the cycle means it rests on.

    The cycles lie between the times `start`, when the first one begins, and `end`, when the last one ends; `cycle_t`,
    `cycle_y` (cycles,) are the middles and mean positions of all cycles of the run. `resolved` is False where the increments are
    too few, or correlated over the whole run: the error is then likely too small (`statistics.Mean`).
    """

    rate: float
    error: float
    start: float
    end: float
    cycle_t: np.ndarray
    cycle_y: np.ndarray
    resolved: bool


def drift(t, y, period, *, skip=SKIPPED, rest=REST):
    """Return the `Drift` of a body that is shaken with `period`: mean of the cycle means' increments over the period.

    `t`, `y` (n,): time and position, t rising. A cycle counts if its middle lies behind the first part `skip` of the run.
    If the body comes to rest at its final position the average ends there (`end_of_motion`), else with the run's last whole
    cycle. With fewer than two cycles that count the rate is NaN.
    """
    t, y = np.asarray(t, dtype=float), np.asarray(y, dtype=float)
    cycle_t, cycle_y = cycle_means(t, y, period)
    first = int(np.searchsorted(cycle_t, t[0] + skip * (t[-1] - t[0]))) if len(t) else 0
    last = end_of_motion(cycle_y, first, rest)
    if last - first < 2:
        return Drift(float("nan"), float("nan"), float("nan"), float("nan"), cycle_t, cycle_y, False)
    steps = block_mean(np.diff(cycle_y[first:last]) / period)
    start, end = (float(t[0] + period * cycles) for cycles in (first, last))
    return Drift(steps.value, steps.error, start, end, cycle_t, cycle_y, steps.resolved)


def cycle_means(t, y, period):
    """Return (times of the middles, mean positions) of the whole periods that a series covers; trapezoidal in time."""
    cycles = int((t[-1] - t[0]) / period * (1 + 1e-12)) if len(t) > 1 else 0
    edges = t[0] + period * np.arange(cycles + 1) if cycles else np.zeros(1)
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(t))]) if cycles else np.zeros(1)
    integral_at_edges = np.array([integral_to(edge, t, y, integral) for edge in edges]) if cycles else np.zeros(1)
    return 0.5 * (edges[1:] + edges[:-1]), np.diff(integral_at_edges) / period


def integral_to(edge, t, y, integral):
    """Return the integral of the piecewise linear y(t) from t[0] to `edge`."""
    k = int(np.clip(np.searchsorted(t, edge, side="right") - 1, 0, len(t) - 2))
    y_edge = np.interp(edge, t, y)
    return integral[k] + 0.5 * (y[k] + y_edge) * (min(edge, t[-1]) - t[k])


def end_of_motion(cycle_y, first, rest=REST):
    """Return the number of cycles until the body has come to rest at its final position; all of them if it has not.

    It rests if cycle means stay within `rest` of the final position for five cycles and a tenth of the run or more, and
    for so long that at its speed until then it would have gone LONG_REST times as far: a slow body only seems to rest.
    """
    if len(cycle_y) == 0:
        return 0
    moving = np.flatnonzero(np.abs(cycle_y - cycle_y[-5:].mean()) > rest)
    arrival = int(moving[-1]) + 2 if len(moving) else 0
    resting = len(cycle_y) - arrival
    if arrival - first < 2 or resting < max(5, 0.1 * len(cycle_y)):
        return len(cycle_y)
    speed = abs(cycle_y[arrival - 1] - cycle_y[first]) / (arrival - 1 - first)
    return arrival if speed * resting >= LONG_REST * rest else len(cycle_y)


def phase_rates(t, y, period, start, end, parts=20):
    """Return (phases, rates, errors), each (parts,): mean velocity of a shaken body in each part of the cycle.

    `t`, `y` (n,): time from the drive's start, and position, interpolated linearly; whole cycles between the times `start`
    and `end` count. Phases are the parts' middles in cycles, in (0, 1); errors are standard errors over the cycles.
    NaN where no whole cycle lies between, errors NaN where only one does.
    """
    phases, found = middles(parts), rates_by_cycle(t, y, period, start, end, parts)
    if not len(found):
        return phases, np.full(parts, np.nan), np.full(parts, np.nan)
    means = [block_mean(column) for column in found.T]
    return phases, np.array([m.value for m in means]), np.array([m.error for m in means])


def middles(parts):
    """Return the phases (parts,) of the parts' middles, in cycles."""
    return (np.arange(parts) + 0.5) / parts


def rates_by_cycle(t, y, period, start, end, parts=20):
    """Return the mean velocity in each part of each whole cycle between the times `start` and `end`, shape (cycles, parts)."""
    first, last = np.ceil(start / period - 1e-9), np.floor(end / period + 1e-9)
    if not last > first:  # also where the times are NaN: nothing was averaged
        return np.zeros((0, parts))
    edges = period * (first + np.arange(int(last - first) * parts + 1) / parts)
    return np.diff(np.interp(edges, t, y)).reshape(-1, parts) * parts / period


def phase_sum(t, y, period, start, end, weights):
    """Return the `Mean` of a sum over the parts of a cycle of `weights` (parts,) times the velocity there; None without a cycle.

    The sum is taken cycle by cycle: what happens in one part of a cycle has to do with what happens in the next.
    """
    found = rates_by_cycle(t, y, period, start, end, len(weights))
    return block_mean(found @ np.asarray(weights, dtype=float)) if len(found) else None
