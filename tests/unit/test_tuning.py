"""Tuning: effects and their bounds, ladders, the search on made-up runs, books of measured settings, and accuracy=."""

import dataclasses
import math
import re

import numpy as np
import pytest

from graindrive.commands.command_line import parse
from graindrive.base.errors import UsageError
from graindrive.parameters import Lever, StudyParameters, quantity
from graindrive.study import Cost, Observable, Study
from graindrive.tuning import __main__ as command
from graindrive.postproc.tuning import held_out as held_out_report
from graindrive.accuracy import book, choice
from graindrive.tuning import held_out, ladder
from graindrive.accuracy.effects import NOTHING, Effect, of_reference, pooled
from graindrive.tuning.search import BAD, FAILED, GOOD, SAVES_NOTHING, UNDECIDED, Search
from graindrive.tuning.trials import Outcome, Trials


class Parameters(StudyParameters):
    speed: float = quantity(1.0, "m/s", "how fast", gt=0)
    cells: int = quantity(64, "-", "cells", ge=4, lever=Lever(64, "lower"))
    time: float = quantity(8.0, "s", "how long", ge=1, lever=Lever(8.0, "lower"))
    frames: int = quantity(1, "-", "pictures", ge=1, watches=True)


STUDY = Study(
    name="made_up",
    parameters=Parameters,
    presets={"demo": {"cells": 32}, "paper": {}},
    run=None,
    observables=(Observable("force", "N", "how strong", headline=True), Observable("torque", "N m", "how turned")),
    cost=Cost(work=lambda p: p.cells * p.time / p.dt_factor, rate=1.0, unit="cell-seconds"),
)


# ---- effects ---------------------------------------------------------------------------------------------------------


def test_deviations_are_pooled_to_bias_error_and_spread():
    effect = pooled([0.01, 0.03, 0.02, 0.02], [math.nan] * 4)
    assert effect.bias == pytest.approx(0.02) and effect.freedom == 3
    assert effect.spread == pytest.approx(np.std([0.01, 0.03, 0.02, 0.02], ddof=1))
    assert effect.error == pytest.approx(effect.spread / 2)
    # Student's t with 3 degrees of freedom between whose signs lie 90 %: 2.353, as in any table.
    assert effect.interval(0.9) == pytest.approx(2.353 * effect.error, rel=1e-3)
    assert effect.bound(0.9) == pytest.approx(0.02 + 2.353 * effect.spread * math.sqrt(1.25), rel=1e-3)


def test_two_runs_that_agree_by_chance_are_not_exact():
    effect = pooled([0.02, 0.02], [0.05, 0.05])
    assert effect.spread == 0.05 and math.isinf(effect.freedom)
    assert effect.interval(0.9) == pytest.approx(1.645 * 0.05 / math.sqrt(2), rel=1e-3)


def test_one_run_without_an_error_of_its_own_says_nothing():
    assert math.isinf(pooled([0.02], [math.nan]).bound(0.9)) and math.isinf(NOTHING.bound(0.9))
    assert pooled([], []) == NOTHING and pooled([math.nan], [0.1]) == NOTHING


def test_a_bound_holds_for_nine_of_ten_further_runs():
    random, kept, tries = np.random.default_rng(5), 0, 4000
    for _ in range(tries):
        *seen, more = random.normal(0.01, 0.03, 6)
        kept += abs(more) <= pooled(seen, [math.nan] * 5).bound(0.9)
    share = kept / tries
    assert 0.9 - 3 * math.sqrt(0.09 / tries) <= share < 0.99  # at least 0.9; the bias makes the interval wider


def test_so_many_runs_bring_the_mean_below_the_target():
    """|bias| + t s n^-1/2 <= target: with bias 1 %, spread 10 % and normal deviations 2 % take (1.645 x 10)^2 = 270.6 runs."""
    effect = Effect(bias=-0.01, error=0.05, spread=0.1, runs=4, freedom=math.inf)
    assert effect.runs_for(0.02, 0.9) == 271
    assert effect.runs_for(0.5, 0.9) == 1
    assert effect.runs_for(0.01, 0.9) == math.inf


def test_a_lever_that_is_auto_starts_from_what_the_study_takes():
    study = command.loaded(command.study_file("lift"))
    values = dict(depth=30, lid_density=40, width=60, breadth=5, height=52, travel=None)
    assert ladder.reference_of(study, {})["travel"] is None
    assert ladder.parameters_of(study, values).taken()["travel"] == 53.4  # 60 d less 2 D, outside of the wake
    assert ladder.rungs(study, values, "travel")[0] == [26.7, 13.35]


