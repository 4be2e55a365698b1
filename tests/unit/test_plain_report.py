"""A report without claims of a paper: means and errors over seeds, and a figure of every observable against every key."""

import json

import matplotlib.pyplot as plt
import numpy as np
import pytest
from made_up_runs import KEYS, write_run

from graindrive.postproc.campaign import plain
from graindrive.postproc.campaign.folder import Campaign
from graindrive.postproc.campaign.report import write_report
from graindrive.study import Observable

DRAG = Observable("drag", "N", "mean force along -V", headline=True)
LIFT = Observable("lift", "N", "mean force across it")


@pytest.fixture
def campaign(tmp_path):
    """A function from {sweep: [(keys, summary)]} to the folder of such a campaign."""

    def make(sweeps, study="made_up"):
        runs = []
        for sweep, members in sweeps.items():
            for k, (keys, summary) in enumerate(members):
                write_run(tmp_path, f"{sweep}-{k}", {**KEYS, **keys}, summary, {}, study)
                runs.append(dict(name=f"{sweep}-{k}", sweeps=[sweep]))
        plan = dict(name="c", file="c.yaml", study=study, report="", runs=runs)
        (tmp_path / "campaign.json").write_text(json.dumps(plan))
        return tmp_path

    return make


def measured(value, error=0.5, name="drag"):
    return {name: value, f"{name}_err": error, f"{name}_unit": "N"}


def lines(report):
    """Return the rows of the report's tables as lists of cells."""
    return [line[2:-2].split(" | ") for line in report.splitlines() if line.startswith("| ")]


def test_errors_are_the_scatter_of_seeds_or_a_single_runs_own(campaign):
    folder = campaign(
        {
            "speed": [
                (dict(v0=1.0, seed=1), measured(10.0)),
                (dict(v0=1.0, seed=2), measured(14.0)),
                (dict(v0=2.0, seed=1), measured(40.0)),
            ]
        }
    )
    report = write_report(folder, None, [DRAG]).read_text()
    # 12 ± (14 - 10)/2: with two values s/sqrt(2) is half their difference. The other has its own error.
    expected = [["v0", "runs", "drag [N]"], 3 * ["---"], ["1", "2", "12.0 ± 2.0"], ["2", "1", "40.00 ± 0.50"]]
    assert lines(report) == expected
    assert "3 runs of `made_up`" in report and "`drag [N]`: mean force along -V; against `v0`." in report
    assert (folder / "table.csv").exists() and "claims" not in report


def test_seeds_that_lie_together_by_chance_have_the_runs_own_error(campaign):
    near = [(dict(v0=1.0, seed=k), measured(10.0 + 0.01 * k, error=3.0)) for k in (1, 2)]
    unknown = [(dict(v0=2.0, seed=k), measured(10.0 + 4.0 * k, error=float("nan"))) for k in (1, 2)]
    report = write_report(campaign({"speed": near + unknown}), None, [DRAG]).read_text()
    # 3/sqrt(2) is larger than the half difference 0.005; where the runs' errors are unknown the scatter counts alone.
    assert lines(report)[2:] == [["1", "2", "10.0 ± 2.1"], ["2", "2", "16.0 ± 2.0"]]


def test_a_quantity_that_equals_the_key_of_its_name_in_some_runs_keeps_all_values(campaign):
    runs = [(dict(v0=v), measured(round(v), name="v0")) for v in (1.0, 1.5, 2.0)]
    report = write_report(
        campaign({"a": runs}), None, [Observable("v0", "m/s", "as measured", headline=True)]
    ).read_text()
    assert [row[2] for row in lines(report)[2:]] == ["1.00 ± 0.50", "2.00 ± 0.50", "2.00 ± 0.50"]


def test_words_and_quantities_without_a_number_are_named(campaign):
    runs = [(dict(v0=v), {**measured(v), "lift": "word", "torque": None}) for v in (1.0, 2.0)]
    shown = [DRAG, LIFT, Observable("torque", "N m", "about the centre")]
    report = write_report(campaign({"a": runs}), None, shown).read_text()
    assert "No run of this sweep gives a number of `lift`, `torque`." in report and "| v0 | runs | drag [N] |" in report


def test_curves_between_words_have_no_lines_and_stand_side_by_side(campaign):
    runs = [(dict(shape=s, v0=v), measured(1.0)) for s in ("disk", "square") for v in (1.0, 2.0)]
    figure = figure_of(campaign({"a": runs}))
    (panel,) = [axes for axes in figure.axes if axes.get_xlabel() == "shape"]
    first, second = (bars.lines[0] for bars in panel.containers)  # `lines` are the points, the caps, the bars
    assert first.get_linestyle() == second.get_linestyle() == "None"
    assert np.allclose(np.asarray(first.get_xdata(), float), [-0.125, 0.875]) and np.allclose(
        np.asarray(second.get_xdata(), float), [0.125, 1.125]
    )


