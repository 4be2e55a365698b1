"""The report on RFT: verdicts on made-up campaigns in which bodies obey one of its two forms."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from graindrive.bodies import outlines_for_lift
from graindrive.campaign.plan import read_plan
from graindrive.postproc.campaign.verdicts import Verdict
from graindrive.postproc.lift import rft, rft_report

D, RHO_G, BREADTH = 1.5e-3, 15e3, 5.0
DEEP, SHALLOW = 30.0, 10.0  # d
FORMS = dict(rft_report.FORMS)
CAMPAIGNS = Path(__file__).resolve().parents[2] / "studies" / "campaigns"


def alpha(beta, depth, form):
    """Return (2, n), the stresses of plates at a depth [m]; alpha_z has an odd part and an even one, which lifts a cylinder."""
    even = 1.0 if form == "published" else DEEP * D / depth
    return RHO_G * np.array([8 - 2 * np.cos(2 * beta), 3 * np.sin(2 * beta) + even])


def scene():
    """All bodies of the campaign: (sweep, shape, depth [d], outline [m])."""
    outlines = {name: corners * D for name, corners in outlines_for_lift.outlines().items()}
    made = [("plates" if "plate" in name else "halves", name, DEEP, corners) for name, corners in outlines.items()]
    made += [("growth", name, SHALLOW, outlines[name]) for name in ("plate_45.csv", "plate_-45.csv")]
    return made + [("cylinder", "cylinder", depth, rft.circle(3.3 * D)) for depth in (SHALLOW, DEEP, 90.0)]


class MadeUp:
    """A campaign in which forces on bodies are the sum of `form` over plates; `turned` changes the sign of the halves' lift."""

    def __init__(self, form, turned=False):
        tilts = np.radians(outlines_for_lift.TILTS)
        plates = rft.Plates(tilts, alpha(tilts, DEEP * D, form), np.zeros((2, len(tilts))), DEEP * D)
        self.outlines, rows = {}, []
        for k, (sweep, shape, depth, corners) in enumerate(scene()):
            self.outlines[f"run{k}"] = corners
            if "plate" in shape:
                beta, length = rft.longest_edge(corners)
                drag, lift = alpha(np.array([beta]), depth * D, form)[:, 0] * length * depth * D
            else:
                drag, lift = rft.force(FORMS[form](rft.leading_elements(corners), plates, depth * D), plates)[0]
            sign = -1 if turned and sweep == "halves" else 1
            rows.append(row_of(f"run{k}", sweep, shape, depth, corners, drag * BREADTH * D, sign * lift * BREADTH * D))
        self.table = pd.DataFrame(rows)

    def sweep(self, name):
        return self.table[self.table["sweeps"] == name]

    def run(self, name):
        return type("Run", (), {"group": lambda _self, _name: {"outline": self.outlines[name]}})()


def row_of(name, sweep, shape, depth, corners, drag, lift):
    """A row of a campaign's table, errors of 0.3 % of the drag."""
    x, z = corners.T
    area = 0.5 * abs(np.sum(x * np.roll(z, -1) - np.roll(x, -1) * z))
    height, pressure = np.ptp(z), RHO_G * depth * D
    buoyancy, unit = RHO_G * area * BREADTH * D, pressure * height * BREADTH * D
    error = 0.003 * drag
    found = dict(run=name, sweeps=sweep, shape=shape, depth=depth, lid_density=0.0, breadth=BREADTH, grain_diameter=D)
    found.update(effective_depth=depth, depth_over_d=depth * D / height, body_height=height / D, pressure=pressure)
    found.update(buoyancy=buoyancy, drag=drag, drag_err=error, lift=lift, lift_err=error)
    found.update(drag_coefficient=drag / unit, drag_coefficient_err=error / unit)
    found.update(lift_over_buoyancy=lift / buoyancy, lift_over_buoyancy_err=error / buoyancy)
    return found


def verdicts(campaign):
    """{text: verdict} of all claims."""
    claims = rft_report.rft_claims(campaign, campaign.sweep("plates"))
    return {claim.text: claim.verdict for claim in claims}


def one(found, words):
    """The verdict on the one claim whose text holds these words."""
    (verdict,) = [verdict for text, verdict in found.items() if words in text]
    return verdict


@pytest.mark.parametrize("form, other", [("published", "split"), ("split", "published")])
def test_the_form_that_bodies_obey_is_told_from_the_other(form, other):
    found = verdicts(MadeUp(form))
    assert one(found, f"deepest run: RFT's lift, {form} form") is Verdict.REPRODUCED
    assert one(found, f"deepest run: RFT's lift, {other} form") is Verdict.NOT_REPRODUCED
    assert one(found, "even in β") is (Verdict.REPRODUCED if form == "published" else Verdict.NOT_REPRODUCED)
    assert one(found, "odd in β") is Verdict.REPRODUCED


def test_plates_off_the_three_fourier_terms_are_told():
    campaign = MadeUp("published")
    found = verdicts(campaign)
    assert one(found, "α_x by tilt") is one(found, "α_z by tilt") is Verdict.REPRODUCED
    shallow = campaign.table["shape"] == "plate_22.5.csv"
    campaign.table.loc[shallow, "lift"] += 0.05 * campaign.table.loc[shallow, "drag"]  # 17 of its errors
    found = verdicts(campaign)
    assert one(found, "α_x by tilt") is Verdict.REPRODUCED
    assert one(found, "α_z by tilt") is Verdict.NOT_REPRODUCED


def test_the_lift_of_half_cylinders_has_a_sign():
    for turned, verdict in ((False, Verdict.REPRODUCED), (True, Verdict.NOT_REPRODUCED)):
        found = verdicts(MadeUp("published", turned))
        for side in ("up", "down"):
            assert one(found, f"flat side {side}: lift over buoyancy") is verdict
            assert one(found, f"flat side {side}: lift over RFT") is verdict
            assert one(found, f"flat side {side}: drag over RFT") is Verdict.REPRODUCED


def test_too_few_plates_make_no_claims_and_an_empty_figure():
    campaign = MadeUp("published")
    few = campaign.sweep("plates").iloc[:2]
    assert rft_report.rft_claims(campaign, few) == []
    figure = rft_report.draw(campaign, few)
    assert not any(axes.lines for axes in figure.axes)
    plt.close(figure)


def test_the_figure_shows_the_lift_by_rft_at_the_depth_of_a_run():
    campaign = MadeUp("published")
    figure = rft_report.draw(campaign, campaign.sweep("plates"))
    lift = figure.axes[3]
    line = next(line for line in lift.lines if line.get_label() == "RFT, published form")
    deepest = campaign.sweep("cylinder").iloc[-1]
    at = np.interp(deepest["depth_over_d"], line.get_xdata(), line.get_ydata())
    plt.close(figure)
    # The run's force is the sum over a polygon with the same number of sides; the curve is a straight line.
    assert at == pytest.approx(deepest["lift_over_buoyancy"], rel=1e-3)


def test_the_campaign_drags_all_outlines_and_the_cylinder_as_lift_small_does():
    """Its runs of the cylinder have the names of those of lift_small.yaml, so that both campaigns can use the same runs."""
    plan, other = (read_plan(CAMPAIGNS / f"{name}.yaml") for name in ("lift_rft", "lift_small"))
    dragged = {Path(run.parameters.shape).name for run in plan.runs if "cylinder" not in run.sweeps}
    assert dragged == set(outlines_for_lift.outlines())
    cylinders = {run.name for run in plan.runs if "cylinder" in run.sweeps}
    assert len(cylinders) == 6 and cylinders <= {run.name for run in other.runs}
