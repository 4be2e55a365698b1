"""Surface, profile, thickness and flow rates of made-up flows in a drum against their closed forms; errors from blocks."""

import dataclasses

import numpy as np
import pytest
from drum_fields import MadeUpDrum

from graindrive.postproc.drum import flow, steady
from graindrive.postproc.drum.blocks import Blocks, blocks_of, dem_continuum_difference, steady_flow

BIN = 0.6  # d


def found_in(made, surface_level=0.7):
    return flow.analysed(made.field(surface_level), made.diameter, made.omega)


@pytest.mark.parametrize("surface_level", [0.7, 0.5, 0.41])
@pytest.mark.parametrize("angle", [-12.0, 0.0, 7.3, 20.0, 31.0])
def test_the_angle_of_a_plane_surface_is_found(angle, surface_level):
    found = found_in(MadeUpDrum(angle_deg=angle), surface_level)
    # The points of 63 columns scatter by a third of a bin at most, as noise 0.2 d/(18 d/sqrt(3) sqrt(63)) = 0.13 degrees.
    assert abs(found.numbers["surface_angle_deg"] - angle) < 0.1


@pytest.mark.parametrize("angle", [0.0, 20.0, 31.0])
@pytest.mark.parametrize("height", [-2.0, 0.0, 1.5])
def test_the_place_of_the_surface_is_found_to_a_bin(angle, height):
    depth = found_in(MadeUpDrum(angle_deg=angle, height=height)).surface.depth
    # A level other than half of the fraction is interpolated between the bin that the surface cuts and its neighbour.
    assert abs(depth + height * np.cos(np.radians(angle))) < BIN


def test_half_of_the_fraction_is_at_the_surface():
    depth = found_in(MadeUpDrum(angle_deg=20, height=1.5), surface_level=0.41).surface.depth
    assert abs(depth + 1.5 * np.cos(np.radians(20))) < 0.02 * BIN  # linear between bins, as the fraction is


@pytest.mark.parametrize("angle", [-12.0, 0.0, 20.0, 31.0])
def test_the_profile_is_that_of_the_closed_form(angle):
    made = MadeUpDrum(angle_deg=angle)
    profile = found_in(made).profile
    inside = (profile.z > flow.SQUARE) & (profile.z < made.diameter / 2 - flow.SQUARE)
    # The mean of a parabola over a square is its middle plus half the curvature times the second moment of the square, and
    # what linear interpolation adds; an error of the angle of 0.1 degrees turns u by Omega D/2 times that.
    bend = 2 * made.speed / made.layer**2 / 2 * (flow.SQUARE**2 / 12 + BIN**2 / 6)
    turned = made.omega * made.diameter / 2 * np.radians(0.1)
    assert inside.sum() > 55
    assert np.abs(profile.u - made.u(profile.z))[inside].max() < 1.5 * bend + turned


@pytest.mark.parametrize("angle", [0.0, 20.0, 31.0])
@pytest.mark.parametrize("layer", [15.0, 26.0, 40.0])
def test_the_thickness_is_found_to_a_fifth_of_a_bin(angle, layer):
    made = MadeUpDrum(angle_deg=angle, layer=layer)
    found = found_in(made).numbers["thickness_over_diameter"] * made.diameter
    # Squares and bins smooth u over 0.4 d: 0.18 d^2 u''/2 over u' is 0.04 d in the thinnest layer, a straight line across a
    # square as much again.
    assert abs(found - made.thickness) < 0.2 * BIN


def test_the_layer_is_counted_from_the_surface():
    found = found_in(MadeUpDrum(height=2.0)).numbers
    layer = found["thickness_over_diameter"] - found["surface_over_diameter"]
    assert found["layer_over_diameter"] == pytest.approx(layer, rel=1e-12)
    assert found["surface_over_diameter"] < 0  # above the axis