def test_every_observable_is_drawn_against_every_key_of_each_sweep(campaign):
    grid = [dict(v0=v, mu=mu) for v in (0.5, 1.0) for mu in (0.1, 0.5)]
    both = [(keys, {**measured(1.0), **measured(2.0, name="lift")}) for keys in grid]
    folder = campaign({"a": both, "b": [(dict(phi=p), measured(p)) for p in (0.135, 0.352)]})
    report = write_report(folder, None, [DRAG, LIFT]).read_text()
    drawn = {"c-a-drag", "c-a-lift", "c-b-drag"}  # no run of sweep b has a lift
    assert {path.stem for path in (folder / "figures").glob("*.png")} == drawn
    assert all(f"(figures/{name}.png)" in report for name in drawn)
    assert report.count("against `mu`, `v0`.") == 2 and report.count("against `phi`.") == 1
    assert ["0.135", "1", "0.14 ± 0.50"] in lines(report)


def figure_of(folder, observable=DRAG):
    """Return the figure of an observable over all runs of a campaign, and the keys of its panels."""
    rows = Campaign.of(folder).table
    keys = [key for key in Campaign.of(folder).varied(rows) if key != "seed"]
    return plain.drawn(rows, keys, {"v0": "m/s"}, observable)


def test_curves_are_the_runs_values_and_a_legend_stands_beside_the_data(campaign):
    law = {(v, mu): 3 * v + mu for v in (0.01, 0.1, 1.0) for mu in (0.25, 0.5)}
    figure = figure_of(campaign({"a": [(dict(v0=v, mu=mu), measured(d)) for (v, mu), d in law.items()]}))
    mu, v0 = figure.axes
    assert (v0.get_xlabel(), v0.get_ylabel(), v0.get_xscale(), mu.get_xscale()) == (
        "v0 [m/s]",
        "drag [N]",
        "log",
        "linear",
    )
    curves = {c.get_label(): c.lines[0].get_xydata() for c in v0.containers}
    assert np.allclose(curves["mu 0.25"], [(v, law[v, 0.25]) for v in (0.01, 0.1, 1.0)]) and len(curves) == 2
    bars = v0.containers[0].lines[2][0].get_segments()
    assert np.allclose(bars[0][:, 1], law[0.01, 0.25] + np.array([-0.5, 0.5]))
    figure.canvas.draw()
    inside, beside = v0.get_window_extent(), v0.get_legend().get_window_extent()
    assert beside.x0 > inside.x1 and beside.x1 <= figure.bbox.x1
    plt.close(figure)


def test_words_and_switches_stand_side_by_side_and_missing_values_are_left_out(campaign):
    values = {"disk": 1.0, "auto": 3.0, 60.0: None, "star": 2.0}
    (axes,) = (figure := figure_of(campaign({"a": [(dict(shape=s), dict(drag=d)) for s, d in values.items()]}))).axes
    assert [text.get_text() for text in axes.get_xticklabels()] == ["60", "auto", "disk", "star"]
    assert np.allclose(axes.containers[0].lines[0].get_xydata(), [(1, 3.0), (2, 1.0), (3, 2.0)])
    plt.close(figure)


def test_a_study_without_observables_shows_what_has_an_error(campaign):
    found = {**measured(1.0), "torque": 2.0}
    report = write_report(campaign({"a": [(dict(v0=v), found) for v in (1.0, 2.0)]})).read_text()
    assert lines(report)[0] == ["v0", "runs", "drag [N]"]


def test_repeats_alone_have_a_mean_and_no_figure(campaign):
    folder = campaign({"a": [(dict(seed=seed), measured(drag)) for seed, drag in ((1, 1.0), (2, 2.0), (3, 3.0))]})
    report = write_report(folder, None, [DRAG]).read_text()
    # s = 1, so that the error is 1/sqrt(3) = 0.577.
    assert lines(report)[2] == ["3", "2.00 ± 0.58"] and "nothing to draw against" in report
    assert not list((folder / "figures").iterdir())


def test_a_quantity_named_as_a_key_keeps_its_measured_value_and_error(campaign):
    runs = [(dict(phi=phi), measured(phi + 0.01, 0.002, "phi")) for phi in (0.1, 0.2)]
    report = write_report(campaign({"a": runs}), None, [Observable("phi", "-", "area fraction", headline=True)])
    assert lines(report.read_text())[2] == ["0.1", "1", "0.1100 ± 0.0020"]


def test_a_campaign_without_runs_leaves_an_empty_table(campaign):
    assert write_report(campaign({}), None, [DRAG]).name == "table.csv"
