"""The books of measured settings in the project: each fits a study of this checkout as it is now, and `accuracy=` finds it."""

import math

import pytest

from graindrive.commands.command_line import parse
from graindrive.commands.parameter_values import argument
from graindrive.study import house, loaded
from graindrive.accuracy import book
from graindrive.tuning import held_out

SHIPPED = {made.file: made for made in book.shipped()}


@pytest.fixture(scope="module")
def studies():
    return {name: loaded(house()[name]) for name in {made.study for made in SHIPPED.values()}}


def test_there_are_books():
    assert {made.study for made in SHIPPED.values()} == {"drum", "lift", "magnus", "shear", "wiggle"}


@pytest.mark.parametrize("name", SHIPPED)
def test_a_book_speaks_of_its_study(studies, name):
    made = SHIPPED[name]
    study = studies[made.study]
    assert set(made.reference) == set(study.levers)
    assert {o.name for o in study.observables} >= set().union(*(s.effects for s in made.settings))
    assert made.settings[0].levers == {} and made.settings[0].effects[study.headline.name].bias == 0
    assert all(set(s.levers) <= set(study.levers) and s.runs >= 2 and s.core_seconds > 0 for s in made.settings)
    assert "/" not in made.command.removeprefix("scripts/tune") and "out=" not in made.command


@pytest.mark.parametrize("name", SHIPPED)
def test_accuracy_finds_a_book_in_each_of_its_scenes(studies, name):
    made = SHIPPED[name]
    study = studies[made.study]
    for error in held_out.accuracies(made, study.headline.name):
        for scene in made.scenes + held_out.drawn_scenes(made, 3, seed=8):
            keys = [argument(study.parameters, key, value) for key, value in scene.items()]
            p = parse(study, [*keys, f"accuracy={error:.6g}"], environment={})
            assert p.choice.book.file == name, p.choice.words
            assert p.choice.bound(study.headline.name) <= error and math.isfinite(error)


@pytest.mark.parametrize("name", ["lift_demo.json", "magnus_demo.json", "shear_demo.json"])
def test_the_demo_takes_levers_that_were_measured(studies, name):
    """The settings of a demo are in its book, and their bias is within 15 % at 90 % confidence."""
    made = SHIPPED[name]
    study = studies[made.study]
    demo = study.usual("demo")
    assert made.outside(demo) == ""
    alike = [s for s in made.settings if all(book.alike(getattr(demo, k), v) for k, v in made.levers_of(s).items())]
    assert len(alike) == 1, made.settings
    effect = alike[0].effects[study.headline.name]
    assert abs(effect.bias) + effect.interval(0.9) < 0.15
