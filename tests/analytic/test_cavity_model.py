"""The cavity model of the wiggle paper: its closed forms against numerical quadrature, and its Table 1."""

import numpy as np
import pytest
from graindrive import engines
from graindrive.postproc.wiggle.cavity_model import CavityModel, smallest_amplitude
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

LENGTHS = st.floats(0.5, 20)
TABLE_1 = {
    "disk": (3.5, 2.82),
    "square": (6.5, 3.74),
    "tall": (9.5, 4.47),
    "wide": (4.5, 3.16),
    "triangle": (8.22, 4.17),
}


def height_of(outline):
    return float(np.ptp(outline.vertices[:, 1]))


def model_of(name):
    outline = engines.outline_of(name)
    return CavityModel(outline.fall_height, height_of(outline))


@pytest.mark.parametrize("name", TABLE_1)
def test_table_1_comes_out_cut_to_two_decimals(name):
    l_printed, t_printed = TABLE_1[name]
    model = model_of(name)
    assert model.fall_height == pytest.approx(l_printed, abs=0.01)  # the triangle's 8.227 is printed as 8.22
    assert 0 <= model.first_rising_period - t_printed < 0.01


def lifted_grains(model, period, amplitude, area_fraction):
    """N of Eq. 3.8 by quadrature: the number of grains that fall below the point of no return in half an oscillation."""
    g, d = model.gravity, model.grain_diameter

    def rate(t):  # Eq. 3.7
        below = 2 * g * t**2 - model.fall
        return (
            below
            * 4
            * area_fraction
            / (np.pi * d**2)
            * 2
            * np.pi
            * amplitude
            / period
            * np.sin(2 * np.pi * t / period)
        )

    return quad(rate, np.sqrt(model.fall / (2 * g)), period / 2, epsabs=0, epsrel=1e-12)[0]


@given(LENGTHS, st.floats(1.001, 5), st.floats(0.2, 10), st.floats(0.1, 0.9), st.floats(0.5, 10), st.floats(0.2, 2))
def test_rise_rate_is_the_layer_of_fallen_grains_per_half_period(height, times, amplitude, area_fraction, g, d):
    model = CavityModel(height, height, d, g)
    period = times * model.first_rising_period
    grains = lifted_grains(model, period, amplitude, area_fraction)
    layer = grains * np.pi * d**2 / 4 / (area_fraction * 2 * amplitude)  # text above Eq. 3.11
    # Near T = T_rise the bracket of Eq. 3.15 is a small difference of numbers near one.
    assert model.filling_rate(period) == pytest.approx(layer / (period / 2), rel=1e-9, abs=1e-14 * g * period)


@given(LENGTHS, st.floats(1, 4))
def test_the_printed_forms_3_13_and_3_15_are_the_same(height, times):
    model = CavityModel(height, height)
    period = times * model.first_rising_period
    root = np.sqrt(model.fall / 2)
    angle = 2 * np.pi / period * root
    terms = (1 - 2 / np.pi**2) * period - 2 * model.fall / period - 2 / np.pi**2 * period * np.cos(angle)
    printed = (terms - 4 / np.pi * root * np.sin(angle)) / 2  # Eq. 3.13
    assert model.filling_rate(period) == pytest.approx(printed, rel=1e-10, abs=1e-13 * period)


@pytest.mark.parametrize("name", TABLE_1)
def test_nothing_rises_up_to_the_first_rising_period_and_everything_just_above(name):
    model = model_of(name)
    first = model.first_rising_period
    assert model.filling_rate(first) == pytest.approx(0, abs=1e-14 * first)
    assert np.all(model.rise_rate(np.linspace(0.1, 1, 9) * first) == 0)
    assert np.all(model.rise_rate(np.linspace(1.01, 0.99 * model.fastest_period / first, 9) * first) > 0)


def test_a_full_cavity_lifts_by_what_lies_below_the_point_of_no_return():
    disk, square = model_of("disk"), model_of("square")
    assert disk.fastest_period == pytest.approx(np.sqrt(56))
    assert disk.rise_rate(10.0) == pytest.approx(0.35)  # (7 - 3.5)/10
    assert square.rise_rate(10.0) == 0  # its foot is vertical: h = l


@pytest.mark.parametrize("degrees, l", [(0, 9.5 * np.sqrt(0.75)), (60, 0), (180, 0), (90, 9.5)])
def test_the_point_of_no_return_follows_the_orientation(degrees, l):
    """A triangle on its base, on its apex (only its upper corners have vertical tangents), and with its base upright."""
    outline = engines.outline_of("triangle", (9.5,), np.radians(degrees))
    assert outline.fall_height == pytest.approx(l, abs=1e-9)
    assert CavityModel(outline.fall_height, height_of(outline)).first_rising_period == pytest.approx(np.sqrt(2 * l + 1))


@pytest.mark.parametrize(
    "changes, words",
    [(dict(fall_height=-1), "fall_height must be positive"), (dict(fall_height=8), "must not exceed height, 7")],
)
def test_bodies_that_cannot_be_are_refused(changes, words):
    with pytest.raises(ValueError, match=words):
        CavityModel(**{**dict(fall_height=3.5, height=7.0), **changes})
    with pytest.raises(ValueError, match="period must be positive"):
        CavityModel(3.5, 7).rise_rate(0)


def test_the_smallest_amplitude_is_half_a_grain():
    assert smallest_amplitude() == 0.5