def test_what_flows_down_comes_up():
    made = MadeUpDrum()
    found, h = found_in(made).numbers, made.thickness
    down = -made.omega * h**2 / 2 + made.speed * made.layer / 3 * (1 - (1 - h / made.layer) ** 3)
    expected = made.density * down / (made.omega * made.diameter**2)
    # Bins that the surface cuts have errors of first order, and the square at h contains both signs of u.
    assert found["flow_down"] == pytest.approx(expected, rel=0.01)
    assert found["flow_up"] == pytest.approx(-expected, rel=0.01)
    assert abs(found["flow_balance"]) < 0.01


def test_the_static_part_turns_with_the_drum():
    made = MadeUpDrum()
    found = found_in(made).numbers
    assert (
        found["rigid_deviation"] < 2e-3
    )  # the error comes from bins: the angle is found to 0.1 degrees, whose cosine differs from 1 by 2e-6
    assert found["packing_fraction"] == pytest.approx(made.density, rel=1e-12)


def test_a_layer_that_slips_deviates_from_rigid_rotation():
    made = MadeUpDrum()
    field = made.field()
    slower = dataclasses.replace(field, velocity_x=0.9 * field.velocity_x, velocity_y=0.9 * field.velocity_y)
    found = flow.analysed(slower, made.diameter, made.omega).numbers
    assert found["rigid_deviation"] == pytest.approx(0.1, abs=2e-3)


def test_the_rotated_frame_is_that_of_the_paper():
    a, X, Z = np.radians(20), 3.0, -7.0
    x, z = -X * np.cos(a) - Z * np.sin(a), X * np.sin(a) - Z * np.cos(a)  # Eq. 48
    assert flow.from_rotated(x, z, a) == pytest.approx((X, Z), abs=1e-14)


def test_nothing_outside_of_the_drum_counts():
    made = MadeUpDrum()
    field = made.field()
    shell = np.hypot(field.x[None, :], field.y[:, None]) > made.diameter / 2
    filled = dataclasses.replace(field, fraction=np.where(shell, 1.0, field.fraction))
    one, other = (flow.analysed(f, made.diameter, made.omega).numbers for f in (field, filled))
    assert one == other


@pytest.mark.parametrize("fraction", [0.0, 0.82])
def test_an_empty_and_a_full_drum_have_no_surface(fraction):
    made = MadeUpDrum()
    field = made.field()
    zero = np.zeros_like(field.fraction)
    level = dataclasses.replace(field, fraction=zero + fraction, velocity_x=zero, velocity_y=zero)
    found = flow.analysed(
        level, 10 * made.diameter, made.omega
    ).numbers  # so large that its wall is outside of the grid
    assert np.isnan(found["surface_angle_deg"]) and np.isnan(found["thickness_over_diameter"])
    assert found["flow_down"] == 0 and np.isnan(found["flow_balance"])


def test_a_grid_of_another_shape_is_refused():
    with pytest.raises(ValueError, match=r"fraction must have the grid's shape \(2, 3\), got \(3, 2\)"):
        flow.FlowField(np.arange(3.0), np.arange(2.0), np.zeros((3, 2)), np.zeros((2, 3)), np.zeros((2, 3)), 0.7)


def test_the_difference_of_two_profiles():
    profile = found_in(MadeUpDrum()).profile
    faster = dataclasses.replace(profile, u=1.1 * profile.u)
    assert flow.difference(profile, profile, 150) == 0
    assert flow.difference(profile, faster, 150) == pytest.approx(0.1, rel=1e-12)


def test_profiles_of_other_squares_are_compared_at_the_same_depths():
    made = MadeUpDrum()
    coarse = flow.profile_of(made.field(), np.radians(made.angle_deg), made.diameter, edge=2.0)
    assert (
        0 < flow.difference(found_in(made).profile, coarse, made.diameter) < 0.02
    )  # the profile's curvature over 2 d, in a layer of 26 d


def noisy_blocks(spread, count=12, seed=3):
    """Blocks of the made-up flow whose solid fractions differ by relative factors of that spread."""
    made = MadeUpDrum()
    field = made.field()
    factors = 1 + spread * np.random.default_rng(seed).standard_normal(count)
    velocity = np.stack([field.velocity_x, field.velocity_y], axis=-1)
    fraction = np.array([f * field.fraction for f in factors])
    return factors, blocks_of(field.x, field.y, fraction, [velocity] * count, np.full(count, 7), 0.5)


