"""The Study object: what it refuses, its presets, and how it is loaded from a file."""

import re
import sys
from pathlib import Path

import pytest

from graindrive.commands.command_line import help_text, parse
from graindrive.base.columns import aligned
from graindrive.base.errors import UsageError
from graindrive.parameters import Lever, StudyParameters, quantity
from graindrive.postproc import quantities
from graindrive.postproc.reader import Run
from graindrive.runs.run_folder import RunFolder
from graindrive.study import Constant, Cost, Observable, Study, duration, house, loaded, observables


class Parameters(StudyParameters):
    depth: float = quantity(3.0, "d", "how deep", gt=0, lever=Lever(10, "lower"))


def made(**parts):
    return Study(
        **{"name": "s", "parameters": Parameters, "presets": {"smoke": {"depth": 1}, "demo": {}}, "run": None, **parts}
    )


SPEED, FORCE = Observable("speed", "m/s", "how fast"), Observable("force", "N", "how strong", headline=True)


@pytest.mark.parametrize(
    "parts, words",
    [
        (dict(parameters=dict), "parameters must be a class derived from StudyParameters"),
        (dict(presets={}), "presets must name at least one scale"),
        (dict(presets={"demo": {"dept": 1}}), "study s: demo sets dept, which are not keys"),
        (dict(defaults={"widht": 1}), "defaults sets widht, which are not keys"),
        (dict(observables=(SPEED,)), "one observable must be the headline, got none"),
        (dict(observables=(FORCE, Observable("speed", "", "", True))), "must be the headline, got force, speed"),
        (dict(observables=(FORCE, SPEED, SPEED)), "observables must have different names, got force, speed, speed"),
    ],
)
def test_a_study_that_does_not_hold_together_is_refused(parts, words):
    with pytest.raises(ValueError, match=words):
        made(**parts)


def test_a_lever_has_a_direction():
    with pytest.raises(ValueError, match="cheaper must be 'higher' or 'lower', got 'faster'"):
        Lever(1, "faster")


def test_a_lever_of_words_names_the_cheaper_ones():
    with pytest.raises(ValueError, match="cheaper must be a tuple of words"):
        Lever("double", "lower")
    with pytest.raises(ValueError, match="factor must be above 1"):
        Lever(1, "higher", factor=1)


def test_a_study_knows_its_headline_and_its_levers():
    study = made(observables=(SPEED, FORCE))
    assert study.headline is FORCE and made().headline is None
    words = Lever("double", ("single",))
    assert study.levers == {"precision": words, "dt_factor": Lever(1.0, "higher"), "depth": Lever(10, "lower")}


def test_a_preset_gives_way_to_the_scale_and_to_the_user():
    deep = made(defaults={"seed": 7}).preset("deep", depth=9.0)
    assert (deep.name, deep.family, deep.preset("deeper").family) == ("deep", "s", "s")
    assert [deep.usual(scale).depth for scale in ("smoke", "demo")] == [1, 9] and deep.usual("demo").seed == 7
    assert parse(deep, ["depth=2"], environment={}).depth == 2 and parse(deep, [], environment={}).out == "deep-demo"


def test_what_a_run_costs_follows_from_its_parameters():
    cost = Cost(work=lambda p: 1e6 * p.depth, rate=lambda p: 1e4 * p.depth, unit="cell-steps")
    study = made(cost=cost)
    assert cost.core_seconds(study.usual("demo")) == pytest.approx(100)
    assert help_text(study).endswith("without the packing: smoke 1e+06 cell-steps, 100 s; demo 3e+06 cell-steps, 100 s")
    assert Cost(work=lambda p: 30, rate=15).core_seconds(None) == 2 and duration(7200) == "2.0 h"


def test_observables_take_units_and_meanings_from_the_table_of_names():
    drag, ratio = observables(quantities.SI, "lift_to_drag", "drag lift_to_drag")
    assert (drag.unit, drag.headline, ratio.unit, ratio.headline) == ("N", False, "-", True)
    assert drag.meaning == quantities.QUANTITIES["summary"]["drag"].meaning
    with pytest.raises(KeyError, match="wind"):
        observables(quantities.SI, "drag", "drag wind")


def test_a_run_folder_holds_the_constants_observables_and_family_of_its_study(tmp_path):
    constants = {"d": Constant(0.02, "m", "diameter of the grains")}
    drag = Observable("drag", "m/s", "what drags here")  # the table of names gives it another meaning
    kept = dict(constants=constants, family="s", observables=(SPEED, drag))
    with RunFolder(Parameters(out=str(tmp_path / "a")), study="deep", **kept) as folder:
        folder.summarize(speed=3.0, drag=2.0)
    run = Run(tmp_path / "a")
    assert (run.study, run.family, run.constants) == ("deep", "s", {"d": 0.02})
    assert run.summary["speed"] == 3 and run.summary["speed_unit"] == "m/s"
    rows = run.contents().set_index(["where", "name"])
    assert rows.loc["summary", "speed"]["meaning"] == "how fast"
    assert tuple(rows.loc["summary", "drag"][["unit", "meaning"]]) == ("m/s", "what drags here")
    assert repr(run) == f"Run({str(tmp_path / 'a')!r}: deep, complete)"


