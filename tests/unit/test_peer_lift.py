"""The comparison of the lift study with LIGGGHTS: means over packings, verdicts, and their entry in RESULTS.md."""

import numpy as np
import pytest

from graindrive.benchmark import peer_lift
from graindrive.postproc.campaign import results
from graindrive.postproc.measured import Measured
from graindrive.postproc.statistics import block_mean


def rows_of(pairs):
    """Rows of seeds 1, 2, … with these drags of both codes [N], and half of them as lift; errors 0.01."""
    return [
        peer_lift.row_of(seed, force, Measured(factor * own, 0.01), Measured(factor * other, 0.01), [10.0, 80.0])
        for seed, (own, other) in enumerate(pairs, 1)
        for force, factor in (("drag", 1), ("lift", 0.5))
    ]


def test_the_mean_over_packings_has_the_larger_of_two_errors():
    drag, lift = peer_lift.over_packings(rows_of([(0.30, 0.31), (0.34, 0.33), (0.32, 0.32)]))
    assert drag["own"] == pytest.approx(0.32) and lift["liggghts"] == pytest.approx(0.16)
    assert drag["own_err"] == pytest.approx(0.02 / np.sqrt(3))  # scatter
    assert lift["liggghts_err"] == pytest.approx(0.01 / np.sqrt(3))  # the runs' own: they scatter by less
    assert drag["own_s"] == pytest.approx(30) and drag["liggghts_s"] == pytest.approx(240)


@pytest.mark.parametrize("other, verdict", [(0.32, "**the same**"), (0.33, "**not the same**")])
def test_the_report_says_whether_two_combined_errors_hold(tmp_path, other, verdict):
    """Errors of 0.01/sqrt(2) each combine to 0.01: 0.30 and 0.32 differ by two errors within round-off, 0.33 by three."""
    rows = rows_of([(0.3, other - 1e-9)] * 2)
    text = peer_lift.report("lift_peer", ["scale=demo"], rows + peer_lift.over_packings(rows))
    (drag,) = [line for line in text.splitlines() if line.startswith("| all | drag")]
    assert verdict in drag and "scripts/compare_lift scale=demo --seeds 1 2 --out lift_peer" in text
    folder = tmp_path / "lift_peer"
    folder.mkdir()
    (folder / "report.md").write_text(text)
    target = results.publish([folder], tmp_path)
    assert results.stored_sections(target) == {"lift_peer": text.strip()}


def test_both_codes_are_averaged_over_the_same_travel():
    """One run drifts for 20 d: the means of both begin where it is steady."""
    rng = np.random.default_rng(2)
    still = rng.normal(0, 0.01, (400, 6)) + [-1, 0, 0.5, 0, 0, 0]
    drifting = still.copy()
    drifting[:80, 0] -= np.linspace(3, 0, 80)
    own, other = peer_lift.means((still, drifting), 0.25, 4.0)
    assert own["drag"].value == other["drag"].value == pytest.approx(1, abs=0.01)
    whole = block_mean(-drifting[16:, 0])
    assert whole.value > 1.1
