"""Surfaces from Python: distances in closed form, set algebra, recipes and pickles, sampled functions, refusals."""

import math
import pickle

import numpy as np
import pytest
from graindrive import engines
from graindrive.solids import surfaces

EPS = np.finfo(float).eps
POINTS = np.random.default_rng(3).uniform(-2, 2, (5000, 3))
RING, THICKNESS = 1.0, 0.3


def torus(points):
    """The distance from a ring about z, in closed form."""
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - RING, points[:, 2]) - THICKNESS


def sampled_torus(spacing=0.1):
    return surfaces.sampled(torus, (-2.2, -2.2, -1.5), (2.2, 2.2, 1.5), spacing)


def every_kind():
    ball, plane = surfaces.ball((0.1, 0.2, -0.3), 0.7), surfaces.half_space((0, 0, 0.1), (1, 2, 3))
    return {
        "ball": ball,
        "half_space": plane,
        "cylinder": surfaces.cylinder((0, 0.1, 0), (1, 1, 0), 0.3, 2),
        "endless cylinder": surfaces.cylinder((0, 0.1, 0), (1, 1, 0), 0.3),
        "swept_outline": surfaces.swept_outline([(0, 0), (1, 0), (0, 1 / 3)], -0.5, 1),
        "placed": ball.placed((1, 0.5, -0.5), (1, 1, 1), 0.3),
        "union": ball | plane,
        "intersection": ball & plane,
        "difference": ball - plane,
        "complement": ~ball,
        "sampled": sampled_torus(0.2),
    }


KINDS = every_kind()
each_kind = pytest.mark.parametrize("kind", KINDS)


@each_kind
def test_recipes_and_pickles_bring_every_bit_back(kind):
    surface = KINDS[kind]
    points = POINTS[np.abs(POINTS[:, 2]) < 1.4]  # within the sampled grid
    for other in (surfaces.Surface(surface.recipe), pickle.loads(pickle.dumps(surface))):
        assert other.recipe == surface.recipe and other == surface
        assert np.array_equal(other.distance(points), surface.distance(points))
        assert np.array_equal(other.normal(points), surface.normal(points))


def test_every_kind_of_recipe_is_tried():
    assert {s.recipe.split()[0] for s in KINDS.values()} == set(surfaces.surface_kinds())


@each_kind
def test_normals_have_unit_length_and_bounds_hold_the_solid(kind):
    surface = KINDS[kind]
    assert np.abs(np.linalg.norm(surface.normal(POINTS), axis=1) - 1).max() < 8 * EPS
    low, high = surface.bounds()
    inside = POINTS[surface.distance(POINTS) < 0]
    assert len(inside) > 3 and np.all(inside >= low) and np.all(inside <= high)


