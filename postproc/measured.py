"""Numbers with standard errors: combined over repeats, divided, subtracted, and fitted by lines and power laws."""

from dataclasses import dataclass

import numpy as np

FEWEST_REPEATS = 3  # with fewer, their scatter says too little about their error


@dataclass(frozen=True)
class Measured:
    """A value and its standard error, in the same unit; the error is NaN where it is not known."""

    value: float
    error: float

    def __str__(self):
        if not np.isfinite(self.error) or self.error == 0:
            return f"{self.value:.4g}" + (" (error unknown)" if np.isnan(self.error) else "")
        digits = max(0, 1 - int(np.floor(np.log10(self.error))))
        return f"{self.value:.{digits}f} ± {self.error:.{digits}f}"

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


def line_through(x, points):
    """Return (slope, intercept) of the straight line through points (n `Measured`) at exact x (n,), as `Measured`.

    Least squares weighted by the errors. Errors of the result grow by sqrt(chi²/(n − 2)) where that is above 1 (Birge):
    points that no line fits do not make a precise slope. Fewer than two points, or a point without a known error, give
    unknown results.
    """
    x = np.asarray(x, dtype=float)
    y, sigma = np.array([(m.value, m.error) for m in points], dtype=float).reshape(-1, 2).T
    if len(set(x)) < 2 or not np.all(np.isfinite(y) & np.isfinite(sigma) & (sigma > 0)):
        return UNKNOWN, UNKNOWN
    design = np.column_stack([x, np.ones_like(x)]) / sigma[:, None]
    covariance = np.linalg.inv(design.T @ design)
    slope, intercept = covariance @ design.T @ (y / sigma)
    freedom = len(x) - 2
    chi_squared = float(np.sum(((y - slope * x - intercept) / sigma) ** 2))
    factor = np.sqrt(max(1.0, chi_squared / freedom)) if freedom > 0 else 1.0
    errors = factor * np.sqrt(np.diag(covariance))
    return Measured(float(slope), float(errors[0])), Measured(float(intercept), float(errors[1]))


def power_of(x, points):
    """Return the exponent of the power law through positive points (n `Measured`) at exact x > 0, as `Measured`."""
    if any(not m.value > 0 for m in points):
        return UNKNOWN
    slope, _ = line_through(np.log(x), [Measured(float(np.log(m.value)), m.error / m.value) for m in points])
    return slope
