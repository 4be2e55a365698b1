"""Verdicts and their arithmetic: definitions, and never `reproduced` if the error is unknown or too large."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from graindrive.postproc.campaign.verdicts import Agrees, Between, Claim, Verdict, above, below, tally
from graindrive.postproc.measured import (
    Limit,
    Measured,
    birge_ratio,
    mean_of,
    polynomial_through,
    power_of,
    steepest_place,
)

RULES = [Agrees(1, 0.1, 0.2), above(0), below(3), Between(0, 3)]
NUMBERS = st.floats(-1e6, 1e6)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("error", [math.nan, math.inf, -1.0])
def test_an_unknown_error_decides_nothing(rule, error):
    assert rule.judge(Measured(1.0, error)) is Verdict.NOT_DECIDED


@pytest.mark.parametrize("rule", RULES)
def test_a_missing_value_decides_nothing(rule):
    assert rule.judge(Measured(math.nan, 0.1)) is Verdict.NOT_DECIDED


@given(NUMBERS, st.floats(0.1001, 1e6))
def test_agreement_is_never_found_by_a_measurement_that_cannot_resolve_it(value, error):
    assert Agrees(1, 0.1, 0.2).judge(Measured(value, error)) is not Verdict.REPRODUCED


@given(NUMBERS, st.floats(0, 1e6))
def test_above_and_below_never_hold_both(value, error):
    found = [rule.judge(Measured(value, error)) for rule in (above(0), below(0))]
    assert found.count(Verdict.REPRODUCED) <= 1
    assert (found[0] is Verdict.NOT_DECIDED) == (found[1] is Verdict.NOT_DECIDED)


@pytest.mark.parametrize(
    "rule, value, error, verdict",
    [
        (Agrees(2, 0.1, 0.2), 2.29, 0.1, "reproduced"),  # 0.1 + 2 x 0.1 = 0.3 away is the limit
        (Agrees(2, 0.1, 0.2), 2.31, 0.1, "not reproduced"),
        (Agrees(2, 0.1, 0.2), 2.0, 0.11, "not decided"),
        (Agrees(2, 0.1, 0.2), 9.0, 1.0, "not reproduced"),  # too coarse to agree, but far enough to differ
        (above(0), 0.21, 0.1, "reproduced"),
        (above(0), 0.19, 0.1, "not decided"),
        (above(0), -0.21, 0.1, "not reproduced"),
        (below(0.5), 0.29, 0.1, "reproduced"),
        (below(0.5), 0.31, 0.1, "not decided"),
        (Between(0, 1), 0.5, 0.24, "reproduced"),
        (Between(0, 1), 0.5, 0.26, "not decided"),
        (Between(0, 1), 1.3, 0.14, "not reproduced"),
    ],
)
def test_rules_at_their_limits(rule, value, error, verdict):
    assert rule.judge(Measured(value, error)).value == verdict


@pytest.mark.parametrize(
    "rule, value, side, verdict",
    [
        (Agrees(2.75, 0.25, 1), 3.0, ">", "not reproduced"),
        (Agrees(2.75, 0.25, 1), 2.9, ">", "not decided"),
        (Agrees(2.75, 0.25, 1), 2.5, "<", "not reproduced"),
        (Agrees(2.75, 0.25, 1), 2.6, "<", "not decided"),
        (above(1), 1.5, ">", "reproduced"),
        (above(1), 0.5, ">", "not decided"),
        (above(1), 0.5, "<", "not reproduced"),
        (above(1), 1.5, "<", "not decided"),
        (below(1), 0.5, "<", "reproduced"),
        (below(1), 1.5, ">", "not reproduced"),
        (Between(0, 1), 0.5, ">", "not decided"),
        (Between(0, 1), 1.0, ">", "not reproduced"),
    ],
)
def test_a_bound_tells_for_a_claim_only_where_the_claim_is_a_bound_too(rule, value, side, verdict):
    assert rule.judge(Limit(value, math.nan, side)).value == verdict


def test_pooled_repeats_tell_how_much_too_small_their_errors_are():
    rng = np.random.default_rng(6)
    groups = [[Measured(m + rng.normal(0, 0.3), 0.1) for _ in range(2)] for m in rng.normal(size=200)]
    assert birge_ratio(groups) == pytest.approx(3, rel=3 / np.sqrt(2 * 200))
    honest = [[Measured(rng.normal(0, 0.1), 1.0) for _ in range(3)] for _ in range(10)]
    assert birge_ratio(honest) == 1  # errors are never made smaller
    assert birge_ratio([]) == birge_ratio([[Measured(1, 0.1)], [Measured(1, math.nan), Measured(2, 0.1)]]) == 1


def test_rules_state_themselves():
    assert str(Agrees(2, 0.1, 0.2)) == "within 0.1 + 2σ of 2, if 2σ ≤ 0.2"
    assert [str(above(0)), str(below(1)), str(Between(0, 1))] == [
        "above 0 by 2σ",
        "below 1 by 2σ",
        "between 0 and 1, 2σ inside",
    ]


def test_a_claim_tells_number_and_verdict_and_claims_are_counted():
    claims = [Claim("x is 1", "Eq. 1", "1", Measured(v, 0.01), Agrees(1, 0, 0.1)) for v in (1.0, 2.0, math.nan)]
    assert str(claims[0]) == "x is 1: 1.000 ± 0.010, reproduced"
    assert claims[2].number == "no data"
    assert tally(claims) == "1 reproduced, 1 not reproduced, 1 not decided"


def test_ratio_and_difference_add_errors_in_squares():
    ratio, difference = Measured(6, 0.3) / Measured(2, 0.1), Measured(6, 0.3) - Measured(2, 0.4)
    assert ratio.value == 3 and ratio.error == pytest.approx(3 * np.hypot(0.05, 0.05))
    assert difference.value == 4 and difference.error == pytest.approx(0.5)


def test_division_by_what_may_be_zero_is_not_trusted():
    assert math.isinf((Measured(1, 0.1) / Measured(0.1, 0.2)).error)


def test_mean_takes_the_larger_of_own_errors_and_scatter():
    alike = mean_of([Measured(1.0, 0.3)] * 4)
    apart = mean_of([Measured(v, 0.01) for v in (0.0, 1.0, 2.0)])
    assert alike.error == pytest.approx(0.15)
    assert apart.error == pytest.approx(1 / np.sqrt(3))


def test_two_repeats_without_errors_do_not_make_one():
    assert math.isnan(mean_of([Measured(v, math.nan) for v in (0.0, 1.0)]).error)
    assert mean_of([Measured(v, math.nan) for v in (0.0, 1.0, 2.0)]).error == pytest.approx(1 / np.sqrt(3))
    assert math.isnan(mean_of([]).value)


def test_error_of_a_slope_is_its_scatter_over_many_experiments():
    x, sigma, random = np.array([1.0, 2, 3, 5]), np.array([0.1, 0.2, 0.1, 0.3]), np.random.default_rng(1)
    fits = [
        polynomial_through(x, [Measured(v, s) for v, s in zip(random.normal(2 * x + 1, sigma), sigma)], 1)
        for _ in range(2000)
    ]
    slopes, intercepts = np.array([[c.value for c in fit] for fit in fits]).T
    # means of 2000: 5 standard errors; Birge's factor is 1.0 at least, so stated errors are above the scatter
    assert abs(slopes.mean() - 2) < 5 * slopes.std() / np.sqrt(2000)
    assert abs(intercepts.mean() - 1) < 5 * intercepts.std() / np.sqrt(2000)
    least = min(fit[0].error for fit in fits)
    assert least == pytest.approx(slopes.std(), rel=0.08)  # a standard deviation of 2000: 1.6 %, times 5


def test_points_that_no_line_fits_do_not_make_a_precise_slope():
    x = np.arange(5.0)
    straight = polynomial_through(x, [Measured(v, 0.01) for v in x], 1)[0]
    bent = polynomial_through(x, [Measured(v**2, 0.01) for v in x], 1)[0]
    assert bent.error > 50 * straight.error


def test_exponent_of_a_power_law():
    x = np.array([0.25, 0.5, 1.0, 2.0])
    slope = power_of(x, [Measured(3 * v**1.7, 0.03 * v**1.7) for v in x])
    assert slope.value == pytest.approx(1.7, abs=1e-12)
    assert slope.error == pytest.approx(0.01 / np.sqrt(np.sum((np.log(x) - np.log(x).mean()) ** 2)), rel=1e-9)


@pytest.mark.parametrize(
    "points", [[Measured(1, 0.1)], [Measured(1, 0.1), Measured(2, math.nan)], [Measured(-1, 0.1)] * 2]
)
def test_exponent_is_unknown_without_two_good_points(points):
    assert math.isnan(power_of([1, 2][: len(points)], points).value)


def test_steepest_place_is_the_middle_of_the_steepest_interval():
    x = [0, 0.5, 1, 1.5, 5]
    sharp = steepest_place(x, [Measured(v, 1e-6) for v in (0, 0.1, 0.6, 0.8, 1.0)])
    vague = steepest_place(x, [Measured(v, 0.5) for v in (0, 0.1, 0.6, 0.8, 1.0)])
    assert sharp == Measured(0.75, 0.25)
    assert vague.error > 0.4
