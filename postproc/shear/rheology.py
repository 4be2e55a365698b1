"""The friction law mu(I) = mu_s + (mu_2 - mu_s)/(I_0/I + 1) (Jop, Forterre, Pouliquen 2006) and the linear law of phi, fitted."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import curve_fit

from ..measured import UNKNOWN, Measured

START = 0.25, 0.5, 0.2  # mu_s, mu_2, I_0 that the search begins at
FEWEST = 4  # points for three constants
LAST_STRAIGHT = 0.1  # I up to which phi and mu count as straight lines
DENSEST_GAS = (
    0.2  # I up to which mu(I) of a dense flow holds; at 0.3 phi is down to 0.68, grains collide in pairs, and mu falls
)


def friction_law(inertial, mu_s, mu_2, i_0):
    """Return mu(I)."""
    return mu_s + (mu_2 - mu_s) / (i_0 / np.asarray(inertial) + 1)


@dataclass(frozen=True)
class FrictionLaw:
    """The three constants with errors, and chi^2 over the degrees of freedom, 1 where the law explains the points."""

    mu_s: Measured
    mu_2: Measured
    i_0: Measured
    chi_squared: float

    def __call__(self, inertial):
        return friction_law(inertial, self.mu_s.value, self.mu_2.value, self.i_0.value)

    def as_summary(self):
        """Return mu_s, mu_2, i_0 with their errors as a flat dict."""
        parts = dict(mu_s=self.mu_s, mu_2=self.mu_2, i_0=self.i_0)
        found = {name: part.value for name, part in parts.items()}
        return {**found, **{f"{name}_err": part.error for name, part in parts.items()}, "chi_squared": self.chi_squared}


def fitted(inertial, points):
    """Return the `FrictionLaw` through `Measured` points at I (n,): least squares weighted by 1/error^2.

    Errors are those of the covariance, widened by sqrt(chi^2/freedom) where the points scatter more than their errors. All
    unknown with fewer than four points, or where the search ends nowhere. It misleads where I does not reach well beyond I_0:
    mu_2 and I_0 are then correlated.
    """
    values, errors = np.array([(m.value, m.error) for m in points], dtype=float).reshape(-1, 2).T
    known = np.isfinite(values) & np.isfinite(errors) & (errors > 0)
    if known.sum() < FEWEST:
        return FrictionLaw(UNKNOWN, UNKNOWN, UNKNOWN, float("nan"))
    x, y, sigma = np.asarray(inertial, dtype=float)[known], values[known], errors[known]
    try:
        constants, covariance = curve_fit(
            friction_law, x, y, START, sigma, absolute_sigma=True, bounds=((0, 0, 1e-6), (2, 5, 100))
        )
    except RuntimeError:
        return FrictionLaw(UNKNOWN, UNKNOWN, UNKNOWN, float("nan"))
    rest = (y - friction_law(x, *constants)) / sigma
    chi_squared = float(np.sum(rest**2) / max(1, len(x) - 3))
    deviations = np.sqrt(np.diag(covariance) * max(1.0, chi_squared))
    return FrictionLaw(*(Measured(float(c), float(e)) for c, e in zip(constants, deviations)), chi_squared)


def straight_line(x, points):
    """Return (value at 0, slope) of a weighted straight line through `Measured` points (n,), errors widened as in `fitted`."""
    values, errors = np.array([(m.value, m.error) for m in points], dtype=float).reshape(-1, 2).T
    known = np.isfinite(values) & np.isfinite(errors) & (errors > 0)
    if known.sum() < 3:
        return UNKNOWN, UNKNOWN
    x, y, sigma = np.asarray(x, dtype=float)[known], values[known], errors[known]
    design = np.c_[np.ones_like(x), x] / sigma[:, None]
    covariance = np.linalg.inv(design.T @ design)
    constants = covariance @ design.T @ (y / sigma)
    chi_squared = np.sum((y / sigma - design @ constants) ** 2) / max(1, len(x) - 2)
    deviations = np.sqrt(np.diag(covariance) * max(1.0, chi_squared))
    return tuple(Measured(float(c), float(e)) for c, e in zip(constants, deviations))