def test_the_reference_scatters_about_the_mean_of_each_scene():
    effect = of_reference([([1.0, 3.0], [0.1, 0.1]), ([10.0, 10.0], [0.1, 0.1])])
    assert effect.bias == 0 and effect.runs == 4 and effect.freedom == 2
    assert effect.spread == pytest.approx(math.sqrt((0.25 + 0.25) / 2))  # deviations -1/2, 1/2, 0, 0 about two means
    assert of_reference([([0.0], [0.0])]) == NOTHING


# ---- ladders ---------------------------------------------------------------------------------------------------------


def test_a_ladder_goes_towards_cheaper_values_until_the_study_refuses():
    values = dict(cells=64, time=8.0, dt_factor=1.0, precision="double")
    found, why = ladder.rungs(STUDY, values, "cells")
    assert found == [32, 16, 8, 4] and all(isinstance(v, int) for v in found) and "cells=2 is not allowed" in why
    assert ladder.rungs(STUDY, values, "time")[0] == [4.0, 2.0, 1.0]
    assert ladder.rungs(STUDY, values, "dt_factor")[0] == [2, 4, 8, 16, 32]
    assert ladder.rungs(STUDY, values, "precision")[0] == ["single"]
    assert ladder.rungs(STUDY, {**values, "precision": "single"}, "precision")[0] == []


def test_what_the_user_gives_is_the_reference():
    assert ladder.reference_of(STUDY, {"cells": 16}) == dict(cells=16, time=8.0, dt_factor=1.0, precision="double")


# ---- search ----------------------------------------------------------------------------------------------------------


class MadeUp(Trials):
    """Trials that run nothing: `law(parameters)` gives the force's relative deviation, `noise` one run's scatter."""

    def __init__(self, law, noise=0.001, scenes=({},), fails=()):
        super().__init__(STUDY, None, None, list(scenes), ladder.reference_of(STUDY, {}), None)
        self.law, self.noise, self.fails, self.batches = law, noise, fails, []

    def make(self, trials, cores):
        self.batches.append(list(trials))
        for trial in trials:
            if dict(trial.setting) in self.fails:
                self.failed[trial] = "overlap too large"
                continue
            p = self.planned(trial).parameters
            noise = np.random.default_rng([trial.seed, trial.scene, *map(ord, str(trial.setting))]).normal(
                0, self.noise
            )
            force = 2.0 * p.speed * (1 + self.law(p) + noise)
            found = dict(force=(force, 2.0 * p.speed * self.noise), torque=(0.0, 0.0))
            self.outcomes[trial] = Outcome(found, 0.5 * STUDY.cost.core_seconds(p), 100.0, p)
            self.asked[trial] = self.planned(trial)


def searched(trials, budget=1e9, **options):
    keys = options.pop("vary", list(STUDY.levers))
    values = {**trials.scenes[0], **trials.reference}
    ladders = {key: ladder.rungs(STUDY, values, key)[0] for key in keys}
    search = Search(trials, ladders, "force", **{"target": 0.05, "confidence": 0.9, **options})
    command.carry_out(search, budget, 1)
    return search


def test_a_search_walks_each_lever_to_the_last_good_value_and_joins_them():
    trials = MadeUp(lambda p: 0.4 / p.cells + (0.03 if p.time < 4 else 0.0) - 0.4 / 64)
    search = searched(trials)
    assert dict(search.walk("cells")) == {32: GOOD, 16: GOOD, 8: GOOD, 4: BAD}  # 0.6, 1.9, 4.4, 9.4 %
    assert dict(search.walk("time"))[1.0] == GOOD and dict(search.walk("dt_factor"))[32.0] == GOOD
    assert dict(search.walk("precision")) == {"single": SAVES_NOTHING}
    # All levers together give an error of 7.4 %, without cells, the lever with the largest effect, 3 %.
    assert search.chosen() == (("dt_factor", 32.0), ("time", 1.0))
    tried = {t.setting for t in trials.outcomes}
    assert (("cells", 8), ("dt_factor", 32.0), ("time", 1.0)) in tried and (("cells", 4), ("time", 1.0)) not in tried


def test_noise_is_answered_with_more_seeds_and_then_named():
    trials = MadeUp(lambda p: 0.0, noise=0.2)
    search = searched(trials, vary=["cells"], most_seeds=4)
    assert dict(search.walk("cells")) == {32: UNDECIDED} and len(trials.of((("cells", 32),))) == 4
    assert search.chosen() == ()


