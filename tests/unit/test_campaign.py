"""Plans of campaigns: what a YAML becomes, names that find their runs again, and what is refused before anything runs."""

import subprocess
from pathlib import Path

import made_up_runs
import pytest

from graindrive.campaign import cost, execution
from graindrive.campaign.__main__ import main, read_arguments
from graindrive.campaign.plan import read_plan
from graindrive.errors import UsageError
from graindrive.postproc.campaign.report import write_report
from graindrive.run_folder import RunFolder

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
    assert found.study == "toy_study" and found.report == ""


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
    assert run.name == f"toy_study-seed_8-steps_20-{run.parameters.digest()}"


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
    with pytest.raises(UsageError, match="period=auto is not allowed"):
        plan(GOOD.replace("steps: 20", "period:"))


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
        (("steps: 20", "steps: 20, steps: 30"), "steps is given twice"),
        (("{seed: [1, 2]}", "{seed: [1, 2"), "is not YAML"),
        ((f"study: {TOY}", "study: wigle"), r"no study 'wigle'; did you mean wiggle\?"),
        ((f"study: {TOY}", "study: house"), "no study 'house'"),
        ((f"study: {TOY}", "study: nowhere.py"), "there is no file"),
        ((f"study: {TOY}", "study: 5"), "study must be the name of a study, got 5"),
        (("common:", "report: weather\ncommon:"), "no report 'weather'"),
        (("common:", "report: magnus\ncommon:"), "report magnus knows no sweep 'a'"),
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
        ("wiggle", "amplitude: [1, 60]", "width=120"),
        ("wiggle", "period: [4, 1e-9]", "period=1e-09"),
    ],
)
def test_values_that_do_not_go_together_are_refused_before_anything_runs(plan, study, values, words):
    with pytest.raises(UsageError, match=f"campaign.yaml: sweep a: .*{words}"):
        plan(f"study: {study}\nsweeps:\n  a: {{scale: demo, {values}}}\n")


@pytest.mark.parametrize("content", ["", "- 1\n", "\0", "{a: b}: 3\n"])
def test_a_file_that_is_no_campaign_is_refused(plan, content):
    with pytest.raises(UsageError, match="campaign.yaml"):
        plan(content)


def test_a_script_that_is_no_study_is_refused(plan, tmp_path):
    (tmp_path / "no_study.py").write_text("x = 1\n")
    with pytest.raises(UsageError, match="does not call headless.main"):
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
        with pytest.raises(UsageError, match="another scripts/campaign is at work"):
            with execution.opened(tmp_path / "out", found):
                pass


def test_what_a_killed_campaign_left_at_work_keeps_others_out(plan, tmp_path):
    found = plan(GOOD)
    with execution.opened(tmp_path / "out", found) as lock:
        left = subprocess.Popen(["cat"], stdin=subprocess.PIPE, pass_fds=[lock.fileno()])  # waits, as Snakemake would
    with pytest.raises(UsageError, match="another scripts/campaign is at work"):
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
