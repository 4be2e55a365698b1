"""The lift study at small size: closed forms of its measurements, the bed at rest, symmetries, both loops, and bad input."""

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import h5py
import lift_study
import numpy as np
import pytest

from graindrive.bodies import dragged_body
from graindrive.scenes import scene, space
from graindrive.beds import sphere_bed
from graindrive.scenes import yade_march
from graindrive.benchmark import peer_lift
from graindrive.base.errors import Interrupted, UsageError
from graindrive.base.numbers import with_error
from graindrive.commands.killtest import TIMED
from graindrive.postproc.lift import forces
from graindrive.runs.run_folder import RunFolder

TINY = dict(lift_study.SMALL, width=16, travel=9.0)


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """A cache that the runs of this file share."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture
def lift(monkeypatch, cache):
    """The study as a module, in this process."""
    return lift_study.module(monkeypatch, cache)


def parameters(lift, **changes):
    return lift.LiftParameters(**{**TINY, **changes})


def carry_out(lift, out, **changes):
    """Run the shrunken study into the folder `out`; return its series."""
    p = parameters(lift, out=str(out), **changes)
    with RunFolder(p, study="lift") as folder:
        lift.run(p, folder)
    with h5py.File(Path(out) / "run.h5") as file:
        return {name: data[:] for name, data in file["series"].items()}


def summary_of(out):
    return json.loads((Path(out) / "summary.json").read_text())


def built(lift, speed, change=None, **keys):
    """Build the scene with any speed along x; return the parameters, the facts of the stage, and the binners of body and base."""
    from yade import O

    p, stage = lift_study.built(lift, {**TINY, **keys}, speed, change)
    return p, stage, O.labeledEngine("binner"), O.labeledEngine("base_binner")


def forces_of_steps(binner, base, steps):
    """Return the mean forces on body and base over so many steps."""
    for engine in (binner, base):
        engine.every = 1
    yade_march.advance(steps)
    return np.array(binner.force), np.array(base.force)


# ---- closed forms ------------------------------------------------------------------------------------------------


def test_the_grains_are_those_of_table_1(lift):
    """Stiffness over sqrt(delta) and damping over delta^(1/4), as in the paper, of two grains and of a grain and the cylinder."""
    grains = lift.material(parameters(lift))
    delta = 0.01 * lift.D / 2
    printed = {grains.terms: (81e3, 86e3, 0.15, 0.13), grains.terms_on_a_plane: (114e3, 122e3, 0.26, 0.21)}
    for terms, numbers in printed.items():
        at = terms(lift.D / 2, 0.01)
        found = (
            at["elastic"] / delta**1.5,
            at["tangential_stiffness"] / delta**0.5,
            at["dashpot"] / delta**0.25,
            at["tangential_dashpot"] / delta**0.25,
        )
        # The paper prints two digits; its gamma_t of the cylinder, 0.2150, is rounded down.
        assert np.allclose(found, numbers, rtol=0.03)


SCENE = forces.Scene(
    gravity=10.0,
    d=1e-3,
    height=2e-3,
    breadth=5e-3,
    volume=np.pi * 1e-6 * 5e-3,
    bulk_density=1500.0,
    effective_depth=0.1,
    bed_weight=2.0,
    lid_weight=1.0,
    friction=0.5,
    speed=0.01,
    grain_density=2500.0,
)


def made_up_series(drag, lift, normal, tangential, blocks=256):
    """A steady series with some white noise of mean zero."""
    noise = np.random.default_rng(5).normal(0, 1e-3, blocks)
    noise -= noise.mean()
    series = {name: np.zeros(blocks) for name in forces.UNITS}
    series.update(travel=np.arange(1, blocks + 1) * 0.1, fx=-drag * (1 + noise), fz=lift * (1 + noise))
    return dict(series, normal=np.tile(normal, (blocks, 1)), tangential=np.tile(tangential, (blocks, 1)))


def test_coefficients_are_what_their_names_say():
    """rho g h~ D L = 1500 * 10 * 0.1 * 2e-3 * 5e-3 N, and the buoyancy rho g pi D^2 L/4."""
    summary, _ = forces.steady_state(made_up_series(0.15, 2.3562e-3, np.ones(64), np.zeros(64)), SCENE)
    # Within the window the mean of the noise is not zero, but of order 1e-3/sqrt(200).
    assert summary["drag_coefficient"] == pytest.approx(10, rel=3e-4)
    assert summary["lift_over_buoyancy"] == pytest.approx(2.3562e-3 / (15000 * np.pi * 1e-6 * 5e-3), rel=3e-4)
    assert 0 < summary["drag_coefficient_err"] < 10 * 1e-3
    assert summary["drag_over_grip"] == pytest.approx(0.15 / (0.5 * (2 + 1 + 1)), rel=3e-4)
    assert SCENE.inertial_number == pytest.approx(0.01 / 2e-3 * 1e-3 * np.sqrt(2500 / 1500))


def test_equation_4_makes_the_buoyancy_of_an_even_pressure():
    """Archimedes: sigma_n = P_0 all around gives (1/pi) int sin^2 = 1; cos^2 in front and behind gives 1/4."""
    theta = forces.angles_of(64)
    pressure = SCENE.pressure
    assert forces.local_pressure_lift(theta, np.full(64, pressure), SCENE) == pytest.approx(1, rel=1e-12)
    assert forces.local_pressure_lift(theta, pressure * np.cos(theta) ** 2, SCENE) == pytest.approx(0.25, rel=1e-12)


def test_stress_by_angle_is_force_over_the_share_of_the_mantle():
    theta = forces.angles_of(64)
    normal = 1e-3 * (1 + np.cos(theta))
    _, angular = forces.steady_state(made_up_series(0.1, 0.01, normal, -normal), SCENE)
    share = 2 * np.pi * SCENE.height / 2 * SCENE.breadth / 64
    assert np.allclose(angular["normal_stress"][0], normal / share)
    assert np.allclose(angular["tangential_stress"][0], -normal / share)


def test_the_fraction_by_height_is_that_of_spheres():
    """One sphere of radius 1 at 0: slabs of [-1, 0] and [0, 1/2] hold 2 pi/3 and pi(1/2 - 1/24); slabs far away are empty."""
    found = sphere_bed.fraction_by_height(np.array([0.0]), np.array([1.0]), np.array([-3, -1, 0, 0.5, 1, 2]), 4.0)
    expected = np.array([0, 2 * np.pi / 3, np.pi * (0.5 - 1 / 24), 2 * np.pi / 3 - np.pi * (0.5 - 1 / 24), 0])
    assert np.allclose(found, expected / 4 / np.array([2, 1, 0.5, 0.5, 1]), rtol=1e-12)


def a_lattice(lift, bulk_gravity):
    """A cubic lattice of touching spheres as the bed at rest around a body without volume, and a lid on it."""
    p = parameters(lift, lid_density=60, bulk_gravity=bulk_gravity, width=16, breadth=5, height=40, depth=20)
    bed, lid = lift.recipes(p, lift.body_of(p))
    bed = replace(bed, volume=0.0)
    i, j, k = (index.ravel() for index in np.mgrid[0:16, 0:5, 0:40])
    x = np.stack([i + 0.5, j + 0.5, k + 1.0], axis=1) * lift.D
    found = dict(x=x, r=np.full(len(x), lift.D / 2), lid=space.lattice(bed.width, bed.breadth, lift.D, 41 * lift.D))
    return sphere_bed.facts(bed, lid, found)


def test_the_effective_depth_is_bed_and_lid_over_the_bulk_density(lift):
    """Layers at 1 to 40 d, axis at 20 d: 20.5 layers are above it. h~ = h + (pi d/6) rho*/rho with rho = (pi/6) rho_g."""
    with_weight, without = a_lattice(lift, True), a_lattice(lift, False)
    # The slabs' edges cut through layers: the fraction differs by up to one layer in 26.
    fraction = with_weight["bulk_fraction"]
    assert fraction == pytest.approx(np.pi / 6, rel=0.04)
    lid_part = np.pi / 6 * 60 / fraction
    assert without["effective_depth"] / lift.D == pytest.approx(lid_part, rel=1e-12)
    assert with_weight["effective_depth"] / lift.D == pytest.approx(20.5 * np.pi / 6 / fraction + lid_part, rel=1e-9)
    grain = lift.DENSITY * np.pi / 6 * lift.D**3 * lift.GRAVITY
    assert with_weight["bed_weight"] == pytest.approx(16 * 5 * 40 * grain)
    assert without["bed_weight"] == 0 and without["lid_weight"] == pytest.approx(60 * 16 * 5 * grain)


# ---- the bed at rest ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("keys", [dict(), dict(bulk_gravity=False), dict(lid_density=0)], ids=str)
def test_a_bed_at_rest_presses_on_base_and_body_with_its_weight_and_does_not_drag(lift, keys):
    p, stage, *binners = built(lift, 0.0, **keys)
    body, below = forces_of_steps(*binners, 300)
    weight = stage["bed_weight"] + stage["lid_weight"]
    assert -(body + below)[2] == pytest.approx(weight, rel=1e-3)
    seen = lift.scene_of(p, lift.body_of(p), stage)
    # Static forces in the bed remain; on a dragged cylinder C_d is 10.
    assert abs(body[0]) < 0.5 * seen.pressure * seen.area
    if keys == dict(lid_density=0):  # a lid is held along x
        assert abs(body[0] + below[0]) < 1e-3 * weight


def test_a_packing_has_no_grain_in_the_cylinder_or_far_into_another(lift):
    from yade import O

    p, stage, *_ = built(lift, 0.0)
    at = np.array(O.bodies[stage["body"]].state.pos)
    rows = scene.rows_of(range(*stage["grains"]))
    across = (rows["x"] - at[0] + p.width * lift.D / 2) % (p.width * lift.D) - p.width * lift.D / 2
    gap = np.hypot(across, rows["z"] - at[2]) - p.cylinder_diameter * lift.D / 2 - rows["r"]
    assert gap.min() > -0.05 * lift.D and gap.min() < 0.0
    assert rows["z"].min() > 0.5 * lift.D  # no grain fell between the spheres of the base
    assert 0.5 < stage["bulk_fraction"] < 0.68  # from loose to dense packing


# ---- symmetries --------------------------------------------------------------------------------------------------


def mirrored(bed, found):
    """Mirror a bed at rest at the plane across x through the body's axis; its springs are lost."""
    there = {name: found[name] * [-1, 1, 1] + [bed.width, 0, 0] for name in ("x", "lid")}
    return peer_lift.without_springs(bed, {**found, **there})


