"""Outlines as in files (rounded, superfluous vertices, rotated, far away) give the beads and the solid of the exact polygon."""

import math
from fractions import Fraction

import numpy as np
import pytest
from graindrive.engines import Outline, clump_of
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

BEAD = 0.5
TOUCH = 1e-5  # over a bead's radius: the tolerance of clump_of


def distances(corners, points):
    """Return the distance of each point (n, 2) to the closed polygon (m, 2)."""
    edges = np.roll(corners, -1, axis=0) - corners
    to = points[:, None, :] - corners
    along = np.clip(np.sum(to * edges, axis=-1) / np.sum(edges**2, axis=-1), 0, 1)
    return np.hypot(*np.moveaxis(to - along[..., None] * edges, -1, 0)).min(axis=1)


def is_inside(corners, points):
    """Return whether each point lies in the polygon, by the crossings of a ray along x."""
    a, b = corners, np.roll(corners, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return np.sum(((a[:, 1] > y) != (b[:, 1] > y)) & (x < at), axis=1) % 2 == 1


def exact_solid(corners):
    """Return centroid (2,) and I/m about it of a polygon, computed in exact fractions."""
    v = [(Fraction(float(x)), Fraction(float(y))) for x, y in corners]
    area = first_x = first_y = polar = Fraction(0)
    for (ax, ay), (bx, by) in zip(v, v[1:] + v[:1]):
        twice = ax * by - ay * bx
        area += twice / 2
        first_x += twice * (ax + bx) / 6
        first_y += twice * (ay + by) / 6
        polar += twice * (ax * ax + ax * bx + bx * bx + ay * ay + ay * by + by * by) / 12
    x, y = first_x / area, first_y / area
    return (x, y), polar / area - x * x - y * y


@st.composite
def polygons(draw):
    """Draw a star-shaped polygon about (0, 0), turned, whose corners all turn by more than a curve does."""
    count = draw(st.integers(3, 9))
    radii = draw(st.lists(st.floats(2, 6), min_size=count, max_size=count))
    places = draw(st.lists(st.floats(0, 0.6), min_size=count, max_size=count))
    turn = draw(st.floats(0, 2 * math.pi))
    angles = turn + 2 * math.pi * (np.arange(count) + np.array(places)) / count
    assume(np.diff(angles, append=angles[0] + 2 * math.pi).max() < 3)  # otherwise (0, 0) may be outside
    return np.array(radii)[:, None] * np.c_[np.cos(angles), np.sin(angles)]


def turns(corners):
    """Return by how much the polygon turns at each corner [rad]."""
    into = corners - np.roll(corners, 1, axis=0)
    out = np.roll(into, -1, axis=0)
    return np.arctan2(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0], np.sum(into * out, axis=1))


@st.composite
def littered(draw, corners, digits, shift):
    """Draw the same polygon with points on its edges and repeated ones, from any vertex on, in any sense, rounded."""
    points = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0)):
        between = sorted(draw(st.lists(st.floats(0.05, 0.95), max_size=3)))
        points += [a] * draw(st.integers(1, 2)) + [a + (b - a) * part for part in between]
    points = np.roll(points, draw(st.integers(0, len(points) - 1)), axis=0)
    points = points[::-1] if draw(st.booleans()) else points
    return np.round(points + shift, digits)


def beads_or_none(vertices):
    try:
        return clump_of(Outline(vertices), BEAD, 3.0)
    except ValueError as error:
        assert "too thin" in str(error)
        return None


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_beads_touch_from_inside_and_are_those_of_the_clean_polygon(data):
    corners = data.draw(polygons())
    assume(np.abs(turns(corners)).min() > 0.15)  # rounding must not decide whether a vertex counts as a corner
    digits = data.draw(st.integers(6, 9))
    shift = np.array([data.draw(st.sampled_from([0, 1, -1])) * data.draw(st.floats(0, 1e7)) for _ in range(2)])
    vertices = data.draw(littered(corners, digits, shift))
    clean, found = beads_or_none(corners), beads_or_none(vertices)
    assume(clean is not None and found is not None)
    outline = Outline(vertices)
    own = outline.about_centroid.vertices
    radius = found.bead_radius
    assert np.abs(distances(own, found.beads) / radius - 1).max() < TOUCH
    assert is_inside(own, found.beads).all()
    assert len(found.beads) == len(clean.beads)
    # Rounding by up to 1e-6 moves a bead in a corner by that over the sine of half its angle, and those between with it.
    sharpest = (math.pi - np.abs(turns(corners)).max()) / 2
    assert cKDTree(clean.beads).query(found.beads)[0].max() < 1e-5 / math.sin(sharpest)


@settings(max_examples=100, deadline=None)
@given(st.data())
def test_centroid_and_inertia_are_exact_far_away_too(data):
    corners = data.draw(polygons())
    shift = np.array([data.draw(st.floats(-1e7, 1e7)) for _ in range(2)])
    vertices = data.draw(littered(corners, data.draw(st.integers(6, 9)), shift))
    outline = Outline(vertices)
    (x, y), moment = exact_solid(vertices)
    assert outline.second_moment == pytest.approx(float(moment), rel=1e-11)  # collinear within 1e-12 is left out
    assert outline.centroid == pytest.approx((float(x), float(y)), abs=4e-9)  # the distance of doubles near 1e7 is 2e-9
    own = outline.about_centroid.vertices
    lowest = min(range(len(vertices)), key=lambda i: (vertices[i][1], vertices[i][0]))
    exact = [float(Fraction(float(c)) - mean) for c, mean in zip(vertices[lowest], (x, y))]
    assert np.hypot(*(own - exact).T).min() < 1e-11  # the differences keep all digits


@settings(max_examples=60, deadline=None)
@given(polygons(), st.floats(-4, 1), st.floats(0.02, 1))
def test_any_bead_that_fits_touches(corners, exponent, spacing):
    diameter = 10**exponent
    try:
        clump = clump_of(Outline(corners), diameter, 1.0, spacing)
    except ValueError as error:
        assert any(words in str(error) for words in ("too thin", "at most 1e5 beads", "must not exceed"))
        return
    own = Outline(corners).about_centroid.vertices
    sample = clump.beads[:: max(1, len(clump.beads) // 2000)]
    assert np.abs(distances(own, sample) / clump.bead_radius - 1).max() < TOUCH
