"""The shear study at small size: its controls and measurements, both loops, resuming, and refused values."""

import importlib
import json
from pathlib import Path

import h5py
import numpy as np
import pytest

from known_names import unexplained

from graindrive.scenes import yade_march
from graindrive.base.errors import Interrupted, UsageError
from graindrive.base.numbers import with_error
from graindrive.postproc.reader import Run
from graindrive.postproc.shear.flow import steady_flow
from graindrive.runs.run_folder import RunFolder

STUDIES = Path(__file__).resolve().parents[2] / "studies"
TINY = dict(grains=80, strain=1.0, settle_strain=0.2, inertial_number=0.2, dt_factor=3)


@pytest.fixture
def shear(monkeypatch):
    """The study as a module, in this process."""
    monkeypatch.syspath_prepend(str(STUDIES))
    return importlib.import_module("shear")


def carry_out(shear, out, **changes):
    """Run the shrunken study into the folder `out`; return (its series, its summary)."""
    p = shear.ShearParameters(**{**TINY, "out": str(out), **changes})
    with RunFolder(p, study="shear") as folder:
        shear.run(p, folder)
    with h5py.File(Path(out) / "run.h5") as file:
        series = {name: data[:] for name, data in file["series"].items()}
    return series, json.loads((Path(out) / "summary.json").read_text())


def test_the_pressure_is_reached_and_stresses_add_up(shear, tmp_path, figures_drawn):
    series, found = carry_out(shear, tmp_path / "run", strain=4.0, settle_strain=2.0, pressure=100.0)
    assert found["mean_pressure"] == pytest.approx(100, rel=0.1)  # 80 flowing disks, over a strain of 2
    assert 0.1 < found["stress_ratio"] < 1 and 0.6 < found["phi"] < 0.85
    trace = sum(series[f"{part}_s{axis}"] for part in ("contact", "kinetic") for axis in ("xx", "yy"))
    np.testing.assert_allclose(series["mean_pressure"], trace / 2, rtol=1e-12)
    np.testing.assert_allclose(series["shear_stress"], -series["contact_sxy"] - series["kinetic_sxy"], rtol=1e-12)
    assert series["strain"][-1] == pytest.approx(4.0, rel=0.02)
    shear.STUDY.figure(tmp_path / "run")
    for panel, name in ((0, "stress_ratio"), (2, "mean_pressure"), (3, "phi")):
        words = figures_drawn[0].axes[panel].get_legend().get_texts()[0].get_text()
        assert with_error(found[name], found[f"{name}_err"]) in words  # where the running mean ends


def test_an_area_fraction_is_reached_and_kept(shear, tmp_path):
    series, found = carry_out(
        shear, tmp_path / "run", area_fraction=0.75, shear_rate=1.0, strain=4.0, settle_strain=3.0
    )
    assert unexplained(Run(tmp_path / "run")) == []
    assert found["phi"] == pytest.approx(0.75, rel=1e-9) and series["growth"][-1] == pytest.approx(0, abs=1e-9)
    assert found["flow_inertial_number"] == pytest.approx(1.0 / np.sqrt(found["mean_pressure"]))


def test_both_loops_begin_alike(shear, tmp_path):
    """The loops agree up to a strain of 0.3, before chaos, except for the affine part of a change of height (README)."""
    runs = [
        carry_out(shear, tmp_path / loop, loop=loop, area_fraction=0.63, shear_rate=2.0, strain=0.3, settle_strain=0.2)[
            0
        ]
        for loop in ("grain", "yade")
    ]
    for name in ("mean_pressure", "shear_stress", "phi", "height"):
        np.testing.assert_allclose(runs[0][name], runs[1][name], rtol=0.02, atol=1e-3, err_msg=name)


def test_a_resumed_run_gives_the_bits_of_one_in_one_go(shear, tmp_path, monkeypatch):
    whole, _ = carry_out(shear, tmp_path / "whole")
    steps, advance = [0], yade_march.advance

    def interrupted(count):
        steps[0] += 1
        if steps[0] == 20:
            raise Interrupted(15)
        advance(count)

    with monkeypatch.context() as patched:
        patched.setattr(yade_march, "advance", interrupted)
        with pytest.raises(Interrupted):
            carry_out(shear, tmp_path / "parts", checkpoint_seconds=0)
    resumed, _ = carry_out(shear, tmp_path / "parts", checkpoint_seconds=0, resume=True)
    for name, values in whole.items():
        assert np.array_equal(values, resumed[name]), name


def test_a_run_that_ends_before_its_pressure_is_there_says_so(shear, tmp_path, capfd):
    _, found = carry_out(shear, tmp_path / "run", strain=0.4)
    assert found["steady"] == 0 and found["mean_pressure"] < 10
    told = capfd.readouterr().err
    assert (
        f"mean_pressure={found['mean_pressure']:.3g} differs from pressure=25; raise settle_strain and strain" in told
    )


def test_the_smallest_scale_comes_to_its_pressure(shear, tmp_path):
    _, found = carry_out(shear, tmp_path / "run", **{**shear.PRESETS["smoke"], "inertial_number": 0.1, "grains": 80})
    # within the scatter of so few disks over a strain of 2
    assert found["mean_pressure"] == pytest.approx(25, rel=0.15)
    assert found["flow_inertial_number"] == pytest.approx(0.1, rel=0.08)


def test_disks_that_never_touch_have_no_friction(shear):
    names = [*shear.UNITS, "coordination"]
    series = {name: np.zeros(40) for name in names}
    series.update(
        strain=np.arange(1, 41) / 20, phi=np.full(40, 0.5), height=np.full(40, 9.0), profile=np.zeros((40, 10))
    )
    with np.errstate(all="raise"):
        found = steady_flow(series, 0.5, 1.0).summary
    assert np.isnan(found["stress_ratio"]) and np.isnan(found["flow_inertial_number"]) and not found["steady"]


@pytest.mark.parametrize(
    "changes, words",
    [
        (
            dict(settle_strain=2.0),
            "settle_strain=2 leaves too little of strain=1 to average, which takes at least 4 rows of",
        ),
        (dict(settle_strain=0.95), "settle_strain=0.95 leaves too little of strain=1"),
        (dict(strain=0.05, settle_strain=0), "leaves too little of strain=0.05 to average"),
        (
            dict(area_fraction=0.8, shear_rate=1e30),
            r"at shear_rate=1e[+]30 the shortest row of the series, 5 steps, .* lower dt_factor or the shear",
        ),
        (dict(inertial_number=10), r"has a strain of 0.075, more than 0.05"),
        (
            dict(area_fraction=0.3, shear_rate=1.0),
            "a strain of 7.34 from its first area fraction, 0.625, to area_fraction=0.3,.*; raise settle_strain and strain, or",
        ),
        (dict(shear_rate=1.0), "at constant pressure give inertial_number"),
        (dict(dt_factor=60), "time step .* is over the critical"),
        (dict(pressure=1e5), "makes grains overlap too far"),
        (dict(inertial_number=1e-9), "steps"),
    ],
)
def test_values_that_do_not_go_together_are_refused(shear, changes, words):
    with pytest.raises(UsageError, match=words):
        shear.check(shear.ShearParameters(**{**TINY, **changes}))
