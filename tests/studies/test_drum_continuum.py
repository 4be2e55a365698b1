"""The drum study's continuum on a coarse grid: surface, layer, static part, kill and resume, both models, extremes, bad input."""

import os
import signal
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from drum_study import STUDIES, assert_same, carry_out
from known_names import unexplained

from graindrive.continuum import drum_continuum
from graindrive.exports import exports
from graindrive.continuum.continuum import FlowMarch
from graindrive.base.errors import EngineError, Interrupted, UsageError
from graindrive.postproc.drum import blocks, figure
from graindrive.postproc.drum.flow import BED_FRACTION
from graindrive.postproc.drum.flow_frames import FlowFrames
from graindrive.postproc.drum.steady import centre_angle
from graindrive.postproc.reader import Run

COARSE = dict(model="continuum", drum_diameter=40, froude=0.02, cells=30, continuum_dt=0.05)
QUICK = {**COARSE, "froude": 0.1, "cells": 20, "frames": 5}
GRAINS = dict(drum_diameter=20, start_turn=2, turn=2, dt_factor=5)
SLOW, FAST = (float(np.degrees(np.arctan(mu))) for mu in (0.246, 0.401))  # angles of repose of slow and of fast flow


@pytest.fixture(scope="module")
def turned(tmp_path_factory):
    """Folder of the coarse run, made once for all tests that read it."""
    return tmp_path_factory.mktemp("turned") / "run"


@pytest.fixture
def run(drum, turned):
    """The coarse run."""
    return Run(turned) if turned.exists() else carry_out(drum, turned, **COARSE)


def test_a_layer_flows_down_a_bed_that_turns(run):
    found = run.summary
    assert run.state == "complete" and found["continuum_steady"] == 1
    # The slope follows from the friction of the layer, between mu_s and mu_2; walls and the round bed add some degrees.
    assert SLOW < found["surface_angle_deg"] < FAST + 5
    assert found["layer_over_diameter"] == pytest.approx(
        0.11 + 1.2 * 0.02, abs=0.04
    )  # the value of the paper; a cell is 0.033
    assert found["rigid_deviation"] < 0.05  # relative to Omega z, as for the paper's drums; 0.015 is usual
    assert abs(found["flow_balance"]) < 0.15
    assert found["flow_down"] > 0 > found["flow_up"]
    assert abs(found["continuum_area_drift"]) < 1e-10
    assert 0 < found["ill_posed_share"] < 1 and found["continuum_core_seconds"] > 0


def test_the_summary_follows_from_the_stored_fields(run):
    p = run.parameters
    flow = blocks.steady_flow(blocks.read(run, "continuum"), p["drum_diameter"], p["angular_velocity"])
    for name, value in flow.summary.items():
        assert run.summary[name] == pytest.approx(value, rel=1e-12, nan_ok=True)
    assert len(blocks.read(run, "continuum")) == drum_continuum.BLOCKS
    assert unexplained(run) == []


def test_the_torque_is_that_of_half_a_disk_at_its_slope(run):
    """M = -(2/3) R^3 times the bed's density and the sine of the slope: half a disk's area times 4R/3pi, the whole drum's."""
    slope = run.summary["centre_angle"]
    assert slope == pytest.approx(run.summary["surface_angle_deg"], abs=3)  # the surface is not a straight line
    half_disk = 2 / 3 * (run.parameters["drum_diameter"] / 2) ** 3 * BED_FRACTION
    # The curved surface and cells of D/30 give errors of some percent. Without the wall's transition M would be a third less.
    assert run.summary["torque"] == pytest.approx(-half_disk * np.sin(np.radians(slope)), rel=0.06)
    assert 0 < run.summary["centre_angle_err"] < 3


def test_the_bed_turns_with_the_drum_until_it_flows(run):
    """Before the surface yields the centre of mass turns by as much as the drum; then it stays where it is."""
    rows = run.group("continuum")
    turn, angle = rows["turn"], rows["centre_angle"]
    assert np.interp(8, turn, angle) - np.interp(2, turn, angle) == pytest.approx(
        6, abs=0.3
    )  # the layer yields at mu_s
    assert (
        np.ptp(angle[turn > turn[-1] - 25]) < 5
    )  # of the 25 by which the drum turned; after the first slide the angle still oscillates by some degrees


def test_the_bed_s_weight_presses_on_its_bottom(run):
    """p below the axis is about that of the bed above, rho g cos(angle) times the depth, less the part that the walls bear."""
    stored, D = run.group("fields/continuum"), run.parameters["drum_diameter"]
    column, row = np.abs(stored["x"]).argmin(), np.abs(stored["y"] + 0.35 * D).argmin()
    pressure = stored["pressure"].mean(axis=0)[row, column]
    assert pressure == pytest.approx(BED_FRACTION * 0.35 * D, rel=0.25)


