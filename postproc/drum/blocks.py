"""A flow in a drum as blocks in time: what is read off their mean, and its errors by leaving out one block after the other."""

from dataclasses import dataclass

import numpy as np

from .. import fields
from .flow import SQUARE, SURFACE_LEVEL, FlowField, Found, analysed, difference


@dataclass(frozen=True)
class Blocks:
    """Fields of blocks in time on one grid: `fraction`, `flux_x`, `flux_y` (n, ny, nx), fraction times velocity.

    `weight` (n,) says how much each counts. `x`, `y`, `surface_level` as of a `FlowField`.
    """

    x: np.ndarray
    y: np.ndarray
    fraction: np.ndarray
    flux_x: np.ndarray
    flux_y: np.ndarray
    weight: np.ndarray
    surface_level: float

    def __len__(self):
        return len(self.weight)

    def first(self, n):
        """Return the first `n` blocks."""
        parts = (part[:n] for part in (self.fraction, self.flux_x, self.flux_y, self.weight))
        return Blocks(self.x, self.y, *parts, self.surface_level)

    def mean(self, without=None):
        """Return the `FlowField` of the mean over all blocks, or over all but one."""
        weight = np.array(self.weight, dtype=float)
        if without is not None:
            weight[without] = 0
        fraction, flux_x, flux_y = (
            np.tensordot(weight / weight.sum(), part, axes=1) for part in (self.fraction, self.flux_x, self.flux_y)
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            velocity = [np.where(fraction > 0, flux / fraction, np.nan) for flux in (flux_x, flux_y)]
        return FlowField(self.x, self.y, fraction, *velocity, self.surface_level)


def blocks_of(x, y, fraction, velocity, weight, surface_level):
    """Return the `Blocks` of fractions (n, ny, nx) and velocities (n, ny, nx, 2), without those of weight 0."""
    kept = np.asarray(weight) > 0
    fraction, velocity = np.asarray(fraction)[kept], np.asarray(velocity)[kept]
    flux = np.where(fraction[..., None] > 0, fraction[..., None] * velocity, 0.0)
    return Blocks(
        np.asarray(x), np.asarray(y), fraction, flux[..., 0], flux[..., 1], np.asarray(weight)[kept], surface_level
    )


def read(run, model):
    """Return the `Blocks` that a run (reader.Run) stored as `fields/MODEL`, "dem" or "continuum"; RunError without them."""
    found = fields.read(run, model)
    fraction, velocity = found.arrays["area_fraction"], found.arrays["velocity"]
    return blocks_of(found.x, found.y, fraction, velocity, found.samples, SURFACE_LEVEL[model])


def models_in(run):
    """Return the models, "dem" before "continuum", whose fields a run holds."""
    names = run.names("fields")
    return [model for model in SURFACE_LEVEL if model in names]


@dataclass(frozen=True)
class Steady:
    """What the mean over all blocks gives, and from each the mean without one block, for the errors."""

    found: Found
    without: tuple

    def error(self, of):
        """Return the standard error of `of(Found)`, a number or an array, nan with fewer than two blocks: the jackknife's.

        sigma^2 = (n - 1)/n sum (theta_i - <theta>)^2 over the values without block i (Tukey 1958). It takes the blocks as
        independent: they must be longer than the flow remembers.
        """
        values, n = np.array([of(found) for found in self.without]), len(self.without)
        if n < 2:
            return np.full(np.shape(of(self.found)), np.nan)
        return np.sqrt((n - 1) / n * np.sum((values - values.mean(axis=0)) ** 2, axis=0))

    @property
    def summary(self):
        """The numbers of `Found`, each with its NAME_err."""
        summary = {}
        for name, value in self.found.numbers.items():
            summary[name], summary[f"{name}_err"] = value, float(self.error(lambda found: found.numbers[name]))
        return summary

    @property
    def profile(self):
        """Arrays of the profile for a run folder: z, u, fraction (n,), each but z with its NAME_err."""
        profile = self.found.profile
        arrays = dict(z=profile.z)
        for name in ("u", "fraction"):
            arrays[name] = getattr(profile, name)
            arrays[f"{name}_err"] = self.error(lambda found: getattr(found.profile, name))
        return arrays


def steady_flow(blocks, diameter, omega, edge=SQUARE):
    """Return the `Steady` flow of `Blocks` in a drum of `diameter` that turns with `omega`, in squares of that edge."""
    found = analysed(blocks.mean(), diameter, omega, edge)
    less = range(len(blocks)) if len(blocks) > 1 else ()
    return Steady(found, tuple(analysed(blocks.mean(without=k), diameter, omega, edge) for k in less))


def dem_continuum_difference(grains, continuum, diameter):
    """Return (L2 norm of the difference of u of two `Steady` flows over that of the first, its standard error).

    The error adds in squares those of leaving out one block of either. The noise of the profiles adds to the norm itself.
    """
    value = difference(grains.found.profile, continuum.found.profile, diameter)
    errors = (
        grains.error(lambda found: difference(found.profile, continuum.found.profile, diameter)),
        continuum.error(lambda found: difference(grains.found.profile, found.profile, diameter)),
    )
    return value, float(np.hypot(*np.nan_to_num(errors))) if np.isfinite(errors).any() else float("nan")
