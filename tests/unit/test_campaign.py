"""Plans of campaigns: runs from a YAML file, names under which runs are found again, and plans that are refused before a run."""

import json
import os
import subprocess
from pathlib import Path

import made_up_runs
import numpy as np
import pytest
from made_up_runs import KEYS, write_run

from graindrive.campaign import cost, execution
from graindrive.campaign.__main__ import main, read_arguments
from graindrive.campaign.plan import read_plan
from graindrive.base.errors import UsageError
from graindrive.postproc.campaign import results, what_was_run
from graindrive.postproc.campaign.folder import Campaign
from graindrive.postproc.campaign.report import write_report
from graindrive.postproc.reader import RunError
from graindrive.commands.parameter_values import argument
from graindrive.runs.run_folder import RunFolder
from graindrive.study import house, loaded

TOY = Path(__file__).parents[1] / "faults" / "toy_study.py"
GOOD = f"study: {TOY}\ncommon: {{scale: smoke, steps: 20}}\nsweeps:\n  a: {{seed: [1, 2]}}\n"


@pytest.fixture
def plan(tmp_path):
    """A function from the text of a campaign file to its plan."""

    def read(text, name="campaign.yaml"):
        (tmp_path / name).write_text(text)
        return read_plan(tmp_path / name)

    return read


def arguments(plan):
    return [" ".join(run.arguments) for run in plan.runs]


def test_lists_are_crossed_and_single_values_are_kept(plan):
    found = plan(GOOD + "  b: {seed: [3, 4], period: [1.5, 2], fault: none}\n")
    assert arguments(found)[:2] == ["scale=smoke steps=20 seed=1", "scale=smoke steps=20 seed=2"]
    assert arguments(found)[2:] == [
        f"scale=smoke steps=20 seed={seed} period={period} fault=none" for seed in (3, 4) for period in (1.5, 2)
    ]
    assert found.study.name == "toy_study" and found.report is None


def test_a_sweep_may_be_several_grids_and_its_values_win_over_common(plan):
    found = plan(GOOD.replace("{seed: [1, 2]}", "[{seed: 1, steps: 30}, {seed: [5, 6]}]"))
    assert [run.parameters.steps for run in found.runs] == [30, 20, 20]


def test_a_run_that_two_sweeps_need_is_planned_once(plan):
    found = plan(GOOD + "  b: {seed: [2, 3]}\n  c: {seed: 2, steps: 20, period: 4.0}\n")
    assert [run.sweeps for run in found.runs] == [["a"], ["a", "b", "c"], ["b"]]


def test_names_depend_on_the_parameters_alone(plan):
    first = plan(GOOD)
    longer = plan(
        GOOD.replace("[1, 2]", "[7, 2, 1]").replace("steps: 20", "steps: 20, period: 4, fault: none"), "other.yaml"
    )
    assert {run.name for run in first.runs} < {run.name for run in longer.runs}
    assert len({run.name for run in longer.runs}) == 3


def test_names_tell_what_is_unusual_and_end_with_the_digest(plan):
    (run, _) = plan(GOOD.replace("[1, 2]", "[8, 9]")).runs
    assert run.name == f"toy_study-steps=20-seed=8-{run.parameters.digest()[:8]}"


def test_names_of_many_long_values_stay_short_and_different(plan):
    found = plan(
        GOOD.replace(
            "[1, 2]", "[1, 2], dt_factor: [1.23456789, 1.23456788], period: 3.33333333, fault: slow, loop: yade"
        )
    )
    names = [run.name for run in found.runs]
    assert len(set(names)) == 4 and max(map(len, names)) <= 120


def test_switches_and_empty_values_become_the_studys_words(plan):
    assert "vtk=1" in arguments(plan(GOOD.replace("steps: 20", "vtk: true")))[0]
    with pytest.raises(UsageError, match="period has no value; leave it out"):
        plan(GOOD.replace("steps: 20", "period:"))


