"""The quick cases of extremes: each number against its closed form, the closed forms themselves, the study and its report."""

import importlib
import json
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import graindrive
from graindrive import engines
from graindrive.commands import headless
from graindrive.scenes import scene
from graindrive.beds import shear_cell
from graindrive.base.errors import UsageError
from graindrive.extremes import fluids, outcome, steps, table
from graindrive.extremes.few_grains import advance, mass_of, spring
from graindrive.scenes.material import SpringDashpotMaterial
from graindrive.postproc.campaign.verdicts import Verdict
from graindrive.postproc.extremes import campaign
from graindrive.postproc.reader import Run

STUDIES = Path(__file__).resolve().parents[2] / "studies"
# The others take a second or more; the campaign runs them.
SLOW = ("step_crystal_3d", "drum_full", "drum_empty", "drum_area", "fraction_3d", "wiggle_ends")
QUICK = [name for name in table.CASES if name not in SLOW]
SINGLE = [name for name in QUICK if "single" in table.CASES[name].precisions]
YADES = [f"step_{law}_2d" for law in steps.LAWS if law != "cundall_strack"] + ["friction_3d", "far_2d", "mass_ratio_2d"]


@pytest.mark.parametrize(
    "name, changes",
    [(name, {}) for name in QUICK]
    + [(name, dict(precision="single")) for name in SINGLE]
    + [(name, dict(loop="yade")) for name in YADES],
    ids=lambda value: value if isinstance(value, str) else "-".join(value.values()) or "double",
)
def test_an_extreme_gives_the_number_of_its_closed_form(name, changes):
    found = table.CASES[name].run(outcome.Setting(steps=100_000, strain=1.0, **changes))
    assert found.word in ("right", "guard", "bound"), found
    assert found.measured == pytest.approx(found.expected, rel=0, abs=found.tolerance), found.sentence


# The judge and the closed forms ---------------------------------------------------------------------------------------


def test_a_number_that_is_off_or_none_is_wrong():
    assert outcome.judged("bound", 1.05, 1.0, 0.1, "", "").word == "bound"
    assert outcome.judged("right", 1.2, 1.0, 0.1, "", "").word == "wrong"
    none = outcome.judged("guard", math.nan, 1.0, 0.1, "", "")
    assert none.word == "wrong" and none.error_over_bound > 1e6


def test_bisection_finds_an_edge_and_says_where_there_is_none():
    assert outcome.largest(lambda x: x < 2, 0.5, 50, 1e-6) == pytest.approx(2, rel=1e-6)
    assert math.isnan(outcome.largest(lambda x: x < 0.1, 0.5, 50, 1e-6))
    assert outcome.largest(lambda x: True, 0.5, 50, 1e-6) == math.inf


def test_a_crystal_without_tangential_springs_swings_at_six_k_over_m():
    mass = mass_of(2)
    assert steps.frictional_frequency(1e6, 0.0, mass) == pytest.approx(math.sqrt(6e6 / mass), rel=1e-12)
    # The safe bound, six contacts each with a sixth of the mass, is above every crystal's frequency.
    for k_t in (1e4, 3e5, 1e6, 5e6):
        assert steps.frictional_frequency(1e6, k_t, mass) ** 2 < 6 * max(2e6, 6 * k_t) / mass


def test_a_spun_up_fluid_begins_at_rest_and_ends_turning_as_a_whole():
    inside = np.array([0.1, 0.4, 0.7])
    assert fluids.spun_up(inside, 2e-3) == pytest.approx(np.zeros(3), abs=1e-3)  # 0.3 is 3.4 widths of the layer
    assert fluids.spun_up(inside, 2.0) == pytest.approx(inside, abs=1e-9)  # exp(-14.7 * 2)
    # Near the wall at early times: the solution for a plane wall, erfc(depth/(2 sqrt(time))); the curvature changes it by 2 %.
    assert fluids.spun_up(np.array([0.98]), 1e-3)[0] == pytest.approx(math.erfc(0.02 / (2 * math.sqrt(1e-3))), rel=0.02)


def test_every_case_says_what_it_is_and_where_it_runs():
    assert len(table.CASES) > 45
    for case in table.CASES.values():
        assert (
            case.meaning and set(case.loops) <= set(outcome.LOOPS) and set(case.precisions) <= set(outcome.PRECISIONS)
        )


# A bed that warms up by itself ----------------------------------------------------------------------------------------

GRAINS = SpringDashpotMaterial(1e6, 1e6, 0.9, 0.5, 1.0)


def warmth(share_of_pair):
    """Return the largest speed of a damped frictional crystal after 20,000 steps, from rest with a noise of 1e-9."""
    dt = share_of_pair * GRAINS.critical_time_step(0.5, 0.1)
    law = spring(GRAINS.normal_stiffness, GRAINS.restitution, GRAINS.friction, 1.0)
    ids, _ = steps.crystal(outcome.Setting(), 2, dt, law)
    advance(20_000)
    return steps.fastest(ids)


