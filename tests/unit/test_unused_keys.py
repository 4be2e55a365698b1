"""Keys that a run does not use: refused where the user types them, told where a file or a campaign shares them."""

import re
from pathlib import Path
from typing import ClassVar

import pytest

from graindrive.base.errors import UsageError
from graindrive.campaign.plan import read_plan
from graindrive.commands import headless
from graindrive.commands.command_line import help_table, parse
from graindrive.parameters import StudyParameters, When, quantity
from graindrive.study import Study, loaded
from graindrive.tuning import __main__ as tune, ladder
from graindrive.tuning.search import Search
from graindrive.tuning.trials import Trials

FOLDER = Path(__file__).resolve().parents[2] / "studies"


def parsed(name, *arguments, environment=()):
    return parse(loaded(FOLDER / f"{name}.py"), arguments, environment=dict(environment))


@pytest.mark.parametrize(
    "study, arguments, words",
    [
        (
            "drum",
            "cells=100",
            "cells=100 has no effect: cells is used only with model=continuum or both, and this run has model=dem",
        ),
        ("drum", "tolerance=1e-4 model=dem", "tolerance is used only with model=continuum or both"),
        (
            "drum",
            "largest_viscosity=8e4",
            "and this run has model=dem; leave largest_viscosity out, or give unused=allow",
        ),
        (
            "drum",
            "model=continuum friction=0.5",
            "friction is used only with model=dem or both, and this run has model=continuum",
        ),
        ("drum", "model=continuum stiffness=1e5", "stiffness=1e5 has no effect"),
        ("drum", "model=continuum loop=yade", "loop is used only with model=dem or both"),
        ("drum", "model=continuum precision=single", "precision is used only with model=dem or both"),
        ("drum", "model=continuum seed=2", "seed is used only with model=dem or both"),
        ("drum", "model=continuum dt_factor=2", "dt_factor is used only with model=dem or both"),
        ("drum", "model=continuum turn=90", "turn is used only with model=dem or both"),
        (
            "drum",
            "grains=7000 filling=0.4",
            "with model=continuum or both, or with grains=auto, and this run has model=dem and grains=7000",
        ),
        ("drum", "loop=yade precision=single", "precision is used only with loop=grain, and this run has loop=yade"),
        ("shear", "loop=yade precision=single", "precision is used only with loop=grain"),
        (
            "shear",
            "area_fraction=0.8 shear_rate=1 inertial_number=0.1",
            "inertial_number is used only with shear_rate=auto, and this run has shear_rate=1",
        ),
        (
            "shear",
            "area_fraction=0.8 shear_rate=1 pressure=9",
            "pressure is used only with area_fraction=0, or with shear_rate=auto",
        ),
        ("magnus", "fields=0 field_spacing=0.1", "field_spacing is used only with fields=1, and this run has fields=0"),
        ("magnus", "fields=0 field_samples=50", "field_samples is used only with fields=1"),
        (
            "magnus",
            "bead_diameter=0.2",
            "bead_diameter is used only with another shape than disk, and this run has shape=disk",
        ),
        ("wiggle", "field_samples=50", "field_samples is used only with fields=1"),
        (
            "wiggle_triangle",
            "lid=grains lid_pressure=0",
            "lid is used only with lid_pressure above 0, and this run has lid_pressure=0",
        ),
        ("wiggle_triangle", "lid=grains scale=paper", "and this run has lid_pressure=0"),
        ("extremes", "strain=3", "strain is used only with case=shear_strains, and this run has case=friction_2d"),
        ("extremes", "pair_steps=1000", "pair_steps is used only with case=bound_pair_2d or bound_pair_3d"),
        ("rounding", "scene=regular average_time=50", "average_time is used only with scene=chaotic"),
        ("rounding", "average_time=0 relax_time=5", "relax_time is used only with average_time above 0"),
        ("lift", "loop=yade threads=2", "threads is used only with loop=grain"),
        (
            "lift",
            "lid_density=0 lid_turns=1",
            "lid_turns is used only with lid_density above 0, and this run has lid_density=0",
        ),
        ("lift", "fields=0 field_samples=50", "field_samples is used only with fields=1"),
        (
            "lift",
            "shape=a.csv travel=20 cylinder_diameter=3",
            "cylinder_diameter is used only with shape=cylinder, or with travel=auto",
        ),
    ],
)
def test_a_key_that_the_run_does_not_use_is_refused_with_rule_value_and_way_out(study, arguments, words):
    with pytest.raises(UsageError, match=re.escape(words)):
        parsed(study, *arguments.split())


