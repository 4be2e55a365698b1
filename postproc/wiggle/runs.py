"""What the report of a wiggle campaign takes from its runs: rise rates over periods, zeros of curves, rates by phase, fields."""

import numpy as np

from .. import fields
from ..campaign.runs import at, curve, quantity
from ..campaign.verdicts import SIGMAS
from ..drift import drift
from ..drift import phase_sum as phase_sum_over
from ..measured import UNKNOWN, Limit, Measured, mean_of
from .cavity_model import CavityModel

SHAPES = ("disk", "square", "tall", "wide", "triangle")  # OS1 to OS5
TITLES = dict(zip(SHAPES, ("disk, OS1", "square, OS2", "tall rectangle, OS3", "wide rectangle, OS4", "triangle, OS5")))
RATE = "rise_rate"
TURN = 2.0  # period between sinking and rising at A = 3 d, section 3.2
NEGLIGIBLE = 0.1  # of the fastest motion: our reading of the paper's "negligible"


def by_shape(rows):
    """Yield (shape, its rows): the paper's five in their order, then others by name."""
    found = list(dict.fromkeys(rows["shape"]))
    for shape in sorted(found, key=lambda s: (SHAPES.index(s) if s in SHAPES else len(SHAPES), s)):
        yield shape, rows[rows["shape"] == shape]


def of_shapes(rows, *shapes):
    """Return the rows of one or several shapes."""
    return rows[rows["shape"].isin(shapes)]


def title(shape):
    """Return a shape's name with the paper's number."""
    return TITLES.get(shape, shape)


def rates(rows):
    """Return (periods, rise rates as `Measured`) of rows that differ in period and seed only."""
    return curve(rows, "period", RATE) if len(rows) else (np.zeros(0), [])


def least_rate(rows):
    """Return the lowest rise rate over the periods, UNKNOWN without runs."""
    return min(rates(rows)[1], key=lambda m: m.value, default=UNKNOWN)


def fastest_rise(rows):
    """Return the largest rise rate over the periods, UNKNOWN without runs."""
    return max(rates(rows)[1], key=lambda m: m.value, default=UNKNOWN)


def rate_at(rows, period):
    """Return the rise rate at one period, UNKNOWN without a run there."""
    return quantity(at(rows, period=period), RATE)


def mean_rise(rows):
    """Return the mean rise rate over the periods beyond TURN: a maximum would grow with the noise of what it is taken from."""
    return mean_over(rates(rows[rows["period"] > TURN])[1])


def largest_motion(rows):
    """Return the rise rate of largest size over the periods, without its sign; UNKNOWN without runs."""
    return max(map(abs, rates(rows)[1]), key=lambda m: m.value, default=UNKNOWN)


def first_rising_period(rows):
    """Return the period at which the rise rate turns positive on the way to its maximum, as `Measured`; see `last_zero`."""
    return last_zero(*rates(rows))


def smallest_moving_amplitude(rows):
    """Return the amplitude at which the rise rate reaches a tenth of its largest, as `Measured`; see `last_zero`."""
    amplitudes, points = curve(rows, "amplitude", RATE)
    largest = max(points, key=lambda m: m.value)
    level = Measured(NEGLIGIBLE * largest.value, NEGLIGIBLE * largest.error)
    return last_zero(amplitudes, [point - level for point in points])


def last_zero(x, points):
    """Return where a curve through points (n `Measured`) at rising x (n,) turns positive on the way to its maximum.

    Linear between the two points about the zero; the error is that of the two. Where all points below the maximum are
    positive, or none is, a `Limit`: the zero lies below the first that is so by two standard errors, or above the last that
    is not. UNKNOWN where there is none.
    """
    values, errors = np.array([(m.value, m.error) for m in points]).reshape(-1, 2).T
    if not len(values):
        return UNKNOWN
    best = int(values.argmax())
    below = np.flatnonzero(values[:best] <= 0)
    if values[best] > 0 and len(below):
        k = int(below[-1])
        return zero_between(x[k], points[k], x[k + 1], points[k + 1])
    if values[best] > 0:
        surely = x[values - SIGMAS * errors > 0]
        return Limit(float(surely[0]), np.nan, "<") if len(surely) else UNKNOWN
    surely = x[values + SIGMAS * errors < 0]
    return Limit(float(surely[-1]), np.nan, ">") if len(surely) else UNKNOWN


def zero_between(x_low, low, x_high, high):
    """Return the zero of the line through two `Measured` points at exact x, low <= 0 < high, as `Measured`."""
    rise, step = high.value - low.value, x_high - x_low
    error = step * np.hypot(high.value * low.error, low.value * high.error) / rise**2
    return Measured(float(x_low - low.value * step / rise), float(error))


def model_of(rows):
    """Return the cavity model of the body of these rows (one shape)."""
    first = rows.iloc[0]
    return CavityModel(float(first["fall_height"]), float(first["intruder_height"]))


# ---- by phase --------------------------------------------------------------------------------------------------------


def phase_curve(campaign, rows):
    """Return (phases (parts,), rise rates by phase over repeats, a list of `Measured`)."""
    groups = [campaign.run(name).group("phase") for name in rows["run"]]
    columns = zip(*(zip(g["vy"], g["vy_err"]) for g in groups))
    return groups[0]["phase"], [mean_of([Measured(float(v), float(e)) for v, e in column]) for column in columns]


def phase_sum(campaign, rows, weights):
    """Return the sum over the parts of a cycle of `weights` (parts,) times V_y there, over repeats, as `Measured`."""
    return mean_of([found for name in rows["run"] if (found := phase_sum_of(campaign.run(name), weights))])


def phase_sum_of(run, weights):
    """Return that sum of one run, as `Mean`; None where the run holds no whole cycle."""
    t, y, period = run.series["t"], run.series["y"], float(run.parameters["period"])
    window = drift(t, y, period)
    return phase_sum_over(t, y, period, window.start, window.end, weights)


# ---- means -----------------------------------------------------------------------------------------------------------


def mean_over(points):
    """Return the mean of independent `Measured` numbers, UNKNOWN of none."""
    if not points:
        return UNKNOWN
    values, errors = np.array([(m.value, m.error) for m in points]).T
    return Measured(float(values.mean()), float(np.sqrt(np.sum(errors**2)) / len(points)))


# ---- fields ----------------------------------------------------------------------------------------------------------


def field_runs(campaign, rows):
    """Return the `Fields` of all repeats."""
    return [fields.read(campaign.run(name), "around") for name in rows["run"]]
