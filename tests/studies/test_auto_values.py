"""Values that follow from other keys: the lid that replaces a part of the bed, the travel, and where they are shown."""

import importlib
import json
from pathlib import Path

import h5py
import pytest

from graindrive.beds import lid
from graindrive.runs import recording
from graindrive.scenes import yade_march
from graindrive.campaign.plan import read_plan
from graindrive.commands.command_line import help_table, parse
from graindrive.base.errors import EngineError, UsageError
from graindrive.runs.run_folder import RunFolder
from graindrive.study import loaded

FOLDER = Path(__file__).resolve().parents[2] / "studies"


def parsed(name, *arguments):
    return parse(loaded(FOLDER / f"{name}.py"), arguments, environment={})


@pytest.mark.parametrize(
    "arguments, load",
    [
        ([], 46.2),  # the demo: 55 d of the paper's 105 d are left out, 0.84 rho d g each
        (["height=195", "depth=105"], 0),
        (["height=120", "depth=80"], 21),
        (["height=60", "depth=30", "width=80"], 63),
        (["height=195", "depth=120"], 0),
        (["depth=50", "lid_pressure=7"], 7),
        (["scale=paper"], 0),
        (["scale=smoke"], 0),  # said at the start of the run
    ],
)
def test_the_lid_stands_for_the_bed_that_is_left_out(arguments, load):
    p = parsed("wiggle_triangle", *arguments)
    assert (
        p.lid_load == load == p.taken()["lid_pressure"]
    )  # to the last bit, because digests and cached beds depend on it
    if load and p.lid_pressure is None:
        assert lid.weight_of_bed(p.depth) + p.lid_load == pytest.approx(0.84 * 105, rel=1e-15)


def test_auto_is_the_same_run_as_its_value_and_another_than_any_other():
    auto, given = parsed("wiggle"), parsed("wiggle", "lid_pressure=46.2")
    assert auto.digest() == given.digest()
    others = [parsed("wiggle", *keys) for keys in (["lid_pressure=0"], ["depth=51"], ["depth=51", "lid_pressure=46.2"])]
    assert len({auto.digest(), *(p.digest() for p in others)}) == 4


def test_a_magnus_run_keeps_the_digest_that_it_had_when_travel_was_left_out():
    p = parsed("magnus")
    assert p.taken()["travel"] == 150 and p.identity()["travel"] is None


def test_help_shows_what_is_taken_for_auto():
    for name, words in (
        ("wiggle", "smoke: 0, demo: auto (46.2), paper: auto (0.0)"),
        ("magnus", "smoke: auto (60.0), demo: auto (150.0), paper: auto (300.0)"),
    ):
        assert words in help_table(loaded(FOLDER / f"{name}.py"))


@pytest.fixture
def wiggle(monkeypatch, tmp_path):
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(tmp_path / "cache"))
    monkeypatch.syspath_prepend(str(FOLDER))
    return importlib.import_module("wiggle")


TINY = [
    "scale=smoke",
    "width=22",
    "height=14",
    "depth=6",
    "amplitude=1",
    "time=0.02",
    "period=0.5",
    "frames=1",
    "rest=1",
]


def test_a_run_says_and_stores_which_pressure_acts_at_the_bodys_depth(wiggle, tmp_path, capfd):
    p = parsed("wiggle", *TINY, "lid_pressure=auto", f"out={tmp_path / 'run'}")
    with RunFolder(p, study="wiggle") as folder:
        wiggle.run(p, folder)
    said = capfd.readouterr().err
    # 6 d of bed weigh 5.04, the lid for the other 99 d of the paper's 105 d 83.16 rho d g.
    assert (
        "pressure at the body's depth: 88.2 rho d g, 5.04 from the bed above and 83.16 from a lid (lid_pressure=auto)"
        in said
    )
    summary = json.loads((tmp_path / "run/summary.json").read_text())
    assert summary["lid_pressure"] == pytest.approx(83.16) and summary["pressure_at_body"] == pytest.approx(88.2)
    with h5py.File(tmp_path / "run/run.h5") as file:
        stored = file["parameters/lid_pressure"]
        assert stored[()] == pytest.approx(83.16) and stored.attrs["auto"] and stored.attrs["unit"] == "rho d g"
        assert not file["parameters/depth"].attrs["auto"]
    other = p.copy(update={"lid_pressure": 1.0})
    with pytest.raises(UsageError, match=r"lid_pressure=83.16 there, lid_pressure=1.0 asked for"):
        with RunFolder(other, study="wiggle"):
            pass


def test_a_guard_that_trips_names_the_keys_that_help(wiggle, tmp_path, monkeypatch):
    def trip(_steps):
        raise EngineError("step 7: grains 1 and 2 overlap by 0.31 of a radius, more than 0.3")

    p = parsed("wiggle", *TINY, f"out={tmp_path / 'run'}")
    monkeypatch.setattr(yade_march, "advance", trip)
    with pytest.raises(EngineError, match="more than 0.3; what may help: lower dt_factor, height or lid_pressure"):
        with RunFolder(p, study="wiggle") as folder:
            wiggle.run(p, folder)
    for name in ("wiggle", "magnus"):
        keys = importlib.import_module(name).OVERLAP_KEYS
        named = set(keys.replace(",", " ").split()) - {"lower", "raise", "or"}
        assert named <= set(loaded(FOLDER / f"{name}.py").parameters.__fields__)


def test_only_overlaps_get_that_advice():
    with pytest.raises(EngineError, match="^step 7: a grain left the box$"), recording.overlap_advice("lower v0"):
        raise EngineError("step 7: a grain left the box")


@pytest.mark.parametrize("file", sorted(p.name for p in (FOLDER / "campaigns").glob("wiggle*.yaml")))
def test_runs_of_our_campaigns_keep_the_lid_that_they_were_measured_with(file):
    for run in read_plan(FOLDER / "campaigns" / file).runs:
        given = dict(argument.split("=", 1) for argument in run.arguments)
        if "lid_pressure" in given:
            assert run.parameters.lid_load == float(given["lid_pressure"])
        else:
            assert run.parameters.scale == "paper" and run.parameters.lid_load == 0
