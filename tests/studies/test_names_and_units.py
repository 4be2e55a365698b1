"""The table of names explains every name in the files of a study's smoke run, with the unit that the file gives."""

import json
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest

from graindrive.commands import headless
from graindrive.postproc import quantities
from graindrive.postproc.campaign.folder import Campaign
from graindrive.postproc.reader import Run
from graindrive.study import loaded

STUDIES = Path(__file__).resolve().parents[2] / "studies"
RUNS = {
    "wiggle": dict(width=22, height=14, depth=6, amplitude=1, time=1.5, period=0.5, frames=2, fields=True),
    "wiggle, velocity": dict(width=22, height=14, depth=6, amplitude=1, time=1, period=0.5, frames=1, drive="velocity"),
    "magnus": dict(width=24, height=20, travel=4, settle_travel=2, frames=2, field_spacing=0.5, intruder_diameter=3),
    "magnus, shape": dict(
        width=24,
        height=20,
        travel=4,
        settle_travel=2,
        fields=False,
        shape="square",
        intruder_diameter=3,
        largest_overlap=0.3,
    ),
    "lift": dict(width=16, height=13, depth=6.5, cylinder_diameter=2, travel=9, lid_density=30, fields=False, frames=2),
}
NO_UNIT_OF_A_STUDY = (
    "parameters",
    "constants",
    "provenance",
    "observables",
)  # they carry units and meanings of their own, or are explained by their names


def study_of(name):
    """Return the study of a name of RUNS, or of a run folder."""
    return loaded(STUDIES / f"{name.split(',')[0]}.py")


@pytest.fixture(scope="module", params=RUNS)
def run(request, tmp_path_factory):
    """A finished run: (its path, its system of units, its keys)."""
    patch, place = pytest.MonkeyPatch(), tmp_path_factory.mktemp("runs")
    patch.setenv("GRAINDRIVE_CACHE", str(tmp_path_factory.getbasetemp() / "cache"))
    study = study_of(request.param)
    keys = {**study.presets["smoke"], **RUNS[request.param], "out": str(place / "run")}
    p = study.parameters(**keys)
    headless.carry_out(study, p)
    patch.undo()
    return place / "run", p.unit_system, keys


def test_every_name_in_run_h5_has_its_unit(run):
    path, system, _ = run
    found = {}
    with h5py.File(path / "run.h5") as file:

        def note(name, item):
            group, _, last = name.rpartition("/")
            if name.split("/")[0] in NO_UNIT_OF_A_STUDY:
                return
            if isinstance(item, h5py.Dataset):
                found[group, last] = item.attrs.get("unit")
            for key in item.attrs:
                if isinstance(item, h5py.Group) and not key.endswith("_unit"):
                    found[name, key] = item.attrs.get(f"{key}_unit")

        file.visititems(note)
    groups = {quantities.place_of(group) for group, _ in found}
    assert groups >= {"series", "frames/NNNN", "frames/NNNN/contacts", "frames/NNNN/intruder", "intruder"}
    for (group, name), unit in found.items():
        known = quantities.QUANTITIES[quantities.place_of(group)]
        assert name in known or name.removesuffix("_err") in known, f"{group}/{name} is not in the table"
        assert unit == quantities.unit_of(group, name, system), f"unit of {group}/{name}"


def test_every_quantity_of_the_summary_has_its_unit(run):
    path, system, keys = run
    summary = json.loads((path / "summary.json").read_text())
    names = [name for name in summary if not name.endswith(("_err", "_unit"))]
    assert len(names) > 10 and all(not isinstance(value, (list, dict)) for value in summary.values())
    for name in names:
        quantity = quantities.QUANTITIES["summary"][name]
        expected = quantities.unit_of("summary", name, system)
        if name == "amplitude" and keys.get("drive") == "velocity":
            expected = "sqrt(g d)"
        assert summary.get(f"{name}_unit") == expected and (expected or quantity.unit == ""), name
    assert all(name.removesuffix("_err") in names for name in summary if name.endswith("_err"))


def test_every_column_of_a_campaign_s_table_is_a_key_a_quantity_or_in_the_table(run, tmp_path):
    path, system, keys = run
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / "a").symlink_to(path)
    plan = dict(name="x", file="x.yaml", study="x", report=None, runs=[dict(name="a", sweeps=["one"])])
    (tmp_path / "campaign.json").write_text(json.dumps(plan))
    campaign = Campaign.of(tmp_path)
    table = campaign.with_units(campaign.table)
    assert list(table)[: len(list(campaign.table))] == list(campaign.table), "units stand behind all else"
    parameters, summary, own = (
        campaign.run("a").parameters,
        quantities.QUANTITIES["summary"],
        quantities.QUANTITIES["table.csv"],
    )
    for column in campaign.table:
        name = column.removesuffix("_measured").removesuffix("_err")
        assert name in parameters or name in summary or name in own, column
    for column in campaign.table:
        unit = table[f"{column}_unit"].iloc[0] if f"{column}_unit" in table else None
        if column in summary and column not in parameters:
            expected = quantities.unit_of("summary", column, system)
            assert unit == (None if expected in ("-", None) else expected), column
    width = "d"
    assert table["width_unit"].iloc[0] == width and "mu_unit" not in table
    assert (
        table["amplitude_unit"].iloc[0] == ("sqrt(g d)" if keys.get("drive") else "d") if "amplitude" in table else True
    )
    assert pd.api.types.is_numeric_dtype(table["wall_s"]) and np.isfinite(table["wall_s"]).all()


def test_a_study_s_observables_and_constants_stand_in_its_run_folder_with_their_units(run):
    path, _, _ = run
    found, summary = Run(path), json.loads((path / "summary.json").read_text())
    study = study_of(found.study)
    assert study.observables and found.family == study.family
    assert {o.name: summary[f"{o.name}_unit"] for o in study.observables} == {o.name: o.unit for o in study.observables}
    assert found.constants == {name: constant.value for name, constant in study.constants.items()}
    assert found.provenance["dt"] == found.constants["time_step"] * found.parameters["dt_factor"]