def test_values_of_numpy_and_paths_are_taken_as_those_of_python():
    keys = loaded(house()["shear"]).parameters
    given = dict(seed=np.int64(2), inertial_number=np.float32(0.5), redo=np.bool_(True), out=Path("a/b"))
    assert [argument(keys, *pair) for pair in given.items()] == ["seed=2", "inertial_number=0.5", "redo=1", "out=a/b"]
    with pytest.raises(UsageError, match="out has no value; leave it out for its default"):
        argument(keys, "out", None)


@pytest.mark.parametrize(
    "change, words",
    [
        (("common", "comon"), r"no key 'comon'; did you mean common\?"),
        (("sweeps:\n  a: {seed: [1, 2]}", "sweeps: {}"), "sweeps must be names with grids of values"),
        (("common: {scale: smoke, steps: 20}", "common: [1]"), "common must be keys of the study"),
        (("steps: 20", "stepz: 20"), r"sweep a: there is no key 'stepz'; did you mean steps\?"),
        (("steps: 20", "steps: 0"), "sweep a: steps=0 is not allowed: steps is a whole number >= 1"),
        (("steps: 20", "steps: many"), "steps=many is not allowed"),
        (("scale: smoke", "scale: huge"), "scale=huge is not known"),
        (("steps: 20", "out: here"), "out is not for campaigns: the campaign names its run folders"),
        (("steps: 20", "redo: 1"), "redo is not for campaigns"),
        (("steps: 20", "steps: {a: 1}"), "steps must be a number, a word or a switch"),
        (("[1, 2]", "[]"), "seed has no values; give at least one"),
        (("[1, 2]", f"{list(range(100_001))}"), "sweep a makes more than 100000 runs"),
        (("{seed: [1, 2]}", "5"), "sweep a must be keys with values or lists of values, got 5"),
        (("{seed: [1, 2]}", "[]"), "sweep a has no grid; give keys with values"),
        (("{seed: [1, 2]}", "{}"), "sweep a has an empty grid; give at least one key with a value"),
        (("{seed: [1, 2]}", "[{seed: 1}, {}]"), "sweep a has an empty grid"),
        (("{seed: [1, 2]}", ""), "sweep a must be keys with values or lists of values, got None"),
        (("a: {seed", "a b: {seed"), "the name of a sweep must be one word, got 'a b'"),
        (("a: {seed", "1: {seed"), "line 4: a key must be a word, got 1; put quotes around it"),
        (("steps: 20", "period: yes"), "period=yes is not allowed: period is a number"),
        (("steps: 20", "period: true"), "period=true is not allowed: period is a number"),
        (("steps: 20", "period: '4'"), "period='4' is not allowed: period is a number"),
        (("steps: 20", "period: 1:30"), "period=1:30 is not allowed"),
        (("steps: 20", "period: .inf"), "period=.inf is not allowed"),
        (("steps: 20", "period: 1e999"), "period=inf is not allowed"),
        (("steps: 20", "period: 2026-01-02"), "period=2026-01-02 is not allowed"),
        (("steps: 20", "period: 2026-99-99"), "period=2026-99-99 is not allowed"),
        (("steps: 20", f"period: {'9' * 5000}"), "line 2: 9{59}… is no int that can be read"),
        (("steps: 20", f"period: {'9' * 4000}"), "period=9{59}… is not allowed"),
        (("steps: 20", "period: !!timestamp 2026-99-99"), "is not YAML: could not determine a constructor"),
        (("steps: 20", "period: !!python/name:os.system x"), "is not YAML: could not determine a constructor"),
        (("steps: 20", "period: !!float soon"), "soon is no float that can be read"),
        (("steps: 20", "period: !!binary 4"), "is not YAML"),
        (("steps: 20", "<<: {steps: 20}"), "no key '<<'"),
        (("[1, 2]", "1:30"), "seed=1:30 is not allowed: seed is a whole number"),
        (("[1, 2]", "true"), "seed=true is not allowed: seed is a whole number"),
        (("[1, 2]", "1.5"), "seed=1.5 is not allowed: seed is a whole number"),
        (("steps: 20", "vtk: yes"), "vtk=yes is not allowed: vtk is 0 or 1"),
        (("steps: 20", "vtk: 2"), "vtk=2 is not allowed: vtk is 0 or 1"),
        (("steps: 20", "vtk: 1.0"), "vtk=1.0 is not allowed: vtk is 0 or 1"),
        (("steps: 20", "fault: true"), "fault=true is not allowed: fault is one of none"),
        (("steps: 20", "'steps=3': 20"), "there is no key 'steps=3'"),
        (("steps: 20", "' steps': 20"), "there is no key 'steps'; did you mean steps"),
        (("steps: 20", f"steps: {'[' * 5000}{']' * 5000}"), "is nested too deeply"),
        (("[1, 2]", "&a [*a]"), "seed must be a number, a word or a switch"),
        (("sweeps:", "sweeps: 1\nsweeps:"), "sweeps is given twice"),
        (("  a: {", "  a: {seed: 1}\n  a: {"), "line 5: a is given twice"),
        (("common:", "report: [magnus]\ncommon:"), "report must be the name of a report"),
        (("common:", "---\ncommon:"), "is not YAML: expected a single document"),
        (("steps: 20", "steps: 20, steps: 30"), "steps is given twice"),
        (("{seed: [1, 2]}", "{seed: [1, 2"), "is not YAML"),
        ((f"study: {TOY}", "study: wigle"), r"no study 'wigle'; did you mean wiggle\?"),
        ((f"study: {TOY}", "study: house"), "no study 'house'"),
        ((f"study: {TOY}", "study: nowhere.py"), "there is no file"),
        ((f"study: {TOY}", "study: 5"), "study must be the name of a study, got 5"),
        (("common:", "report: weather\ncommon:"), "no report 'weather'"),
        (("common:", "report: magnus\ncommon:"), "no report 'magnus': study toy_study has none"),
        ((f"study: {TOY}\ncommon: {{scale: smoke, steps: 20}}", "study: magnus\nreport: magnus"), "knows no sweep 'a'"),
        (("common:", "report: wiggle\ncommon:"), "no report 'wiggle'"),
    ],
)
def test_a_bad_file_is_refused_with_the_place_the_value_and_the_way_out(plan, change, words):
    assert change[0] in GOOD
    with pytest.raises(UsageError, match=words) as refusal:
        plan(GOOD.replace(*change))
    assert "campaign.yaml" in str(refusal.value) and "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "study, values, words",
    [
        ("magnus", "travel: [60, 300]", "travel=300 d is longer than the channel"),
        ("magnus", "width: [60, 60.5], travel: 40", "width must be a whole number of wall disks, got 60.5; round it"),
        ("wiggle", "lid_pressure: [auto, 1e6]", "weighs 1e[+]06 rho d g, but grains can carry only"),
        ("wiggle", "amplitude: [1, 60]", "width=120"),
        ("wiggle", "period: [4, 1e-9]", "period=1e-09"),
    ],
)
def test_values_that_do_not_go_together_are_refused_before_anything_runs(plan, study, values, words):
    with pytest.raises(UsageError, match=f"campaign.yaml: sweep a: .*{words}"):
        plan(f"study: {study}\nsweeps:\n  a: {{scale: demo, {values}}}\n")


