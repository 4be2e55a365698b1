"""The report of a wiggle campaign on made-up runs with a known law: first rising periods, order, verdicts, figures."""

import itertools
import json

import numpy as np
import pytest
from made_up_runs import write_run

from graindrive.postproc.campaign import results
from graindrive.postproc.campaign.folder import Campaign
from graindrive.postproc.campaign.report import write_report
from graindrive.postproc.campaign.verdicts import Verdict
from graindrive.postproc.measured import Measured
from graindrive.postproc.wiggle import campaign as wiggle_campaign
from graindrive.postproc.wiggle import runs as wiggle_runs
from graindrive.postproc.wiggle.claims import drive_claims, phase_claims, scene_claims
from graindrive.postproc.wiggle.period_claims import (
    amplitude_claims,
    order_and_triangle_claims,
    period_claims,
    table_claims,
)

FIRST = dict(disk=2.75, square=3.5, tall=3.6, wide=2.5, triangle=4.4)  # within Table 1's observed ranges
SPEED = dict(disk=0.2, square=0.1, tall=0.15, wide=0.06, triangle=0.01)
FALL = dict(disk=(3.5, 7.0), square=(6.5, 6.5), tall=(9.5, 9.5), wide=(4.5, 4.5), triangle=(8.22, 8.22))
PERIODS = [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0]
KEYS = dict(
    shape="disk", amplitude=5.0, period=4.0, drive="displacement", mu=0.1, width=120.0, height=90.0, depth=50.0,
    lid="rigid", lid_pressure=46.2, dt_factor=5.0, time=100.0, fields=0, seed=1,
)  # fmt: skip
SCENES = [dict(width=300.0, lid_pressure=0.0, n_grains=63000), dict(width=120.0, lid_pressure=46.2, n_grains=11500)]
PHASE = (np.arange(20) + 0.5) / 20
NOISE = 1e-3


def law(keys):
    """V_y: a minimum at T = 1, zero at the shape's first period, a maximum, then a fall; nothing at A <= 1; linear in mu."""
    t, first = keys["period"], FIRST[keys["shape"]]
    if keys["amplitude"] <= 1:
        return 0.0
    sinking = -0.05 * np.interp(t, [0.25, 1, first], [0.2, 1, 0])
    rising = SPEED[keys["shape"]] * np.interp(t, [first, 5, 8], [0, 1, 0.4])
    return keys["amplitude"] / 5 * (sinking + rising) + (0.2 * (keys["mu"] - 0.1) if t > first else 0)


def write(folder, changes, noise, **facts):
    keys = {**KEYS, **changes}
    name = "-".join(f"{key}_{value}" for key, value in keys.items()).replace("/", "_")
    fall, height = FALL[keys["shape"]]
    rate = dict(rise_rate=law(keys) + NOISE * noise(), rise_rate_err=NOISE, fall_height=fall, intruder_height=height)
    swing = 0.3 * np.cos(4 * np.pi * PHASE - np.pi / 2)  # up in the first and third quarter
    groups = dict(
        phase=dict(phase=PHASE, vy=rate["rise_rate"] + swing, vy_err=np.full(20, 0.01)),
        intruder=dict(outline=np.array([[-3, -3], [3, -3], [3, 3], [-3, 3]], dtype=float)),
        series=dict(t=np.linspace(0, 100, 50), y=40 + rate["rise_rate"] * np.linspace(0, 100, 50)),
    )
    if keys["fields"]:
        groups["fields/around"] = made_up_fields(noise)
    if not (folder / "runs" / name).exists():
        write_run(folder, name, keys, {**rate, **facts}, groups, study="wiggle")
    return name


def made_up_fields(noise):
    """A wake on the left and a pressure on the right of a body of 6 d."""
    x = np.arange(-15, 15, 0.5) + 0.25
    shape = (20, 60, 60)
    fraction = np.broadcast_to(np.where(x < 0, 0.3, 0.8) + 0.01 * noise(), shape)
    pressure = np.broadcast_to(np.where(x < 0, 1.0, 50.0) + 0.01 * noise(), shape)
    velocity = np.ones((*shape, 2))
    return dict(x=x, y=x, samples=np.full(20, 100), area_fraction=fraction, pressure=pressure, velocity=velocity)