def test_a_mirrored_bed_gives_mirrored_forces(lift):
    _, _, *binners = built(lift, 0.4, peer_lift.without_springs)
    there = forces_of_steps(*binners, 300)
    _, _, *binners = built(lift, -0.4, mirrored)
    back = forces_of_steps(*binners, 300)
    for one, other in zip(there, back):
        # Sums in another order differ by round-off, which collisions let grow.
        assert np.allclose(one * [-1, 1, 1], other, rtol=0, atol=1e-7 * np.abs(one).max())
    assert there[0][0] < 0  # drag


def test_body_and_base_are_pushed_against_each_other(lift, tmp_path):
    """The base bears the drag of the body that the lid does not bear."""
    carry_out(lift, tmp_path / "run", lid_density=0, width=40, travel=12.0)
    found = summary_of(tmp_path / "run")
    assert found["drag"] > 0 and found["drag_on_base"] > 0
    # A steady bed has no other support along x, so the base bears the drag within errors.
    assert abs(found["drag"] - found["drag_on_base"]) < 5 * (found["drag_err"] + found["drag_on_base_err"])


def test_the_cylinder_may_stand_still_in_place_of_the_bed(lift, tmp_path, monkeypatch):
    """Galilean invariance: over the first 0.2 d results are the same to round-off, which grows with every collision."""
    monkeypatch.setattr(lift, "BLOCK_TRAVEL", 0.1)
    bed = carry_out(lift, tmp_path / "bed")
    cylinder = carry_out(lift, tmp_path / "cylinder", frame="cylinder")
    scale = np.abs(bed["fx"]).max()
    for name in ("fx", "fz", "base_fx", "base_fz"):
        difference = np.abs(bed[name] - cylinder[name])
        assert difference[0] < 1e-6 * scale and difference[1] < 1e-4 * scale, name
    assert scale > 1e-3