def test_a_setting_that_fails_ends_its_ladder():
    search = searched(MadeUp(lambda p: 0.0, fails=[{"cells": 16}]), vary=["cells"])
    assert dict(search.walk("cells")) == {32: GOOD, 16: FAILED}


def test_the_budget_is_kept_and_the_largest_savings_come_first():
    trials = MadeUp(lambda p: 0.0)
    searched(trials, budget=1300.0)  # two runs of the reference take 512 by half of the estimate
    assert trials.spent <= 1300 and {t.setting for t in trials.batches[0]} == {()}
    whole = MadeUp(lambda p: 0.0)
    searched(whole)
    assert whole.spent > 1300


def test_a_reference_beyond_the_budget_is_refused():
    with pytest.raises(UsageError, match="reference alone needs about .* more than the budget of 100 s; raise budget"):
        searched(MadeUp(lambda p: 0.0), budget=100.0)


def test_a_search_goes_on_as_it_would_have():
    law = lambda p: 0.4 / p.cells - 0.4 / 64  # noqa: E731
    whole, stopped = MadeUp(law), MadeUp(law)
    searched(whole)
    searched(stopped, budget=1300.0)
    searched(stopped)
    assert stopped.outcomes.keys() == whole.outcomes.keys()


def test_scenes_are_paired_and_scaled_each_by_its_own_mean():
    trials = MadeUp(lambda p: 0.4 / p.cells - 0.4 / 64, noise=1e-9, scenes=[{"speed": 1.0}, {"speed": 50.0}])
    searched(trials, vary=["cells"])
    effect = trials.effect((("cells", 16),), "force")
    assert effect.bias == pytest.approx((0.4 / 16 - 0.4 / 64), rel=1e-3) and effect.runs == 4
    assert trials.effect((("cells", 16),), "torque") == NOTHING  # its reference is 0, so no relative change exists


# ---- books and accuracy ----------------------------------------------------------------------------------------------


def bound_of(share):
    """An effect with which one more run is within `share` at 90 %."""
    return Effect(0.0, 0.0, share / 1.6448536 / math.sqrt(1.5), 2, math.inf)


def made_book(tmp_path, **changes):
    reference = dict(cells=32, time=8.0, dt_factor=1.0, precision="double")
    same = {k: v for k, v in book.scene_of(parse(STUDY, [], {}), reference).items() if k != "speed"}
    settings = tuple(
        book.Setting(levers, {"force": bound_of(error)}, 0.5, 1.0, 100.0, 2)
        for levers, error in ((dict(), 0.01), (dict(cells=16), 0.04), (dict(cells=8), 0.2), (dict(time=4.0), 0.03))
    )
    made = book.Book(
        "made_up",
        "scripts/tune made_up",
        "1",
        "a processor",
        reference,
        same,
        dict(speed=[0.5, 2.0]),
        [{"speed": 0.5}, {"speed": 2.0}],
        settings,
    )
    path = tmp_path / "made_up.json"
    book.write(path, dataclasses.replace(made, **changes))
    return path


@pytest.fixture
def books(tmp_path, monkeypatch):
    made_book(tmp_path)
    monkeypatch.setattr(book, "FOLDER", tmp_path)
    return tmp_path


def test_a_book_is_read_as_it_was_written(tmp_path):
    path = made_book(tmp_path)
    text = path.read_text()
    book.write(path, book.read(path))
    assert path.read_text() == text and book.read(path).settings[1].effects["force"] == bound_of(0.04)


@pytest.mark.parametrize("damage", ["", "[]", "{}", '{"study": 1, "settings": [{}]}', "{", '{"settings": 3}'])
def test_a_file_that_is_no_book_is_refused(tmp_path, damage):
    (tmp_path / "x.json").write_text(damage)
    with pytest.raises(UsageError, match="x.json holds no measured settings"):
        book.read(tmp_path / "x.json")


def test_accuracy_takes_the_cheapest_setting_within_it(books):
    p = parse(STUDY, ["accuracy=5%", "speed=1.5"], {})
    assert (p.cells, p.time, p.scale) == (16, 8.0, "demo")
    assert "cells=16: force off by 0" in p.choice.words and p.choice.book.file == "made_up.json"
    assert p.choice.bound("force") == pytest.approx(0.04, rel=1e-6)
    assert parse(STUDY, ["accuracy=0.02"], {}).cells == 32
    assert parse(STUDY, ["accuracy=25%"], {}).cells == 8
    assert (
        p.digest() == parse(STUDY, ["cells=16", "speed=1.5"], {}).digest()
    )  # the same run, although it was chosen in another way


