"""The claims of a shear campaign on made-up runs of known laws: right laws are reproduced, wrong laws are not."""

import json

import numpy as np
import pytest
from made_up_runs import write_run

from graindrive.postproc.campaign.folder import Campaign
from graindrive.postproc.campaign.verdicts import Verdict
from graindrive.postproc.measured import Measured
from graindrive.postproc.shear import da_cruz, friction, held_area
from graindrive.postproc.shear.rheology import friction_law

KEYS = dict(area_fraction=0.0, shear_rate=1.0, inertial_number=0.1, pressure=25.0, friction=0.5, restitution=0.92)
KEYS.update(grains=400, stiffness=2e5, seed=1)
PAPER = dict(mu_s=0.246, mu_2=0.401, i_0=0.133)
STIFF = dict(mu_s=0.25, mu_2=0.7, i_0=0.3)
REPRODUCED, NOT, UNDECIDED = Verdict.REPRODUCED, Verdict.NOT_REPRODUCED, Verdict.NOT_DECIDED


def summary(inertial, ratio, phi, pressure):
    """The numbers of a run: exact values with errors of a usual size."""
    values = dict(flow_inertial_number=inertial, stress_ratio=ratio, phi=phi, mean_pressure=pressure)
    errors = dict(flow_inertial_number=1e-6, stress_ratio=0.001, phi=5e-4, mean_pressure=0.002 * pressure)
    return {**values, **{f"{name}_err": error for name, error in errors.items()}}


def made(folder, law=STIFF, held=PAPER, soft=None, gas=1.0):
    """Make a campaign whose mu(I) is `law` up to 0.2 and `gas` times it beyond, and `held` at constant area fraction.

    The soft sweep has mu falling linearly with phi, from the law's value at phi = 0.79 to `soft`, else that of `held`, at 0.825.
    """
    runs = []

    def add(sweep, keys, found):
        keys = {**KEYS, **keys}
        name = f"{sweep}-{len(runs)}"
        write_run(folder, name, keys, found, {}, study="shear")
        runs.append(dict(name=name, sweeps=[sweep]))

    for inertial in (0.001, 0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5):
        ratio = friction_law(inertial, **law) * (gas if inertial > 0.2 else 1)
        add("rheology", dict(inertial_number=inertial), summary(inertial, ratio, 0.81 - 0.3 * inertial, 25.0))
    for rate, inertial, pressure in (
        (0.5, 0.016, 1000),
        (1, 0.03, 1300),
        (2, 0.05, 1700),
        (5, 0.095, 2800),
        (10, 0.15, 4300),
        (20, 0.25, 6500),
    ):
        found = summary(inertial, friction_law(inertial, **held), 0.825, float(pressure))
        add("constant", dict(area_fraction=0.825, shear_rate=float(rate)), found)
    low, high = friction_law(0.1, **law), friction_law(0.1, **held) if soft is None else soft
    for pressure, phi in ((25.0, 0.79), (100.0, 0.791)):
        add("stiffness", dict(pressure=pressure), summary(0.1, low, phi, pressure))
    for pressure, phi in ((1600.0, 0.80), (3200.0, 0.82), (6400.0, 0.84)):
        ratio = low + (phi - 0.79) / 0.035 * (high - low)
        add("soft", dict(pressure=pressure), summary(0.1, ratio, phi, pressure))
    for inertial in (0.01, 0.02, 0.05, 0.1):
        theirs = da_cruz.BY_MASS * inertial
        keys = dict(friction=0.4, restitution=0.1, inertial_number=inertial)
        add("da_cruz", keys, summary(inertial, 0.25 + 1.1 * theirs, 0.81 - 0.3 * theirs, 25.0))
    plan = dict(name="shear", file="campaigns/x.yaml", study="shear", report="shear", runs=runs)
    (folder / "campaign.json").write_text(json.dumps(plan))
    return Campaign.of(folder)


def verdicts(claims, campaign, sweep):
    """Return the verdicts of a figure's claims."""
    return [claim.verdict for claim in claims(campaign, campaign.sweep(sweep))]


def test_constants_are_those_of_the_dense_flow_whatever_the_gas_does(tmp_path):
    campaign = made(tmp_path, law=PAPER, gas=0.8)
    assert verdicts(friction.claims, campaign, "rheology")[:5] == [REPRODUCED] * 4 + [NOT]
    found = friction.law_of(friction.up_to(campaign.sweep("rheology"), 0.2))
    assert found.mu_2.value == pytest.approx(0.401, abs=1e-3) and found.chi_squared < 0.1


def test_the_paper_s_constants_are_found_at_its_area_fraction_and_not_at_constant_pressure(tmp_path):
    campaign = made(tmp_path)
    assert verdicts(friction.claims, campaign, "rheology")[1:3] == [NOT, NOT]
    assert NOT not in verdicts(held_area.claims, campaign, "constant")


@pytest.mark.parametrize(
    "changes, which, verdict",
    [(dict(soft=0.40), -2, NOT), (dict(held=STIFF), -1, UNDECIDED), (dict(held=STIFF), 3, NOT)],
)
def test_another_reason_would_be_told(tmp_path, changes, which, verdict):
    """Claims fail if soft grains have other friction than grains at constant area, or if those have that of stiff grains."""
    campaign = made(tmp_path, **changes)
    assert verdicts(held_area.claims, campaign, "constant")[which] == verdict


def test_the_lines_of_da_cruz_are_found_with_their_inertial_number(tmp_path):
    campaign = made(tmp_path)
    claims = da_cruz.claims(campaign, campaign.sweep("da_cruz"))
    values = [claim.measured.value for claim in claims[:4]]
    assert values == pytest.approx([0.25, 1.1, 0.81, -0.3], rel=1e-9)
    assert [claim.verdict for claim in claims[:4]] == [REPRODUCED] * 4
    assert len(claims) == 8


def test_their_inertial_number_has_the_mean_mass_of_a_disk():
    diameters = np.random.default_rng(1).uniform(1, 1.2, 10**6)
    assert da_cruz.BY_MASS == pytest.approx(
        np.sqrt(np.pi / 4 * np.mean(diameters**2)), rel=3e-4
    )  # as of a million disks


def test_a_place_between_two_points():
    x, y = [Measured(0.0, 0.1), Measured(2.0, 0.1)], [Measured(1.0, 0.2), Measured(2.0, 0.2)]
    found = held_area.through(1.0, x, y)
    assert found.value == pytest.approx(1.5)
    assert found.error == pytest.approx(np.hypot(0.2, 0.5 * 0.1) / np.sqrt(2))
    assert np.isnan(held_area.through(3.0, x, y).value)
