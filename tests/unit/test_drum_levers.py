"""The levers of the drum's continuum in a report: errors against the finest value of each, and the cheapest within 1 %."""

import numpy as np
import pandas as pd
import pytest
from made_up_drums import MadeUpDrums, make_drums

from graindrive.postproc.campaign.folder import Campaign
from graindrive.postproc.campaign.verdicts import Verdict
from graindrive.postproc.drum import levers

STEPS = dict(model=["continuum"], continuum_dt=[0.01, 0.02, 0.08], froude=[3e-3])
GRIDS = dict(model=["continuum"], cells=[40, 75, 150], froude=[3e-3])


class Levered(MadeUpDrums):
    """The layer gets thicker in proportion to the time step, and not at all with the grid."""

    def thickness(self, keys, model):
        return 0.11 + 0.1 * keys["continuum_dt"]


@pytest.fixture
def campaign(tmp_path):
    """A campaign of three time steps and three grids about one default."""
    folder = tmp_path / "made_up"
    folder.mkdir()
    return Campaign.of(make_drums(folder, Levered(), dict(steps=STEPS, grids=GRIDS)))


def rows_of(campaign):
    return pd.concat([campaign.sweep("steps"), campaign.sweep("grids")]).drop_duplicates("run", ignore_index=True)


def test_each_lever_is_measured_against_its_finest_value(campaign):
    found = levers.by_lever(campaign, rows_of(campaign))
    assert list(found) == ["continuum_dt", "cells"]  # no other lever has two values
    steps, grids = found["continuum_dt"], found["cells"]
    assert [one.value for one in steps] == [0.08, 0.02, 0.01] and [one.value for one in grids] == [40, 75, 150]
    assert steps[-1].error.value == grids[-1].error.value == 0
    # To first order the profile differs by the shift of the layer, which is proportional to the excess of the time step.
    assert steps[0].error.value / steps[1].error.value == pytest.approx(7, rel=0.2)
    assert max(one.error.value for one in grids) < 1e-12
    assert [one.seconds for one in grids] == pytest.approx([0.05 * cells**2 for cells in (40, 75, 150)], rel=1e-12)


def test_the_cheapest_setting_is_the_one_of_least_seconds_within_one_per_cent(campaign):
    found = levers.by_lever(campaign, rows_of(campaign))
    assert levers.cheapest(found["cells"]).value == 40
    within = [one for one in found["continuum_dt"] if one.error.value <= 0.01]
    assert levers.cheapest(found["continuum_dt"]) is within[0]


def test_claims_name_value_error_and_cost(campaign):
    rows = rows_of(campaign)
    claims = levers.lever_claims(campaign, rows)
    assert len(claims) == 4  # two values of each lever beside its finest
    grids = [claim for claim in claims if claim.text.startswith("error of u(z), cells")]
    assert {claim.verdict for claim in grids} == {Verdict.REPRODUCED} and "80 s, 1125 s" in grids[0].text
    assert sum("the cheapest within 1 %" in claim.text for claim in grids) == 1
    coarse = next(claim for claim in claims if claim.text.startswith("error of u(z), dt = 0.08"))
    assert coarse.verdict is Verdict.NOT_REPRODUCED


def test_the_figure_is_drawn_with_and_without_settings(campaign):
    rows = rows_of(campaign)
    figure = levers.draw(campaign, rows)
    left, middle, _ = figure.axes
    assert len(left.texts) == 4 and {text.get_text() for text in middle.get_legend().get_texts()} == {"dt", "cells"}
    assert np.array_equal(np.sort([float(t.get_text()) for t in left.texts]), [0.02, 0.08, 40, 75])
    assert levers.draw(campaign, rows[:1]).axes[1].get_legend() is None
