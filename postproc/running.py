"""Running means: an average over the first part of a run, with its error, against how long it is. Is it converged?"""

from dataclasses import dataclass

import numpy as np

from ..base.numbers import with_error
from .figures import BLACK
from .statistics import FEWEST_BLOCKS, block_mean, ratio_mean

POINTS = 60  # of a running mean
SHOWN_FROM = 0.2  # of the samples: what comes before does not set a panel's range
MARGIN = 0.15  # of a panel's range, above and below


@dataclass(frozen=True)
class Running:
    """An average over the first `ends` (k,) samples: `values`, standard `errors` (k,), NaN where not known.

    `resolved` says of the last whether its error can be believed (`statistics.Mean`).
    """

    ends: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    resolved: bool

    def __str__(self):
        """The last average in words."""
        return with_error(self.values[-1], self.errors[-1]) if len(self.values) else "no data"

    def named(self, label):
        """Return a label in which {} stands for the last average; it says so where that one's error is not to be believed."""
        words = label.replace("{}", str(self))
        return words if self.resolved or not len(self.values) else f"{words}\n(error unresolved)"


def running(estimate, length, *, fewest=FEWEST_BLOCKS, points=POINTS):
    """Return the `Running` average of a series of `length` samples; `estimate(n)` returns the average of the first n.

    That is anything with `value` and `error`, of a `statistics.Mean` also `resolved`. There are up to `points` places, evenly
    from `fewest` samples to all of them.
    """
    least = min(fewest, length)
    ends = np.unique(np.linspace(least, length, points).round().astype(int)) if length else np.zeros(0, int)
    found = [estimate(int(n)) for n in ends]
    values, errors = np.array([(one.value, one.error) for one in found], dtype=float).reshape(-1, 2).T
    return Running(ends, values, errors, bool(found) and getattr(found[-1], "resolved", True))


def running_mean(samples, **options):
    """Return the `Running` mean of equally spaced, correlated samples (n,), errors by blocking."""
    return running(lambda n: block_mean(samples[:n]), len(samples), **options)


def running_ratio(numerator, denominator, **options):
    """Return the `Running` mean(numerator)/mean(denominator) of two series (n,) that are correlated with each other."""
    return running(lambda n: ratio_mean(numerator[:n], denominator[:n]), len(numerator), **options)


def draw_running(axes, x, found, *, colour, scale=1.0, label=None, marker=None):
    """Draw a `Running` average as a line with a band of one standard error, against `x` (k,), where its samples end.

    `scale` divides the numbers. `label` may hold {}, which stands for the last number with its error; the line is what the
    legend shows.
    """
    values, errors = found.values / scale, np.nan_to_num(found.errors / abs(scale))
    axes.fill_between(x, values - errors, values + errors, color=colour, alpha=0.25, linewidth=0)
    axes.plot(x, values, color=colour, linewidth=1.2, marker=marker, label=label and found.named(label))


def draw_convergence(axes, x, found, *, colour, label=None, marker=None):
    """Fill a panel with one `Running` average, the last value as a dashed line, in a range that the early noise does not set."""
    draw_running(axes, x, found, colour=colour, label=label, marker=marker)
    if not len(found.values):
        return
    axes.axhline(found.values[-1], color=BLACK, linewidth=0.5, linestyle=(0, (4, 2)), zorder=0)
    late = np.asarray(x) >= x[0] + SHOWN_FROM * (x[-1] - x[0])
    errors = np.nan_to_num(found.errors)
    low, high = np.nanmin((found.values - errors)[late]), np.nanmax((found.values + errors)[late])
    if np.isfinite(low + high) and high > low:
        axes.set_ylim(low - MARGIN * (high - low), high + MARGIN * (high - low))
