"""Parameters: accepted input, the values that it gives, and the error message, one line, for wrong input."""

import math
import os
import subprocess
import sys
from typing import Literal, Optional

import pytest
from hypothesis import given, strategies as st
from pydantic import root_validator

from graindrive.commands.command_line import help_table, parameters_or_exit, parse
from graindrive.base.errors import UsageError
from graindrive.parameters import StudyParameters, quantity
from graindrive.study import Study

PRESETS = {"smoke": {"time": 10.0, "width": 20.0}, "demo": {"time": 100.0}, "paper": {"time": 1000.0, "width": 300.0}}


class Wiggle(StudyParameters):
    shape: Literal["disk", "triangle"] = quantity("triangle", "-", "outline of the intruder")
    amplitude: float = quantity(3.0, "d", "amplitude of the displacement", gt=0)
    period: float = quantity(4.0, "sqrt(d/g)", "period of the drive", gt=0)
    width: float = quantity(60.0, "d", "width of the box", ge=1, le=1e4)
    time: float = quantity(100.0, "sqrt(d/g)", "length of the run", gt=0)
    grains: int = quantity(1000, "-", "number of grains", ge=1)
    lid: Optional[float] = quantity(None, "d", "height of the lid's load", ge=0)

    @root_validator(skip_on_failure=True)
    def _fits(cls, values):
        if 2 * values["amplitude"] >= values["width"]:
            raise ValueError(
                f"the stroke 2 amplitude = {2 * values['amplitude']:g} d must be below width = {values['width']:g} d"
            )
        return values


def study(name="wiggle", presets=PRESETS, **defaults):
    return Study(name, Wiggle, presets, run=None, defaults=defaults)


def parsed(*arguments, **defaults):
    return parse(study(**defaults), arguments, environment={})


def message(*arguments):
    with pytest.raises(UsageError) as caught:
        parsed(*arguments)
    text = str(caught.value)
    assert text.isprintable(), "the message must be one line"
    return text


def test_defaults_then_scale_then_user():
    assert (parsed().time, parsed().width) == (100, 60)
    assert (parsed("scale=paper").time, parsed("scale=paper").width) == (1000, 300)
    assert parsed("time=7", "scale=paper").time == 7
    preset = parsed("scale=smoke", shape="disk", width=33.0)
    assert (preset.shape, preset.width) == ("disk", 20)


def test_values_get_their_declared_types():
    p = parsed("grains=1e3", "amplitude=2", "resume=1", "shape=disk", "lid=3.5")
    assert (p.grains, p.amplitude, p.resume, p.shape, p.lid) == (1000, 2.0, True, "disk", 3.5)
    assert isinstance(p.grains, int) and isinstance(p.amplitude, float) and p.resume is True
    assert parsed("lid=auto").lid is None


@pytest.mark.parametrize(
    "argument, expected",
    [
        ("amplitud=3", ["no key 'amplitud'", "did you mean amplitude?", "allowed:", "period"]),
        ("--amplitude=3", ["no key '--amplitude'", "did you mean amplitude?"]),
        ("A" * 500 + "=1", ["no key", "…"]),
        ("smoke", ["'smoke' is not of the form key=value", "scale=smoke"]),
        ("period", ["not of the form key=value", "period=…"]),
        ("period=abc", ["period=abc", "a number > 0", "[sqrt(d/g)]"]),
        ("period=0", ["period=0", "> 0"]),
        ("period=-2", ["period=-2", "> 0"]),
        ("period=nan", ["period=nan", "> 0"]),
        ("period=inf", ["period=inf", "> 0"]),
        ("period=", ["period= is not allowed"]),
        ("width=1e5", ["width=1e5", ">= 1 and <= 10000"]),
        ("grains=2.5", ["grains=2.5", "a whole number >= 1"]),
        ("grains=1e999", ["grains=1e999", "whole"]),
        ("resume=2", ["resume=2", "0 or 1"]),
        ("shape=triangel", ["shape=triangel", "one of disk, triangle", "did you mean triangle?"]),
        ("scale=huge", ["scale=huge", "smoke, demo, paper"]),
        ("lid=-1", ["lid=-1", ">= 0", "or auto"]),
        ("out=a\nb", ["out=a b"]),
        (
            "period=5e-324",
            ["period=5e-324: the size of a number must be 0 or lie between 1e-30 and 1e+30", "mind the unit"],
        ),
        ("period=1e308", ["period=1e308: the size of a number"]),
    ],
)
def test_a_mistake_gets_one_line_with_given_allowed_and_nearest(argument, expected):
    text = message(argument)
    for part in expected:
        assert part in text


