"""The report of a lift campaign: verdicts on made-up tables that agree with the paper, and on ones that do not."""

import numpy as np
import pandas as pd
import pytest

from graindrive.postproc.campaign.verdicts import Verdict
from graindrive.postproc.lift import claims


def table(lift_deep, lift_bare, drag=10.0):
    """Runs at 3, 9, 15, 20 D with weight in the bulk, and at 15, 20 D without."""
    depth = np.array([3.0, 9, 15, 20, 15, 20])
    bulk = np.array([True, True, True, True, False, False])
    lift = np.where(bulk, np.where(depth < 12, lift_deep * depth / 15, lift_deep), lift_bare)
    n = len(depth)
    return pd.DataFrame(
        dict(
            run=[f"run{k}" for k in range(n)],
            bulk_gravity=bulk,
            lid_density=[0, 0, 40, 60, 40, 60],
            depth=30.0,
            cylinder_diameter=3.3,
            depth_over_d=depth,
            drag_coefficient=drag,
            drag_coefficient_err=0.2,
            lift_over_buoyancy=lift,
            lift_over_buoyancy_err=1.0,
        )
    )


def verdicts(rows):
    return [claim.verdict for claim in claims.depth_claims(None, rows)]


def test_the_papers_numbers_are_reproduced():
    assert verdicts(table(30.0, 0.0)) == [Verdict.REPRODUCED] * 6


@pytest.mark.parametrize(
    "rows, wrong",
    [
        (table(2.0, 0.0), [3]),  # an Archimedean lift
        (table(30.0, 30.0), [4]),  # a lift without a gradient of pressure
        (table(30.0, 0.0, drag=3.0), [0, 1]),
        (table(-30.0, 0.0), [3, 5]),
    ],
    ids=["small", "everywhere", "drag", "down"],
)
def test_other_numbers_are_not(rows, wrong):
    assert [k for k, verdict in enumerate(verdicts(rows)) if verdict is Verdict.NOT_REPRODUCED] == wrong


def test_what_was_not_run_decides_nothing():
    rows = table(30.0, 0.0)
    found = verdicts(rows[rows["bulk_gravity"]])
    assert found[0] is Verdict.REPRODUCED and found[1] is found[2] is found[4] is Verdict.NOT_DECIDED


class MadeUp:
    """A campaign whose runs have stresses of a cosine plus a part of the weight, 3 rho g D sin(theta), at the front."""

    theta = (np.arange(64) + 0.5) * 2 * np.pi / 64 - np.pi

    def __init__(self, rows):
        self.rows = rows.set_index("run")

    def run(self, name):
        row, front = self.rows.loc[name], np.cos(self.theta).clip(0)
        weight = 3 * np.sin(self.theta) * front * row["pressure"] / row["depth_over_d"] if row["bulk_gravity"] else 0
        stress = 15 * front * row["pressure"] + weight
        return type("Run", (), {"group": lambda _self, _name: dict(theta=self.theta, normal_stress=stress)})()


def test_what_weight_adds_to_the_stress_is_the_same_at_all_depths():
    rows = table(30.0, 0.0).assign(pressure=lambda t: 50.0 * t["depth_over_d"])
    found = list(claims.differences(MadeUp(rows), rows))
    assert [depth for depth, *_ in found] == [3, 9, 15, 20]
    for _, theta, difference in found:
        assert np.allclose(difference, 3 * np.sin(theta) * np.cos(theta).clip(0), atol=1e-12)
    asymmetry = claims.asymmetry(MadeUp(rows), rows)
    inside = theta[(theta > 0) & (theta < claims.FRONT)]
    assert asymmetry.value == pytest.approx(2 * (3 * np.sin(inside) * np.cos(inside)).mean())
