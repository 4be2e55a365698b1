"""The drift of shaken bodies with known motion: rate, arrest, rates by phase and their errors."""

import numpy as np
import pytest

from graindrive.postproc.drift import cycle_means, drift, phase_rates, phase_sum


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
    assert found.start == pytest.approx(40) and found.end == pytest.approx(400)


def test_the_average_ends_with_the_last_whole_cycle_and_phases_rest_on_the_same_cycles():
    t, y = shaken(0.05, period=2.0, end=4.0, points=401)
    found = drift(t, y, 2.0)
    assert (found.start, found.end) == (0.0, 4.0), "both cycles have their middles behind 0.4, and nothing was arrested"
    _, rates, errors = phase_rates(t, y, 2.0, found.start, found.end)
    assert rates.mean() == pytest.approx(found.rate, abs=1e-9) and np.all(errors < 1e-9)
    assert drift(*shaken(0.05, period=4.0, end=10.0), 4.0).end == 8.0


def test_a_cycle_whose_middle_lies_in_the_first_tenth_does_not_count():
    t, y = shaken(0.05, period=2.0, end=40.0)
    found = drift(t, np.where(t < 4, 5.0, y), 2.0)
    assert found.start == 4.0 and found.rate == pytest.approx(0.05, abs=1e-4)


def test_drift_lies_within_its_error_for_a_random_ratchet():
    """Steps of 0.1 ± 0.5 per cycle, independent: the error of 450 of them is 0.5/sqrt(450)/T."""
    rng, inside = np.random.default_rng(5), 0
    for _ in range(40):
        position = np.repeat(np.cumsum(rng.normal(0.1, 0.5, 500)), 20)
        found = drift(np.arange(10000) * 0.2, position, 4.0)
        assert found.error == pytest.approx(0.5 / np.sqrt(450) / 4, rel=0.5)
        inside += abs(found.rate - 0.025) < 2 * found.error
    assert inside >= 32, "95 % of 40 are 38; fewer than 32 happen once in 10^5"


@pytest.mark.parametrize("cycles, resolved", [(8, False), (200, True)])
def test_drift_says_whether_its_error_is_resolved(cycles, resolved):
    """Independent steps of cycles: their error needs sixteen of them."""
    y = np.repeat(np.cumsum(np.random.default_rng(5).normal(size=cycles)), 40)
    assert drift(np.arange(len(y)) * 0.1, y, 4.0).resolved == resolved


def test_drift_ends_where_the_body_rests():
    t = np.linspace(0, 400, 4001)
    found = drift(t, np.minimum(0.1 * t, 20.0), 4.0)
    assert found.rate == pytest.approx(0.1, rel=0.03) and 196 <= found.end <= 208


@pytest.mark.parametrize("t, y", [([], []), ([0.0], [1.0]), (np.linspace(0, 7, 50), np.zeros(50))])
def test_too_short_for_a_drift(t, y):
    assert np.isnan(drift(t, y, 4.0).rate)


def test_a_body_that_wanders_slowly_is_not_called_at_rest():
    """Steps of 0.04 ± 0.25 d per cycle: sometimes the body stays within 0.25 d for a tenth of the run, but it goes on."""
    rng, cut, rates = np.random.default_rng(7), 0, []
    for _ in range(200):
        found = drift(np.arange(2501) * 0.04, np.repeat(np.cumsum(rng.normal(0.04, 0.25, 51)), 50)[:2501], 2.0)
        cut += found.end < found.cycle_t[-1]
        rates.append(found.rate)
    assert cut <= 20  # a walk that ends at its highest point by chance cannot be distinguished from an arrest
    assert np.mean(rates) == pytest.approx(0.02, abs=3 * 0.125 / np.sqrt(45 * 200) + 0.002)


@pytest.mark.parametrize("speed, stops", [(0.1, True), (0.02, False)])
def test_a_rest_counts_only_if_the_body_would_have_gone_far_meanwhile(speed, stops):
    t = np.linspace(0, 100, 2001)
    found = drift(t, np.minimum(speed * t, speed * 70), 2.0)  # the remaining way: 3 d at one speed, 0.6 d at the other
    assert (found.end < 75) == stops


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
    # Sometimes blocks have more than one cycle, which scatter more; the mean of 40 errors, each known to 10 %, is known to 2 %.
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


def test_a_sum_over_the_cycle_has_the_error_of_its_cycles():
    """Parts of a cycle are correlated: counted as independent, they would give a third of the true error."""
    rng, cycles, weights = np.random.default_rng(8), 400, np.repeat([1.0, -1.0], 8) / 8
    rates = np.repeat(rng.normal(size=(cycles, 2)), 8, axis=1)
    y = np.concatenate([[0], np.cumsum(rates.ravel())]) / 16
    found = phase_sum(np.arange(cycles * 16 + 1) / 16, y, 1.0, 0, cycles, weights)
    assert found.error == pytest.approx(np.sqrt(2 / cycles), rel=0.15)
    assert found.value == pytest.approx((rates @ weights).mean())
    assert phase_sum([0, 1], [0, 1], 4.0, 0, 1, weights) is None