def test_a_key_given_twice_is_refused():
    assert "period is given twice: period=1 and period=2" in message("period=1", "period=2")


def test_a_condition_between_values_names_both():
    assert message("amplitude=40") == "the stroke 2 amplitude = 80 d must be below width = 60 d"


def test_a_scale_that_the_study_lacks():
    with pytest.raises(UsageError, match="scale=paper is not known to x; allowed: demo"):
        parse(study("x", {"demo": {}}), ["scale=paper"], environment={})


def test_default_folder_is_readable_and_differs_between_runs():
    assert parsed().out == "wiggle-demo"
    assert parsed("period=2", "scale=smoke", "resume=1").out == "wiggle-smoke-period=2"
    assert parsed("out=here").out == "here"
    assert len(parsed("period=2." + "0" * 200).out) <= 120
    assert "/" not in parse(study("a/b"), ["period=2"], environment={}).out


def test_identity_ignores_what_does_not_change_the_result():
    assert parsed("out=a", "vtk=1").digest() == parsed("out=b", "redo=1").digest()
    assert parsed("seed=1").digest() != parsed("seed=2").digest()
    assert parsed("time=1000", "width=300").digest() == parsed("scale=paper").digest()


def test_parameters_are_frozen():
    p = parsed()
    with pytest.raises(TypeError, match="immutable"):
        p.period = 3
    assert p.period == 4


def test_help_shows_every_key_with_unit_default_meaning_and_range():
    table = help_table(study())
    for key in Wiggle.__fields__:
        assert any(line.startswith(key + " ") for line in table.splitlines())
    period = next(line for line in table.splitlines() if line.startswith("period "))
    assert (
        period.split()[:3] == ["period", "sqrt(d/g)", "4.0"]
        and "period of the drive (a number > 0 [sqrt(d/g)])" in period
    )
    assert "smoke: 10.0, demo: 100.0, paper: 1000.0" in table


@pytest.mark.parametrize("word", ["help", "--help", "-h"])
def test_help_exits_0_and_a_mistake_exits_2(word, capsys):
    with pytest.raises(SystemExit) as caught:
        parameters_or_exit(study(), ["nonsense=1", word])
    assert caught.value.code == 0 and "amplitude" in capsys.readouterr().out
    with pytest.raises(SystemExit) as caught:
        parameters_or_exit(study(), ["nonsense=1"])
    captured = capsys.readouterr()
    assert caught.value.code == 2 and captured.out == "" and captured.err.count("\n") == 1


@given(st.floats(allow_nan=True, allow_infinity=True))
def test_any_float_is_taken_exactly_or_refused(value):
    if 1e-30 <= value <= 1e30:
        assert parsed(f"period={value!r}").period == value
    else:
        message(f"period={value!r}")


@given(st.integers())
def test_any_integer_is_taken_exactly_or_refused(value):
    if value >= 1:
        assert parsed(f"grains={value}").grains == value
    else:
        message(f"grains={value}")


@given(st.lists(st.text(), max_size=3))
def test_no_text_escapes_the_one_line_answer(arguments):
    try:
        p = parsed(*arguments)
    except UsageError as error:
        assert str(error).isprintable()
    else:
        assert isinstance(p, Wiggle)


