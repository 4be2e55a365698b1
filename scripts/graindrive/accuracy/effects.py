"""What a setting changes: deviations of runs from those at the reference, pooled to a bias, its error and one run's spread."""

import math
from dataclasses import dataclass

import numpy as np

CONFIDENCE = 0.9  # of intervals and bounds: at least nine in ten runs stay within what is said of them
MANY = 1e6  # its square is more runs than anybody makes
FEWEST_RUNS = 2  # deviations of which a scatter can be taken


@dataclass(frozen=True)
class Effect:
    """Deviations of an observable from its value at the reference, relative to that [-].

    `bias` is their mean over `runs` runs, `error` its standard error, `spread` the standard deviation of one run's; `freedom`
    are the degrees of freedom of both, infinite where the runs' own errors decide.
    """

    bias: float
    error: float
    spread: float
    runs: int
    freedom: float

    def interval(self, confidence):
        """Return the half width of the interval around `bias` that holds the true bias with that confidence."""
        return quantile(confidence, self.freedom) * self.error

    def bound(self, confidence):
        """Return the size below which one more run's deviation from the reference lies with that confidence, at least.

        |bias| + t s (1 + 1/n)^1/2, a prediction interval of normal deviations, t the quantile of Student's distribution for
        its two sides (any text on statistics, e.g. Hahn, Meeker, "Statistical Intervals", 1991, section 4.7). It is too wide
        where the bias is larger than the spread, for then only one side counts.
        """
        if not math.isfinite(self.spread):
            return math.inf
        return abs(self.bias) + quantile(confidence, self.freedom) * self.spread * math.sqrt(1 + 1 / self.runs)

    def runs_for(self, target, confidence):
        """Return how many runs to average so that the mean deviates from the reference by less than `target` with `confidence`.

        The smallest n with |bias| + t s n^-1/2 <= target; infinite where the bias alone is larger.
        """
        room = target - abs(self.bias)
        if not (math.isfinite(self.spread) and room > 0):
            return math.inf
        root = quantile(confidence, self.freedom) * self.spread / room
        return max(1, math.ceil(root**2)) if root < MANY else math.inf


def quantile(confidence, freedom):
    """Return the quantile of Student's distribution between whose two signs lies the part `confidence`."""
    from scipy import special  # a tenth of a second that no other start of a study needs

    if not freedom > 0:
        return math.inf
    upper = 0.5 + confidence / 2
    return float(special.ndtri(upper) if math.isinf(freedom) else special.stdtrit(freedom, upper))


NOTHING = Effect(math.nan, math.inf, math.inf, 0, 0)


def pooled(deviations, own_errors):
    """Return the `Effect` of relative deviations (n,), with the standard errors (n,) that the runs themselves give, or nan.

    The spread is the larger of the scatter and the own errors' root mean square: two runs that agree by chance are not exact.
    Without own errors two runs or more are needed.
    """
    values, own = np.asarray(deviations, dtype=float), np.asarray(own_errors, dtype=float)
    known = np.isfinite(values)
    values, own = values[known], own[known]
    n = len(values)
    if n == 0:
        return NOTHING
    scatter = float(values.std(ddof=1)) if n >= FEWEST_RUNS else math.nan
    stated = float(np.sqrt(np.mean(own**2))) if np.isfinite(own).all() else math.nan
    if math.isnan(scatter) and math.isnan(stated):
        return Effect(float(values.mean()), math.inf, math.inf, n, 0)
    spread = float(np.fmax(scatter, stated))
    freedom = math.inf if spread == stated else n - 1
    return Effect(float(values.mean()), spread / math.sqrt(n), spread, n, freedom)


def of_reference(groups):
    """Return the `Effect` of the reference's own runs: about their mean; `groups` are [(values, errors)] by scene."""
    deviations, own, lost = [], [], 0
    for values, errors in groups:
        mean = np.mean(values)
        if len(values) and mean != 0:
            deviations += list((np.asarray(values) - mean) / abs(mean))
            own += list(np.asarray(errors) / abs(mean))
            lost += 1
    if not deviations:
        return NOTHING
    freedom = len(deviations) - lost
    stated = float(np.sqrt(np.mean(np.square(own)))) if np.isfinite(own).all() else math.nan
    scatter = float(np.sqrt(np.sum(np.square(deviations)) / freedom)) if freedom > 0 else math.nan
    if math.isnan(scatter) and math.isnan(stated):
        return NOTHING
    spread = float(np.fmax(scatter, stated))
    runs = len(deviations)
    return Effect(0.0, spread / math.sqrt(runs), spread, runs, math.inf if spread == stated else freedom)