def campaign_of(folder, sweeps):
    """Make a campaign's folder of {sweep: [grids]}; a grid maps keys to lists of values."""
    noise, runs = np.random.default_rng(1).standard_normal, {}
    for sweep, grids in sweeps.items():
        for grid in grids:
            grid = dict(grid)
            facts = {"n_grains": grid.pop("n_grains")} if "n_grains" in grid else {}
            lists = {key: value if isinstance(value, list) else [value] for key, value in grid.items()}
            for values in itertools.product(*lists.values()):
                name = write(folder, dict(zip(lists, values)), noise, **facts)
                runs.setdefault(name, dict(name=name, sweeps=[]))["sweeps"].append(sweep)
    plan = dict(name=folder.name, file="x.yaml", study="wiggle", report="wiggle", runs=list(runs.values()))
    (folder / "campaign.json").write_text(json.dumps(plan))
    return Campaign.of(folder)


PERIOD_GRIDS = [
    dict(shape=list(FIRST), amplitude=[3.0, 5.0], period=PERIODS),
    dict(shape=list(FIRST), amplitude=[0.5, 1.0], period=[0.5, 1.0, 2.0, 4.0, 8.0]),
]


def all_of_periods(campaign):
    """Return all claims on the sweep over periods."""
    makers = (period_claims, table_claims, order_and_triangle_claims)
    return [claim for maker in makers for claim in maker(campaign, campaign.sweep("periods"))]


def test_a_paper_that_is_true_is_reproduced(tmp_path):
    campaign = campaign_of(tmp_path, dict(periods=PERIOD_GRIDS))
    claims = all_of_periods(campaign)
    judged = {c.text: c.verdict for c in claims}
    for shape, first in FIRST.items():
        found = next(c for c in claims if c.text == f"{shape}: first period that rises, observed")
        # The law has a kink at its zero, between samples that are one apart: the chord may miss it by up to 0.4.
        assert found.measured.value == pytest.approx(first, abs=0.4)
        assert found.verdict is Verdict.REPRODUCED, str(found)
        assert (
            judged[f"{shape}: nothing moves at A ≤ 1; largest |V_y| there over that at larger A"] is Verdict.REPRODUCED
        )
    order = [c for c in claims if "rises faster than" in c.text]
    assert len(order) == 8 and {c.verdict for c in order} == {Verdict.REPRODUCED}
    assert all(c.verdict is Verdict.REPRODUCED for c in claims if "sinking is fastest at T = 1" in c.text)
    assert all(c.verdict is Verdict.REPRODUCED for c in claims if "barely rises" in c.text)
    signs = [c for c in claims if "A 3: it " in c.text]
    # In these runs square and tall rectangle sink up to 3.5 and 3.6: they do not rise at all T > 2.
    late = ("square, A 3: it rises at T > 2; the least V_y", "tall, A 3: it rises at T > 2; the least V_y")
    assert len(signs) == 8
    assert {c.text for c in signs if c.verdict is not Verdict.REPRODUCED} == set(late)
    # The model's T_rise of the tall rectangle, 4.47, is not the 3.6 of these runs.
    assert judged["tall: first period that rises, cavity model"] is Verdict.NOT_REPRODUCED
    assert judged["disk: first period that rises, cavity model"] is Verdict.REPRODUCED


def test_a_paper_that_is_false_is_not_reproduced(tmp_path, monkeypatch):
    monkeypatch.setitem(SPEED, "disk", 0.02)
    monkeypatch.setitem(SPEED, "triangle", 0.3)
    monkeypatch.setitem(FIRST, "disk", 4.5)
    campaign = campaign_of(tmp_path, dict(periods=PERIOD_GRIDS[:1]))
    judged = {c.text: c.verdict for c in all_of_periods(campaign)}
    for text in (
        "A 5: disk rises faster than tall; difference of the fastest rises",
        "disk: first period that rises, observed",
        "A 5: the triangle sinks or barely rises; its fastest rise over the disk's",
    ):
        assert judged[text] is Verdict.NOT_REPRODUCED


def test_the_zero_of_a_line_and_its_error():
    zero = wiggle_runs.zero_between(2.0, Measured(-0.01, 0.002), 3.0, Measured(0.03, 0.004))
    assert zero.value == pytest.approx(2.25)
    rng = np.random.default_rng(2)
    low, high = rng.normal(-0.01, 0.002, 100_000), rng.normal(0.03, 0.004, 100_000)
    assert zero.error == pytest.approx(np.std(2 - low / (high - low)), rel=0.05)  # first order of 10 to 20 % errors