@given(st.sampled_from(sorted(Wiggle.__fields__)), st.text())
def test_no_value_escapes_the_one_line_answer(key, text):
    try:
        value = getattr(parsed(f"{key}={text}"), key)
    except UsageError as error:
        # The message on a value begins with its key; the message on a condition between keys names both.
        assert str(error).isprintable() and key in str(error)
    else:
        assert not isinstance(value, float) or math.isfinite(value)


class TestBatchTable:
    """A row of YADE's table, which yade-batch passes in YADE_BATCH."""

    @pytest.fixture
    def table(self, tmp_path):
        path = tmp_path / "table"
        path.write_text(
            "# periods\nperiod! shape seed !THREADS grains\npi/2 'disk' 1 2 *\n2 = 2 1 1e3\n3 = 3 1 10 # last\n"
        )
        return path

    def row(self, table, line, *arguments):
        return parse(study("w"), arguments, environment={"YADE_BATCH": f"{table}:{line}"})

    def test_rows(self, table):
        first, second = self.row(table, 3), self.row(table, 4)
        assert (first.period, first.shape, first.grains) == (math.pi / 2, "disk", 1000)
        assert (second.period, second.shape, second.seed, second.grains) == (2, "disk", 2, 1000)
        assert first.out != second.out

    def test_mistakes(self, table):
        with pytest.raises(UsageError, match="period is given twice"):
            self.row(table, 3, "period=1")
        with pytest.raises(UsageError, match="line 99 of batch table .* cannot be read"):
            self.row(table, 99)
        with pytest.raises(UsageError, match="No such file"):
            self.row(str(table) + "x", 3)
        table.write_text("perod\n1\n")
        with pytest.raises(UsageError, match="no key 'perod'; did you mean period"):
            self.row(table, 2)

    @pytest.mark.parametrize(
        "text, line, words",
        [
            ("period seed\n1 2 3\n", 2, "line 2 has 3 values for 2 columns"),
            ("period seed\n1\n", 2, "line 2 has 1 values for 2 columns"),
            ("period seed period!\n1 2 3\n", 2, "two columns have the same name, period seed period!; keep one"),
            ("period\n=\n2\n", 2, "'=' in line 2 has no value above it to repeat"),
            ("period\n1\n", 1, "its rows are in lines 2"),
            ("", 1, r"its rows are in lines [(]none[)]"),
            ("# nothing\n", "x", "cannot be read"),
            ("\xff", 1, "cannot be read: .* codec can't decode"),
            ("period\nyes\n", 2, "period=yes is not allowed"),
            ("period\n9**9**9**9\n", 2, "is not allowed"),
            ("period\n__import__('os').abort()\n", 2, "is not allowed"),
            ("period\n-pi/2\n", 2, "period=-1.57.* is not allowed"),
            ("period\n1e-400\n", 2, "period=0.0 is not allowed"),
            ("period\n1e-300\n", 2, "period=1e-300: the size of a number"),
            ("seed\n2**40\n", 2, "is not allowed"),
        ],
    )
    def test_a_table_that_does_not_fit_is_refused_in_one_line(self, table, text, line, words):
        table.write_text(text, encoding="latin-1")
        with pytest.raises(UsageError, match=words) as refusal:
            self.row(table, line)
        assert str(refusal.value).isprintable()

    def test_the_last_line_needs_no_newline(self, table):
        table.write_text("seed period\n1 2*sqrt(4)\n12 =")
        assert (self.row(table, 3).seed, self.row(table, 3).period) == (12, 4.0)

    def test_a_table_that_is_no_file(self, tmp_path):
        with pytest.raises(UsageError, match="Is a directory"):
            self.row(tmp_path, 2)

    def test_no_batch(self):
        assert parse(study("w"), [], environment={"YADE_BATCH": ""}).period == 4


def test_parsing_needs_neither_yade_nor_a_display():
    modules = "graindrive.commands.headless, graindrive.runs.recording, graindrive.study"
    code = f"import sys, {modules}; sys.exit('yade' in sys.modules)"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    assert subprocess.run([sys.executable, "-c", code], env=environment).returncode == 0
