"""Standard errors against processes whose error is known."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from graindrive.postproc.statistics import (
    block_mean,
    chi_squared_99,
    ratio_mean,
    steady_start,
)


def autoregressive(n, correlation, rng):
    """AR(1) of unit variance; the variance of its mean is (1 + φ)/(1 − φ)/n for n much larger than 1/(1 − φ)."""
    noise = rng.normal(size=n) * np.sqrt(1 - correlation**2)
    x = np.empty(n)
    x[0] = rng.normal()
    for i in range(1, n):
        x[i] = correlation * x[i - 1] + noise[i]
    return x


@pytest.mark.parametrize("time", [0, 1, 5, 30])
def test_error_of_a_process_with_known_correlation_time(time):
    """Blocks of ~10 correlation times leave 2^15/(10·30) ≈ 100 blocks: 7 % each, below 10 % in the mean of 40, plus the bias."""
    rng, n, correlation = np.random.default_rng(1), 2**15, np.exp(-1 / time) if time else 0.0
    true = np.sqrt((1 + correlation) / (1 - correlation) / n)
    means = [block_mean(autoregressive(n, correlation, rng)) for _ in range(40)]
    assert np.sqrt(np.mean([m.error**2 for m in means])) == pytest.approx(true, rel=0.1)
    assert np.mean([m.resolved for m in means]) > 0.9
    assert np.std([m.value for m in means]) == pytest.approx(
        true, rel=0.4
    ), "40 means scatter as the error says, to 3 σ"
    if time:
        assert np.median([m.block_length for m in means]) >= time


def test_white_noise_is_taken_as_it_is():
    x = np.random.default_rng(2).normal(3, 2, 1000)
    mean = block_mean(x)
    assert mean.block_length == 1 and mean.error == pytest.approx(x.std() / np.sqrt(999))


def test_a_random_walk_is_not_resolved():
    """The correlation time is as long as the series, so no block length is enough."""
    walks = np.cumsum(np.random.default_rng(3).normal(size=(20, 256)), axis=1)
    assert sum(not block_mean(walk).resolved for walk in walks) >= 10


@pytest.mark.parametrize("samples, error", [([1.0], np.nan), ([2.0, 2.0], 0.0), (np.full(1000, 0.1), 0.0)])
def test_short_and_constant_series(samples, error):
    mean = block_mean(samples)
    assert mean.value == pytest.approx(samples[0]) and (mean.error == error or np.isnan(mean.error) and np.isnan(error))


@pytest.mark.parametrize("samples", [[], [np.nan, 1], [np.inf], [[1, 2]]])
def test_what_has_no_mean_is_refused(samples):
    with pytest.raises(ValueError, match="samples must be"):
        block_mean(samples)


# Six decimals: squares of smaller numbers would leave the normal range, where powers of two no longer scale exactly.
DECIMALS = st.floats(-1e6, 1e6).map(lambda value: round(value, 6))


@given(st.lists(DECIMALS, min_size=2, max_size=200), st.floats(-1e3, 1e3), st.sampled_from([0.5, 2.0, 4.0]))
def test_mean_and_error_shift_and_scale(samples, shift, scale):
    x = np.array(samples)
    mean = block_mean(x)
    scaled = block_mean(x * scale)
    assert scaled.error == mean.error * scale and scaled.value == mean.value * scale, "powers of two scale exactly"
    assert block_mean(x + shift).value == pytest.approx(mean.value + shift, abs=1e-6)


def test_quantiles_of_chi_squared():
    table = {1: 6.635, 2: 9.210, 5: 15.086, 10: 23.209, 20: 37.566}
    assert [chi_squared_99(np.array([k]))[0] for k in table] == pytest.approx(list(table.values()), rel=0.02)


def test_error_of_a_ratio_of_correlated_series_is_that_of_many_repeats():
    """Lift = drag/2 + independent noise: the common part cancels in the ratio, so its error comes from the noise only."""
    rng, n = np.random.default_rng(3), 4096
    ratios, errors = [], []
    for _ in range(60):
        drag = 4 + autoregressive(n, 0.8, rng)
        found = ratio_mean(0.5 * drag + autoregressive(n, 0.5, rng), drag)
        ratios.append(found.value)
        errors.append(found.error)
    true = np.sqrt(1.5 / 0.5 / n) / 4
    # The spread of 60 repeats is known to 9 %; blocking's bias is below 5 %.
    assert np.std(ratios) == pytest.approx(true, rel=0.25)
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(true, rel=0.1)
    assert abs(np.mean(ratios) - 0.5) < 4 * true / np.sqrt(60)


def test_a_ratio_over_nothing_is_unknown():
    assert np.isnan(ratio_mean(np.ones(10), np.zeros(10)).value)


@pytest.mark.parametrize("ratio", [1.0, 1 / 3, -0.7])
def test_a_constant_ratio_has_no_error_not_one_of_round_off(ratio):
    """Sums of the same numbers in another order differ by some 1e-16 of them, which is no scatter of the ratio."""
    b = np.random.default_rng(3).exponential(1.0, 300)
    found = ratio_mean(ratio * b * (1 + np.random.default_rng(4).choice([-2e-16, 0, 2e-16], 300)), b)
    assert found.value == pytest.approx(ratio, rel=1e-15) and found.error == 0 and found.resolved
    assert ratio_mean(b * (1 + 1e-12 * np.arange(300)), b).error > 0


def test_a_transient_is_left_out_and_noise_is_not():
    rng, n = np.random.default_rng(4), 4000
    falsely_cut = 0
    for _ in range(40):
        noise = autoregressive(n, 0.7, rng)
        falsely_cut += steady_start(noise)[0] > 0
        cut, steady = steady_start(noise + 10 * np.exp(-np.arange(n) / 200))
        assert steady and 200 <= cut <= 1600
    assert falsely_cut <= 4  # 3 standard errors of the estimated error, which is known to some 10 %


def test_a_drift_to_the_end_is_not_steady():
    noise = autoregressive(4000, 0.7, np.random.default_rng(5))
    assert not steady_start(noise + np.linspace(0, 20, 4000))[1]
