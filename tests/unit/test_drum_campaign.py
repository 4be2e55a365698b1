"""The report of a drum campaign and the figure of a run on made-up runs with known laws."""

import numpy as np
import pytest
from made_up_drums import MadeUpDrums, make_drums

from graindrive.postproc.campaign.folder import Campaign
from graindrive.postproc.campaign.report import write_report
from graindrive.postproc.campaign.verdicts import Verdict
from graindrive.postproc.drum import claims, constants, figure
from graindrive.postproc.drum.campaign import REPORT, SWEEPS
from graindrive.postproc.reader import Run
from graindrive.study import house, loaded

ALL = dict(drum_diameter=[60.0, 120.0], froude=[1e-3, 3e-3, 1.2e-2])
SPEEDS = {name: ALL for name in SWEEPS}


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "made_up"
    path.mkdir()
    return path


def claims_of(folder, laws, which, **changes):
    campaign = Campaign.of(make_drums(folder, laws, dict(one={**ALL, **changes})))
    return getattr(claims, which)(campaign, campaign.sweep("one"))


@pytest.mark.parametrize("model", ["dem", "continuum", "both"])
def test_the_fit_of_the_thickness_finds_its_law(folder, model):
    found = claims_of(folder, MadeUpDrums(slope=3.0), "thickness_claims", model=[model])
    assert len(found) == (6 if model == "both" else 3)
    for intercept, slope, rises in zip(found[::3], found[1::3], found[2::3]):
        # 1 % of 0.11 at six points, over Froude numbers that scatter by 5e-3
        assert abs(intercept.measured.value - 0.11) < 5 * intercept.measured.error < 0.01
        assert abs(slope.measured.value - 3.0) < 5 * slope.measured.error
        assert slope.verdict is Verdict.NOT_REPRODUCED and rises.verdict is Verdict.REPRODUCED


def test_the_likely_reading_is_reproduced_and_the_printed_one_is_not(folder, tmp_path):
    assert claims_of(folder, MadeUpDrums(), "thickness_claims")[0].verdict is Verdict.REPRODUCED
    other = tmp_path / "other"
    other.mkdir()
    assert claims_of(other, MadeUpDrums(intercept=0.2), "thickness_claims")[0].verdict is Verdict.NOT_REPRODUCED


@pytest.mark.parametrize("model", [["both"], ["dem", "continuum"]])
@pytest.mark.parametrize("apart, verdict", [(0.0, Verdict.REPRODUCED), (0.05, Verdict.NOT_REPRODUCED)])
def test_the_difference_of_the_models_is_judged_at_each_speed(folder, apart, verdict, model):
    made = claims_of(folder, MadeUpDrums(apart=apart), "profile_claims", model=model)
    found = [c for c in made if "one u(z)" in c.text]
    assert len(found) == 6 and {c.verdict for c in found} == {verdict}


def test_rigid_rotation_is_claimed_of_each_model(folder):
    found = [c for c in claims_of(folder, MadeUpDrums(), "profile_claims") if "static part" in c.text]
    assert [c.text.split(":")[0] for c in found] == ["grains", "continuum"]
    assert all(c.verdict is Verdict.REPRODUCED for c in found)


@pytest.mark.parametrize("thicker, verdict", [(0.0, Verdict.REPRODUCED), (0.08, Verdict.NOT_REPRODUCED)])
def test_profiles_collapse_at_equal_froude_number(folder, thicker, verdict):
    found = claims_of(folder, MadeUpDrums(thicker=thicker), "collapse_claims", model=["dem"])
    assert len(found) == 3 and {c.verdict for c in found} == {verdict}