def test_distances_are_those_of_the_closed_forms():
    close = dict(rtol=0, atol=16 * EPS)  # sums of a few numbers up to 4
    x, y, z = POINTS.T
    np.testing.assert_allclose(
        surfaces.ball((1, 0, 0), 0.5).distance(POINTS), np.sqrt((x - 1) ** 2 + y**2 + z**2) - 0.5, **close
    )
    np.testing.assert_allclose(surfaces.half_space((0, 0, 1), (0, 0, 5)).distance(POINTS), z - 1, **close)
    np.testing.assert_allclose(
        surfaces.cylinder((0, 0, 0), (0, 2, 0), 0.5).distance(POINTS), np.hypot(x, z) - 0.5, **close
    )
    square = surfaces.swept_outline([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    q = np.abs(POINTS[:, :2]) - 1
    expected = np.hypot(*np.maximum(q, 0).T) + np.minimum(q.max(axis=1), 0)
    np.testing.assert_allclose(square.distance(POINTS), expected, **close)


def test_a_swept_outline_lies_between_low_and_high_and_along_its_axis():
    bar = [(-0.2, -0.1), (0.3, -0.1), (0.3, 0.1), (-0.2, 0.1)]
    low, high = surfaces.swept_outline(bar, 1, 3).bounds()
    assert (low.tolist(), high.tolist()) == ([-0.2, -0.1, 1], [0.3, 0.1, 3])
    low, high = surfaces.swept_outline(bar, 1, 3, axis=(5, 0, 0)).bounds()  # z becomes x, x becomes -z
    np.testing.assert_allclose([low, high], [[1, -0.1, -0.3], [3, 0.1, 0.2]], atol=1e-14)
    low, high = surfaces.swept_outline(bar, 1, 3, axis=(0, 0, -1)).bounds()  # turned about x
    np.testing.assert_allclose([low, high], [[-0.2, -0.1, -3], [0.3, 0.1, -1]], atol=1e-14)
    disk = surfaces.swept_outline(engines.outline_of("disk", 2.0), 0, 1)
    np.testing.assert_allclose(disk.distance([[0.6, 0.8, 0.5], [0, 0, 3]]), [0, 2], atol=4 * EPS)


def test_operators_are_those_of_sets():
    a, b = surfaces.ball((0, 0, 0), 1), surfaces.ball((1, 0, 0), 1)
    inside = lambda s: s.distance(POINTS) < 0  # noqa: E731
    assert np.array_equal(inside(a | b), inside(a) | inside(b))
    assert np.array_equal(inside(a & b), inside(a) & inside(b))
    assert np.array_equal(inside(a - b), inside(a) & ~inside(b))
    assert np.array_equal(inside(~a), ~inside(a))
    assert (~~a).recipe == a.recipe
    assert (a | b | a | b).recipe.startswith("union 4 ball")  # one union, not unions of unions
    with pytest.raises(TypeError, match="unsupported operand .*'Surface' and 'int'"):
        a | 3


def test_placed_turns_then_shifts():
    rod = surfaces.cylinder((0, 0, 0), (0, 0, 1), 0.1, 2).placed((0, 5, 0), axis=(0, 3, 0), angle=math.pi / 2)
    low, high = rod.bounds()  # along x now
    np.testing.assert_allclose([low, high], [[-1, 4.9, -0.1], [1, 5.1, 0.1]], atol=1e-14)


def test_a_torus_is_sampled_by_one_call():
    calls = []

    def function(points):
        calls.append(points.shape)
        return torus(points)

    surface = surfaces.sampled(function, (-2, -2, -1), (2, 2, 1), 0.05)
    assert calls == [(81 * 81 * 41, 3)]
    near = POINTS[np.abs(torus(POINTS)) < 0.1]
    # spacing^3 over the square of the smallest radius of curvature, 0.3 - 0.1 at these points
    np.testing.assert_allclose(surface.distance(near), torus(near), rtol=0, atol=0.05**3 / 0.2**2)


def refused(call, *words):
    with pytest.raises(ValueError) as refusal:
        call()
    for word in words:
        assert word in str(refusal.value)


def test_bad_input_is_refused_with_the_rule_the_value_and_the_way_out():
    refused(lambda: surfaces.ball((0, 0), 1), "centre must be three numbers, got (0, 0); give (x, y, z)")
    refused(lambda: surfaces.ball("here", 1), "centre must be three numbers, got 'here'")
    refused(lambda: surfaces.ball((0, 0, 0), "big"), "radius must be a number, got 'big'")
    refused(lambda: surfaces.ball((0, 0, 0), -1), "ball radius must be positive and finite, got -1; give a length > 0")
    refused(lambda: surfaces.ball((0, math.inf, 0), 1), "ball centre must be finite numbers, got (0, inf, 0)")
    refused(lambda: surfaces.ball((0, math.nan, 0), 1), "centre of ball must be a number, got 'nan' as word 3")
    refused(lambda: surfaces.half_space((0, 0, 0), (0, 0, 0)), "half-space normal must not be zero", "any length")
    refused(lambda: surfaces.cylinder((0, 0, 0), (0, 0, 1), 1, 0), "cylinder length must be positive, got 0")
    refused(lambda: surfaces.swept_outline([(0, 0), (1, 0)]), "3")
    refused(lambda: surfaces.swept_outline([(0, 0), (1, 0), (0, 1)], low=0), "both be finite", "give both ends")
    refused(
        lambda: surfaces.swept_outline([(0, 0), (1, 0), (0, 1)], 2, 1), "low must be less than high, got 2.0 and 1.0"
    )
    refused(
        lambda: surfaces.swept_outline([(0, 0), (1, 0), (0, 1)], axis=(0, 0, 0)), "axis must be finite and not zero"
    )
    refused(lambda: KINDS["ball"].placed(axis=(0, 0, 0)), "axis not zero, got [0.0, 0.0, 0.0]")
    refused(lambda: KINDS["ball"].placed(angle=math.inf), "angle must be finite")
    refused(lambda: KINDS["ball"].distance([1, 2, 3]), "shape (n, 3)", "got shape (3,); give [[x, y, z]] for one")
    refused(lambda: KINDS["ball"].normal([[1, 2, math.nan]]), "must be finite numbers, got one that is not in row 0")
    refused(
        lambda: surfaces.Surface("ball 0 0 0 x"), "radius of ball must be a number, got 'x' as word 5 of the recipe"
    )


def test_functions_that_are_no_distances_are_refused_by_name():
    box = (-2, -2, -2), (2, 2, 2), 0.2
    refused(lambda: surfaces.sampled(lambda p: p, *box), "one distance for each of 9261 points", "got shape (9261, 3)")
    refused(lambda: surfaces.sampled(lambda p: 0.0, *box), "got shape ()")
    refused(lambda: surfaces.sampled(lambda p: torus(p) + math.inf, *box), "finite")
    refused(
        lambda: surfaces.sampled(lambda p: 0.6 * torus(p), *box),
        "must have the length 1 near the surface",
        "between 0.5",
    )
    refused(lambda: surfaces.sampled(lambda p: (p**2).sum(axis=1) - 1, *box), "f/|grad f| is near it")
    refused(
        lambda: surfaces.sampled(lambda p: p[:, 2], *box),
        "with distances > 0 at all outer nodes, got the least of them -2",
    )
    refused(lambda: surfaces.sampled(lambda p: torus(p) + 9, *box), "got")  # no solid in the grid
    refused(lambda: surfaces.sampled(torus, (0, 0, 0), (1, 1, -1), 0.1), "low must be less than high along each axis")
    refused(lambda: surfaces.sampled(torus, (0, 0, 0), (1, 1, 1), 0), "spacing must be positive and finite, got 0.0")
