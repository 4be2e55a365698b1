"""The report of a Magnus campaign on made-up runs with known laws: slopes, errors, verdicts, files."""

import csv
import json

import h5py
import numpy as np
import pytest
from made_up_runs import MadeUpMagnus, make_campaign

from graindrive.postproc.campaign import results
from graindrive.postproc.campaign.folder import Campaign
from graindrive.postproc.campaign.report import write_report
from graindrive.postproc.campaign.verdicts import Verdict
from graindrive.postproc.magnus.campaign import REPORT
from graindrive.postproc.magnus.figure import fields_of
from graindrive.postproc.magnus.claims import drag_claims, speed_claims
from graindrive.postproc.magnus.wake import wake_claims
from graindrive.postproc.reader import Run, RunError
from graindrive.study import house, loaded

SPEEDS = dict(phi=[0.352, 0.818], v0=[0.25, 0.5, 1.0, 2.0])
SWEEPS = dict(
    speed=SPEEDS,
    spin=dict(phi=[0.352, 0.818], spin_ratio=[0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 10.0, 20.0]),
    angles=dict(phi=[0.818], spin_ratio=[0.0, 1.0, 20.0], seed=[1, 2, 3]),
    fields=dict(fields=[1], phi=[0.818], v0=[0.25], spin_ratio=[0.0, 1.0, 10.0], seed=[1, 2, 3]),
    friction=dict(phi=[0.135, 0.352, 0.818], spin_ratio=[20.0], mu=[0.0, 0.25, 0.5]),
)


def claims_on_speed(folder, laws, **options):
    campaign = Campaign.of(make_campaign(folder, laws, dict(speed=SPEEDS), **options))
    return speed_claims(campaign, campaign.sweep("speed"))


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "made_up"
    path.mkdir()
    return path


def test_slope_of_the_drag_is_found_within_its_error(folder):
    slope = claims_on_speed(folder, MadeUpMagnus())[0]
    # four points of 1 % over a factor of 8 in speed
    assert slope.measured.error == pytest.approx(
        0.01 / np.sqrt(np.sum((np.log(2) * np.array([1.5, 0.5, 0.5, 1.5])) ** 2)), rel=1.5
    )
    assert abs(slope.measured.value - 2) < 5 * slope.measured.error
    assert slope.verdict is Verdict.REPRODUCED


def test_another_power_is_not_reproduced(folder):
    claims = claims_on_speed(folder, MadeUpMagnus(power=1.5))
    slopes = [c for c in claims if "slope" in c.text]
    assert [c.verdict for c in slopes] == [Verdict.NOT_REPRODUCED] * 2


def test_runs_with_large_errors_decide_nothing(folder):
    claims = claims_on_speed(folder, MadeUpMagnus(error=0.5), seed=3)
    assert Verdict.REPRODUCED not in {c.verdict for c in claims if "slope" in c.text}


def test_the_paper_of_made_up_runs_is_reproduced_and_written(folder, figures_drawn):
    make_campaign(folder, MadeUpMagnus(rise=0.5), SWEEPS)
    report = write_report(folder, REPORT).read_text()
    assert "0 not reproduced, 0 not decided" in report
    assert report.count("![") == len(REPORT.figures)
    names = {f"made_up-{figure.name}" for figure in REPORT.figures}
    assert {p.stem for p in (folder / "figures").iterdir()} == names
    assert all((folder / "figures" / f"{name}.png").stat().st_size > 10_000 for name in names)
    assert "scripts/campaign campaigns/x.yaml" in report and "core-seconds" in report and "a processor" in report


def test_the_wake_counts_in_radii_of_the_body(folder, tmp_path):
    found = {}
    for diameter in (5.0, 10.0):
        place = tmp_path / f"{diameter:g}"
        place.mkdir()
        sweep = dict(SWEEPS["fields"], intruder_diameter=[diameter])
        campaign = Campaign.of(make_campaign(place, MadeUpMagnus(), dict(fields=sweep)))
        found[diameter] = wake_claims(campaign, campaign.sweep("fields"))
    core, wider, bent, *hot = zip(*found.values())
    # The same fields at twice the scale: lengths double; fractions and directions stay, except in bins at the edges of a window.
    assert core[0].measured.value == core[1].measured.value == 0
    assert wider[1].measured.value == pytest.approx(2 * wider[0].measured.value, rel=1e-9)
    assert bent[1].measured.value == pytest.approx(2 * bent[0].measured.value, rel=1e-9)
    for small, large in hot:
        assert large.measured.value == pytest.approx(small.measured.value, abs=0.05)  # smoothing stays 0.5 d wide


