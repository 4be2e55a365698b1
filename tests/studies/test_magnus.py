"""The Magnus study at small size: symmetries of the forces, the sign of the lift, both loops, and resuming."""

import importlib
import json
import os
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest

from graindrive.base.numbers import with_error
from graindrive.commands import headless
from graindrive.scenes import yade_march
from graindrive.base.errors import EngineError, Interrupted, UsageError
from graindrive.commands.killtest import TIMED
from graindrive.runs.run_folder import RunFolder

STUDIES = Path(__file__).resolve().parents[2] / "studies"
TINY = dict(width=24, height=20, intruder_diameter=3, v0=2.5, dt_factor=2, travel=2.0, settle_travel=0.5, fields=False)


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """A cache that the runs of this file share."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture
def magnus(monkeypatch, cache):
    """The study as a module, in this process."""
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(cache))
    monkeypatch.syspath_prepend(str(STUDIES))
    return importlib.import_module("magnus")


def carry_out(magnus, out, **changes):
    """Run the shrunken study into the folder `out`; return its series."""
    p = magnus.MagnusParameters(**{**TINY, "out": str(out), **changes})
    with RunFolder(p, study="magnus") as folder:
        magnus.run(p, folder)
    return series_of(out)


def series_of(out):
    with h5py.File(Path(out) / "run.h5") as file:
        return {name: data[:] for name, data in file["series"].items()}


def summary_of(out):
    return json.loads((Path(out) / "summary.json").read_text())


def change_packings(magnus, monkeypatch, change):
    """Give the study packings that `change(x, y, r)` has changed."""
    made = magnus.packing

    def changed(p, body):
        found = made(p, body)
        x, y, r = change(found["x"], found["y"], found["r"])
        return {**found, "x": x, "y": y, "r": r}

    monkeypatch.setattr(magnus, "packing", changed)


def mirrored(x, y, r):
    return x, -y, r


def symmetric(x, y, r):
    upper = y > r
    return np.r_[x[upper], x[upper]], np.r_[y[upper], -y[upper]], np.r_[r[upper], r[upper]]


def test_lift_is_odd_in_the_spin_and_drag_even(magnus, monkeypatch, tmp_path):
    there = carry_out(magnus, tmp_path / "there", spin_ratio=2)
    change_packings(magnus, monkeypatch, mirrored)
    back = carry_out(magnus, tmp_path / "back", spin_ratio=-2)
    # Grains are sorted in another order, so sums differ by round-off, which collisions let grow.
    scale = np.abs(there["fx"]).max()
    assert scale > 1 and np.abs(there["fy"]).max() > 0.1 * scale
    assert np.abs(there["fx"] - back["fx"]).max() < 1e-9 * scale
    assert np.abs(there["fy"] + back["fy"]).max() < 1e-9 * scale
    one, other = summary_of(tmp_path / "there"), summary_of(tmp_path / "back")
    assert other["lift"] == pytest.approx(one["lift"], rel=1e-6)  # both along -omega x V


@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_a_symmetric_packing_gives_no_lift_without_spin(magnus, monkeypatch, tmp_path, mu):
    change_packings(magnus, monkeypatch, symmetric)
    series = carry_out(magnus, tmp_path / "run", spin_ratio=0, mu=mu)
    assert np.abs(series["fx"]).max() > 1
    assert np.abs(series["fy"]).max() < 1e-9 * np.abs(series["fx"]).max()


def test_without_friction_spin_does_nothing(magnus, tmp_path):
    still = carry_out(magnus, tmp_path / "still", spin_ratio=0, mu=0)
    spinning = carry_out(magnus, tmp_path / "spinning", spin_ratio=7, mu=0)
    assert np.array_equal(still["fx"], spinning["fx"]) and np.array_equal(still["fy"], spinning["fy"])


def test_lift_points_against_omega_cross_v(magnus, tmp_path):
    """At Omega = 5 nearly all contacts slip: L/D is near kappa mu - (1 - kappa)/mu (Eq. 15), about 0.35."""
    carry_out(magnus, tmp_path / "run", width=60, height=40, intruder_diameter=5, travel=60, settle_travel=10)
    found = summary_of(tmp_path / "run")
    assert found["lift"] > 3 * found["lift_err"] > 0
    assert found["slipping_share"] > 0.9
    assert abs(found["lift_to_drag"] - found["model_kappa"]) < 0.05  # the model assumes only that all contacts slip
    assert found["front_share"] > 0.9


def test_summary_and_figure_agree_with_the_series(magnus, tmp_path, figures_drawn):
    series = carry_out(magnus, tmp_path / "run", travel=4.0)
    found = summary_of(tmp_path / "run")
    steady = series["travel"] >= found["steady_from"] - 1e-9
    assert found["drag"] == pytest.approx(-series["fx"][steady].mean(), rel=1e-12)
    assert found["lift"] == pytest.approx(-series["fy"][steady].mean(), rel=1e-12)
    assert abs(found["phi"] - 0.352) < 1e-3 and found["v0"] == 2.5
    # x = V0 t to round-off of positions of 1 m
    assert np.abs(series["x"] - 0.24 - 2.5 * series["t"]).max() < 1e-12
    magnus.STUDY.figure(tmp_path / "run")
    words = figures_drawn[0].axes[1].get_legend().get_texts()[0].get_text()
    assert with_error(found["lift_to_drag"], found["lift_to_drag_err"]) in words  # where the running mean ends


def test_both_loops_give_the_same_forces_until_chaos(magnus, tmp_path):
    found = {loop: carry_out(magnus, tmp_path / loop, loop=loop, travel=1.0) for loop in ("grain", "yade")}
    fast, slow = found["grain"], found["yade"]
    scale = np.abs(slow["fx"]).max()
    assert scale > 1
    for name in ("fx", "fy"):
        assert np.abs(fast[name] - slow[name]).max() < 1e-6 * scale


@pytest.mark.parametrize("fields, wall_pressure", [(False, 5.0), (True, 0.0)])
def test_an_interrupted_run_goes_on_as_if_it_had_not_been(magnus, tmp_path, monkeypatch, fields, wall_pressure):
    keys = dict(fields=fields, field_spacing=0.5, wall_pressure=wall_pressure)
    expected = carry_out(magnus, tmp_path / "whole", **keys)
    advance, blocks = yade_march.advance, iter(range(12))

    def stop_in_the_twelfth_block(steps):
        if next(blocks) == 11:
            raise Interrupted(15)
        return advance(steps)

    monkeypatch.setattr(yade_march, "advance", stop_in_the_twelfth_block)
    with pytest.raises(Interrupted):
        carry_out(magnus, tmp_path / "parts", checkpoint_seconds=0, **keys)  # one after every block
    monkeypatch.setattr(yade_march, "advance", advance)
    found = carry_out(magnus, tmp_path / "parts", resume=True, **keys)
    assert all(np.array_equal(expected[name], found[name]) for name in expected)
    one, other = summary_of(tmp_path / "whole"), summary_of(tmp_path / "parts")
    assert all(one[name] == other[name] for name in one if name not in TIMED)
    if fields:
        with h5py.File(tmp_path / "whole/run.h5") as a, h5py.File(tmp_path / "parts/run.h5") as b:
            assert np.array_equal(a["fields/around/area_fraction"], b["fields/around/area_fraction"])
            assert a["fields/around/samples"][0] > 0


def test_a_run_ends_when_lift_over_drag_is_good_enough(magnus, monkeypatch, tmp_path):
    monkeypatch.setattr(magnus, "FEWEST_BLOCKS", 20)
    series = carry_out(magnus, tmp_path / "run", travel=20.0, width=24, until_error=0.5)
    assert summary_of(tmp_path / "run")["lift_to_drag_err"] <= 0.5
    assert series["travel"][-1] < 19


@pytest.mark.parametrize("loop", ["grain", "yade"])
def test_walls_under_pressure_push_the_grains_together(magnus, tmp_path, loop):
    """Before grains hinder it, a wall of mass m_wall = N rho pi d^2/4 has the acceleration p L/m_wall."""
    from yade import O

    carry_out(magnus, tmp_path / "run", wall_pressure=5.0, travel=1.0, loop=loop)
    walls = [b.state.pos[1] for b in O.bodies if b and b.isClump]
    time, mass_over_length = 1.0 * 0.02 / 2.5, 20 * np.pi * 0.02 / 4
    free_fall = 5.0 / mass_over_length * time**2 / 2
    moved = [9.5 * 0.02 - abs(y) for y in walls]
    assert len(moved) == 2 and all(0.3 * free_fall < way <= 1.01 * free_fall for way in moved)
    with h5py.File(tmp_path / "run/run.h5") as file:
        begun, phi = file["series/phi"][0], file["series/phi"][-1]
        frame, width = file["frames/0001"], file["parameters/width"][()] * 0.02
        area = np.pi * np.sum(frame["r"][:][frame["role"][:] == 0] ** 2)
    assert phi > begun
    assert area / begun - area / phi == pytest.approx(
        width * sum(moved), rel=0.1
    )  # less their displacement in the first block


def test_another_shape_is_driven_as_beads(magnus, tmp_path):
    carry_out(magnus, tmp_path / "run", shape="square", bead_diameter=0.5)
    with h5py.File(tmp_path / "run/run.h5") as file:
        assert np.ptp(file["intruder/outline"][:], axis=0) == pytest.approx([3 * 0.02, 3 * 0.02])


def test_what_an_engine_says_is_one_line_without_a_traceback(capsys):
    def stopped():
        raise EngineError("step 7: grains overlap")

    assert headless.guarded(stopped, "magnus") == 1
    assert capsys.readouterr().err == "magnus: failed: EngineError: step 7: grains overlap\n"


@pytest.mark.parametrize(
    "changes, said",
    [
        (dict(travel=30), "meet its wake"),
        (dict(settle_travel=3), "leaves too little to average"),
        (dict(height=6), "too small for a body"),
        (dict(width=24.5), "whole number of wall disks"),
        (dict(dt_factor=100), "lower dt_factor"),
        (dict(shape="hexagram"), "shape must be one of"),
        (dict(settle_travel=1.99), "leaves too little to average"),
        (dict(travel=0.01, settle_travel=0), "leaves too little to average"),
        (dict(field_spacing=0.3), "must divide 1 d"),
        (dict(field_spacing=0.001, fields=True), "raise it, or leave the fields out"),
        (dict(v0=1e-12, fields=True), "steps, more than"),
        (dict(dt_factor=1e-20, fields=True), "steps, more than"),
        (dict(shape="square", bead_diameter=1e-6), "raise bead_diameter"),
        (dict(wall_pressure=1e12), "wall_pressure=1e.12 N/m makes grains overlap"),
    ],
)
def test_bad_input_is_a_usage_error_and_nothing_is_written(magnus, tmp_path, changes, said):
    with pytest.raises(UsageError, match=said):
        carry_out(magnus, tmp_path / "run", **changes)
    assert list(tmp_path.iterdir()) == []


def test_the_smoke_run_as_a_command_leaves_one_complete_folder(cache, tmp_path):
    environment = {**os.environ, "HOME": str(tmp_path / "home"), "GRAINDRIVE_CACHE": str(cache)}
    keys = ["scale=smoke", "width=40", "settle_travel=20", "field_spacing=1", "out=result"]
    command = ["yade", "-n", "-x", str(STUDIES / "magnus.py"), *keys]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    names = sorted(path.name for path in (tmp_path / "result").iterdir())
    assert names == ["figure.pdf", "figure.png", "run.h5", "summary.json"]
    found = summary_of(tmp_path / "result")
    for name in ("drag", "lift", "lift_to_drag", "contacts"):
        assert found[f"{name}_err"] > 0


def test_frames_are_even_in_time_and_the_last_is_at_the_end(magnus, tmp_path):
    carry_out(magnus, tmp_path / "run", travel=4.0, width=24, frames=3)
    with h5py.File(tmp_path / "run/run.h5") as file:
        times = [file[f"frames/{k:04d}"].attrs["t"] for k in (1, 2, 3)]
        end, dt = file["series/t"][-1], file["provenance"].attrs["dt"]
    np.testing.assert_allclose(times, end * np.array([1, 2, 3]) / 3, rtol=0, atol=0.51 * dt)  # half a time step