@pytest.mark.parametrize(
    "study, arguments",
    [
        ("drum", "cells=100 friction=0.4 seed=2 model=both"),
        ("drum", "cells=100 filling=0.4 model=continuum"),
        ("drum", "filling=0.4 froude=1e-3 frames=3 drum_diameter=100"),
        ("shear", "area_fraction=0.8 inertial_number=0.2 pressure=9"),
        ("magnus", "field_spacing=0.1 shape=square bead_diameter=0.2"),
        ("wiggle", "lid=grains fields=1 field_samples=50"),
        ("lift", "threads=2 lid_turns=1 cylinder_diameter=5 travel=20"),
        ("lift", "shape=a.csv cylinder_diameter=5"),
    ],
)
def test_keys_that_the_run_uses_are_taken(study, arguments):
    assert parsed(study, *arguments.split()).given_in_vain == {}


@pytest.mark.parametrize("scale", ["smoke", "demo", "paper"])
def test_values_of_scales_and_defaults_are_never_given_in_vain(scale):
    """smoke sets field_spacing, dt_factor and turn; a run that does not use them is the same as before."""
    assert parsed("drum", f"scale={scale}", "model=continuum").given_in_vain == {}
    assert parsed("magnus", f"scale={scale}", "fields=0").given_in_vain == {}
    assert parsed("wiggle", f"scale={scale}", "lid_pressure=0").given_in_vain == {}


def test_unused_allow_names_the_keys_and_changes_no_digest(tmp_path, capsys):
    p = parsed("drum", "model=continuum", "friction=0.3", "unused=allow", f"out={tmp_path}/run")
    assert list(p.given_in_vain) == ["friction"] and p.friction == 0.3
    assert p.digest() == parsed("drum").copy(update=dict(model="continuum", friction=0.3)).digest()
    study = Study("drum", type(p), {"demo": {}}, run=lambda p, folder: None)
    headless.carry_out(study, p)
    assert "drum: this run does not use friction, which needs model=dem or both\n" in capsys.readouterr().err


def test_a_file_of_parameters_may_serve_several_models(tmp_path):
    (tmp_path / "both.yaml").write_text("friction: 0.3\ncells: 90\n")
    assert list(parsed("drum", f"@{tmp_path}/both.yaml").given_in_vain) == ["cells"]
    assert list(parsed("drum", f"@{tmp_path}/both.yaml", "model=continuum").given_in_vain) == ["friction"]
    with pytest.raises(UsageError, match="cells=91 has no effect"):
        parsed("drum", f"@{tmp_path}/both.yaml", "cells=91")


def test_a_row_of_a_batch_table_leaves_out_what_its_model_does_not_use(tmp_path):
    (tmp_path / "t").write_text("model cells\ncontinuum 90\ndem *\ndem 90\n")
    assert parsed("drum", environment={"YADE_BATCH": f"{tmp_path}/t:2"}).cells == 90
    assert parsed("drum", environment={"YADE_BATCH": f"{tmp_path}/t:3"}).model == "dem"
    with pytest.raises(UsageError, match="cells=90 has no effect"):
        parsed("drum", environment={"YADE_BATCH": f"{tmp_path}/t:4"})


def test_help_says_with_what_a_key_is_used():
    table = help_table(loaded(FOLDER / "drum.py"))
    assert "cells across the drum (a whole number >= 1 and <= 2000; only with model=continuum or both)" in table
    assert "(one of double, single; only with model=dem or both, and with loop=grain)" in table
    assert "(one of rigid, grains; only with lid_pressure above 0)" in help_table(loaded(FOLDER / "wiggle.py"))


# ---- campaigns -------------------------------------------------------------------------------------------------------


def planned(tmp_path, text):
    (tmp_path / "c.yaml").write_text(f"study: drum\n{text}")
    return read_plan(tmp_path / "c.yaml").runs


def test_one_value_beside_several_models_is_taken_and_its_runs_may_be_made(tmp_path):
    """drum_small.yaml gives dt_factor to both models; a value that equals the default must not fail it either."""
    dem, continuum = planned(
        tmp_path, "common: {dt_factor: 5, friction: 0.5}\nsweeps: {a: {model: [dem, continuum]}}\n"
    )
    assert "unused=allow" not in dem.arguments and continuum.arguments[-1] == "unused=allow"
    assert set(continuum.parameters.given_in_vain) == {"dt_factor", "friction"}
    study = loaded(FOLDER / "drum.py")
    assert parse(study, continuum.arguments, environment={}).digest() == continuum.parameters.digest()


