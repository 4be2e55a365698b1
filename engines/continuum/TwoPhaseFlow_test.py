"""TwoPhaseFlow from Python: arrays and their shapes, refusals by name, states, and one of Graindrive's solids as vessel."""

import numpy as np
import pytest

from graindrive.solids import surfaces
from graindrive.engines import TwoPhaseFlow, flow_words, pressure_solvers, well_posed_range

CELLS, SPACING = 24, 0.5
LOW = -CELLS * SPACING / 2
X = LOW + (np.arange(CELLS) + 0.5) * SPACING
GRID = dict(cells_x=CELLS, cells_y=CELLS, spacing=SPACING, low_x=LOW, low_y=LOW)
BED = dict(density=1.0, gas_density=1e-3, gas_viscosity=1e-3, largest_viscosity=100.0, gravity_y=-1.0, time_step=0.01)
HALF = np.repeat((X < 0).astype(float)[:, None], CELLS, axis=1)  # rows are y
DRUM = ~surfaces.cylinder((0, 0, 0), axis=(0, 0, 1), radius=4.0)


def flow(solid=DRUM, fraction=HALF, **keys):
    return TwoPhaseFlow(fraction, solid, **{**GRID, **BED, **keys})


def test_arrays_have_rows_of_y_and_columns_of_x():
    made = flow(wall_spin=0.1)
    made.advance(3)
    assert made.fraction.shape == made.pressure.shape == made.openness.shape == (CELLS, CELLS)
    assert made.velocity.shape == (CELLS, CELLS, 2)
    assert made.face_velocity_x.shape == (CELLS, CELLS + 1)
    assert made.face_velocity_y.shape == (CELLS + 1, CELLS)
    # y grows with the row: the bed is in the first rows, except in the wall's layer, which has the values of the cells beside it.
    # In three steps the wall turns by 0.003.
    middle = slice(CELLS // 2 - 4, CELLS // 2 + 4)
    assert np.allclose(made.fraction[middle, CELLS // 2], HALF[middle, CELLS // 2], rtol=0, atol=1e-3)
    # The wall rotates rigidly: u = -spin y, v = spin x, exact in the solid.
    solid = made.openness[:, 0] == 0
    assert np.allclose(made.velocity[solid, 1, 0], -0.1 * X[solid], rtol=0, atol=1e-12)


def test_pressure_of_rest_grows_with_depth():
    made = flow()
    made.advance(10)
    middle, depth = CELLS // 2, -X[X < 0]
    inside = depth < 3
    assert np.allclose(made.pressure[X < 0, middle][inside], depth[inside], rtol=0, atol=0.01)


def test_a_vessel_is_the_section_of_any_solid():
    square = ~surfaces.swept_outline([(-3, -3), (3, -3), (3, 3), (-3, 3)])
    openness = flow(solid=square, transition=1).openness
    x, y = np.meshgrid(X, X)
    # chi by the formula of Oba, Otsuki (2025), (41), where the nearest point is on an edge, not at a corner.
    depth = np.maximum(np.abs(x), np.abs(y)) - 3
    off = np.minimum(np.abs(x), np.abs(y)) < 2
    expected = np.clip(0.5 * (1 - np.sin(np.pi * np.clip(depth, -SPACING, SPACING) / (2 * SPACING))), 0, 1)
    assert np.allclose(openness[off], expected[off], rtol=0, atol=1e-12)


def test_state_and_restore_give_the_same_bits():
    one, other = flow(wall_spin=0.05), flow(wall_spin=0.05)
    one.advance(20)
    kept = one.state()
    one.advance(20)
    other.restore(kept)
    other.advance(20)
    assert other.steps == one.steps == 40 and other.time == one.time
    for name, values in one.state().items():
        assert np.array_equal(values, other.state()[name]), name


def test_what_does_not_fit_is_not_restored():
    made = flow()
    kept = made.state()
    for name, value, words in (
        ("fraction", kept["fraction"][:-1], "fraction must have"),
        ("velocity_x", kept["velocity_x"] * np.nan, "velocity_x must hold finite"),
    ):
        with pytest.raises(ValueError, match=words):
            made.restore({**kept, name: value})
    with pytest.raises(ValueError, match="must have 'pressure'"):
        made.restore({name: value for name, value in kept.items() if name != "pressure"})
    assert all(np.array_equal(value, made.state()[name]) for name, value in kept.items())


@pytest.mark.parametrize(
    "keys, words",
    [
        (dict(cells_x=1), "cells_x must be a whole number from 2"),
        (dict(spacing=-1.0), "spacing of a grid must be positive"),
        (dict(time_step=0.0), "the time step must be positive"),
        (dict(density=float("nan")), "density of the dense fluid must be positive"),
        (dict(gas_density=2.0), "gas must not be denser"),
        (dict(rheology="honey"), "rheology must be one of mu_i"),
        (dict(viscosity="half"), "viscosity must be one of full, split"),
        (dict(viscosity="split", time_step=1.0), "explicit part of the viscosity"),
        (dict(static_friction=0.5), "mu_2 must not be below"),
        (dict(pressure_solver="guess"), "guess"),
        (dict(viscocity="full"), "does not know 'viscocity'; it knows cells_x"),
        (dict(edge=1), "edge must be a word"),
    ],
)
def test_what_cannot_be_is_refused_by_name(keys, words):
    with pytest.raises(ValueError, match=words):
        flow(**keys)


def test_fractions_of_another_shape_and_outside_of_their_range_are_refused():
    with pytest.raises(ValueError, match=r"must have the shape \(24, 24\), got \(24, 23\)"):
        flow(fraction=HALF[:, 1:])
    with pytest.raises(ValueError, match=r"must lie in \[0, 1\], got 1.5"):
        flow(fraction=HALF * 1.5)


def test_a_vessel_without_room_is_refused():
    with pytest.raises(ValueError, match="no cell of the grid is wholly in the fluid"):
        flow(solid=~surfaces.cylinder((0, 0, 0), axis=(0, 0, 1), radius=0.5))


def test_a_time_step_is_heard_at_once_or_refused():
    made = flow(viscosity="split", time_step=1e-4)
    made.advance(1)
    made.time_step = 2e-4
    made.advance(1)
    assert made.time == pytest.approx(3e-4, rel=1e-12)
    with pytest.raises(ValueError, match="explicit part"):
        made.time_step = 1.0
    assert made.time_step == 2e-4


def test_words_are_listed_with_defaults_and_meanings():
    words = {name: (value, meaning) for name, value, meaning in flow_words()}
    assert words["rheology"][0] == "mu_i" and all(meaning for _, meaning in words.values())
    assert "bicgstab" in pressure_solvers() and "multigrid" in pressure_solvers()


def test_ill_posed_where_the_inertial_number_is_out_of_range():
    low, high = well_posed_range(0.246, 0.401, 0.133)
    assert (low, high) == pytest.approx((0.0035329266, 1.1622904), rel=1e-7)  # roots by scipy's brentq
    made = flow(wall_spin=0.05, grain_density=1.0)
    made.advance(50)
    inertial = made.shear_rate / np.sqrt(np.maximum(made.pressure, 1e-5))
    bed = (made.fraction >= 0.5) & (made.openness >= 1)
    assert np.array_equal(made.ill_posed[bed] == 1, ((inertial < low) | (inertial > high))[bed])
    assert not made.ill_posed[~bed].any()


def test_regularised_rheology_is_well_posed_where_the_plain_one_is_not():
    plain, regular = (flow(wall_spin=0.05, grain_density=1.0, rheology=name) for name in ("mu_i", "regularised"))
    for made in (plain, regular):
        made.advance(50)
    assert plain.ill_posed.sum() > 10 * regular.ill_posed.sum()