def test_errors_of_a_mean_over_blocks_are_those_of_independent_blocks():
    factors, blocks = noisy_blocks(0.01)
    found = steady_flow(blocks, 150.0, 6.28e-3).summary
    assert found["packing_fraction"] == pytest.approx(0.82 * factors.mean(), rel=1e-12)
    # the jackknife of a mean is the usual error
    assert found["packing_fraction_err"] == pytest.approx(0.82 * factors.std(ddof=1) / np.sqrt(12), rel=1e-9)
    assert found["thickness_over_diameter_err"] < 1e-9  # all blocks have the same flow


def test_one_block_has_no_error():
    _, blocks = noisy_blocks(0.01, count=1)
    found = steady_flow(blocks, 150.0, 6.28e-3)
    assert np.isnan(found.summary["packing_fraction_err"]) and np.isnan(found.profile["u_err"]).all()
    assert np.isfinite(found.summary["packing_fraction"])


def test_blocks_that_saw_nothing_are_left_out():
    made = MadeUpDrum()
    field = made.field()
    velocity = np.stack([field.velocity_x, field.velocity_y], axis=-1)
    fraction = np.array([field.fraction, 0 * field.fraction])
    blocks = blocks_of(field.x, field.y, fraction, [velocity, np.nan * velocity], [5, 0], 0.7)
    assert len(blocks) == 1 and np.array_equal(blocks.mean().fraction, field.fraction)


def test_blocks_are_weighted():
    grid, one = np.arange(2.0), np.ones((2, 2))
    blocks = Blocks(
        grid, grid, np.array([one, 3 * one]), np.array([one, one]), np.array([one, one]), np.array([3, 1]), 0.5
    )
    assert np.all(blocks.mean().fraction == 1.5) and np.all(blocks.mean().velocity_x == 1 / 1.5)
    assert np.all(blocks.mean(without=0).fraction == 3)


def test_the_error_of_the_difference_comes_from_both():
    _, grains = noisy_blocks(0.0)
    speeds = 1 + 0.02 * np.random.default_rng(1).standard_normal(12)
    moved = Blocks(
        grains.x,
        grains.y,
        grains.fraction,
        grains.flux_x * (1.1 * speeds)[:, None, None],
        grains.flux_y * (1.1 * speeds)[:, None, None],
        grains.weight,
        0.5,
    )
    one, other = (steady_flow(blocks, 150.0, 6.28e-3) for blocks in (grains, moved))
    value, error = dem_continuum_difference(one, other, 150.0)
    assert value == pytest.approx(1.1 * speeds.mean() - 1, rel=1e-9)
    assert error == pytest.approx(1.1 * speeds.std(ddof=1) / np.sqrt(12), rel=1e-9)


def test_the_centre_of_mass_turns_with_the_surface():
    made = MadeUpDrum(angle_deg=17)
    field = made.field().within(made.diameter)
    x, y = np.meshgrid(field.x, field.y)
    assert abs(steady.centre_angle(x, y, field.fraction) - 17) < 0.05  # bins at the wall: 0.6 d of 75 d, all around


def test_a_flow_is_steady_when_its_slope_no_longer_drifts():
    turn = np.arange(1.0, 181.0)
    rising = np.minimum(turn, 60) / 2
    assert not steady.is_steady(turn[:89], rising[:89], 90)  # too soon
    assert not steady.is_steady(turn[:70], rising[:70], 60)  # the slope rose until 60
    assert steady.is_steady(turn[:120], rising[:120], 90)
    assert not steady.is_steady(turn, 20 + 0.03 * turn, 90)  # 0.9 degrees from third to third
    assert not steady.is_steady([], [], 90) and not steady.is_steady([90.0, 91.0], [20.0, 20.0], 90)