@pytest.mark.parametrize("text", ["x = 1\n", "STUDY = 'magnus'\n"])
def test_a_file_that_makes_no_study_is_refused(tmp_path, text):
    (tmp_path / "no_study.py").write_text(text)
    with pytest.raises(
        UsageError, match="no_study.py defines no STUDY, so it is not a study; see studies/guides/study.md"
    ):
        loaded(tmp_path / "no_study.py")
    assert str(tmp_path) not in sys.path


def test_the_studies_of_the_house_are_named_as_their_files_and_presets_belong_to_them():
    studies = {name: loaded(path) for name, path in house().items()}
    assert {"magnus", "wiggle", "wiggle_triangle"} <= set(studies) and "house" not in studies
    assert {name: study.name for name, study in studies.items()} == {name: name for name in studies}
    assert all(set(study.presets) == {"smoke", "demo", "paper"} for study in studies.values())
    assert all(study.family == name.partition("_")[0] for name, study in studies.items())
    assert all(study.headline and study.cost and study.levers for study in studies.values())


def test_a_file_is_loaded_from_any_folder_under_another_name_than_main(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "beside.py").write_text("VALUE = 5.0\n")
    (tmp_path / "mine.py").write_text(
        "import beside\nfrom test_study import made\nSTUDY = made(defaults={'depth': beside.VALUE})\n"
        "assert __name__ != '__main__' and __file__.endswith('mine.py')\n"
    )
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    assert loaded("mine.py").usual("demo").depth == 5


def test_the_usage_line_names_what_the_user_called(monkeypatch):
    study = loaded(house()["wiggle"])
    monkeypatch.setattr("sys.argv", ["/anywhere/studies/wiggle.py"])
    monkeypatch.delenv("GRAINDRIVE_CALLED", raising=False)
    both = "usage: scripts/run wiggle [key=value …]   or   yade -n -x /anywhere/studies/wiggle.py [key=value …]\n"
    assert help_text(study).startswith(both)
    monkeypatch.setenv("GRAINDRIVE_CALLED", "graindrive run wiggle")
    assert help_text(study).startswith("usage: graindrive run wiggle [key=value …]\n")


@pytest.mark.parametrize("name", ["magnus", "wiggle", "lift", "drum", "shear"])
def test_help_says_what_an_observable_means_in_this_study_alone(name):
    """Several studies have phi, drag, lift or torque; shear's phi was said to be that of Magnus."""
    own = {"lift": "lift study", "shear": "shear study"}.get(name, name)
    for observable in loaded(house()[name]).observables:
        others = {"Magnus", "wiggle", "lift study", "drum", "shear study", "omega x V"} - {own, name, name.capitalize()}
        others -= {"omega x V"} if name == "magnus" else set()
        assert not [other for other in others if other in observable.meaning], observable


def test_a_meaning_of_no_observable_is_refused():
    with pytest.raises(ValueError, match="meanings of drag, which are no names of observables"):
        observables("SI", "lift", "lift", drag="along x")


def test_columns_are_aligned_and_lines_end_without_blanks():
    assert aligned([("a", "b", "c"), ("long", "", "x"), ("", "wide", "")]) == "a     b     c\nlong        x\n      wide"


@pytest.mark.parametrize(
    "study, key, words",
    [
        ("wiggle", "grains", "there is no key 'grains'; drum, rounding and shear have it; allowed: "),
        ("wiggle", "diameter", "there is no key 'diameter'; did you mean bead_diameter? allowed: "),
        ("magnus", "spin", "there is no key 'spin'; did you mean spin_ratio? allowed: "),
        ("magnus", "diameter", "did you mean intruder_diameter or bead_diameter? allowed: "),
        ("shear", "height", "there is no key 'height'; lift, magnus and wiggle have it; allowed: "),
        ("shear", "fraction", "did you mean area_fraction? allowed: "),
        ("wiggle", "--lid-load", "there is no key '--lid-load'; did you mean lid? allowed: "),
        ("wiggle", "perod", "there is no key 'perod'; did you mean period? allowed: "),
        ("wiggle", "qqq", "there is no key 'qqq'; allowed: "),
        ("wiggle", "[(", "there is no key '[('; allowed: "),
    ],
)
def test_an_unknown_key_gets_the_keys_that_hold_it_and_the_studies_that_have_it(study, key, words):
    with pytest.raises(UsageError, match=re.escape(words)):
        parse(loaded(house()[study]), [f"{key}=1"], environment={})