def test_a_setting_that_the_study_refuses_in_the_scene_is_not_taken(books):
    def check(p):
        if p.cells == 16:
            raise UsageError("sixteen cells are refused")

    p = parse(dataclasses.replace(STUDY, check=check), ["accuracy=5%"], {})
    assert (p.cells, p.time) == (32, 4.0)


def test_a_lever_that_is_given_stays(books):
    assert parse(STUDY, ["accuracy=5%", "time=4"], {}).dict().items() >= dict(time=4.0, cells=32).items()
    p = parse(STUDY, ["accuracy=5%", "time=2"], {})
    assert (p.time, p.cells) == (2.0, 64) and "no setting was measured with time=2" in p.choice.words


@pytest.mark.parametrize(
    "arguments, why",
    [
        (["speed=3"], "speed=3.0, measured from 0.5 to 2"),
        (["accuracy=0.1%"], "the smallest measured error of force is 1 %"),
        (["loop=yade"], "loop=yade, measured at grain"),
        (["scale=paper"], "cells=64 is more accurate than the measured reference, 32"),
        (["accuracy=torque:5%"], "torque has no measured error"),
    ],
)
def test_where_nothing_was_measured_the_papers_settings_are_taken(books, arguments, why):
    given = arguments if any(a.startswith("accuracy") for a in arguments) else [*arguments, "accuracy=5%"]
    p = parse(STUDY, given, {})
    assert p.cells == 64 and p.choice.setting is None and why in p.choice.words
    assert math.isnan(p.choice.bound("force"))


def test_what_is_only_watched_does_not_leave_the_cover(books):
    assert parse(STUDY, ["accuracy=5%", "frames=9", "seed=4"], {}).cells == 16


@pytest.mark.parametrize(
    "text, words",
    [
        ("5 %%", "must be a share as 5% or 0.05"),
        ("fast", "must be a share"),
        ("0", "must lie between 0 and 100 %"),
        ("100%", "must lie between"),
        ("-5%", "must lie between"),
        ("lift:5%", "made_up measures no lift; it measures force, torque"),
        ("1e", "must be a share"),
    ],
)
def test_an_accuracy_that_means_nothing_is_refused(books, text, words):
    with pytest.raises(UsageError, match=words):
        parse(STUDY, [f"accuracy={text}"], {})


@pytest.mark.parametrize("text", ["fast", "0", "100%", "lift:5%", "force:2"])
def test_a_refused_accuracy_says_what_to_type_and_that_works(books, text):
    with pytest.raises(
        UsageError, match="for example scripts/run made_up accuracy=.*, or leave accuracy out"
    ) as refused:
        parse(STUDY, [f"accuracy={text}"], {})
    (example,) = re.findall(r"scripts/run made_up (accuracy=\S+),", str(refused.value))
    assert parse(STUDY, [example], {}).choice.setting is not None
    with pytest.raises(
        UsageError, match="accuracy=torque:0 must .*; no error of torque was measured: leave accuracy out"
    ):
        parse(STUDY, ["accuracy=torque:0"], {})
    with pytest.raises(UsageError, match=f"^target={text}.*; for example target=5%$"):
        choice.asked_of(STUDY, text, "target")


def test_an_accuracy_that_no_setting_reaches_says_which_one_would_be(books):
    p = parse(STUDY, ["accuracy=0.01%"], {})
    assert p.choice.setting is None
    (example,) = re.findall(r"smallest measured error of force is \S+ %, which (accuracy=\S+) takes", p.choice.words)
    assert parse(STUDY, [example], {}).choice.setting is not None


@pytest.mark.parametrize(
    "error, text", [(0.05, "5.1%"), (0.0499, "5%"), (0.123, "13%"), (0.0012, "0.13%"), (0.98, "99%")]
)
def test_an_error_is_asked_for_rounded_up(error, text):
    assert choice.as_asked(STUDY, "force", error) == f"accuracy={text}"
    assert choice.as_asked(STUDY, "torque", error) == f"accuracy=torque:{text}"


def test_a_study_without_observables_has_no_accuracy():
    with pytest.raises(UsageError, match="names no observable"):
        parse(dataclasses.replace(STUDY, observables=()), ["accuracy=5%"], {})


# ---- files of parameters and the command's words ----------------------------------------------------------------------


def test_a_file_of_parameters_gives_way_to_the_command_line(tmp_path):
    (tmp_path / "p.yaml").write_text("cells: 8\ntime: 4\nprecision: single\n")
    p = parse(STUDY, [f"@{tmp_path}/p.yaml", "time=2"], {})
    assert (p.cells, p.time, p.precision) == (8, 2.0, "single")