# ---- what a run leaves -------------------------------------------------------------------------------------------


def test_forces_by_angle_sum_to_the_force_on_the_body(lift, tmp_path, figures_drawn):
    """A Gaussian of 8 degrees multiplies the first harmonic, which gives the force, by exp(-zeta^2/2)."""
    carry_out(lift, tmp_path / "run")
    found = summary_of(tmp_path / "run")
    with h5py.File(tmp_path / "run/run.h5") as file:
        theta, normal, tangential = (
            file["angular"][name][:] for name in ("theta", "normal_stress", "tangential_stress")
        )
    share = np.pi * (2 * lift.D) * (5 * lift.D) / len(theta)
    drag = np.sum(normal * np.cos(theta) + tangential * np.sin(theta)) * share
    up = np.sum(normal * np.sin(theta) - tangential * np.cos(theta)) * share
    smoothed = np.exp(-(np.radians(8) ** 2) / 2)
    assert drag == pytest.approx(found["drag"] * smoothed, rel=1e-3)  # the integral is a sum over 64 points
    assert up == pytest.approx(found["lift"] * smoothed, abs=1e-3 * found["drag"])
    assert found["drag_coefficient"] > 0.5
    lift.STUDY.figure(tmp_path / "run")
    words = figures_drawn[0].axes[1].get_legend().get_texts()[0].get_text()
    assert (
        with_error(found["lift_over_buoyancy"], found["lift_over_buoyancy_err"]) in words
    )  # where the running mean ends


