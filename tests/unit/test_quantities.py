"""Names and units: the table in the documentation is the one from which units in files are taken."""

from pathlib import Path

import pytest

from graindrive.postproc import quantities

README = Path(__file__).resolve().parents[2] / "postproc" / "README.md"


def test_the_documentation_shows_the_table():
    assert quantities.as_markdown() in README.read_text(), "paste the output of quantities.as_markdown() into it"


@pytest.mark.parametrize(
    "group, name, si, grain",
    [
        ("summary", "drag_err", "N", "rho g d^2"),
        ("summary", "wall_s", "s", "s"),
        ("summary", "shape", None, None),
        ("series", "travel", "d", "d"),
        ("frames/0017", "spin", "rad/s", "sqrt(g/d)"),
        ("frames/0017/contacts", "slip", "m", "d"),
        ("fields/around", "pressure", "N/m", "rho g d"),
        ("series", "weather", None, None),
        ("weather", "x", None, None),
    ],
)
def test_units_by_group_and_system(group, name, si, grain):
    assert quantities.unit_of(group, name, quantities.SI) == si
    assert quantities.unit_of(group, name, quantities.GRAIN) == grain


def test_a_study_with_units_of_its_own_gets_those_that_all_share():
    assert quantities.unit_of("summary", "steps", "") == "-" and quantities.unit_of("series", "x", "") is None


def test_units_stand_behind_their_quantities():
    values = {"rise_rate": 1.0, "rise_rate_err": 0.1, "shape": "disk", "answer": 42}
    told = quantities.with_units("summary", values, quantities.GRAIN, {"answer": "s"})
    assert told == {**values, "rise_rate_unit": "sqrt(g d)", "answer_unit": "s"}


def test_an_unknown_name_cannot_be_declared():
    with pytest.raises(KeyError, match="weather"):
        quantities.units("series", "t weather", quantities.SI)
