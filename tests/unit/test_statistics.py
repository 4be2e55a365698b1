"""Standard errors against processes whose error is known, and the drift of shaken bodies whose motion is known."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from graindrive.postproc.statistics import (
    block_mean,
    chi_squared_99,
    cycle_means,
    drift,
    phase_rates,
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
    """Its correlation time is the series itself: no block length can do."""
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


def shaken(rate, period=4.0, end=400.0, points=4001, noise=0.0):
    t = np.linspace(0, end, points)
    return t, rate * t + 0.3 * np.sin(2 * np.pi * t / period) + noise * np.random.default_rng(4).normal(size=points)


def test_cycle_means_of_a_line_are_its_middles():
    t, y = shaken(0.01)
    cycle_t, cycle_y = cycle_means(t, y, 4.0)
    assert len(cycle_t) == 100 and np.allclose(cycle_t, 2 + 4 * np.arange(100))
    assert np.allclose(cycle_y, 0.01 * cycle_t, atol=1e-12), "the sine has no mean over its period"


def test_cycle_means_do_not_need_the_period_to_be_a_multiple_of_the_sampling():
    t, y = shaken(0.02, period=3.7, points=4117)
    _, cycle_y = cycle_means(t, y, 3.7)
    assert np.allclose(np.diff(cycle_y) / 3.7, 0.02, atol=1e-4)


@pytest.mark.parametrize("rate", [-0.03, 0.0, 0.02])
def test_drift_of_a_steady_riser(rate):
    found = drift(*shaken(rate), 4.0)
    assert found.rate == pytest.approx(rate, abs=1e-9) and found.error < 1e-9
    assert found.start == pytest.approx(42) and found.end == pytest.approx(398)


def test_drift_lies_within_its_error_for_a_random_ratchet():
    """Steps of 0.1 ± 0.5 per cycle, independent: the error of 450 of them is 0.5/sqrt(450)/T."""
    rng, inside = np.random.default_rng(5), 0
    for _ in range(40):
        position = np.repeat(np.cumsum(rng.normal(0.1, 0.5, 500)), 20)
        found = drift(np.arange(10000) * 0.2, position, 4.0)
        assert found.error == pytest.approx(0.5 / np.sqrt(450) / 4, rel=0.5)
        inside += abs(found.rate - 0.025) < 2 * found.error
    assert inside >= 32, "95 % of 40 are 38; fewer than 32 happen once in 10^5"


def test_drift_ends_where_the_body_rests():
    t = np.linspace(0, 400, 4001)
    found = drift(t, np.minimum(0.1 * t, 20.0), 4.0)
    assert found.rate == pytest.approx(0.1, rel=0.03) and 196 <= found.end <= 208


@pytest.mark.parametrize("t, y", [([], []), ([0.0], [1.0]), (np.linspace(0, 7, 50), np.zeros(50))])
def test_too_short_for_a_drift(t, y):
    assert np.isnan(drift(t, y, 4.0).rate)


def test_error_of_a_ratio_of_correlated_series_is_that_of_many_repeats():
    """Lift = drag/2 + noise of its own: the common part drops out of the ratio, so its error is the noise's alone."""
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


def test_a_transient_is_left_out_and_noise_is_not():
    rng, n = np.random.default_rng(4), 4000
    falsely_cut = 0
    for _ in range(40):
        noise = autoregressive(n, 0.7, rng)
        falsely_cut += steady_start(noise)[0] > 0
        cut, steady = steady_start(noise + 10 * np.exp(-np.arange(n) / 200))
        assert steady and 200 <= cut <= 1600
    assert falsely_cut <= 4  # 3 standard errors of an error that is itself known to some 10 %


def test_a_drift_to_the_end_is_not_steady():
    noise = autoregressive(4000, 0.7, np.random.default_rng(5))
    assert not steady_start(noise + np.linspace(0, 20, 4000))[1]


def test_rates_by_phase_are_the_velocity_of_a_known_motion():
    t, period = np.linspace(0, 40, 1601), 4.0
    y = 0.1 * t + 0.3 * np.sin(2 * np.pi * t / period)
    phases, rates, errors = phase_rates(t, y, period, 3.9, 40)
    edges = 2 * np.pi * np.arange(21) / 20
    expected = 0.1 + 0.3 * np.diff(np.sin(edges)) * 20 / period
    assert phases == pytest.approx((np.arange(20) + 0.5) / 20)
    assert rates == pytest.approx(expected, abs=1e-9)  # every edge is a sample, so interpolation is exact
    assert np.all(errors < 1e-9)
    assert rates.mean() == pytest.approx(0.1, abs=1e-9)


def test_errors_of_rates_by_phase_are_those_of_independent_cycles():
    rng, cycles, parts = np.random.default_rng(4), 900, 40
    steps = rng.normal(size=cycles * parts)
    y = np.concatenate([[0], np.cumsum(steps)]) / parts
    _, rates, errors = phase_rates(np.arange(cycles * parts + 1) / parts, y, 1.0, 0, cycles, parts)
    # Now and then blocks of more than one cycle are taken, which scatter more; 40 errors of a tenth each give 2 %.
    assert np.sqrt(np.mean(errors**2)) == pytest.approx(1 / 30, rel=0.1)
    assert np.sqrt(np.mean(rates**2)) == pytest.approx(1 / 30, rel=0.4)  # 3 sigma of 40 values


@pytest.mark.parametrize(
    "start, end, known", [(0, 0.5, 0), (0.2, 1.9, 0), (np.nan, np.nan, 0), (0.2, 2.0, 1), (0.0, 1.0, 1)]
)
def test_only_whole_cycles_make_rates_by_phase(start, end, known):
    t = np.linspace(0, 3, 61)
    _, rates, errors = phase_rates(t, t, 1.0, start, end, parts=4)
    assert np.all(np.isnan(errors))
    assert rates == pytest.approx(1.0) if known else np.all(np.isnan(rates))
