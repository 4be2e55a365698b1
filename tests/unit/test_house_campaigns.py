"""Every campaign of studies/campaigns can be planned with the present studies: none of its runs is refused."""

from pathlib import Path

import pytest

from graindrive.campaign import plan_file
from graindrive.campaign.plan import read_plan

CAMPAIGNS = sorted((Path(__file__).resolve().parents[2] / "studies" / "campaigns").glob("*.yaml"))


@pytest.mark.parametrize("file", CAMPAIGNS, ids=lambda file: file.stem)
def test_a_campaign_of_the_house_is_accepted(file):
    runs = read_plan(file).runs
    assert {sweep for run in runs for sweep in run.sweeps} == set(plan_file.read_plan_file(file)["sweeps"])
    assert len({run.name for run in runs}) == len({run.parameters.digest() for run in runs}) == len(runs)
