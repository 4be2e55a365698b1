"""The drum study at small size: balance of torques, flowing layer and static part, both loops, resuming, refused values."""

import numpy as np
import pytest
from drum_study import assert_same, carry_out
from known_names import unexplained

from graindrive.scenes import yade_march
from graindrive.base.errors import Interrupted, UsageError
from graindrive.postproc.drum import blocks
from graindrive.postproc.reader import Run

TINY = dict(drum_diameter=24, froude=1e-2, start_turn=60, turn=60, dt_factor=5)
SHORT = {**TINY, "start_turn": 2, "turn": 2}


@pytest.fixture(scope="module")
def turned(tmp_path_factory):
    """Folder of a run of the small study, made once for all tests that read it."""
    return tmp_path_factory.mktemp("turned") / "run"


@pytest.fixture
def run(drum, turned):
    """The run: its module, folder, series."""
    if not turned.exists():
        carry_out(drum, turned, **TINY, frames=2)
    return Run(turned)


def test_the_bed_turns_with_the_drum_until_it_flows(run):
    turn, angle = run.series["turn"], run.series["centre_angle"]
    # Before the surface yields, at some 20 degrees, the bed turns with the drum; compared from 5 to 12 degrees.
    assert np.interp(12, turn, angle) - np.interp(5, turn, angle) == pytest.approx(7, abs=0.7)


def test_the_drive_bears_the_lever_of_the_weight(run):
    """The torque on the drum is the weight at the centre of mass, up to the change of the grains' angular momentum."""
    steady = run.series["turn"] > 60
    t, mass = run.series["t"], np.pi * np.sum(run.frame().grains["r"] ** 2)
    lever = np.trapz(mass * run.series["centre_x"][steady], t[steady])
    given = np.diff(run.series["work"][steady][[0, -1]])[0] / run.parameters["angular_velocity"]
    # angular momentum: at most M (D/2)^2 Omega/2 of rigid rotation, and as much of the layer
    change = mass * 12**2 * run.parameters["angular_velocity"]
    assert abs(given - lever) < change < 0.15 * lever
    assert run.summary["torque"] == pytest.approx(-lever / np.ptp(t[steady]), rel=0.15)


def test_a_layer_flows_down_a_bed_that_turns(run):
    found = run.summary
    assert found["steady"] == 1 and found["froude"] == 1e-2
    assert (
        15 < found["surface_angle_deg"] < 35
    )  # usual for disks with mu = 0.5 in a small drum; errors are some degrees
    assert 0.05 < found["thickness_over_diameter"] < 0.25
    assert 0.75 < found["packing_fraction"] < 0.87  # loose and close random packing of disks, 0.77 and 0.84
    assert found["rigid_deviation"] < 0.2
    assert abs(found["flow_balance"]) < 0.3
    assert found["flow_down"] > 0 > found["flow_up"]


def test_the_summary_follows_from_the_stored_fields(run):
    p = run.parameters
    flow = blocks.steady_flow(blocks.read(run, "dem"), p["drum_diameter"], p["angular_velocity"])
    for name, value in flow.summary.items():
        assert run.summary[name] == pytest.approx(value, rel=1e-12, nan_ok=True)
    stored = run.group("depth/dem")
    assert all(np.array_equal(stored[name], array, equal_nan=True) for name, array in flow.profile.items())
    assert len(blocks.read(run, "dem")) == 8


def test_fields_hold_all_grains(run):
    seen = blocks.read(run, "dem").mean()
    area = np.sum(seen.fraction) * (seen.x[1] - seen.x[0]) ** 2
    assert area == pytest.approx(np.pi * np.sum(run.frame().grains["r"] ** 2), rel=1e-9)


def test_every_name_has_a_unit_and_a_meaning(run):
    assert unexplained(run) == []


def test_frames_show_grains_and_wall(run, drum):
    first, last = run.frame(0), run.frame(-1)
    assert len(run.frame_names) == 2 and len(last.grains["x"]) == run.provenance["n_grains"]
    assert np.hypot(last.intruder["x"], last.intruder["y"]) == pytest.approx(12.0, rel=1e-12)
    angle = run.parameters["angular_velocity"] * (last.t - first.t)
    turned = np.arctan2(last.intruder["y"][0], last.intruder["x"][0]) - np.arctan2(
        first.intruder["y"][0], first.intruder["x"][0]
    )
    assert (turned - angle + np.pi) % (2 * np.pi) - np.pi == pytest.approx(0, abs=1e-9)


def test_both_loops_turn_alike_until_chaos(drum, tmp_path):
    fast, slow = (carry_out(drum, tmp_path / loop, **SHORT, loop=loop).series for loop in ("grain", "yade"))
    early = fast["turn"] < 0.35  # 400 steps, 40 times as long as a contact; then round-off has grown to 1e-11
    assert np.ptp(slow["centre_angle"][early]) > 0.1
    assert np.abs(fast["centre_angle"] - slow["centre_angle"])[early].max() < 1e-9
    assert np.abs(fast["work"] - slow["work"])[early].max() < 1e-9 * np.abs(slow["work"]).max()


def test_an_interrupted_run_goes_on_as_if_it_had_not_been(drum, tmp_path, monkeypatch):
    whole = carry_out(drum, tmp_path / "whole", **SHORT)
    advance, count = yade_march.advance, iter(range(1000))

    def stop_in_the_fiftieth_block(steps):
        if next(count) == 49:
            raise Interrupted(15)
        return advance(steps)

    monkeypatch.setattr(yade_march, "advance", stop_in_the_fiftieth_block)
    with pytest.raises(Interrupted):
        carry_out(drum, tmp_path / "parts", **SHORT, checkpoint_seconds=0)
    monkeypatch.setattr(yade_march, "advance", advance)
    carry_out(drum, tmp_path / "parts", **SHORT, resume=True)
    assert len(whole.series["t"]) > 60  # so that averaging had begun
    assert_same(tmp_path / "whole", tmp_path / "parts")


