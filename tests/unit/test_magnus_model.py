"""The model of the saturated lift, and means of forces over the steady state, against closed forms."""

import numpy as np
import pytest

from graindrive.postproc.magnus import forces, model

THETA = (np.arange(24) + 0.5) * np.pi / 12 - np.pi


def slipping(normal, mu):
    """Drag, lift and the normal forces' drag of contacts that all slip clockwise, spread evenly in each bin (Eqs 10, 11)."""
    edges = THETA - np.pi / 24, THETA + np.pi / 24
    cosine = (np.sin(edges[1]) - np.sin(edges[0])) * 12 / np.pi
    sine = -(np.cos(edges[1]) - np.cos(edges[0])) * 12 / np.pi
    return normal @ (cosine - mu * sine), normal @ (sine + mu * cosine), normal @ cosine


@pytest.mark.parametrize("mu", [0.1, 0.5, 1.2])
def test_equations_14_and_15_give_the_lift_of_any_distribution_that_slips(mu):
    normal = np.random.default_rng(1).uniform(0, 1, 24) * (np.abs(THETA) < np.pi / 2) * (1.5 - np.sign(THETA))
    drag, lift, pressing = slipping(normal, mu)
    kappa = pressing / drag
    assert kappa < 1
    assert model.saturated_lift_to_drag(kappa, mu) == pytest.approx(lift / drag, rel=1e-12)


def test_a_symmetric_distribution_gives_mu():
    normal = np.cos(THETA) * (np.abs(THETA) < np.pi / 2)
    drag, lift, pressing = slipping(normal, 0.5)
    assert pressing / drag == pytest.approx(1, rel=1e-12)
    assert lift / drag == pytest.approx(model.symmetric_lift_to_drag(0.5), rel=1e-12)


def test_the_papers_kappas_give_its_saturation():
    assert model.saturated_lift_to_drag(0.95, 0.5) == pytest.approx(0.375, rel=1e-12)
    assert model.saturated_lift_to_drag(0.90, 0.5) == pytest.approx(0.25, rel=1e-12)
    assert model.saturated_lift_to_drag(1.0, 0.0) == 0


def series(n, mu=0.5, seed=2):
    """Block means of a body whose contacts all slip, with normal forces that fluctuate from block to block."""
    rng = np.random.default_rng(seed)
    shape = (1 - 0.3 * np.sin(THETA)) * np.cos(THETA) * (np.abs(THETA) < np.pi / 2)
    normal = rng.exponential(1.0, (n, 1)) * shape * rng.uniform(0.5, 1.5, (n, 24))
    drag, lift, pressing = np.array([slipping(row, mu) for row in normal]).T
    touching = (normal > 0).astype(float)
    zeros = np.zeros(n)
    found = dict(t=np.arange(n) + 1.0, travel=0.1 * (np.arange(n) + 1), x=zeros, fx=-drag, fy=-lift, torque=zeros)
    found.update(normal_x=-pressing, phi=zeros + 0.8)
    found.update(contacts=touching.sum(axis=1), slipping=touching.sum(axis=1), contacts_var=zeros)
    found.update(fx_var=zeros + 4.0, fy_var=zeros)
    return {
        **found,
        "normal": normal,
        "tangential": -mu * normal,
        "contacts_by_angle": touching,
        "slipping_by_angle": touching,
    }


def test_measured_kappa_gives_back_lift_over_drag_when_all_slips():
    found = forces.steady_state(series(2000), 30, 0.5, 5.0).summary
    assert found["model_kappa"] == pytest.approx(found["lift_to_drag"], rel=1e-10)
    assert found["model_kappa_err"] == pytest.approx(found["lift_to_drag_err"], rel=0.02)  # linear in the same ratio
    assert found["slipping_share"] == 1 and found["front_share"] == 1
    assert found["slipping_share_err"] == found["front_share_err"] == 0
    assert found["steady"] == 1 and found["steady_from"] == pytest.approx(30.1)


def test_lift_follows_the_spin_and_fluctuations_add_up():
    rows = series(2000)
    up = forces.steady_state(rows, 30, 0.5, 5.0).summary
    down = forces.steady_state({**rows, "fy": -rows["fy"]}, 30, 0.5, -5.0).summary
    assert up["lift"] == down["lift"] > 0
    kept = rows["fx"][300:]
    assert up["drag_std"] == pytest.approx(np.sqrt(4 + kept.var()), rel=1e-12)


def test_mobilised_friction_is_one_where_all_slips_and_unknown_where_nothing_presses():
    angular = forces.steady_state(series(500), 0, 0.5, 5.0).angular
    mobilised = angular["mobilised"][0]
    front = np.abs(THETA) < np.pi / 2
    assert np.allclose(mobilised[front], -1) and np.isnan(mobilised[~front]).all()
    assert (angular["mobilised_err"][0][front] == 0).all(), "the same in every block"


def test_contacts_that_pull_while_they_slip_mobilise_more_than_all():
    """Of the sum of |F_N| the share p pulls: F_T/(mu F_N) of the sums is 1/(1 - 2p)."""
    rows, pull = series(500), 0.02
    mobilised = forces.steady_state({**rows, "normal": (1 - 2 * pull) * rows["normal"]}, 0, 0.5, 5.0).angular[
        "mobilised"
    ][0]
    assert mobilised[np.abs(THETA) < np.pi / 2] == pytest.approx(-1 / (1 - 2 * pull), rel=1e-12)


def test_a_drifting_series_is_not_steady():
    rows = series(2000)
    drifting = {**rows, "fx": rows["fx"] * np.linspace(3, 1, 2000)}
    assert forces.steady_state(drifting, 0, 0.5, 5.0).summary["steady"] == 0