@pytest.mark.parametrize("constants", [{"d": 0.04}, {}])
def test_lengths_count_in_the_grains_of_the_run(folder, constants):
    """d is a constant in the run folder; in one of an older version it follows from the travel, which is given in m and in d."""
    make_campaign(folder, MadeUpMagnus(), dict(fields={**SWEEPS["fields"], "spin_ratio": [0.0], "seed": [1]}))
    (path,) = (folder / "runs").iterdir()
    with h5py.File(path / "run.h5", "r+") as file:
        x = file["fields/around/x"][()]
        del file["constants"]
        for name, value in constants.items():
            file[f"constants/{name}"] = value
        file["series/t"], file["series/travel"] = [1.0, 2.0], np.array([1.0, 2.0]) * 0.25 / 0.04
    assert fields_of(Run(path)).x == pytest.approx(x / 0.04, rel=1e-15)


def test_a_drag_that_does_not_rise_with_spin_is_reported(folder):
    campaign = Campaign.of(make_campaign(folder, MadeUpMagnus(rise=0.0), dict(spin=SWEEPS["spin"])))
    (rise,) = [c for c in drag_claims(campaign, campaign.sweep("spin")) if "spin raises D" in c.text]
    assert rise.verdict is not Verdict.REPRODUCED and abs(rise.measured.value - 1) < 5 * rise.measured.error


def test_the_table_has_a_row_per_run_with_keys_and_quantities_sorted(folder):
    make_campaign(folder, MadeUpMagnus(), dict(speed=SPEEDS))
    write_report(folder, REPORT)
    rows = list(csv.DictReader((folder / "table.csv").open()))
    assert len(rows) == 8
    values = [(float(row["phi"]), float(row["v0"])) for row in rows]
    assert values == sorted(values)
    assert {"run", "sweeps", "drag", "drag_err", "wall_s", "cpu", "mu", "seed"} <= set(rows[0])
    assert not list(folder.glob(".*.tmp"))


def test_a_campaign_of_which_nothing_is_done_has_an_empty_table(folder):
    make_campaign(folder, MadeUpMagnus(), dict(speed=SPEEDS))
    for run in (folder / "runs").iterdir():
        (run / "run.h5").unlink()
    assert write_report(folder, REPORT).name == "table.csv"
    assert (folder / "table.csv").read_text() == "run,sweeps\n"


def test_missing_runs_are_counted_and_their_claims_not_made_up(folder):
    make_campaign(folder, MadeUpMagnus(), dict(speed=SPEEDS))
    for run in sorted((folder / "runs").glob("phi_0.818*"))[1:]:
        (run / "summary.json").unlink()
    report = write_report(folder, REPORT).read_text()
    assert "5 runs of `magnus` (3 more are missing)" in report
    (row,) = [line for line in report.splitlines() if "0.818: log D" in line]
    assert "no data" in row and "**not decided**" in row


def test_a_folder_without_a_plan_is_refused(tmp_path):
    with pytest.raises(RunError, match="holds no campaign.json"):
        Campaign.of(tmp_path)


def test_results_keep_other_campaigns_and_replace_their_own(folder, tmp_path):
    studies = tmp_path / "studies"
    studies.mkdir()
    make_campaign(folder, MadeUpMagnus(), dict(speed=SPEEDS))
    write_report(folder, REPORT)
    other = folder.with_name("other")
    folder.rename(other)
    for name in ("b", "a", "b"):
        (other / "campaign.json").write_text(
            json.dumps({**json.loads((other / "campaign.json").read_text()), "name": name})
        )
        write_report(other, REPORT)
        results.publish([other], studies)
    text = (studies / "RESULTS.md").read_text()
    assert list(results.stored_sections(studies / "RESULTS.md")) == ["a", "b"]
    assert text.count("log D against log V0") == 4 and text.startswith("# Results")
    assert (studies / "figures" / "a-fig2.png").exists() and "(figures/b-fig2.png)" in text


def test_expected_cost_follows_grains_and_steps():
    study = loaded(house()["magnus"])
    p = study.parameters(phi=0.352, width=300, height=200, v0=1.0)
    grains, steps = 0.352 * 300 * 200 / (np.pi / 4), 300 * 0.02 / 2e-6
    assert study.cost.work(p) == pytest.approx(grains * steps) and study.cost.unit == "particle-steps"
    assert study.cost.core_seconds(p) == pytest.approx(grains * steps / 313e6)
    assert study.cost.core_seconds(p.copy(update=dict(travel=150))) == pytest.approx(grains * steps / 626e6)
    assert study.cost.core_seconds(p.copy(update=dict(dt_factor=2.0))) == pytest.approx(grains * steps / 626e6)