def test_paraview_s_files_hold_the_fields_in_the_frame_of_the_grains(run):
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    exports.write(run.path, ["vtk"])
    stored = run.group("fields/continuum")
    ny, nx = len(stored["y"]), len(stored["x"])
    for block in (0, drum_continuum.BLOCKS - 1):
        reader = vtkXMLImageDataReader()
        reader.SetFileName(str(run.path / "vtk" / f"fields_continuum_{block + 1:02d}.vti"))
        reader.Update()
        image, data = reader.GetOutput(), reader.GetOutput().GetPointData()
        assert image.GetDimensions() == (nx, ny, 1)
        assert image.GetOrigin() == pytest.approx((stored["x"][0], stored["y"][0], 0), abs=1e-12)
        assert image.GetSpacing()[0] == pytest.approx(stored["x"][1] - stored["x"][0], rel=1e-12)
        for name in ("area_fraction", "pressure", "ill_posed"):
            read = vtk_to_numpy(data.GetArray(name)).reshape(ny, nx)
            assert np.array_equal(read, stored[name][block], equal_nan=True)
        read = vtk_to_numpy(data.GetArray("velocity")).reshape(ny, nx, 3)
        assert np.array_equal(read[..., :2], stored["velocity"][block], equal_nan=True) and not read[..., 2].any()
    times = (run.path / "vtk" / "fields_continuum.pvd").read_text()
    told = [float(part.split('"')[1]) for part in times.split("timestep=")[1:]]
    assert len(told) == drum_continuum.BLOCKS and min(np.diff(told)) > 0
    assert 0 < told[0] and told[-1] < run.group("continuum")["t"][-1]


def test_pictures_of_the_flow_are_even_in_time_and_show_the_bed_of_their_moment(drum, whole):
    """Frames have the centre of mass of the rows, which are at most a degree of turn apart; the last frame is that of the end."""
    run = Run(whole) if whole.exists() else carry_out(drum, whole, **QUICK)
    frames, rows, p = FlowFrames(run), run.group("continuum"), run.parameters
    assert len(frames) == 5
    planned = np.radians(drum_continuum.START_TURN + drum_continuum.WINDOW) / p["angular_velocity"]
    assert np.diff([frame.t for frame in frames]) == pytest.approx(
        planned / 5, rel=0.05
    )  # rounded to whole steps and rows
    assert frames[4].t <= rows["t"][-1]
    for frame in frames:
        weight = frame.arrays["area_fraction"].astype(float)
        x, y = np.meshgrid(frame.x, frame.y)
        angle = centre_angle(x, y, weight)
        assert angle == pytest.approx(
            np.interp(frame.t, rows["t"], rows["centre_angle"]), abs=0.5
        )  # half a degree of turn
        assert weight.max() <= np.float32(BED_FRACTION) and np.isfinite(frame.arrays["velocity"]).all()


def test_the_figure_shows_where_the_equations_are_ill_posed(run):
    figure.draw(run.path)
    assert (run.path / "figure.png").stat().st_size > 10_000
    x, y, share = figure.ill_posed_map(run)
    stored = run.group("fields/continuum")
    bed = stored["area_fraction"].mean(axis=0) / BED_FRACTION
    assert share.shape == (len(y), len(x)) and np.nanmax(share) <= 1
    # summary.json has the area of the last state's bed over that of the grains; here the mean bed is used
    assert np.nansum(share * bed) / bed.sum() == pytest.approx(run.summary["ill_posed_share"], rel=0.05)


# Kill and resume ------------------------------------------------------------------------------------------------------


def stop_after(monkeypatch, calls):
    """Interrupt the continuum's march at the start of that call."""
    advance, count = FlowMarch.advance, iter(range(10**6))

    def stopped(self, steps):
        if next(count) == calls:
            raise Interrupted(signal.SIGTERM)
        return advance(self, steps)

    monkeypatch.setattr(FlowMarch, "advance", stopped)
    return lambda: monkeypatch.setattr(FlowMarch, "advance", advance)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Folder of a quick run without interruption."""
    return tmp_path_factory.mktemp("whole") / "run"


@pytest.mark.parametrize("calls", [20, 75])  # before and during averaging
def test_an_interrupted_run_goes_on_as_if_it_had_not_been(drum, whole, tmp_path, monkeypatch, calls):
    if not whole.exists():
        carry_out(drum, whole, **QUICK)
    go_on = stop_after(monkeypatch, calls)
    with pytest.raises(Interrupted):
        carry_out(drum, tmp_path / "parts", **QUICK, checkpoint_seconds=0)
    go_on()
    carry_out(drum, tmp_path / "parts", **QUICK, checkpoint_seconds=0, resume=True)
    assert_same(whole, tmp_path / "parts")


KILLED = """
import os, sys
from graindrive.commands import headless
from graindrive.continuum.continuum import FlowMarch
from graindrive.study import loaded
study, number = loaded(sys.argv.pop(1)), int(sys.argv.pop(1))
advance = FlowMarch.advance
calls = iter(range(10**6))
def killed(self, steps):
    if number and next(calls) == 40:
        os.kill(os.getpid(), number)
    advance(self, steps)