# Lists that hold each other ten times over: 10^30 values on one line.
LAUGHS = "[&a0 [ha], " + ", ".join(f"&a{n} [{', '.join(10 * [f'*a{n - 1}'])}]" for n in range(1, 31)) + ", *a30]"


@pytest.mark.parametrize(
    "change",
    [
        (str(TOY), LAUGHS),
        ("{scale: smoke, steps: 20}", LAUGHS),
        ("20", LAUGHS),
        ("{seed: [1, 2]}", LAUGHS),
        ("[1, 2]", LAUGHS),
    ],
)
def test_lists_that_grow_beyond_all_bounds_get_one_short_line(plan, change):
    with pytest.raises(UsageError, match="must be") as refusal:
        plan(GOOD.replace(*change))
    assert len(str(refusal.value)) < 500


def test_runs_that_many_grids_share_are_counted_before_they_are_parsed(plan):
    with pytest.raises(UsageError, match="makes more than 100000 runs"):
        plan(GOOD.replace("{seed: [1, 2]}", f"[&g {{seed: {list(range(1000))}}}, {', '.join(100 * ['*g'])}]"))


def test_numbers_are_read_as_a_person_reads_them(plan):
    found = plan(GOOD.replace("[1, 2]", "[010, 1e1, 11]").replace("steps: 20", "steps: 2.0e+1, period: 1e-9, vtk: 1"))
    assert [run.parameters.seed for run in found.runs] == [10, 11]  # YAML 1.1 reads 010 as 8, and 1e-9 as text
    assert found.runs[0].parameters.period == 1e-9 and found.runs[0].parameters.vtk is True


