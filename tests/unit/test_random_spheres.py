"""Random packings of spheres from Python: no overlaps, out of solids, and bad input refused by name."""

import numpy as np
import pytest

pytest.importorskip("yade")

from graindrive import engines  # noqa: E402
from graindrive.beds import packing  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402

BOX = (-5, 5, -5, 5, 0, 12)


def cylinder(points):
    """Distance to an upright cylinder of radius 2 about the z axis."""
    return np.hypot(points[:, 0], points[:, 1]) - 2


def test_they_fill_the_room_outside_of_a_solid_and_do_not_overlap():
    centres, radii = packing.random_spheres(BOX, 0.25, 0.9, 1.1, 3, periodic="xy", keep_out=cylinder)
    room = 12 * (100 - np.pi * 4)
    # By the grid of 40 x 40 points the cylinder's cross-section is known to some 2 %, that of the box to 0.3 %.
    assert 4 / 3 * np.pi * np.sum(radii**3) / room == pytest.approx(0.25, rel=0.02)
    assert engines.overlaps_in_space(BOX, "xy", centres, radii) == (0.0, None, None)
    assert (cylinder(centres) >= radii).all() and (cylinder(centres) - radii).min() < 0.1
    assert (np.abs(centres[:, :2]) <= 5).all()
    assert (centres[:, 2] >= radii).all() and (centres[:, 2] <= 12 - radii).all()


def test_periodic_sides_are_crossed_and_others_are_not():
    beyond = {}
    for periodic in ("", "x", "yz"):
        centres, radii = packing.random_spheres(BOX, 0.2, 1, 1, 5, periodic=periodic)
        low, high = np.array(BOX[::2]), np.array(BOX[1::2])
        beyond[periodic] = ((centres - radii[:, None] < low) | (centres + radii[:, None] > high)).any(axis=0)
        assert engines.overlaps_in_space(BOX, periodic, centres, radii)[0] == 0
    assert {key: list(found) for key, found in beyond.items()} == {
        "": [False] * 3,
        "x": [True, False, False],
        "yz": [False, True, True],
    }


def test_the_same_for_a_seed():
    first, again, other = (packing.random_spheres(BOX, 0.1, 0.9, 1.1, seed)[0] for seed in (1, 1, 2))
    assert np.array_equal(first, again) and not np.array_equal(first, other)


def test_the_deepest_overlap_is_named():
    relative, i, j = engines.overlaps_in_space(BOX, "z", [(0, 0, 0.2), (3, 3, 3), (0, 0, 11.9)], [0.5, 0.5, 0.4])
    assert (i, j) == (0, 2) and relative == pytest.approx((0.9 - 0.3) / 0.4, rel=1e-12)


def raising(points):
    raise KeyError("the solid's own mistake")


@pytest.mark.parametrize(
    "change, error, words",
    [
        (dict(fraction=0.5), UsageError, r"fraction must lie in \(0, 0.36\], got 0.5"),
        (dict(fraction=1e-6), UsageError, "no room for spheres"),
        (dict(keep_out=lambda points: points), ValueError, r"one distance per point, shape \(n,\)"),
        (dict(keep_out=raising), KeyError, "the solid's own mistake"),
        (dict(keep_out=lambda points: points[:, 0] * (np.nan if len(points) == 1 else 1)), ValueError, "got nan at"),
        (dict(periodic="xx"), ValueError, "periodic must name axes of x, y, z, each once"),
        (dict(box=(0, 1, 0, 1)), ValueError, "got 4 numbers"),
        (dict(box=(0, 9, 0, 9, 3, 1)), ValueError, "z_min < z_max"),
        (dict(d_min=2), ValueError, "0 < d_min <= d_max"),
    ],
)
def test_what_cannot_be_is_refused_by_name(change, error, words):
    asked = {**dict(box=BOX, fraction=0.1, d_min=0.9, d_max=1.1, seed=1), **change}
    with pytest.raises(error, match=words):
        packing.random_spheres(**asked)