@pytest.mark.parametrize("keys", [dict(), dict(bulk_gravity=False)], ids=str)
def test_both_loops_agree_until_chaos_parts_them(lift, keys):
    """Forty steps from the same bed at rest, springs included; the tangential spring is turned by another formula."""
    found = []
    for loop in ("grain", "yade"):
        _, _, *binners = built(lift, 0.4, loop=loop, **keys)
        found.append(np.concatenate(forces_of_steps(*binners, 40)))
    scale = np.abs(found[0]).max()
    assert scale > 1e-3
    assert np.abs(found[0] - found[1]).max() < 1e-4 * scale


@pytest.mark.parametrize("keys", [dict(fields=True, frames=2), dict(bulk_gravity=False)], ids=str)
def test_an_interrupted_run_goes_on_as_if_it_had_not_been(lift, tmp_path, monkeypatch, keys):
    expected = carry_out(lift, tmp_path / "whole", **keys)
    advance, blocks = yade_march.advance, iter(range(30))

    def stop_in_the_thirtieth_block(steps):
        if next(blocks) == 29:
            raise Interrupted(15)
        return advance(steps)

    monkeypatch.setattr(yade_march, "advance", stop_in_the_thirtieth_block)
    with pytest.raises(Interrupted):
        carry_out(lift, tmp_path / "parts", checkpoint_seconds=0, **keys)  # one after every block
    monkeypatch.setattr(yade_march, "advance", advance)
    found = carry_out(lift, tmp_path / "parts", resume=True, **keys)
    assert all(np.array_equal(expected[name], found[name]) for name in expected)
    one, other = summary_of(tmp_path / "whole"), summary_of(tmp_path / "parts")
    assert all(one[name] == other[name] for name in one if name not in TIMED)
    if "fields" in keys:
        with h5py.File(tmp_path / "whole/run.h5") as a, h5py.File(tmp_path / "parts/run.h5") as b:
            assert np.array_equal(a["fields/around/pressure"], b["fields/around/pressure"])
            assert a["fields/around/samples"][0] > 0
            assert a["fields/around/velocity"].shape[-1] == 3 and len(a["frames"]) == 2


# ---- shapes of one's own -----------------------------------------------------------------------------------------

BALL = """
import numpy as np
low, high, spacing = (-2.2,) * 3, (2.2,) * 3, 0.1
def distance(points):
    return np.sqrt((points**2).sum(axis=1)) - 1.5
"""


