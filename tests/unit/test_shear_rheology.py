"""The constants of mu(I) and the means of a shear run: made-up data with known answers."""

import numpy as np
import pytest

from graindrive.postproc.measured import Measured
from graindrive.postproc.shear import flow, rheology

INERTIAL = np.array([1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.2, 0.3, 0.5])


def points(errors=0.002, seed=None, law=(0.25, 0.6, 0.2)):
    rng = np.random.default_rng(seed or 1)
    noise = rng.normal(0, errors, len(INERTIAL)) if seed else np.zeros(len(INERTIAL))
    return [Measured(float(m), errors) for m in rheology.friction_law(INERTIAL, *law) + noise]


def test_the_fit_finds_the_constants_that_made_the_points():
    law = rheology.fitted(INERTIAL, points())
    found = law.mu_s.value, law.mu_2.value, law.i_0.value
    assert found == pytest.approx((0.25, 0.6, 0.2), rel=1e-4)  # the search ends where chi^2 changes by 1e-8


def test_its_errors_are_those_of_repeated_noise():
    laws = [rheology.fitted(INERTIAL, points(seed=seed)) for seed in range(2, 102)]
    for name in ("mu_s", "mu_2", "i_0"):
        values = np.array([getattr(law, name).value for law in laws])
        told = np.median([getattr(law, name).error for law in laws])
        # The scatter of 100 fits has an error of 7 %; chi^2 > 1 widens half of the errors by a third.
        assert 0.7 < told / values.std(ddof=1) < 1.6, name


def test_too_few_points_give_no_constants():
    law = rheology.fitted(INERTIAL[:3], points()[:3])
    assert np.isnan(law.mu_s.value) and np.isnan(law.as_summary()["i_0_err"])


def test_a_straight_line_and_its_errors():
    x = np.array([0.0, 1.0, 2.0, 3.0])
    first, slope = rheology.straight_line(x, [Measured(1 - 0.5 * v, 0.1) for v in x])
    assert (first.value, slope.value) == pytest.approx((1, -0.5))
    assert slope.error == pytest.approx(0.1 / np.sqrt(5))  # sigma over the root of the sum of squares about the middle


def series(n=400, seed=1):
    rng = np.random.default_rng(seed)
    constant = {name: np.ones(n) for name in flow.UNITS}
    noise = rng.normal(0, 0.1, n)
    profile = rng.normal(0, 0.01, (n, 10)) + 0.05 * np.sin(2 * np.pi * (np.arange(10) + 0.5) / 10)
    return {
        **constant,
        "strain": np.linspace(0, 8, n),
        "mean_pressure": 4 + noise,
        "shear_stress": 1.2 + 0.3 * noise,
        "contact_syy": np.full(n, 3.0),
        "height": np.full(n, 10.0),
        "phi": 0.8 + rng.normal(0, 0.01, n),
        "profile": profile,
    }


def test_means_of_a_steady_flow():
    found = flow.steady_flow(series(), 2.0, shear_rate=0.5).summary
    assert found["stress_ratio"] == pytest.approx(0.3, abs=1e-12) and found["stress_ratio_err"] < 1e-12  # tau = 0.3 p
    assert found["flow_inertial_number"] == pytest.approx(0.5 / np.sqrt(found["mean_pressure"]))
    assert found["normal_stress_difference"] == pytest.approx(-2 / found["mean_pressure"])
    # 0.05 of a sine over the sides' 5: its root mean square, with noise of 0.01 over the root of 300 rows.
    assert found["profile_deviation"] == pytest.approx(0.05 / np.sqrt(2) / 5, rel=0.05)
    assert 0 < found["profile_deviation_err"] < 0.1 * found["profile_deviation"]
    assert found["steady_from_strain"] >= 2 and found["steady"] == 1