def test_the_paper_s_numbers_are_taken(drum):
    for diameter, grains, wall in ((150, 7700, 475), (300, 30600, 632), (450, 69200, 946)):
        p = drum.DrumParameters(drum_diameter=diameter)
        assert (p.count, p.wall_count) == (grains, wall)
        # without a given speed that of the paper's Fig. 2, at equal Froude number
        assert p.omega == pytest.approx(6.28e-3 * np.sqrt(150 / diameter), rel=1e-15)
    small = drum.DrumParameters(drum_diameter=75, filling=0.25)
    # half of a half: 0.25 pi/4 75^2 of the area at 0.828, of disks of 1.2133 pi/4 on average
    assert small.count == round(0.25 * 75**2 * 0.828 / (3.64 / 3)) and small.wall_count == 236


def test_speed_is_given_in_either_way(drum):
    by_froude = drum.DrumParameters(froude=3e-3)
    assert by_froude.omega == pytest.approx(np.sqrt(2 * 3e-3 / 150), rel=1e-15) and by_froude.froude_number == 3e-3
    assert drum.DrumParameters(angular_velocity=0.01).froude_number == pytest.approx(0.0075, rel=1e-15)
    assert drum.DrumParameters(**drum.PRESETS["smoke"], angular_velocity=0.01).omega == 0.01
    by_speed, usual = drum.DrumParameters(angular_velocity=by_froude.omega), drum.DrumParameters()
    changed = {key for key, value in by_speed.identity().items() if value != usual.identity()[key]}
    assert changed == {"angular_velocity", "froude"} and by_speed.froude_number == pytest.approx(3e-3, rel=1e-15)


@pytest.mark.parametrize(
    "keys, words",
    [
        (dict(filling=0.9), r"filling=0.9 leaves no room for pouring the grains .* at most 0.7"),
        (dict(filling=1e-6), "a drum of 150 d holds no grain at this filling"),
        (dict(grains=13000), "13000 grains .* do not fit"),
        (dict(froude=1.0), r"Fr=1 at D=150 d: from Fr=1 on the grains are centrifuged"),
        (dict(angular_velocity=0.2), "centrifuged; lower angular_velocity or froude"),
        (dict(angular_velocity=6.28e-3, froude=3e-3), "both say how fast the drum turns; give one"),
        (dict(drum_diameter=1.0), "drum_diameter=1 d has no room .* at least 20 d"),
        (dict(drum_diameter=1e6), "more than 10000000|bins, more than"),
        (dict(wall_disks=200), r"wall_disks=200 leaves gaps of 1.36 d, .* give at least 262"),
        (dict(wall_disks=5000), "more than twice the number that fits side by side; give at most 942"),
        (dict(dt_factor=100), "time step 0.01 is over the critical"),
        (dict(stiffness=10.0), "the lowest grains carry a load|time step"),
        (dict(dt_factor=1e-4), "the run would take"),
        (dict(turn=1e-4), "turn=0.0001 must last at least four steps"),
        (dict(field_spacing=1e-3), "field_spacing=0.001 d makes .* bins"),
        (dict(field_spacing=5, drum_diameter=40), "fewer than four columns of bins .* give 3.33 d or less"),
        (dict(filling=0.01, drum_diameter=40), r"11 grains make a bed 1.3 d deep .* at least 3 d"),
        (dict(grains=1), "1 grains make a bed"),
        (dict(grains=5, filling=1e-9), "5 grains make a bed"),
        (
            dict(model="both", grains=4000),
            "grains=4000 fills 0.26 of the drum, but .* filling=0.5: .* or give filling=0.26",
        ),
        (dict(start_turn=0.01), "start_turn=0.01 and turn=360 degrees differ too much"),
        (dict(turn=0.02), "differ too much: rows that are short enough for the smaller make .* raise the smaller"),
        (dict(pressure_solver="foo"), "pressure_solver=foo is not known; leave it empty or take one of multigrid"),
        (dict(wall_disks=1), "wall_disks=1 leaves gaps of 149 d"),
    ],
)
def test_what_cannot_be_run_is_refused_in_one_line(drum, keys, words):
    with pytest.raises(UsageError, match=words) as refused:
        drum.check(drum.DrumParameters(**keys))
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 250


@pytest.mark.parametrize(
    "keys", [{}, dict(froude=1e-6, dt_factor=5), dict(froude=0.9), dict(filling=0.05), dict(drum_diameter=20)]
)
def test_what_can_be_run_is_not_refused(drum, keys):
    assert 0 < drum.check(drum.DrumParameters(**keys)) < 1


def test_a_flow_that_never_is_steady_is_averaged_all_the_same_and_said_to_be_none(drum, tmp_path, monkeypatch, capfd):
    monkeypatch.setattr(drum, "is_steady", lambda turn, angle, least: False)
    run = carry_out(drum, tmp_path / "run", **SHORT)
    series, found = run.series, run.summary
    assert found["steady"] == 0 and found["averaged_from"] == pytest.approx(4, abs=0.1)
    assert series["turn"][-1] == pytest.approx(6, abs=0.1) and "still drifted after 4 degrees" in capfd.readouterr().err