def test_a_campaign_keeps_the_names_of_its_runs(tmp_path):
    """The names and digests that drum_small.yaml gave before keys knew which model uses them."""
    runs = planned(
        tmp_path,
        "common: {scale: paper, dt_factor: 5, start_turn: 120, turn: 240, model: [dem, continuum]}\n"
        "sweeps: {profiles: {drum_diameter: 150, froude: 3.0e-4}}\n",
    )
    assert [run.parameters.digest() for run in runs] == ["a18c9c40d1fb", "d6a0d68b8696"]


@pytest.mark.parametrize(
    "text, words",
    [
        (
            "sweeps: {a: {model: dem, cells: 90}}",
            "sweep a: cells has no effect in any run: it is used only with model=continuum or both",
        ),
        ("common: {cells: 90}\nsweeps: {a: {friction: [0.1, 0.2]}}", "common: cells has no effect in any run"),
        (
            "sweeps: {a: {model: [dem, continuum], friction: [0.1, 0.2]}}",
            "friction has 2 values, but its runs with model=continuum do not use it and would be the same",
        ),
        (
            "common: {model: continuum}\nsweeps: {a: {seed: [1, 2]}}",
            "seed has 2 values, but its runs with model=continuum",
        ),
        ("sweeps: {a: {model: dem, unused: allow}}", "unused is not for campaigns"),
    ],
)
def test_a_campaign_refuses_what_none_of_its_runs_uses_and_runs_that_would_be_the_same(tmp_path, text, words):
    with pytest.raises(UsageError, match=re.escape(words)):
        planned(tmp_path, text)


# ---- tunings ---------------------------------------------------------------------------------------------------------


class Parameters(StudyParameters):
    only: ClassVar[dict] = dict(dt_factor=When("fine", (True,)))

    fine: bool = quantity(True, "-", "with steps")
    speed: float = quantity(1.0, "m/s", "of what moves", gt=0, only=When("fine", (True,)))


TUNED = Study("tuned", Parameters, {"demo": {}}, run=None)


def scenes(*values):
    return [ladder.parameters_of(TUNED, {"fine": int(value), "dt_factor": 1.0}) for value in values]


def test_a_tuning_varies_the_levers_that_all_scenes_use():
    assert tune.varied(TUNED, "", scenes(True)) == ["precision", "dt_factor"]
    assert tune.varied(TUNED, "", scenes(True, False)) == ["precision"]
    with pytest.raises(
        UsageError,
        match="vary=dt_factor: dt_factor has no effect: it is used only with fine=1, and the scene has fine=0",
    ):
        tune.varied(TUNED, "dt_factor", scenes(False))


def test_a_tuning_refuses_keys_that_no_scene_uses():
    tune.refuse_unused({"speed": "2"}, scenes(True, False))
    with pytest.raises(
        UsageError, match="speed=2 has no effect: speed is used only with fine=1, and the scene has fine=0"
    ):
        tune.refuse_unused({"speed": "2"}, scenes(False))
    with pytest.raises(UsageError, match="speed=2,3 has no effect: .* and a scene has fine=0"):
        tune.refuse_unused({"speed": "2,3"}, scenes(True, False))


def test_a_tuning_makes_one_run_of_a_setting_whose_scenes_use_no_seed():
    study = loaded(FOLDER / "drum.py")
    dem, continuum = (ladder.parameters_of(study, {"model": model}) for model in ("dem", "continuum"))
    assert tune.seeds_of([continuum], 6) == (1, 1)
    assert tune.seeds_of([continuum, dem], 6) == tune.seeds_of([dem], 6) == (2, 6)
    trials = Trials(study, None, None, [{"model": "continuum"}], {}, None)
    assert [t.seed for t in Search(trials, {}, "torque", 0.1, 0.9, 1, 1).next_trials(1e9)] == [1]


def test_the_papers_settings_are_told_without_levers_that_the_run_does_not_use():
    words = parsed("drum", "model=continuum", "accuracy=0.01%").choice.words
    assert "the paper's settings, cells=75 continuum_dt=0.02 largest_viscosity=80000 tolerance=1e-05" in words


def test_a_campaign_refuses_a_film_that_cannot_be_before_any_run(tmp_path):
    with pytest.raises(UsageError, match="sweep a: film=1 needs frames=2 or more, got frames=1"):
        planned(tmp_path, "common: {film: 1}\nsweeps: {a: {model: dem}}\n")


def test_the_cases_of_the_extremes_take_no_seed():
    study = loaded(FOLDER / "extremes.py")
    with pytest.raises(UsageError, match="seed=2: the cases have their own random numbers"):
        study.check(parse(study, ["seed=2"], environment={}))
