"""The half full drum of a slow Newtonian fluid: the closed form of its velocity, and our continuum against it."""

import numpy as np
import pytest
from scipy.integrate import quad

from graindrive.benchmark import drum_newtonian
from graindrive.benchmark.drum_newtonian import Found, cost_at, exact


def by_series(depth, terms=400):
    """Return u of the closed form from psi's series: u_theta = sum of 2/(pi n) ((n + 2) r^(n+1) - n r^(n-1)) sin(n pi/2)."""
    n = np.arange(1, 2 * terms, 2)
    return (2 / (np.pi * n) * ((n + 2) * depth ** (n + 1) - n * depth ** (n - 1.0)) * np.sin(n * np.pi / 2)).sum()


@pytest.mark.parametrize("depth", [0.05, 0.3, 0.6, 0.9])
def test_the_closed_form_sums_its_series(depth):
    assert exact(depth) == pytest.approx(by_series(depth), abs=1e-12)  # 0.9^800 is 1e-37: round-off of 400 terms


def test_the_closed_form_sticks_to_the_wall_carries_nothing_and_leaves_the_surface_free():
    assert exact(1.0) == pytest.approx(1, abs=1e-15)
    assert quad(exact, 0, 1)[0] == pytest.approx(0, abs=1e-12)
    assert exact(1e-6) == pytest.approx(
        exact(0.0), abs=1e-11
    )  # u is even in the depth, so there is no shear at the surface


def test_our_continuum_nears_the_closed_form():
    """At wall and surface the error is of first order: half the spacing halves it. Other orders may be a fifth of it."""
    numbers = drum_newtonian.drum()
    coarse, fine = (drum_newtonian.ours(numbers, cells, 0.2, 60.0).error for cells in (28, 56))
    assert fine < 0.06 and coarse / fine > 1.6


def test_a_surface_is_the_line_that_was_painted():
    """The surface is a straight line: in each column the part below it, at the column's middle, gives the angle exactly."""
    x = np.linspace(-0.975, 0.975, 40)
    below = np.clip((0.02 + 0.1 * x - x[:, None]) / 0.05 + 0.5, 0, 1)
    angle, level = drum_newtonian.surface(x, x, below, 0.5)
    assert np.tan(angle) == pytest.approx(0.1, rel=1e-12) and level == pytest.approx(0.02, rel=1e-12)


def made_up(error, seconds):
    """Return a made-up Found with this error and these seconds."""
    found = Found.__new__(Found)
    found.u, found.seconds = exact(drum_newtonian.DEPTHS) * (1 + error), seconds
    return found


def test_costs_at_an_error_lie_between_grids_by_powers_and_beyond_them_nowhere():
    found = {10: made_up(0.08, 1.0), 20: made_up(0.04, 8.0), 40: made_up(0.02, 64.0)}
    assert cost_at(0.04, found) == pytest.approx(8, rel=1e-9)
    assert cost_at(0.04 * np.sqrt(2), found) == pytest.approx(np.sqrt(8), rel=1e-9)  # the cube of the error
    assert cost_at(0.16, found) == pytest.approx(1, rel=1e-9)
    assert cost_at(0.019, found) is None
