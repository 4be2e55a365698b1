"""Disks that cover the inside of a body: all inside, no room for a grain between them, the same at any position."""

from types import SimpleNamespace

import numpy as np
import pytest
from graindrive.bodies import cover, intruder
from graindrive.beds import packing
from graindrive.engines import Outline, clump_of
from matplotlib.path import Path

SPACING = 0.225  # a quarter of the smallest grain's diameter
BOOT = np.array([(0, 0), (9, 0), (9, 3), (4, 3), (4, 10), (0, 10)], dtype=float)


def rough(radius, count=5000):
    """Return a body whose edge has many more vertices than affect a grain."""
    angle = 2 * np.pi * np.arange(count) / count
    return (radius * (1 - 0.05 * (np.arange(count) % 2)))[:, None] * np.c_[np.cos(angle), np.sin(angle)]


def distance_to_edges(outline, points):
    best = np.full(len(points), np.inf)
    for a, b in zip(outline, np.roll(outline, -1, axis=0)):
        along = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        best = np.minimum(best, np.hypot(*(points - a - along[:, None] * (b - a)).T))
    return best


@pytest.mark.parametrize("outline", [BOOT, rough(3.5, 60), intruder.outline_of("triangle", 17).vertices])
def test_disks_lie_inside_the_outline(outline):
    disks = cover.disks_inside(outline, SPACING)
    assert Path(outline).contains_points(disks[:, :2]).all()
    assert distance_to_edges(outline, disks[:, :2]).min() >= SPACING
    assert (disks[:, 2] == SPACING).all()


@pytest.mark.parametrize("outline", [BOOT, rough(3.5, 60)])
def test_beads_and_disks_leave_no_room_for_a_grain(outline):
    clump, at = clump_of(Outline(outline), 0.5, 1.0), np.array([20.0, 30.0])
    own = Outline(outline).about_centroid.vertices + at
    recipe = SimpleNamespace(beads=clump.beads + at, bead_radius=0.25, outline=own, d_min=4 * SPACING)
    covered = packing.keep_clear(recipe)
    spots = np.random.default_rng(1).uniform(own.min(axis=0), own.max(axis=0), (5000, 2))
    spots = spots[Path(own).contains_points(spots)]
    gaps = np.hypot(*(spots[:, None] - covered[:, :2]).transpose(2, 0, 1)) - covered[:, 2]
    assert gaps.min(axis=1).max() < 0.45  # a grain of the smallest radius would overlap something


def test_the_cover_of_a_square_is_the_same_wherever_it_stands():
    square = np.array([(-3.25, -3.25), (3.25, -3.25), (3.25, 3.25), (-3.25, 3.25)])
    counts = {len(cover.disks_inside(square + at, SPACING)) for at in [(0, 0), (13, 10.5), (60, 40.5), (150, 90.5)]}
    assert len(counts) == 1


def test_a_large_rough_body_is_covered():
    disks = cover.disks_inside(rough(60.0), SPACING)
    assert len(disks) * SPACING**2 == pytest.approx(np.pi * 57**2, rel=0.02)  # as far as disks fit into its notches


def test_a_body_too_small_for_a_disk_has_none():
    assert cover.disks_inside(BOOT / 100, SPACING).shape == (0, 3)