def test_each_drum_is_compared_with_the_largest_at_each_rate(folder):
    drums = dict(drum_diameter=[60.0, 120.0, 240.0], froude=[3e-3], model=["continuum"], inertial_scale=[0.133, 1e6])
    laws = MadeUpDrums(thicker=0.08)
    laws.thickness = lambda keys, model: 0.11 + (
        0.1 * np.log2(keys["drum_diameter"] / 60) if keys["inertial_scale"] < 1 else 0
    )
    found = claims_of(folder, laws, "collapse_claims", **drums)
    assert [(c.text.split(";")[0], c.verdict) for c in found] == [
        (f"continuum, Fr 0.003, I_0 {scale}: D {size} and 240 have one u/(ΩD)", verdict)
        for scale, verdict in (("0.133", Verdict.NOT_REPRODUCED), ("1e+06", Verdict.REPRODUCED))
        for size in (60, 120)
    ]


def test_the_continuum_is_compared_with_the_grains_for_each_set_of_constants(folder):
    laws, grid = MadeUpDrums(), dict(
        drum_diameter=[60.0], froude=[3e-3], model=["dem", "continuum"], static_friction=[0.246, 0.3]
    )
    laws.thickness = lambda keys, model: 0.11 + 0.1 * (model == "continuum" and keys["static_friction"] > 0.25)
    campaign = Campaign.of(make_drums(folder, laws, dict(constants=grid)))
    found = constants.constants_claims(campaign, campaign.sweep("constants"))
    assert ["μ_s 0.246" in c.text for c in found] == [True, False]
    assert [c.verdict for c in found] == [Verdict.REPRODUCED, Verdict.NOT_REPRODUCED]


def test_fraction_and_place_of_the_surface(folder):
    fraction = claims_of(folder, MadeUpDrums(), "fraction_claims")
    assert fraction[0].verdict is Verdict.REPRODUCED
    campaign = Campaign.of(folder)
    assert [c.verdict for c in claims.surface_claims(campaign, campaign.sweep("one"))] == [Verdict.REPRODUCED] * 2


def test_a_report_has_all_figures_and_claims(folder, figures_drawn):
    text = write_report(Campaign.of(make_drums(folder, MadeUpDrums(), SPEEDS)).folder, REPORT).read_text()
    assert all((folder / "figures" / f"made_up-{planned.name}.png").exists() for planned in REPORT.figures)
    # 6 differences, 2 rigid rotations, 3 collapses of two models, 6 differences again for the one set of constants,
    # 3 claims on h/D of two models, fraction, 2 surfaces
    assert text.count("**reproduced**") == 6 + 2 + 6 + 6 + 6 + 1 + 2


def test_claims_on_grains_alone_speak_of_no_continuum(folder):
    campaign = Campaign.of(make_drums(folder, MadeUpDrums(), dict(one={**ALL, "model": ["dem"]})))
    rows = campaign.sweep("one")
    found = [claim for planned in REPORT.figures for claim in planned.claims(campaign, rows)]
    assert len(found) == 1 + 3 + 3 + 1 + 1 and not any("continuum" in claim.text for claim in found)


@pytest.mark.parametrize("model", ["continuum", "both"])
def test_the_figure_of_a_run_is_drawn_from_its_fields(folder, model, figures_drawn):
    make_drums(folder, MadeUpDrums(), dict(one=dict(model=[model])))
    (run,) = (folder / "runs").iterdir()
    figure.draw(run)
    assert (run / "figure.png").stat().st_size > 20_000 and (run / "figure.pdf").exists()
    words = ", ".join(figure.title(Run(run)))
    assert ("difference" in words) == (model == "both") and "h/D" in words


def test_expected_cost_follows_grains_and_turn():
    study = loaded(house()["drum"])
    p = study.parameters(drum_diameter=150, angular_velocity=6.28e-3, start_turn=180, turn=180)
    assert study.cost.work(p) == pytest.approx(7700 * 2 * 3.14159265 / 6.28e-3 / 1e-4, rel=1e-6)
    assert study.cost.work(p.copy(update=dict(dt_factor=2.0))) == pytest.approx(study.cost.work(p) / 2)
    assert study.cost.core_seconds(p) == pytest.approx(study.cost.work(p) / 85e6)