@pytest.mark.parametrize("kind", ["folder", "pipe", "large", "long name"])
def test_what_is_no_file_of_a_plan_is_not_read(tmp_path, kind):
    path = tmp_path / ("x" * 300 if kind == "long name" else "plan.yaml")
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "large":
        path.touch()
        os.truncate(path, 10**12)
    with pytest.raises(UsageError, match="not a file|more than 4000000|cannot be read"):
        read_plan(path)


@pytest.mark.parametrize("content", ["", "- 1\n", "\0", "{a: b}: 3\n"])
def test_a_file_that_is_no_campaign_is_refused(plan, content):
    with pytest.raises(UsageError, match="campaign.yaml"):
        plan(content)


def test_a_script_that_is_no_study_is_refused(plan, tmp_path):
    (tmp_path / "no_study.py").write_text("x = 1\n")
    with pytest.raises(UsageError, match="campaign.yaml: .*no_study.py defines no STUDY"):
        plan(GOOD.replace(str(TOY), "no_study.py"))


def test_a_file_that_is_not_there_exits_2_and_makes_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["nowhere.yaml"]) == 2
    assert "nowhere.yaml cannot be read" in capsys.readouterr().err and not list(tmp_path.iterdir())


def test_a_dry_run_names_the_runs_and_makes_nothing(plan, tmp_path, monkeypatch, capsys):
    names = [run.name for run in plan(GOOD).runs]
    monkeypatch.chdir(tmp_path)
    assert main(["campaign.yaml", "-n"]) == 0
    shown = capsys.readouterr().out
    assert all(name in shown for name in names) and "2 of 2 runs would be made" in shown
    assert [p.name for p in tmp_path.iterdir()] == ["campaign.yaml"]


def test_what_follows_two_dashes_is_snakemakes():
    options = read_arguments(["x.yaml", "--cores", "3", "--", "--profile", "slurm", "-n"])
    assert options.cores == 3 and options.snakemake == ["--profile", "slurm", "-n"] and not options.dry_run


def test_a_campaign_at_work_keeps_others_out(plan, tmp_path):
    found = plan(GOOD)
    with execution.opened(tmp_path / "out", found):
        with pytest.raises(UsageError, match="another scripts/campaign is working"):
            with execution.opened(tmp_path / "out", found):
                pass


def test_what_a_killed_campaign_left_at_work_keeps_others_out(plan, tmp_path):
    found = plan(GOOD)
    with execution.opened(tmp_path / "out", found) as lock:
        left = subprocess.Popen(["cat"], stdin=subprocess.PIPE, pass_fds=[lock.fileno()])  # waits, as Snakemake would
    with pytest.raises(UsageError, match="another scripts/campaign is working"):
        with execution.opened(tmp_path / "out", found):
            pass
    left.communicate()
    with execution.opened(tmp_path / "out", found):
        pass


def test_marks_follow_the_run_folders(plan, tmp_path):
    found = plan(GOOD)
    with execution.opened(tmp_path / "out", found):
        stale = tmp_path / "out" / "done" / found.runs[0].name
        stale.touch()
        execution.set_marks(tmp_path / "out", found)
    assert not stale.exists()


