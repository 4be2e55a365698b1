"""How far a run has drifted from the same run with longer numbers, and how fast: by a power of time, or by exp(rate t)."""

from decimal import Decimal, localcontext

import numpy as np

from ..measured import UNKNOWN, Measured
from ..statistics import block_mean

DIGITS = 180  # more than any of the numbers has
PREDICTED = 1e-2  # distance up to which a run predicts where the grains are [d]
FIRST_CONTACTS = 2.0  # until which disks touch for the first time, and distances turn towards what grows [t_0]
FEWEST = 4  # rows that a rate or an order is taken from
SKIPPED = 0.1  # share of a run at its start that the power of time leaves out


def distances(place, truth, period=0.0):
    """Return how far each grain is from the truth [d], (n, m), from texts of decimal digits (n, 2m); nearest periodic images.

    The difference is taken with 180 digits and then rounded: doubles would lose it.
    """
    with localcontext() as context:
        context.prec = DIGITS
        apart = [[float(Decimal(a) - Decimal(b)) for a, b in zip(*rows)] for rows in zip(place, truth)]
    apart = np.array(apart).reshape(len(apart), -1, 2)
    if period:
        apart -= period * np.round(apart / period)
    return np.hypot(apart[..., 0], apart[..., 1])


def root_mean_square(apart):
    """Return the distance of all grains together (n,), the root of the mean square over the grains."""
    return np.sqrt((apart**2).mean(axis=1))


def horizon(t, distance):
    """Return the time at which a distance (n,) first reaches `PREDICTED`, NaN if it never does."""
    beyond = np.flatnonzero(distance >= PREDICTED)
    return float(t[beyond[0]]) if len(beyond) else float("nan")


def growing(t, distance):
    """Return which rows (n,) a rate is taken from: behind `FIRST_CONTACTS`, until the distance first reaches `PREDICTED`."""
    beyond = np.cumsum(distance >= PREDICTED) > 0
    return (t >= FIRST_CONTACTS) & ~beyond & (distance > 0)


def growth_rate(t, distance):
    """Return the Lyapunov rate, d ln(distance)/dt, as `Measured`: the mean of its growth from row to row, error by blocking.

    The rate of a stretch of a trajectory differs from that of others: the error says by how much.
    """
    rows = growing(t, distance)
    if rows.sum() < FEWEST:
        return UNKNOWN
    growth = block_mean(np.diff(np.log(distance[rows])) / np.diff(t[rows]))
    return Measured(growth.value, growth.error)


def power_of_time(t, apart):
    """Return the power of time by which distances (n, m) grow, the mean of the grains' own powers, as `Measured`.

    Each is the slope of ln(distance) against ln(t), even weight by ln(t); grains that do not touch each other are repeats.
    """
    late = t >= SKIPPED * t[-1]
    if late.sum() < FEWEST:
        return UNKNOWN
    x, weight = np.log(t[late]), np.sqrt(1 / t[late])
    with np.errstate(divide="ignore"):
        y = np.log(apart[late])
    slopes = np.array([np.polyfit(x, column, 1, w=weight)[0] for column in y.T if np.isfinite(column).all()])
    if len(slopes) < 2:
        return UNKNOWN
    return Measured(float(slopes.mean()), float(slopes.std(ddof=1) / np.sqrt(len(slopes))))