def test_a_function_of_distance_from_a_file_is_a_body(lift, tmp_path):
    (tmp_path / "ball.py").write_text(BALL)
    body = dragged_body.of_shape(str(tmp_path / "ball.py"), 0, 0, lift.D)
    assert body.volume == pytest.approx(
        4 / 3 * np.pi * 1.5**3 * lift.D**3, rel=0.01
    )  # steps of a fifteenth of the radius
    # A sample off the axis by half of the spacing's diagonal misses the pole by spacing^2/(4 radius).
    assert (body.height, body.breadth) == pytest.approx((3 * lift.D,) * 2, rel=2e-3)
    assert body.surface.normal(np.array([[0, 0, 2 * lift.D]]))[0] == pytest.approx([0, 0, 1], abs=1e-3)
    carry_out(lift, tmp_path / "run", shape=str(tmp_path / "ball.py"), breadth=7, width=18)
    assert summary_of(tmp_path / "run")["drag"] > 0


def test_a_function_that_changes_its_argument_describes_the_same_body(lift, tmp_path):
    box = "low, high = (-0.9, -1.9, -1.4), (2.9, 1.9, 2.4)\n"
    function = "def distance(p):\n    p -= (1.0, 0.0, 0.5)\n    return (p**2).sum(axis=1) ** 0.5 - 1.2\n"
    (tmp_path / "off.py").write_text(box + function)
    body = dragged_body.of_shape(str(tmp_path / "off.py"), 0, 0, 1.0)
    assert np.allclose(body.low, (-0.2, -1.2, -0.7), atol=0.01) and np.allclose(body.high, (2.2, 1.2, 1.7), atol=0.01)


def test_an_outline_is_swept_along_y_with_its_y_up(lift, tmp_path):
    """A right-angled wedge with a flat lower side; its highest corner is at the rear."""
    (tmp_path / "wedge.csv").write_text("0, 0\n3, 0\n0, 1.5\n")
    body = dragged_body.of_shape(str(tmp_path / "wedge.csv"), 0, 5 * lift.D, lift.D)
    assert body.volume == pytest.approx(2.25 * 5 * lift.D**3)
    assert (body.low[2], body.high[2]) == pytest.approx((-0.5 * lift.D, 1.0 * lift.D))
    inside, outside = np.array([[-0.5, 3.0, 0.5], [1.0, -3.0, 0.5]]) * lift.D
    assert body.surface.distance(inside[None])[0] < 0 < body.surface.distance(outside[None])[0]
    carry_out(lift, tmp_path / "run", shape=str(tmp_path / "wedge.csv"))
    assert summary_of(tmp_path / "run")["drag"] > 0


def test_a_tall_body_is_dragged_no_farther_than_its_own_wake_allows(lift, tmp_path):
    (tmp_path / "tall.csv").write_text("0, 0\n2, 0\n2, 6\n0, 6\n")
    keys = dict(shape=str(tmp_path / "tall.csv"), travel=None, width=40, height=20, depth=9)
    p = parameters(lift, **keys)
    lift.check(p)
    assert p.way == pytest.approx(40 - 2 * 6)
    assert parameters(lift, **{**keys, "shape": "cylinder"}).way == pytest.approx(40 - 2 * 2)


def test_a_body_smaller_than_a_grain_has_other_units(lift, tmp_path):
    (tmp_path / "metres.csv").write_text("0, 0\n0.006, 0\n0.006, 0.006\n0, 0.006\n")
    with pytest.raises(UsageError, match="0.006 d long, less than a grain; its lengths are in grain diameters"):
        lift.check(parameters(lift, shape=str(tmp_path / "metres.csv")))
    (tmp_path / "microns.csv").write_text("0, 0\n6000, 0\n6000, 6000\n0, 6000\n")
    with pytest.raises(UsageError, match="3e[+]03 d above its axis"):
        lift.check(parameters(lift, shape=str(tmp_path / "microns.csv")))


def test_a_run_of_a_shape_from_a_file_is_known_by_its_contents(lift, tmp_path):
    (tmp_path / "a.py").write_text(BALL)
    (tmp_path / "b.py").write_text(BALL.replace("1.5", "1.6"))
    for name in "ab":
        contents = (tmp_path / f"{name}.py").read_bytes()
        outline = parameters(lift, shape=str(tmp_path / f"{name}.py")).identity()["outline"]
        assert outline == hashlib.sha256(contents).hexdigest()[:12]
    assert (tmp_path / "a.py").read_bytes() != (tmp_path / "b.py").read_bytes()