@pytest.mark.parametrize("file", ["run.h5", "summary.json"])
def test_a_damaged_finished_run_is_named_set_aside_and_planned_again(plan, tmp_path, file):
    found = plan(GOOD)
    with execution.opened(tmp_path / "out", found):
        for run in found.runs:
            with RunFolder(run.parameters.copy(update={"out": str(tmp_path / "out/runs" / run.name)}), study="toy"):
                pass
        assert execution.missing(tmp_path / "out", found) == []
        damaged = tmp_path / "out/runs" / found.runs[0].name
        (damaged / file).write_bytes((damaged / file).read_bytes()[:-10])
        (line,) = execution.set_damaged_aside(tmp_path / "out", found)
        assert (
            f"{damaged / file} cannot be read" in line
            and f"it is kept as {damaged.name}.damaged and made again" in line
        )
        assert execution.missing(tmp_path / "out", found) == found.runs[:1]
        assert execution.set_damaged_aside(tmp_path / "out", found) == []


def test_a_run_that_cannot_be_read_leaves_a_report_with_the_others(tmp_path, capsys):
    made_up_runs.make_campaign(
        tmp_path / "c", made_up_runs.MadeUpMagnus(), {"speed": dict(v0=[0.5, 1, 2], seed=[1, 2])}
    )
    first = sorted((tmp_path / "c/runs").iterdir())[0]
    (first / "summary.json").write_text("{")
    write_report(tmp_path / "c")
    assert len((tmp_path / "c/table.csv").read_text().splitlines()) == 1 + 5
    assert f"campaign: {first / 'summary.json'} cannot be read" in capsys.readouterr().err


def test_durations_in_words():
    assert [cost.duration(s) for s in (0.2, 90, 600, 5400, 86400, 1e6)] == [
        "1 s",
        "90 s",
        "10 min",
        "90 min",
        "24 h",
        "12 days",
    ]


@pytest.mark.parametrize("place", ["done/{run}", "campaign.json", "done", ".lock"])
def test_what_is_in_the_way_of_a_campaign_is_named(plan, tmp_path, monkeypatch, capsys, place):
    run = plan(GOOD).runs[0].name
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "campaign" / place.format(run=run)
    path.parent.mkdir(parents=True)
    if place == "done":
        path.touch()
    else:
        path.mkdir()
    assert main(["campaign.yaml"]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert str(path) in said or str(tmp_path / "campaign") in said and "cannot be written" in said


def test_a_table_that_is_a_folder_and_a_log_that_is_one_are_named(plan, tmp_path, monkeypatch, capsys):
    run = plan(GOOD).runs[0].name
    monkeypatch.chdir(tmp_path)
    (tmp_path / "campaign" / "logs" / f"{run}.log").mkdir(parents=True)
    assert main(["campaign.yaml", "--report"]) == 1
    assert "its log cannot be read (Is a directory)" in capsys.readouterr().err
    (tmp_path / "campaign" / "table.csv").unlink()
    (tmp_path / "campaign" / "table.csv").mkdir()
    assert main(["campaign.yaml", "--report"]) == 2
    assert "table.csv cannot be written (Is a directory); move it away" in capsys.readouterr().err


@pytest.mark.parametrize("content", ["", "5", "[1]", "{}", "\xff", "[" * 100_000])
def test_a_damaged_plan_in_a_campaigns_folder_is_one_line(tmp_path, content):
    (tmp_path / "campaign.json").write_text(content, encoding="latin-1")
    with pytest.raises(RunError, match="campaign.json") as refusal:
        Campaign.of(tmp_path)
    assert "\n" not in str(refusal.value)


def test_results_find_a_campaign_whose_name_has_blanks_again(tmp_path):
    target = tmp_path / "RESULTS.md"
    target.write_text("".join(results.SECTION.format(name=name, text="## text") for name in ("a b", "c")))
    assert results.stored_sections(target) == {"a b": "## text", "c": "## text"}


def test_a_table_of_words_and_numbers_is_sorted_and_told(tmp_path):
    runs = {"one": "auto", "two": 60.0}
    for name, travel in runs.items():
        write_run(tmp_path, name, dict(KEYS, travel=travel), {"drag": 1.0}, {})
    plan = dict(name="mixed", file="x.yaml", study="magnus", report="", runs=[dict(name=n, sweeps=["a"]) for n in runs])
    (tmp_path / "campaign.json").write_text(json.dumps(plan))
    table = Campaign.of(tmp_path).table
    assert list(table["travel"]) == [60.0, "auto"] and what_was_run.values(table["travel"]) == "60, auto"
