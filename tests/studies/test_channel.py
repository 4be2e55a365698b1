"""Channels of the Magnus study: area fraction, walls, the body's position, diameters, grains at rest, and refused values."""

from dataclasses import replace

import numpy as np
import pytest

from graindrive.beds import channel
from graindrive import engines
from graindrive.base.errors import UsageError
from graindrive.scenes.material import HertzHistoryMaterial


@pytest.fixture(autouse=True)
def cache(monkeypatch, tmp_path_factory):
    """One cache for the whole file, because dense channels take long to make."""
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(tmp_path_factory.getbasetemp() / "channels"))


def recipe(**changes):
    """A channel 30 x 24 with a disk of 4 in the middle; the paper's grains, d = 1 m, without friction."""
    values = dict(
        width=30.0,
        height=24.0,
        d=1.0,
        d_min=0.9,
        d_max=1.1,
        phi=0.352,
        material=HertzHistoryMaterial(2e6, 2.45e6, 2500, 2500, 0.0, 1.0),
        beads=((15.0, 0.0),),
        bead_radius=2.0,
        outline=(),
        body_area=np.pi * 4,
        closing_speed=0.2,
        rest_speed=2e-3,
        seed=1,
    )
    return channel.ChannelRecipe(**{**values, **changes})


@pytest.mark.parametrize("phi", [0.05, 0.352, 0.49, 0.585, 0.78, 0.815])
def test_area_fraction_is_reached_and_nothing_overlaps(phi):
    made = channel.channel(recipe(phi=phi))
    # The area between the walls' centre lines, less 30 half disks at each wall and the body.
    free = 30 * 23 - 30 * np.pi / 4 - np.pi * 4
    assert np.sum(np.pi * made["r"] ** 2) / free == pytest.approx(phi, abs=1e-3)
    assert made["phi"] == pytest.approx(np.sum(np.pi * made["r"] ** 2) / free, rel=1e-12)
    assert made["deepest_overlap"] < (
        1e-3 if phi > 0.5 else 1e-12
    )  # in a compressed channel grains touch with overlaps of some 1e-4 R
    body = np.hypot(made["x"] - 15, made["y"]) - made["r"] - 2
    assert body.min() > -1e-3
    wall = (np.arange(30) + 0.5, 11.5)
    gaps = np.hypot(made["x"][:, None] - wall[0], np.abs(made["y"])[:, None] - wall[1]) - made["r"][:, None] - 0.5
    assert gaps.min() > -1e-3
    assert np.abs(made["y"]).max() < 11.5  # no grain is between the wall's disks


def test_diameters_are_uniform():
    diameters = 2 * channel.channel(recipe(width=120.0, height=60.0))["r"]
    assert 0.9 <= diameters.min() and diameters.max() < 1.1
    share = (np.sort(diameters) - 0.9) / 0.2
    apart = np.abs(share - (np.arange(len(share)) + 0.5) / len(share)).max()
    assert apart < 1.63 / np.sqrt(len(share))  # Kolmogorov-Smirnov, 99 %


def test_a_compressed_channel_is_as_dense_at_the_walls_as_in_the_middle():
    made = channel.channel(recipe(phi=0.815))
    third = np.abs(made["y"]) < 11 / 2
    inner = np.sum(np.pi * made["r"][third] ** 2) / (30 * 11 - np.pi * 4)
    assert inner == pytest.approx(
        0.815, abs=0.04
    )  # the edges of a band cut through 60 grains: a few percent of its area


def test_thinning_keeps_places_and_takes_grains_of_all_sizes_everywhere():
    dense, thin = channel.channel(recipe(phi=0.78)), channel.channel(recipe(phi=0.585))
    places = {tuple(row) for row in np.c_[dense["x"], dense["y"], dense["r"]]}
    assert all(tuple(row) in places for row in np.c_[thin["x"], thin["y"], thin["r"]])
    kept = len(thin["r"]) / len(dense["r"])
    assert kept == pytest.approx(0.75, abs=0.01)
    upper = np.sum(thin["y"] > 0) / np.sum(dense["y"] > 0)
    assert upper == pytest.approx(kept, abs=4 * np.sqrt(kept * (1 - kept) / (len(dense["r"]) / 2)))


def test_too_high_an_area_fraction_says_what_was_reached():
    with pytest.raises(UsageError, match=r"phi=0.89 is beyond jamming: at 0\.8\d+ grains overlap"):
        channel.channel(recipe(phi=0.89))


def test_an_area_fraction_that_whole_grains_cannot_reach_is_refused():
    with pytest.raises(UsageError, match="whole grains"):
        channel.channel(
            recipe(width=6.0, height=6.0, beads=((3.0, 0.0),), bead_radius=0.5, body_area=np.pi / 4, phi=0.05)
        )


@pytest.mark.parametrize(
    "changes, said",
    [(dict(width=30.5), "whole number of wall disks"), (dict(width=3e6), "1 and 10000000 are possible")],
)
def test_channels_that_cannot_be_are_refused(changes, said):
    with pytest.raises(UsageError, match=said):
        channel.channel(recipe(**changes))


def test_the_cache_gives_the_same_channel_back_and_knows_the_seed(monkeypatch):
    first = channel.channel(recipe(seed=5))
    monkeypatch.setattr(channel, "build", lambda _recipe: pytest.fail("the channel was built twice"))
    again = channel.channel(recipe(seed=5))
    assert all(np.array_equal(first[name], again[name]) for name in first)
    with pytest.raises(pytest.fail.Exception):
        channel.channel(recipe(seed=6))


def test_a_body_of_beads_is_kept_clear():
    clump = engines.clump_of(engines.outline_of("square", (4.0,)), 0.5, 1.0)
    corners = np.array(engines.outline_of("square", (4.0,)).vertices)
    at = np.array([15.0, 0.0])
    square = replace(
        recipe(),
        beads=tuple(map(tuple, clump.beads + at)),
        bead_radius=clump.bead_radius,
        outline=tuple(map(tuple, corners + at)),
        body_area=16.0,
    )
    made = channel.channel(square)
    inside = (np.abs(made["x"] - 15) < 2) & (np.abs(made["y"]) < 2)
    assert not inside.any() and made["phi"] == pytest.approx(0.352, abs=1e-3)
