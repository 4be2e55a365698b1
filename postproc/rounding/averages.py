"""Averages over a chaotic run: kinetic energy, pressure by motion and contacts, and the velocities' distribution."""

import numpy as np

from ..measured import Measured
from ..statistics import block_mean

EDGES = np.linspace(-3, 3, 25)  # of the bins of velocities over their root mean square [-]
AVERAGED = ("kinetic_energy", "pressure", "kurtosis")
PORTION = 500  # rows at a time: pairs of all grains are tried


def averages(places, velocities, *, side, stiffness):
    """Return {name: `Measured`} of `AVERAGED`, of disks of mass and diameter 1 in a periodic square.

    `places`, `velocities` (n, m, 2) are samples, equally spaced. Kinetic energy: of a grain [m d^2/t_0^2]. Pressure:
    P = (sum m v^2 + sum over contacts of force times branch)/(2 side^2) [m/t_0^2], with k_n = `stiffness`. Kurtosis:
    <v_x^4>/<v_x^2>^2, nearly 3 for many grains (Maxwell). Errors by blocking. Velocities are half a step behind places.
    """
    square = (velocities**2).sum(axis=2)
    series = dict(
        kinetic_energy=square.mean(axis=1) / 2,
        pressure=(square.sum(axis=1) + virial(places, side, stiffness)) / (2 * side**2),
        kurtosis=(velocities**4).mean(axis=(1, 2)) / (velocities**2).mean(axis=(1, 2)) ** 2,
    )
    means = {name: block_mean(values) for name, values in series.items()}
    return {name: Measured(mean.value, mean.error) for name, mean in means.items()}


def virial(places, side, stiffness):
    """Return the sum over contacts of force times branch of each sample (n,)."""
    one, other = np.triu_indices(places.shape[1], 1)
    sums = []
    for first in range(0, len(places), PORTION):
        part = places[first : first + PORTION]
        branch = part[:, one] - part[:, other]
        branch -= side * np.round(branch / side)
        length = np.hypot(branch[..., 0], branch[..., 1])
        sums.append((stiffness * np.maximum(1 - length, 0) * length).sum(axis=1))
    return np.concatenate(sums)


def distribution(velocities):
    """Return (density, error) of v_x and v_y over their root mean square in the bins of `EDGES`; errors by blocking."""
    scaled = velocities.reshape(len(velocities), -1) / np.sqrt((velocities**2).mean())
    counts = np.array([np.histogram(row, EDGES)[0] for row in scaled]) / (scaled.shape[1] * np.diff(EDGES))
    means = [block_mean(column) for column in counts.T]
    return np.array([mean.value for mean in means]), np.array([mean.error for mean in means])


def apart(one, other):
    """Return the largest difference of two dicts of averages, in standard errors of the difference."""
    return max(
        abs(one[name].value - other[name].value) / np.hypot(one[name].error, other[name].error) for name in AVERAGED
    )