@pytest.mark.parametrize(
    "text, words",
    [
        ("[1, 2]", "must hold key: value on each line"),
        ("", "must hold key: value"),
        ("cells: 8\ncells: 9", "cells is given twice"),
        ("celsl: 8", "did you mean cells"),
        ("cells: many", "cells=many is not allowed"),
        ("cells: [8, 9]", "cells must be a number, a word or a switch"),
    ],
)
def test_a_bad_file_of_parameters_is_refused_by_name(tmp_path, text, words):
    (tmp_path / "p.yaml").write_text(text)
    with pytest.raises(UsageError, match=words):
        parse(STUDY, [f"@{tmp_path}/p.yaml"], {})
    with pytest.raises(UsageError, match="cannot be read|give a file of parameters"):
        parse(STUDY, [f"@{tmp_path}"], {})


@pytest.mark.parametrize("text, seconds", [("90s", 90), ("30min", 1800), ("2h", 7200), ("0.5h", 1800)])
def test_a_budget_is_a_time(text, seconds):
    assert command.seconds_of(text) == seconds


@pytest.mark.parametrize("text", ["", "30", "h", "-1h", "0s", "nanh", "infh", "1day"])
def test_a_budget_that_is_none_is_refused(text):
    with pytest.raises(UsageError, match="must be a time as 90s, 30min or 2h"):
        command.seconds_of(text)


def test_keys_with_several_values_make_scenes_and_levers_the_reference():
    scenes, given = command.scenes_of(STUDY, dict(speed="1,2", cells="16"))
    assert scenes == [{"speed": 1.0}, {"speed": 2.0}] and given == {"cells": 16}
    with pytest.raises(UsageError, match="a tuning takes seeds 1, 2, … itself"):
        command.scenes_of(STUDY, dict(seed="3"))
    with pytest.raises(UsageError, match="speed is no lever of made_up; there are: "):
        command.varied(STUDY, "speed", [ladder.parameters_of(STUDY, {})])


# ---- books on trial --------------------------------------------------------------------------------------------------


def test_scenes_on_trial_lie_inside_the_cover_and_are_the_same_each_time(books):
    made = book.read(books / "made_up.json")
    scenes = held_out.drawn_scenes(made, 50, 3)
    speeds = [scene["speed"] for scene in scenes]
    assert min(speeds) >= 0.5 and max(speeds) <= 2.0 and len(set(speeds)) > 40
    assert scenes == held_out.drawn_scenes(made, 50, 3) != held_out.drawn_scenes(made, 50, 4)


def test_the_accuracies_on_trial_make_each_setting_of_the_front_the_choice(books):
    made = book.read(books / "made_up.json")
    found = held_out.accuracies(made, "force")
    # Within 4 % all settings cost the same, and the reference is the most accurate; it is not compared with itself.
    assert found == []
    cheaper = [
        dataclasses.replace(s, core_seconds=1.0 / (1 + len(s.levers) + s.levers.get("cells", 0))) for s in made.settings
    ]
    book.write(books / "made_up.json", dataclasses.replace(made, settings=tuple(cheaper)))
    book.shipped.cache_clear()
    found = held_out.accuracies(book.read(books / "made_up.json"), "force")
    assert found == [
        pytest.approx(0.03, rel=1e-3),
        pytest.approx(0.04, rel=1e-3),
    ]  # the one of 20 % costs more than that of 4 %
    taken = [held_out.choice_for(STUDY, {"speed": 1.5}, error, 1001).choice.setting.levers for error in found]
    assert taken == [{"time": 4.0}, {"cells": 16}]
    with pytest.raises(UsageError, match="speed=3.0, measured from 0.5 to 2"):
        held_out.choice_for(STUDY, {"speed": 3.0}, 0.05, 1001)


def test_the_share_that_holds_has_the_confidence_interval_of_clopper_and_pearson():
    low, high = held_out_report.confidence_interval(18, 20)
    # The tails of the binomial distribution beyond 18 of 20 hold 5 % each.
    tail = [math.comb(20, k) for k in range(21)]
    assert sum(tail[k] * low**k * (1 - low) ** (20 - k) for k in range(18, 21)) == pytest.approx(0.05)
    assert sum(tail[k] * high**k * (1 - high) ** (20 - k) for k in range(19)) == pytest.approx(0.05)
    assert (
        held_out_report.confidence_interval(20, 20)[1] == 1.0 and held_out_report.confidence_interval(0, 20)[0] == 0.0
    )


def test_an_unknown_book_is_refused_by_name(books):
    with pytest.raises(UsageError, match="no book of measured settings 'wigle'; there are: made_up"):
        held_out.books_of(["wigle"])
