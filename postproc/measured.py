"""Numbers with standard errors: combined over repeats, divided, subtracted, and fitted by lines and power laws."""

from dataclasses import dataclass

import numpy as np

from ..base.numbers import with_error

FEWEST_REPEATS = 3  # with fewer, their scatter says too little about their error


@dataclass(frozen=True)
class Measured:
    """A value and its standard error, in the same unit; the error is NaN where it is not known."""

    value: float
    error: float

    def __str__(self):
        return with_error(self.value, self.error)

    def __abs__(self):
        """The number without its sign."""
        return Measured(abs(self.value), self.error)

    def __sub__(self, other):
        other = exactly(other)
        return Measured(self.value - other.value, float(np.hypot(self.error, other.error)))

    def __truediv__(self, other):
        """The ratio of independent measurements, error to first order; infinite errors where the divisor may be zero."""
        other = exactly(other)
        if abs(other.value) <= other.error or other.value == 0:
            return Measured(float("nan"), float("inf"))
        ratio = self.value / other.value
        return Measured(ratio, float(np.hypot(self.error / other.value, ratio * other.error / other.value)))


UNKNOWN = Measured(float("nan"), float("nan"))


def exactly(number):
    """Return a plain number as a `Measured` without error."""
    return number if isinstance(number, Measured) else Measured(float(number), 0.0)


def mean_of(repeats):
    """Return the mean of independent repeats (a sequence of `Measured`) with its standard error.

    The error is the larger of what the repeats' own errors give and, from three repeats on, of what their scatter
    gives: repeats that scatter more than they should have errors that are too small. Where an own error is unknown the
    scatter decides alone.
    """
    if not repeats:
        return UNKNOWN
    values, errors = np.array([(m.value, m.error) for m in repeats], dtype=float).T
    n = len(values)
    own = float(np.sqrt(np.sum(errors**2)) / n)
    scatter = float(np.std(values, ddof=1) / np.sqrt(n)) if n >= FEWEST_REPEATS else float("nan")
    return Measured(float(values.mean()), own if np.isnan(scatter) else float(np.fmax(own, scatter)))


def birge_ratio(groups):
    """Return by how much repeats scatter more than their own errors say, pooled over groups of `Measured`; at least 1.

    sqrt(chi²/freedom) of the repeats about their groups' weighted means (R. T. Birge, Phys. Rev. 40, 207, 1932). Many
    groups of two or three repeats, none of which says much of its own error, say together whether errors are too small.
    Repeats without a known error do not count; 1 where nothing is repeated.
    """
    chi_squared, freedom = 0.0, 0
    for group in groups:
        values, errors = np.array([(m.value, m.error) for m in group], dtype=float).reshape(-1, 2).T
        known = np.isfinite(values) & np.isfinite(errors) & (errors > 0)
        if known.sum() > 1:
            values, weights = values[known], errors[known] ** -2
            mean = np.sum(weights * values) / weights.sum()
            chi_squared, freedom = (
                chi_squared + float(np.sum(weights * (values - mean) ** 2)),
                freedom + known.sum() - 1,
            )
    return max(1.0, float(np.sqrt(chi_squared / freedom))) if freedom else 1.0


@dataclass(frozen=True)
class Limit(Measured):
    """A bound where a number was not reached: its value lies above `value` (`side` ">") or below it ("<")."""

    side: str = ">"

    def __str__(self):
        return f"{self.side} {self.value:.4g}"

    def excludes(self, low, high):
        """True if no number between `low` and `high` is possible."""
        return self.value >= high if self.side == ">" else self.value <= low


def polynomial_through(x, points, degree):
    """Return the coefficients, highest power first, of the polynomial through points (n `Measured`) at exact x (n,).

    Least squares weighted by the errors. Errors of the result grow by sqrt(chi²/(n − degree − 1)) where that is above 1
    (Birge): points that no such polynomial fits do not make precise coefficients. Too few points, or a point without a
    known error, give unknown coefficients.
    """
    x = np.asarray(x, dtype=float)
    y, sigma = np.array([(m.value, m.error) for m in points], dtype=float).reshape(-1, 2).T
    if len(set(x)) < degree + 1 or not np.all(np.isfinite(y) & np.isfinite(sigma) & (sigma > 0)):
        return [UNKNOWN] * (degree + 1)
    design = np.vander(x, degree + 1) / sigma[:, None]
    coefficients, *_ = np.linalg.lstsq(design, y / sigma, rcond=None)
    errors = np.sqrt(np.diag(np.linalg.pinv(design.T @ design)))
    freedom = len(x) - degree - 1
    chi_squared = float(np.sum((y / sigma - design @ coefficients) ** 2))
    factor = np.sqrt(max(1.0, chi_squared / freedom)) if freedom > 0 else 1.0
    return [Measured(float(c), float(factor * e)) for c, e in zip(coefficients, errors)]


def power_of(x, points):
    """Return the exponent of the power law through positive points (n `Measured`) at exact x > 0, as `Measured`."""
    if any(not m.value > 0 for m in points):
        return UNKNOWN
    logarithms = [Measured(float(np.log(m.value)), m.error / m.value) for m in points]
    return polynomial_through(np.log(x), logarithms, 1)[0]


def steepest_place(x, points, draws=400, seed=1):
    """Return where a curve through points (n `Measured`) at rising x (n,) rises fastest, as `Measured`.

    It is the middle of the interval with the largest difference quotient. The error adds in squares the interval's half
    width and the scatter of that middle when the points are drawn anew within their errors.
    """
    x = np.asarray(x, dtype=float)
    values, errors = np.array([(m.value, m.error) for m in points], dtype=float).reshape(-1, 2).T
    if len(x) < 3 or not np.all(np.isfinite(values) & np.isfinite(errors)):
        return UNKNOWN
    middles, widths = 0.5 * (x[1:] + x[:-1]), np.diff(x)
    drawn = np.random.default_rng(seed).normal(values, errors, (draws, len(x)))
    scatter = middles[np.argmax(np.diff(drawn, axis=1) / widths, axis=1)].std()
    best = int(np.argmax(np.diff(values) / widths))
    return Measured(float(middles[best]), float(np.hypot(widths[best] / 2, scatter)))
