"""Walls and the energy ledger in Python: attributes, checks, saving, and a compression from a script."""

import disks
import numpy as np
import pytest
from graindrive import engines
from graindrive.loops import grain_loop
from yade import O


def bed(**settings):
    """Return the GrainLoop of 20 x 25 disks apart from each other, periodic in x, above a floor that is not a wall yet."""
    disks.new_scene(period=(25, 60, 5))
    rng = np.random.default_rng(3)
    for row in range(20):
        for column in range(25):
            disks.disk(column + 0.5, 1.1 * row + 0.6, rng.uniform(0.45, 0.5), velocity=rng.uniform(-0.1, 0.1, 2))
    disks.loop(disks.hertz(gamma_n=500, gamma_t=500), friction=0.3)
    return grain_loop.use_grain_loop(periods=(O.cell.size[0], 0), **settings)  # walls are across y


def test_a_bed_is_compressed_to_an_area_fraction():
    loop = bed(targetAreaFraction=0.8)
    loop.setWall("y_low", position=0)
    loop.setWall("y_high", position=22.2, velocity=-2)
    disks.run(60000)
    area = sum(np.pi * b.shape.radius**2 for b in O.bodies)
    height = loop.walls["y_high"]["position"] - loop.walls["y_low"]["position"]
    assert area / (25 * height) == pytest.approx(0.8, abs=1e-3)
    assert loop.areaFraction == pytest.approx(area / (25 * height), rel=1e-12)
    assert loop.walls["y_high"]["velocity"] == 0


def test_a_bed_is_compressed_to_a_pressure():
    loop = bed()
    loop.setWall("y_low", position=0)
    loop.setWall("y_high", position=22.2, pressure=5, mass=20, damping=200, speedLimit=2)
    disks.run(200000)
    for side in ("y_low", "y_high"):  # after 20 s the bed still oscillates, by less than a hundredth
        assert loop.walls[side]["measuredPressure"] == pytest.approx(5, rel=1e-2)
    contacts = loop.wallContacts()
    on_floor = np.array(contacts["side"]) == "y_low"
    force = (contacts["normal_force"] + contacts["tangential_force"])[on_floor].sum(axis=0)
    assert force[:2] == pytest.approx(loop.walls["y_low"]["force"], abs=1e-9)


def test_walls_and_their_springs_are_saved_with_the_scene(tmp_path):
    loop = bed()
    loop.setWall("y_low", position=0, slide=0.5)
    loop.setWall("y_high", position=22.2, pressure=5, mass=20)
    disks.run(20000)
    before = loop.walls
    assert len(loop.wallSprings) > 0
    O.save(str(tmp_path / "scene.xml"))
    O.load(str(tmp_path / "scene.xml"))
    loaded = grain_loop.find("GrainLoop")
    for side in ("y_low", "y_high"):
        for key in ("position", "velocity", "slide", "pressure", "mass", "speedLimit"):
            assert loaded.walls[side][key] == before[side][key]
    assert len(loaded.wallSprings) == len(loop.wallSprings)
    disks.run(1)
    assert loaded.walls["y_low"]["force"][1] == pytest.approx(before["y_low"]["force"][1], rel=0.05)


def test_a_wall_can_be_taken_away():
    loop = bed()
    loop.setWall("y_low", position=0)
    disks.run(1)
    loop.removeWall("y_low")
    assert loop.walls == {}
    disks.run(1)


@pytest.mark.parametrize(
    "side, keywords, message",
    [
        ("top", dict(position=0), "x_low, x_high, y_low or y_high, got top"),
        ("y_low", dict(velocity=1), "a new wall needs a position"),
        ("y_low", dict(position=0, velocity=1, pressure=1), "a velocity or a pressure, got both"),
        (
            "y_low",
            dict(position=0, colour=1),
            "position, velocity, slide, pressure, mass, damping, speedLimit, got colour",
        ),
    ],
)
def test_bad_walls_are_refused_at_once(side, keywords, message):
    with pytest.raises(ValueError, match=message):
        engines.GrainLoop().setWall(side, **keywords)


def test_walls_that_the_box_cannot_have_are_refused():
    loop = bed()
    disks.run(1)
    with pytest.raises(ValueError, match="wall x_low: the box must not be periodic across it"):
        loop.setWall("x_low", position=0)
    with pytest.raises(ValueError, match="wall y_low: a wall under pressure needs a positive mass"):
        loop.setWall("y_low", position=0, pressure=3)
    with pytest.raises(ValueError, match=r"targetAreaFraction must lie in \[0, 1\), got 1.2"):
        loop.targetAreaFraction = 1.2


def test_the_ledger_closes_with_drives_and_knows_their_work():
    disks.shaken_bed()
    loop = grain_loop.use_grain_loop(trackEnergy=True)
    disks.run(5000)
    entries = loop.energy
    # Sums of 5000 steps, each with a round-off of 1e-16.
    assert entries["closure"] < 1e-12
    assert entries["friction"] > 0 and entries["normalDamping"] > 0
    clump = next(b.id for b in O.bodies if b.isClump)
    # The drive sums work over whole steps, the ledger up to the present time: the difference is the work of half a step.
    assert entries["workByBody"][clump] == pytest.approx(disks.engine("shake").work, rel=1e-2, abs=1e-3)


def test_energy_is_told_only_where_it_is_tracked():
    disks.shaken_bed()
    loop = grain_loop.use_grain_loop()
    disks.run(1)
    with pytest.raises(RuntimeError, match="trackEnergy"):
        loop.energy


def test_frozen_disks_as_a_lid_under_a_load_fall_as_they_should():
    disks.new_scene()
    lid, _ = disks.clump([(-0.5, 0), (0.5, 0)], at=(0, 10), mass=2)
    O.bodies[lid].state.blockedDOFs = "xzXYZ"
    disks.loop(disks.hertz())
    loop = grain_loop.use_grain_loop()
    loop.setLoad(lid, (0, -4, 0))
    disks.run(1000)
    # 2 kg under 4 N for 0.1 s.
    assert O.bodies[lid].state.vel[1] == pytest.approx(-0.2, rel=1e-12)