@pytest.mark.parametrize(
    "text, reason",
    [
        ("low = high = (0, 0, 0)\n", "lacks distance"),
        ("def distance(points): pass\nlow = (0, 0)\nhigh = (1, 1)\n", "must be three numbers"),
        ("def distance(points:\n", "SyntaxError"),
        ("import numpy as np\nlow, high = (-2,) * 3, (2,) * 3\ndef distance(p): return 3 * p[:, 0]\n", "slope"),
        (BALL.replace("0.1\n", "'fine'\n"), "could not convert"),
        (BALL.replace("(-2.2,) * 3", "('a', 0, 0)"), "could not convert"),
        (BALL.replace("- 1.5", "+ 1.5"), "at some nodes, inside"),
        (BALL.replace("0.1\n", "0\n"), "spacing"),
        (BALL.replace("0.1\n", "float('nan')\n"), "spacing"),
        (BALL.replace("sum(axis=1)", "sum()"), "must give one distance"),
        ("import sys\nsys.exit('I am a program')\n", "SystemExit: I am a program"),
    ],
)
def test_a_file_that_describes_no_body_is_refused(lift, tmp_path, text, reason):
    (tmp_path / "bad.py").write_text(text)
    with pytest.raises(UsageError, match=reason):
        lift.check(parameters(lift, shape=str(tmp_path / "bad.py")))


# ---- bad input ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "keys, reason",
    [
        (dict(cylinder_diameter=20), "of the surface or lid"),
        (dict(depth=2.5), "of the surface or lid"),
        (dict(depth=11), "of the base"),
        (dict(depth=20), "of the base"),
        (dict(width=5, cylinder_diameter=3.5), "too small for a body"),
        (dict(breadth=1.5), "breadth=1.5 d must be at least"),
        (dict(width=3), "width=3 d must be at least"),
        (dict(travel=15.0), "own wake"),
        (dict(travel=2.0), "too little after the transient"),
        (dict(lid_density=0, bulk_gravity=False), "needs a lid"),
        (dict(lid_density=1e6), "lower lid_density"),
        (dict(dt_factor=20), "lower dt_factor"),
        (dict(shape="pyramid"), "shape must be cylinder"),
        (dict(shape="missing.py"), "No such file or directory; name a file that defines distance"),
        (dict(shape="missing.csv"), "shape=missing.csv"),
        (dict(field_spacing=0.3), "must divide 1 d"),
        (dict(width=1e6, breadth=1e4), "more than 5e"),
        (dict(speed=1e-9), "steps"),
    ],
    ids=str,
)
def test_values_that_do_not_go_together_are_refused(lift, keys, reason):
    with pytest.raises(UsageError, match=reason):
        lift.check(parameters(lift, **keys))


def test_a_bed_that_cannot_hold_the_drag_is_told_of(lift, capsys):
    """C_d D P_axis = 10 * 2 d * P_0 against mu times the load on base and lid: a width of 16 d is too small, 80 d is enough."""
    for width, told in ((16, True), (80, False)):
        weight = 1500 * 9.81 * 0.03 * width * lift.D * 5 * lift.D
        seen = forces.Scene(
            9.81, lift.D, 2 * lift.D, 5 * lift.D, 1e-8, 1500.0, 0.03, weight, 0.0, 0.5, 0.1, lift.DENSITY
        )
        lift.say_what_presses(seen)
        assert ("slip as a whole" in capsys.readouterr().err) is told


def test_each_scale_is_a_run_that_can_be_made(lift):
    for scale, values in lift.PRESETS.items():
        _, ratio = lift.check(lift.LiftParameters(**values, scale=scale))
        assert ratio < 0.7
    paper = lift.LiftParameters()
    assert (paper.width, paper.breadth, paper.height) == (140, 10, 120) and paper.way == pytest.approx(132)
    assert sum(lift.recipes(paper, lift.body_of(paper))[0].counts()) == pytest.approx(190_000, rel=0.03)