def test_a_body_that_always_or_never_rises_has_no_first_period(tmp_path, monkeypatch):
    campaign = campaign_of(tmp_path, dict(periods=[dict(shape=["disk"], period=[3.0, 4.0, 5.0])]))
    assert np.isnan(wiggle_runs.first_rising_period(campaign.table).value)
    monkeypatch.setitem(SPEED, "wide", -0.5)
    campaign = campaign_of(tmp_path, dict(periods=[dict(shape=["wide"], period=[3.0, 4.0, 5.0])]))
    assert np.isnan(wiggle_runs.first_rising_period(campaign.table).value)


def test_the_smallest_amplitude_that_moves_is_where_a_tenth_of_the_fastest_is_reached(tmp_path):
    campaign = campaign_of(tmp_path, dict(amplitudes=[dict(period=[5.0], amplitude=[0.5, 1.0, 3.0, 5.0], seed=[1, 2])]))
    of_runs, of_model = amplitude_claims(campaign, campaign.sweep("amplitudes"))
    # Nothing at 1, three fifths at 3: a tenth of the fastest at 1 + 2 / 6.
    assert of_runs.measured.value == pytest.approx(4 / 3, abs=0.02)
    assert of_runs.verdict is of_model.verdict is Verdict.REPRODUCED


def test_scenes_are_compared_with_the_one_of_most_grains(tmp_path):
    campaign = campaign_of(tmp_path, dict(scene=[dict(scene, period=[1.0, 4.0], seed=[1, 2, 3]) for scene in SCENES]))
    claims = scene_claims(campaign, campaign.sweep("scene"))
    assert [c.text.split(":")[0] for c in claims] == [
        f"T {t}, 120 × 90 d, depth 50 d + lid (rigid) 46.2, dt × 5" for t in (1, 4)
    ]
    assert {c.verdict for c in claims} == {Verdict.REPRODUCED}
    assert all(abs(c.measured.value) < 4 * c.measured.error for c in claims)


def test_phases_and_drives_are_judged(tmp_path):
    campaign = campaign_of(
        tmp_path,
        dict(phases=[dict(period=[4.0], seed=[1, 2])], drive=[dict(period=[4.0], drive=["displacement", "velocity"])]),
    )
    (climbs,) = phase_claims(campaign, campaign.sweep("phases"))
    assert climbs.measured.value == pytest.approx(
        2 * 0.3 * 2 / np.pi, rel=0.02
    )  # means of a sine's half waves, in five parts
    assert climbs.verdict is Verdict.REPRODUCED
    (same,) = drive_claims(campaign, campaign.sweep("drive"))
    assert same.verdict is Verdict.REPRODUCED


def test_all_figures_are_drawn_and_the_report_names_them(tmp_path):
    folder = tmp_path / "made_up"
    folder.mkdir()
    campaign_of(
        folder,
        dict(
            periods=[dict(shape=["disk", "wide", "triangle"], amplitude=[1.0, 5.0], period=[1.0, 2.0, 3.0, 5.0, 8.0])],
            phases=[dict(shape=["disk", "triangle"], period=[1.0, 4.0])],
            amplitudes=[dict(shape=["disk", "tall"], amplitude=[0.5, 1.0, 3.0, 5.0], period=5.0)],
            friction=[dict(shape=["disk", "tall"], period=[4.0, 5.0], mu=[0.0, 0.1, 0.3, 0.5])],
            drive=[dict(period=PERIODS, drive=["displacement", "velocity"])],
            fields=[dict(shape=["disk", "triangle"], period=[1.0], fields=1, seed=[1, 2, 3])],
            scene=[dict(scene, period=[1.0, 4.0]) for scene in SCENES],
        ),
    )
    report = write_report(folder).read_text()
    for planned in wiggle_campaign.FIGURES:
        figure = folder / "figures" / f"made_up-{planned.name}.png"
        assert figure.stat().st_size > 10_000
        assert f"figures/{figure.name}" in report
    assert report.count("**reproduced**") > 20
    assert "| disk: first period that rises, cavity model | Eq. 3.14 | 2.83 |" in report
    studies = tmp_path / "studies"
    studies.mkdir()
    results.publish([folder], studies)
    assert "Wiggle: bodies shaken sideways" in (studies / "RESULTS.md").read_text()


def test_the_cost_of_the_papers_run_is_that_of_its_particle_steps():
    keys = dict(width=300.0, height=195.0, time=1000.0, dt_factor=1.0)
    assert wiggle_campaign.expected_core_seconds(keys) == pytest.approx(63000 * 1e7 / 90e6, rel=0.02)