def test_a_bed_at_rest_warms_up_above_the_step_of_its_contacts_and_checks_refuse_that_step():
    pair, bed = GRAINS.critical_time_step(0.5, 0.1), GRAINS.bed_time_step(0.5)
    assert bed / pair < 1 / math.sqrt(6) + 0.05  # undamped 1/sqrt(6), overdamped 1/6
    assert warmth(bed / pair) < 1e-8
    assert warmth(0.6) > 1e-2  # below the pair's critical step, and no guard detects it
    assert scene.check_time_step(0.999 * bed, GRAINS, 0.5, 0.1) == pytest.approx(0.999 * bed / pair)
    with pytest.raises(UsageError, match="a grain with six contacts may be unstable: .* lower dt_factor, to 0.* times"):
        scene.check_time_step(1.01 * bed, GRAINS, 0.5, 0.1)


def test_a_sheared_cell_refuses_that_step_too():
    numbers = dict(grains=100, stiffness=2e5, friction=0.5, restitution=0.92, shear_rate=1.0, pressure=25.0)
    cell = shear_cell.ShearCell(**numbers, area_fraction=0.0, every=5, seed=1)
    pair, bed = cell.critical_time_step(), cell.critical_time_step(6)
    # The critical step of the two smallest disks, computed independently from k_n with m/2 and k_t = 2/7 k_n with m/6.
    mass = math.pi / 4
    eta = -2 * math.log(0.92) * math.sqrt(mass / 2 * 2e5 * mass / (math.pi**2 + math.log(0.92) ** 2))
    assert pair == pytest.approx(
        min(engines.critical_step(2e5 * mass, eta, mass / 2), engines.critical_step(2e5 * mass * 2 / 7, eta, mass / 6))
    )
    assert cell.check(0.999 * bed, 0.1) == pytest.approx(0.999 * bed / pair)
    with pytest.raises(UsageError, match="six contacts"):
        cell.check(1.01 * bed, 0.1)


# Study and report -----------------------------------------------------------------------------------------------------


@pytest.fixture
def extremes(monkeypatch):
    """The study as a module, in this process."""
    monkeypatch.syspath_prepend(str(STUDIES))
    return importlib.import_module("extremes")


def test_a_run_leaves_its_outcome_with_the_case_s_number(extremes, tmp_path):
    p = extremes.ExtremesParameters(case="friction_2d", out=str(tmp_path / "run"))
    headless.carry_out(extremes.STUDY, p)
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["outcome"] == "right" and abs(summary["measured"] - summary["expected"]) < summary["bound"]
    assert summary["error_over_bound"] == pytest.approx(abs(summary["measured"]) / summary["bound"])
    trials = Run(tmp_path / "run").group("trials")
    assert trials["mu"][-1] == 10 and trials["found"][-1] == pytest.approx(-1.2, abs=5e-3)
    assert (tmp_path / "run" / "figure.png").exists()


@pytest.mark.parametrize("loop", ["grain", "yade"])
def test_a_case_runs_in_a_process_of_its_own(loop, tmp_path, monkeypatch):
    """As by scripts/run: nothing but the study has imported YADE."""
    monkeypatch.chdir(tmp_path)
    made = graindrive.run("extremes", case="friction_2d", loop=loop, progress=False)
    assert made.summary["outcome"] == "right" and made.summary["meaning"] == table.CASES["friction_2d"].meaning


@pytest.mark.parametrize(
    "keys, words",
    [
        (dict(case="softest_2d", loop="yade"), "loop=yade does not apply to case=softest_2d"),
        (dict(case="drum_full", precision="single"), "precision=single does not apply to case=drum_full"),
        (dict(case="friction_2d", loop="yade", precision="single"), "precision=single exists only in GrainLoop"),
        (dict(case="friction_2d", dt_factor=2), "every case has its own time step"),
    ],
)
def test_what_means_nothing_to_a_case_is_refused_by_name(extremes, keys, words):
    with pytest.raises(UsageError, match=words):
        extremes.check(extremes.ExtremesParameters(**keys))


def test_a_claim_is_reproduced_where_the_number_is_within_its_bound_and_else_not():
    columns = dict(
        case=["far_2d", "spin_2d"], loop="grain", precision="double", run=["a", "b"], outcome=["bound", "wrong"]
    )
    rows = pd.DataFrame(dict(columns, sentence="x", source="y", expected=0.0, bound=1.0, measured=[0.5, 2.0]))
    claims = campaign.outcome_claims(SimpleNamespace(), rows)
    assert [claim.verdict for claim in claims] == [Verdict.REPRODUCED, Verdict.NOT_REPRODUCED]
    assert [claim.runs for claim in claims] == [("a",), ("b",)] and claims[1].settings.startswith("spin_2d, double")
