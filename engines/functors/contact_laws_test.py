"""The registry of contact laws in Python: names, constants, terms and critical time steps."""

import math

import pytest
from disks import engines
from graindrive.scenes.material import HertzHistoryMaterial

LAWS = engines.contact_laws()


@pytest.mark.parametrize("law", LAWS)
def test_grain_loop_takes_every_law_and_every_number_that_it_is_given(law):
    loop = engines.GrainLoop(law=law)
    for name, (symbol, unit, rule) in LAWS[law].items():
        assert isinstance(getattr(loop, name), float)
        documented = getattr(engines.GrainLoop, name).__doc__
        assert f"{symbol} [{unit}]" in documented and law in documented
        with pytest.raises(ValueError, match=f"GrainLoop.{name} must .*, got -2"):
            engines.GrainLoop(law=law, **{name: -2.0})
        assert " must " in rule


def test_an_unknown_law_is_refused_with_the_names_of_all():
    with pytest.raises(ValueError, match="got mindlin") as refused:
        engines.GrainLoop(law="mindlin")
    assert all(f"'{name}'" in str(refused.value) for name in LAWS)


def test_our_functors_have_the_numbers_of_their_law():
    for functor, law in engines.law_functors().items():
        made = getattr(engines, functor)()
        assert set(LAWS[law]) < set(made.dict())


def test_terms_are_those_of_hertz():
    k_n, k_t, gamma_n, gamma_t, radius, mass, overlap = 2e6, 2.46e6, 300.0, 200.0, 0.25, 0.4, 1e-2
    given = dict(normalStiffness=k_n, tangentialStiffness=k_t, normalDamping=gamma_n, tangentialDamping=gamma_t)
    hertz = math.sqrt(radius * overlap)
    assert engines.terms_of_law("hertzHistory", given, overlap, radius, mass) == pytest.approx(
        dict(
            elastic=k_n * hertz * overlap,
            energy=0.4 * k_n * hertz * overlap**2,
            stiffness=1.5 * k_n * hertz,
            dashpot=gamma_n * mass * hertz,
            tangential_stiffness=k_t * hertz,
            tangential_dashpot=gamma_t * mass * hertz,
        ),
        rel=1e-14,
    )
    with pytest.raises(ValueError, match="normal stiffness must be positive .Pa., got -1"):
        engines.terms_of_law("hertzHistory", dict(given, normalStiffness=-1.0), overlap, radius, mass)


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_material_bears_the_step_of_its_stiffer_direction(friction):
    radius, overlap, density, k_n, k_t = 0.4, 0.1, 1.5, 2e6, 2.46e6
    material = HertzHistoryMaterial(k_n, k_t, 0.0, 0.0, friction, density)
    mass, hertz = density * math.pi * radius**2, math.sqrt(radius / 2 * overlap * radius)
    normal, sliding = 2 * math.sqrt(mass / 2 / (1.5 * k_n * hertz)), 2 * math.sqrt(mass / 6 / (k_t * hertz))
    expected = min(normal, sliding) if friction else normal
    assert material.critical_time_step(radius, overlap) == pytest.approx(expected, rel=1e-14)
    assert material.force_between(radius, overlap) == pytest.approx(k_n * hertz * overlap * radius, rel=1e-14)