FlowMarch.advance = killed
headless.main(study)
"""


def test_a_process_that_is_asked_to_stop_leaves_a_run_that_goes_on(drum, whole, tmp_path):
    if not whole.exists():
        carry_out(drum, whole, **QUICK)
    place = tmp_path / "killed"
    keys = [f"{name}={value}" for name, value in QUICK.items()] + [f"out={place}", "checkpoint_seconds=0"]

    def call(number, *more):
        command = [sys.executable, "-c", KILLED, str(STUDIES / "drum.py"), str(int(number)), *keys, *more]
        pipes = dict(stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)
        return subprocess.run(
            command, env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}, cwd=tmp_path, **pipes
        )

    stopped = call(signal.SIGTERM)
    assert stopped.returncode not in (0, 1), stopped.stderr
    assert "Traceback" not in stopped.stderr
    assert not place.exists() and place.with_name("killed.interrupted").is_dir()
    done = call(0, "resume=1")
    assert done.returncode == 0, done.stderr
    assert_same(whole, place)


# Both models ----------------------------------------------------------------------------------------------------------


def test_both_models_leave_their_flows_side_by_side_and_a_resumed_run_keeps_the_grains(drum, tmp_path, monkeypatch):
    keys = {**QUICK, **GRAINS, "model": "both"}
    whole = carry_out(drum, tmp_path / "whole", **keys)
    assert blocks.models_in(whole) == ["dem", "continuum"]
    found = whole.summary
    assert {"continuum_surface_angle_deg", "surface_angle_deg", "dem_continuum_difference"} <= found.keys()
    assert unexplained(whole) == []
    assert 5 < found["continuum_surface_angle_deg"] < 40
    times = [whole.frame(k).t for k in range(len(whole.frame_names))]
    seen = [frame.t for frame in FlowFrames(whole)]
    assert len(seen) == len(times) == 5  # the continuum's run is longer; frames are taken at the grains' times
    assert seen == pytest.approx(times, abs=0.5 * QUICK["continuum_dt"] + 1e-9)
    assert whole.provenance["n_grains"] == drum.DrumParameters(**keys).count
    go_on, built = stop_after(monkeypatch, 50), drum.build
    with pytest.raises(Interrupted):
        carry_out(drum, tmp_path / "parts", **keys, checkpoint_seconds=0)
    go_on()
    monkeypatch.setattr(drum, "build", lambda *_: pytest.fail("the grains were poured again"))
    carry_out(drum, tmp_path / "parts", **keys, checkpoint_seconds=0, resume=True)
    monkeypatch.setattr(drum, "build", built)
    assert_same(tmp_path / "whole", tmp_path / "parts")


# Extremes -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "keys, low, high",
    [
        # A thin bed slopes by its friction; in a nearly full drum the centre of mass does not show the slope of the surface.
        (dict(filling=0.2), SLOW, FAST + 3),
        (dict(filling=0.9), 0, 60),
        # A fluid of small viscosity slopes less than grains; a large viscosity adds its own resistance.
        (dict(largest_viscosity=1e2, continuum_dt=0.02), 5, FAST + 3),
        (dict(largest_viscosity=1e6), SLOW, FAST + 6),
        (dict(rheology="regularised"), SLOW, FAST + 3),
        (dict(froude=0.9, continuum_dt=0.02), FAST, 90),  # a bed that is nearly centrifuged rises far
    ],
)
def test_an_extreme_flow_keeps_its_area_and_slopes_as_it_must(drum, keys, low, high):
    p = drum.DrumParameters(**{**COARSE, "cells": 30 if "filling" in keys else 24, "froude": 0.05, **keys})
    drum.check(p)
    flow = drum_continuum.flow_of(p)
    march, area = FlowMarch(flow), flow.area
    march.advance(int(np.radians(70) / (p.omega * p.continuum_dt)))
    row = drum_continuum.row_of(p, march)
    assert low < row["centre_angle"] < high
    assert flow.area == pytest.approx(area, rel=1e-12)
    assert flow.fraction.min() > -1e-12 and flow.fraction.max() < 1 + 1e-6  # the tolerance of the projection
    assert np.isfinite(flow.pressure).all()
    assert p.rheology == "mu_i" or not flow.ill_posed.any()


def test_a_slow_drum_carries_its_bed_along_as_it_is(drum):
    p = drum.DrumParameters(**{**COARSE, "froude": 1e-6, "cells": 24})
    drum.check(p)
    flow = drum_continuum.flow_of(p)
    FlowMarch(flow).advance(400)
    x, y = drum_continuum.grid_of(p)
    deep = (flow.fraction > 0.999) & (flow.openness >= 1) & (y[:, None] < -0.1 * p.drum_diameter)
    rigid = p.omega * np.stack(np.broadcast_arrays(-y[:, None], x[None, :]), axis=-1)
    # the decay of the start, a bed at rest that the wall sets in motion
    assert np.abs(flow.velocity - rigid)[deep].max() < 0.1 * p.omega * p.drum_diameter / 2


def test_a_bed_that_is_a_liquid_is_said_to_be_one(drum, capsys):
    usual, large = (drum.DrumParameters(model="continuum", drum_diameter=D) for D in (150, 1e5))
    # mu_s rho g R over eta_max and Omega: 0.246 x 0.825 x 75 over pi/4 8e4 x 6.28e-3
    assert drum_continuum.creep_over_turning(usual) == pytest.approx(0.0386, rel=0.01)
    for p in (usual, large):
        drum_continuum.announce(p, SimpleNamespace(size=1))
    told = capsys.readouterr().err
    assert told.count("flows like a liquid; raise largest_viscosity") == 1 and told.count("cells of") == 2


def test_a_finer_grid_costs_more_than_its_cells(drum):
    """Measured: 0.33 us a cell-step at 75 cells across, 0.45 at 150, 0.75 at 300."""
    p = [drum.DrumParameters(model="continuum", cells=cells) for cells in (75, 150, 300)]
    times = [drum_continuum.seconds(one) / drum_continuum.cell_steps(one) for one in p]
    assert times == pytest.approx([0.33e-6, 0.45e-6, 0.75e-6], rel=0.05)


def test_a_flow_that_outruns_its_step_says_which_key_to_lower(drum, tmp_path):
    with pytest.raises(EngineError, match="must cross less than half a cell .* lower continuum_dt"):
        carry_out(drum, tmp_path / "run", **{**COARSE, "froude": 0.05, "continuum_dt": 0.3, "largest_viscosity": 1e2})


@pytest.mark.parametrize(
    "keys, words",
    [
        (dict(cells=10), "cells=10 across the drum do not resolve its flow; give 20 or more"),
        (dict(dynamic_friction=0.2), "dynamic_friction=0.2 must not be below static_friction=0.246; exchange them"),
        (
            dict(viscosity="split"),
            "these keys give no continuum: the time step must not be above .* got 0.05; lower continuum_dt or largest_viscosity",
        ),
        (
            dict(filling=0.02),
            r"filling=0.02 makes a bed 1.6 cells deep, .* at least 6 cells deep; raise filling or cells",
        ),
        (dict(filling=0.95), "filling=0.95 gives the continuum no free surface; it must be at most 0.9"),
        (dict(pressure_solver="guess"), "pressure_solver=guess is not known; leave it empty or take one of multigrid"),
        (
            dict(largest_viscosity=1e12),
            "largest_viscosity=1e[+]12 makes round-off larger than the flow: .* lower it to 3.7e",
        ),
        (dict(tolerance=1e-30), "the initial pressure does not reach tolerance=1e-30: .* give a larger"),
        (dict(export="vtk,xyz"), "export=xyz needs grains, and model=continuum has none; give export=vtk"),
        (
            dict(froude=0.05, continuum_dt=0.5),
            r"continuum_dt=0.5 lets the wall cross 0.78 cells .* take less than 0.3",
        ),
        (dict(froude=1.0), "Fr=1 at D=40 d: from Fr=1 on the grains are centrifuged; lower angular_velocity or froude"),
        (dict(continuum_dt=1e-12), "the run would take .* raise continuum_dt or the drum's speed"),
        (dict(drum_diameter=10), "drum_diameter=10 d has no room"),
        (dict(model="both", filling=0.8), "filling=0.8 leaves no room"),
    ],
)
def test_what_cannot_be_run_is_refused_in_one_line(drum, keys, words):
    with pytest.raises(UsageError, match=words) as refused:
        drum.check(drum.DrumParameters(**{**COARSE, **keys}))
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 250
