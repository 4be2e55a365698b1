"""Every key of every study with extreme and wrong values: they are refused in one line, or they pass all checks."""

import math
from pathlib import Path

import pytest
from hypothesis import given, settings, strategies as st

from graindrive.commands.command_line import parse
from graindrive.base.errors import UsageError
from graindrive.parameters import LIMITS, choices, plain_type
from graindrive.runs.run_place import place_of
from graindrive.study import loaded

FOLDER = Path(__file__).resolve().parents[2] / "studies"
STUDIES = {
    path.stem: loaded(path) for path in sorted(FOLDER.glob("[dlmsw]*.py"))
}  # drum, lift, magnus, shear, wiggle and its presets
KEYS = [
    (study, key)
    for study in ("drum", "lift", "magnus", "shear", "wiggle")
    for key in STUDIES[study].parameters.__fields__
]

SIZES = ["5e-324", "1e-300", "1e-160", "1e-30", "1e-29", "1e-12", "0", "-0", "1e12", "1e29", "1e30", "1e160", "1e308"]
NO_NUMBERS = [
    "",
    "nan",
    "inf",
    "-inf",
    "1e999",
    "9" * 5000,
    "yes",
    "1:30",
    "2026-01-02",
    "0x10",
    "1,5",
    "٣",
    "1" + "0" * 400,
]
WORDS = [
    *(
        "",
        "'",
        '"',
        "a'b\"c",
        "a\nb",
        "a\0b",
        "\udcff",
        "ü/æ.csv",
        "~nosuchuser/x.csv",
        "~nosuchuser",
        "..",
        "a/..",
        ".",
        "/",
    ),
    *(
        "x" * 300,
        "x" * 300 + ".csv",
        "x" * 5000,
        "a/" * 3000 + "b",
        "{x}",
        "$(x)",
        "auto",
        "a b",
        "-",
        "disk ",
        "DISK",
        "OS1",
    ),
]


def outcome(study, *arguments):
    """Return "accepted" or "refused" for a study's arguments; fails if the message is not one printable line."""
    declared = STUDIES[study]
    try:
        p = parse(declared, arguments, environment={})
        place_of(p.out)
        declared.check(p)
    except UsageError as error:
        assert str(error).isprintable() and str(error)
        return "refused"
    return "accepted"


def bounds(field):
    """Return the bounds of a numeric field with the next number to either side, as text."""
    found = [getattr(field.field_info, name) for name in LIMITS if getattr(field.field_info, name) is not None]
    return [
        repr(value)
        for b in map(float, found)
        for value in (b, math.nextafter(b, math.inf), math.nextafter(b, -math.inf))
    ]


def values_for(field):
    """Return texts to try for a field: numbers of both signs, bounds, texts that are no numbers, words."""
    if plain_type(field) in (int, float):
        return [*SIZES, *(f"-{size}" for size in SIZES), *bounds(field), *NO_NUMBERS, "auto"]
    return [*WORDS, *choices(field), *SIZES]


@pytest.mark.parametrize("study, key", KEYS)
def test_any_value_of_a_key_is_refused_in_one_line_or_passes_the_check(study, key):
    answers = {text: outcome(study, f"{key}={text}") for text in values_for(STUDIES[study].parameters.__fields__[key])}
    assert set(answers.values()) <= {"accepted", "refused"}
    if plain_type(STUDIES[study].parameters.__fields__[key]) is float:
        assert {answers[text] for text in ("5e-324", "1e-300", "1e160", "1e308", "nan", "inf")} == {"refused"}


@pytest.mark.parametrize("study", STUDIES)
@pytest.mark.parametrize("scale", ["smoke", "demo", "paper"])
def test_what_a_study_comes_with_passes_its_own_check(study, scale):
    assert outcome(study, f"scale={scale}") == "accepted"


def extreme(field):
    """Return a strategy of texts for a field: usual numbers, extreme ones, bounds, and any text."""
    if plain_type(field) is bool:
        return st.sampled_from(["0", "1"])
    if plain_type(field) in (int, float):
        usual = st.floats(min_value=1e-3, max_value=1e3).map(repr) | st.integers(0, 1000).map(str)
        any_size = st.floats(allow_nan=False, allow_infinity=False).map(repr)
        return usual | st.sampled_from(SIZES + bounds(field)) | any_size
    return st.sampled_from(list(choices(field)) or ["disk", "square", "tall", "wide", "triangle"])


def arguments_of(study):
    """Return a strategy of lists of arguments: a few keys of a study, each with any value."""
    fields = {k: f for k, f in STUDIES[study].parameters.__fields__.items() if k != "out"}
    few = st.lists(st.sampled_from(sorted(fields)), unique=True, max_size=8)
    return few.flatmap(lambda keys: st.tuples(*(extreme(fields[key]).map(f"{key}={{}}".format) for key in keys)))


@pytest.mark.parametrize("study", ["drum", "lift", "magnus", "shear", "wiggle"])
def test_no_combination_of_values_escapes_the_one_line_answer(study):
    @settings(max_examples=300)
    @given(arguments_of(study))
    def tried(arguments):
        assert outcome(study, *arguments) in ("accepted", "refused")

    tried()


@pytest.mark.parametrize(
    "study, arguments, words",
    [
        (
            "wiggle",
            ["dt_factor=5e-324"],
            "dt_factor=5e-324: the size of a number must be 0 or lie between 1e-30 and 1e[+]30",
        ),
        ("wiggle", ["largest_overlap=5e-324"], "largest_overlap=5e-324: the size"),
        (
            "wiggle",
            ["largest_overlap=1e-20"],
            "can carry only .* at largest_overlap=1e-20 R; lower height or lid_pressure, or raise",
        ),
        ("wiggle", ["height=1e308"], "height=1e308: the size"),
        ("wiggle", ["height=1e20"], "grains, more than 10000000; lower width or height"),
        ("wiggle", ["lid_pressure=1e9"], "weighs 1e[+]09 rho d g, but grains can carry only"),
        ("wiggle", ["intruder_mass=1e9"], "lower intruder_mass"),
        ("wiggle", ["lid_pressure=1e-6"], "critical .* of a body of mass 1e-06; lower dt_factor"),
        ("wiggle", ["bead_diameter=1e-5"], "raise bead_diameter"),
        ("wiggle", ["amplitude=0", "period=1e-20"], "must be at least 40 time steps"),
        ("wiggle", ["orientation_deg=1e20"], "degrees"),
        ("magnus", ["field_spacing=1e-160"], "field_spacing=1e-160: the size"),
        ("magnus", ["width=60.5", "travel=40"], "whole number"),
        ("magnus", ["height=1e12"], "grains; between 1 and 10000000 are possible"),
        ("magnus", ["out=~nosuchuser/x"], "out=~nosuchuser/x names a home folder that does not exist"),
        ("magnus", ["out=a/.."], "is not the name of a run folder"),
        ("magnus", ["out=" + "ü" * 120], "is longer than 238 bytes"),
    ],
)
def test_what_cannot_be_run_is_refused_before_anything_runs(study, arguments, words):
    declared = STUDIES[study]
    with pytest.raises(UsageError, match=words):
        p = parse(declared, arguments, environment={})
        place_of(p.out)
        declared.check(p)


def test_zero_has_no_sign():
    p = parse(STUDIES["magnus"], ["spin_ratio=-0", "mu=-0"], environment={})
    assert math.copysign(1, p.spin_ratio) == math.copysign(1, p.mu) == 1
    q = parse(STUDIES["magnus"], ["spin_ratio=0", "mu=0"], environment={})
    assert p.digest() == q.digest()
