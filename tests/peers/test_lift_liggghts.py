"""The lift study against LIGGGHTS (Debian's `liggghts`): the same bed at rest, carried past the same held cylinder.

Both begin without tangential springs, which LIGGGHTS cannot be given. Friction is not the same law (see test_spheres_liggghts):
LIGGGHTS shortens the lever by half an overlap, and lets spring and dashpot together exceed Coulomb's bound. The first steps agree
to round-off without friction and closely with it, and time means of drag and lift agree within their errors.
"""

from dataclasses import replace

import lift_study
import numpy as np
import pytest

from graindrive.scenes import scene
from graindrive.benchmark import liggghts_lift, peer_lift

pytestmark = pytest.mark.skipif(
    liggghts_lift.available() is None, reason="needs LIGGGHTS, which scripts/setup installs"
)

SMALL = dict(lift_study.SMALL, width=30, travel=24.0, frame="cylinder")


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """A cache that the scenes of this file share."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture
def lift(monkeypatch, cache):
    """The study as a module, in this process."""
    return lift_study.module(monkeypatch, cache)


def built(lift, friction, speed):
    """Build the scene; return its parameters, stage and material, all with this friction though it was poured with another."""
    p, stage = lift_study.built(lift, SMALL, speed, peer_lift.without_springs)
    scene.fast_loop().friction = friction
    return p, stage, replace(lift.material(p), friction=friction)


def difference(lift, folder, friction, speed, steps, **changes):
    """Return the largest difference of forces in the first steps over the largest one; LIGGGHTS may be given another material."""
    p, stage, material = built(lift, friction, speed)
    other = peer_lift.theirs(lift, p, stage, replace(material, **changes), steps, 1, folder)
    own = peer_lift.ours(steps, 1, 1)
    return np.abs(own - other).max() / np.abs(own).max()


@pytest.mark.parametrize(
    "friction, speed, tolerance",
    [
        (0.0, 0.0, 1e-11),  # round-off of some 1e4 operations on numbers that do not cancel
        (
            0.5,
            0.0,
            5e-3,
        ),  # overlaps, and so the differences of the levers, are of the order of a hundredth of a radius
    ],
)
def test_a_bed_let_go_takes_the_same_first_steps(lift, tmp_path, friction, speed, tolerance):
    assert difference(lift, tmp_path, friction, speed, 10) < tolerance


def test_the_comparison_can_fail(lift, tmp_path):
    assert difference(lift, tmp_path, 0.0, 0.0, 10, restitution=0.601) > 1e-8


def test_drag_and_lift_are_the_same_within_their_errors(lift, tmp_path):
    """By chaos the two runs differ, and their means by their errors; a difference of three errors occurs once in 400 times."""
    own, other, *_ = peer_lift.both(lift, lift.LiftParameters(**SMALL), tmp_path)
    for name in ("drag", "lift"):
        mine, peers = own[name], other[name]
        assert max(mine.error, peers.error) < 0.1 * own["drag"].value  # otherwise the next line could hardly fail
        assert abs(mine.value - peers.value) < 3 * np.hypot(mine.error, peers.error)
