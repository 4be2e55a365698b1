"""Means with standard errors of correlated series.

Blocking: H. Flyvbjerg, H. G. Petersen, J. Chem. Phys. 91, 461 (1989), with the stopping rule of
M. Jonsson, Phys. Rev. E 98, 043304 (2018).
"""

from dataclasses import dataclass

import numpy as np

ROUND_OFF = 1e-14  # of a number that is the sum of some tens [-]
FEWEST_BLOCKS = 16  # with fewer, a random walk passes the test for correlation


@dataclass(frozen=True)
class Mean:
    """A mean, its standard error, the block length [samples] that the error needed, and whether it was long enough.

    `resolved` is False when even the longest blocks are correlated, or too few: the error is then the largest of all
    block lengths, and still likely too small.
    """

    value: float
    error: float
    block_length: int
    resolved: bool


def block_mean(samples):
    """Return the `Mean` of equally spaced, correlated samples (n,).

    Neighbours are averaged in pairs until what is left is uncorrelated; the variance of the mean is then σ_k²/(n_k − 1).
    Level k is taken when M_k = Σ_{j≥k} n_j [γ_j(1) + (n_j − 1) σ_j²/n_j²]²/σ_j⁴ stays below the 99 % quantile of χ² with as
    many degrees of freedom as there are terms (γ_j(1): covariance of neighbours at level j). It misleads for series
    shorter than some tens of correlation times. Fewer than two samples have the error NaN.
    """
    x = np.asarray(samples, dtype=float)
    if x.ndim != 1 or not np.all(np.isfinite(x)) or len(x) == 0:
        raise ValueError(f"samples must be a 1D array of finite numbers, got shape {x.shape}")
    mean = float(x.mean())
    if len(x) < 2:
        return Mean(mean, float("nan"), 1, False)
    counts, variances, terms = blocking_levels(x)
    if variances[0] <= (1e-14 * abs(mean)) ** 2:
        return Mean(mean, 0.0, 1, True)
    tails = np.cumsum(terms[::-1])[::-1]
    errors = np.sqrt(variances / (counts - 1))
    passes = (tails < chi_squared_99(np.arange(len(terms), 0, -1))) & (counts >= FEWEST_BLOCKS)
    level = int(np.argmax(passes)) if passes.any() else int(np.argmax(errors))
    return Mean(mean, float(errors[level]), 2**level, bool(passes.any()))


def ratio_mean(numerator, denominator):
    """Return the `Mean` of mean(numerator)/mean(denominator) of two series (n,) that are correlated with each other.

    Delta method: to first order the ratio R deviates by the mean of (a_i - R b_i)/mean(b), whose error blocking gives. What
    is no more than round-off of a_i counts as 0, so that a constant ratio has the error 0. NaN where the denominator's mean is 0.
    """
    a, b = np.asarray(numerator, dtype=float), np.asarray(denominator, dtype=float)
    if b.mean() == 0:
        return Mean(float("nan"), float("nan"), 1, False)
    ratio = float(a.mean() / b.mean())
    rest = a - ratio * b
    rest[np.abs(rest) <= ROUND_OFF * np.abs(a)] = 0
    deviation = block_mean(rest / b.mean())
    return Mean(ratio, deviation.error, deviation.block_length, deviation.resolved)


def steady_start(samples, *, parts=20, at_most=0.5, deviations=3.0):
    """Return (samples to leave out at the start of a series (n,) as its transient, whether what is left is steady).

    Geweke's test (1992): the means of the first fifth and of the last half of what is left must agree within so many
    standard errors; the first multiple of n/`parts` that passes is taken, up to `at_most` of the series. The errors are
    those of a steady process: the last half's by blocking, the first fifth's in proportion, since its own would hold the
    transient. It cuts nothing that noise explains; as several cuts are tried, a weak drift
    passes more easily than the level of one test says. A last half whose error blocking cannot resolve is not called steady.
    """
    x = np.asarray(samples, dtype=float)
    for cut in (k * len(x) // parts for k in range(int(at_most * parts) + 1)):
        early, late = x[cut : cut + (len(x) - cut) // 5], x[(cut + len(x)) // 2 :]
        if len(early) < FEWEST_BLOCKS:
            return cut, False
        mean = block_mean(late)
        error = mean.error * np.sqrt(1 + len(late) / len(early))
        if abs(early.mean() - mean.value) <= deviations * error:
            return cut, mean.resolved
    return cut, False


def blocking_levels(x):
    """Return (n_k, σ_k², term of M_k) of all levels of pairwise averaging with at least two blocks."""
    counts, variances, terms = [], [], []
    while len(x) >= 2:
        n, deviation = len(x), x - x.mean()
        variance = float(np.mean(deviation**2))
        neighbours = float(np.sum(deviation[1:] * deviation[:-1]) / n)
        counts.append(n)
        variances.append(variance)
        terms.append(n * ((neighbours + (n - 1) * variance / n**2) / variance) ** 2 if variance > 0 else 0.0)
        x = 0.5 * (x[: n - n % 2 : 2] + x[1 : n - n % 2 : 2])
    return np.array(counts), np.array(variances), np.array(terms)


def chi_squared_99(degrees):
    """Return the 99 % quantile of χ² for arrays of degrees of freedom (Wilson and Hilferty 1931; within 2 %)."""
    a = 2 / (9 * np.asarray(degrees, dtype=float))
    return degrees * (1 - a + 2.3263478740408408 * np.sqrt(a)) ** 3
