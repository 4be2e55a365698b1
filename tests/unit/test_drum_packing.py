"""Grains as they are placed in a drum before they are poured: inside of the wall, without overlaps, by seed."""

import dataclasses

import numpy as np
import pytest

from graindrive.beds import drum
from graindrive import engines
from graindrive.base.errors import UsageError
from graindrive.scenes.material import SpringDashpotMaterial

GRAINS = SpringDashpotMaterial(1.6e5, 4.5e4, 0.5, 0.5, 1.0)
HALF = drum.DrumRecipe(150.0, 475, 7700, 1.0, 1.2, GRAINS, 5e-4, 1e-3, 1)


def filled(part, diameter=150.0, seed=1):
    grains = round(part * 7700 / 0.5 * (diameter / 150) ** 2)
    return dataclasses.replace(HALF, grains=grains, diameter=diameter, seed=seed)


SMALL_AND_LARGE = [(d, part) for d in (20.0, 47.3, 150.0, 300.0) for part in (0.1, 0.5, 0.6)]


@pytest.mark.parametrize("diameter, part", [*SMALL_AND_LARGE, (150.0, 0.7), (300.0, 0.7)])
def test_grains_are_placed_inside_without_overlaps(diameter, part):
    recipe = filled(part, diameter)
    x, y, r = drum.place(recipe)
    assert len(x) == recipe.grains and r.min() >= 0.5 and r.max() < 0.6
    assert (np.hypot(x, y) + r).max() < recipe.room  # not in contact with the wall's disks at any position of these
    deepest, _, _ = engines.overlaps((-diameter, diameter, -diameter, diameter), False, np.c_[x, y], r)
    assert deepest <= 0


def test_places_follow_the_seed():
    one, same, other = (drum.place(filled(0.5, seed=seed)) for seed in (1, 1, 2))
    assert all(np.array_equal(a, b) for a, b in zip(one, same)) and not np.array_equal(one[0], other[0])


def test_the_wall_is_a_closed_circle():
    x, y = drum.wall_places(150.0, 475)
    assert np.hypot(x, y) == pytest.approx(75.0, rel=1e-14)
    gaps = np.hypot(np.diff(x, append=x[0]), np.diff(y, append=y[0]))
    assert (
        gaps == pytest.approx(150 * np.sin(np.pi / 475), rel=1e-12) and gaps.max() < 1
    )  # neighbours overlap by 0.008 d


@pytest.mark.parametrize(
    "grains, words",
    [(0, "holds no grain"), (13000, "do not fit"), (12000, "do not fit"), (20_000_000, "more than 10000000")],
)
def test_a_drum_that_is_empty_or_too_full_is_refused(grains, words):
    with pytest.raises(UsageError, match=words):
        drum.check(dataclasses.replace(HALF, grains=grains))


def test_a_grain_outside_of_the_wall_is_noticed():
    inside = dict(x=np.array([0.0, 10.0]), y=np.array([-74.0, 0.0]))
    drum.require_inside(150.0, inside)
    with pytest.raises(RuntimeError, match="a grain left the drum of 150 d"):
        drum.require_inside(150.0, {**inside, "x": np.array([20.0, 10.0])})


def test_the_critical_step_is_that_of_a_linear_spring():
    m = np.pi / 4
    loose = SpringDashpotMaterial(2e5 * m, 0.0, 1.0, 0.0, 1.0)
    # two smallest disks, omega^2 = k/(m/2), without friction and damping: dt = 2/omega
    assert loose.critical_time_step(0.5, 0.1) == pytest.approx(2 / np.sqrt(4e5), rel=1e-12)
    assert loose.force_between(0.5, 0.1) == pytest.approx(2e5 * m * 0.05, rel=1e-12)
