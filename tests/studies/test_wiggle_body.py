"""The wiggle study's body: its motion without grains, its mass, its orientation; mirrored beds, and beds under a lid."""

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest
from graindrive import engines
from graindrive.bodies import intruder
from graindrive.beds import lid, packing
from graindrive.scenes import scene
from graindrive.base.errors import UsageError

STUDIES = Path(__file__).resolve().parents[2] / "studies"
SHAPES = ["disk", "square", "tall", "wide", "triangle"]
NO_GRAINS = {name: np.zeros(0) for name in ("x", "y", "r", "density")}


@pytest.fixture(scope="module")
def wiggle(tmp_path_factory):
    """The study as a module, with a cache of its own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GRAINDRIVE_CACHE", str(tmp_path_factory.mktemp("cache")))
        patch.syspath_prepend(str(STUDIES))
        yield importlib.import_module("wiggle")


def small(wiggle, **changes):
    values = dict(width=30, height=30, depth=16, amplitude=1.5, period=2, dt_factor=5, rest=1e-2)
    values.update(shape="disk", lid_pressure=0)
    return wiggle.WiggleParameters(**{**values, **changes})


def built(wiggle, p, bed=NO_GRAINS):
    """Build the scene of parameters `p` with that bed; return the state of the body and the drive."""
    from yade import O

    dt, grains, at = wiggle.TIME_STEP * p.dt_factor, wiggle.material(p), np.array([p.width / 2, p.height - p.depth])
    stage = wiggle.build(p, wiggle.body_of(p), at, bed, dt, grains)
    return O.bodies[stage["body"]].state, O.labeledEngine("drive")


def settled(wiggle, p):
    """Return the settled bed of parameters `p`."""
    at = np.array([p.width / 2, p.height - p.depth])
    return wiggle.make_bed(p, wiggle.body_of(p), at, wiggle.TIME_STEP * p.dt_factor, wiggle.material(p))


def run(steps):
    from yade import O

    O.run(steps, True)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_body_among_no_grains_falls_freely_and_has_the_mass_that_was_asked_for(wiggle, shape):
    p = small(wiggle, shape=shape)
    state, _ = built(wiggle, p)
    y, dt = state.pos[1], 5e-4
    run(2000)
    # Leapfrog from rest: the velocity at half steps makes y = -(n + 1) n dt^2/2 exactly, up to round-off of 14 d.
    fallen = 2001 * 2000 / 2 * dt**2
    assert state.pos[1] - y == pytest.approx(-fallen, abs=1e-11)
    assert state.pos[0] - 15 == pytest.approx(p.amplitude * np.sin(2 * np.pi * 2000 * dt / p.period), abs=1e-12)

    state, drive = built(wiggle, p)
    scene.fast_loop().setLoad(drive.body, (0, 3 * np.pi * 7**2 / 4, 0))  # three times the mass of a 7 d disk
    run(2000)
    assert state.pos[1] - y == pytest.approx(2 * fallen, abs=1e-11)


def test_a_held_body_does_not_move_under_its_grains(wiggle):
    from yade import O

    p = small(wiggle)
    bed, body = settled(wiggle, p), wiggle.body_of(p)
    scene.start(p.width, 40)
    scene.add_base(p.width, 1.0, 1.0)
    scene.add_disks(bed["x"], bed["y"], bed["r"], bed["density"])
    held = scene.add_intruder(body, 15.0, 14.0)
    scene.run_on("grain", wiggle.material(p), gravity=1.0)
    O.dt = 5e-4
    state = O.bodies[held].state
    before = tuple(state.pos)
    run(500)
    assert tuple(state.pos) == before
    contacts = scene.fast_loop().contacts()
    beads = set(O.bodies[held].shape.members)
    assert sum(i in beads or j in beads for i, j in zip(contacts["i"], contacts["j"])) > 10  # grains press on it


def test_mirrored_beds_give_mirrored_motion(wiggle):
    p = small(wiggle)
    bed = settled(wiggle, p)
    way = []
    for mirrored in (False, True):
        x = (p.width - bed["x"]) if mirrored else bed["x"]
        state, drive = built(wiggle, p, {**bed, "x": x})
        drive.phase = np.pi if mirrored else 0.0  # x = -A sin(w t)
        rows = []
        for _ in range(40):
            run(50)
            rows.append((state.pos[0], state.pos[1]))
        way.append(np.array(rows))
    t = 50 * 5e-4 * np.arange(1, 41)
    apart = np.abs(way[0][:, 1] - way[1][:, 1])
    assert np.abs(way[0][:, 0] + way[1][:, 0] - p.width).max() < 1e-12
    assert np.ptp(way[0][:, 1]) > 1e-3
    # Round-off of 1e-14 grows tenfold in about 0.1 sqrt(d/g), as between the two loops.
    assert apart[t <= 0.1].max() < 1e-12
    assert apart[t <= 0.5].max() < 1e-7


def test_a_shape_is_turned_about_its_centroid_and_keeps_its_mass(wiggle):
    upright = wiggle.body_of(small(wiggle, shape="tall"))
    lying = wiggle.body_of(small(wiggle, shape="tall", orientation_deg=90))
    wide = wiggle.body_of(small(wiggle, shape="wide"))
    assert np.ptp(lying.outline, axis=0) == pytest.approx([9.5, 4.5]) == np.ptp(wide.outline, axis=0)
    assert lying.fall_height == pytest.approx(wide.fall_height)
    assert (upright.height, lying.height) == pytest.approx((9.5, 4.5))
    assert lying.mass == upright.mass
    tilted = wiggle.body_of(small(wiggle, shape="triangle", orientation_deg=17))
    assert engines.Outline(tilted.outline).centroid == pytest.approx((0, 0), abs=1e-12)


@pytest.mark.parametrize("spacing", [1.0, 0.4])
def test_beads_stand_as_close_as_asked(wiggle, spacing):
    beads = wiggle.body_of(small(wiggle, shape="square", bead_spacing=spacing)).beads
    steps = np.hypot(*(np.roll(beads, -1, axis=0) - beads).T)
    assert steps.max() <= 0.5 * spacing * (1 + 1e-12)
    assert steps.max() > 0.5 * spacing * 0.9


def test_orientation_beads_and_lid_are_other_beds(wiggle):
    def recipe(**changes):
        p, found = small(wiggle, **changes), []
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(packing, "settled_bed", lambda recipe: found.append(packing.as_plain(recipe)))
            settled(wiggle, p)
        return found[0]

    usual = recipe(shape="triangle")
    for change in (
        dict(orientation_deg=5),
        dict(bead_diameter=0.4),
        dict(bead_spacing=0.5),
        dict(lid_pressure=3),
        dict(lid_pressure=3, lid="grains"),
    ):
        assert recipe(shape="triangle", **change) != usual
    assert recipe(shape="triangle", intruder_mass=9) == usual  # it is held while the bed settles


@pytest.mark.parametrize("kind", ["grains", "rigid"])
def test_a_lid_presses_on_the_bed_as_much_as_was_asked(wiggle, monkeypatch, kind):
    p = small(wiggle, depth=22, height=34, lid=kind, lid_pressure=20, rest=1e-6)
    monkeypatch.setattr(packing, "settled_bed", packing.settle)  # whose contacts still exist
    bed = settled(wiggle, p)
    area = np.pi * bed["r"] ** 2
    assert np.sum(bed["density"] * area) - area.sum() == pytest.approx(20 * 30 if kind == "grains" else 0, abs=1e-9)
    heights = [20.5, 24.0, 27.0]  # above the body and below the lid
    carried = mean_forces_through(heights, samples=40, steps=120)
    for height, force in zip(heights, carried):
        above = np.sum(area[bed["y"] > height]) / p.width
        # Contacts at each height bear the weight above. The bed still oscillates, period 1.2 sqrt(d/g): over twice that time
        # the mean acceleration is below two of its speeds, sqrt(2e-5), over the time: 4e-3 g.
        assert force / p.width == pytest.approx(20 + above, rel=1e-2)


def mean_forces_through(heights, samples, steps):
    """Return the mean upward forces (n,) that contacts pass through horizontal planes at `heights` (n,)."""
    total = np.zeros(len(heights))
    for _ in range(samples):
        run(steps)
        contacts, table = scene.fast_loop().contacts(), engines.body_table(sys.modules["yade"].O._sceneObj)
        height_of = dict(zip(table["id"].tolist(), table["position"][:, 1]))
        i, j = (np.array([height_of[k] for k in contacts[side].tolist()]) for side in ("i", "j"))
        upward = (contacts["normal_force"] + contacts["tangential_force"])[:, 1]
        total += [np.sum(upward[(i < h) & (j > h)]) - np.sum(upward[(i > h) & (j < h)]) for h in heights]
    return total / samples


def test_a_lid_of_grains_is_the_layer_on_top():
    rng = np.random.default_rng(1)
    bed = dict(y=rng.uniform(0, 40, 2000), r=rng.uniform(0.45, 0.55, 2000))
    density = lid.heavy_layer(bed, 50.0, 7.0, 1.0, 0.8)
    heavy = density > 1
    area = np.pi * bed["r"] ** 2
    assert bed["y"][heavy].min() > bed["y"][~heavy].max()
    assert area[heavy].sum() == pytest.approx(lid.LAYER * 50 * 0.8, abs=1)  # to within one grain
    assert np.sum(density * area) - area.sum() == pytest.approx(7 * 50, rel=1e-12)


def test_the_lid_is_no_room_for_the_body(wiggle):
    with pytest.raises(UsageError, match="bed below its lid of 5 d by 2.5 d; raise depth"):
        wiggle.body_of(small(wiggle, depth=6, lid_pressure=1, lid="grains"))
    wiggle.body_of(small(wiggle, depth=6, lid_pressure=1))
    assert intruder.names_a_file("Arrow.CSV") and not intruder.names_a_file("disk")


def test_fields_of_a_held_bed_are_empty_where_the_body_is_and_full_around_it(wiggle):
    from yade import O

    p = small(wiggle, width=40, amplitude=0.0, fields=True, shape="square")
    bed = settled(wiggle, p)
    built(wiggle, p, bed)
    around = O.labeledEngine("around")
    around.dead = False
    run(round(p.period / 5e-4))
    assert around.samples.tolist() == [5] * 20  # 100 samples a period, in 20 phases
    inside = np.ix_(np.abs(around.y) < 1, np.abs(around.x) < 1)
    beside = np.ix_(np.abs(around.y) < 3, (np.abs(around.x) > 6) & (np.abs(around.x) < 12))
    fraction, pressure = around.areaFraction.mean(axis=0), around.pressure.mean(axis=0)
    assert fraction[inside].max() < 0.02  # a Gaussian of 1 d that begins 2.5 d away
    assert fraction[beside].mean() == pytest.approx(0.84, abs=0.03)
    # The walls (Janssen) and the body bear a part; a fluid would have the pressure rho phi g times the depth of 16 d.
    assert 0.4 < pressure[beside].mean() / (0.84 * 16) < 1.3
