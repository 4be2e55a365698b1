"""Resistive-force theory: sums with known values, interpolation exact at measured plates, and the symmetry of a mirrored bed."""

import numpy as np
import pytest

from graindrive.bodies import outlines_for_lift
from graindrive.postproc.lift import rft

TILTS = np.radians([-67.5, -45, -22.5, 0, 22.5, 45, 67.5, 90])
DEPTH, RADIUS = 0.05, 0.0025


def plates(alpha_x, alpha_z, error=0.0):
    """Plates with stresses that are these functions of beta."""
    alpha = np.array([np.broadcast_to(f(TILTS), TILTS.shape) for f in (alpha_x, alpha_z)], dtype=float)
    return rft.Plates(TILTS, alpha, np.full_like(alpha, error), DEPTH)


def constant(value):
    return lambda beta: np.full_like(beta, value)


SUMS = pytest.mark.parametrize("weights", [rft.linear, rft.fourier])


@SUMS
def test_a_constant_stress_on_a_circle_acts_on_half_its_circumference(weights):
    """The force is alpha times pi R times the axis' depth, the mean depth of the leading half; the same for the error."""
    made = plates(constant(3e5), constant(-2e5), error=1e4)
    rows = rft.as_published(rft.leading_elements(rft.circle(2 * RADIUS)), made, DEPTH, weights)
    found, error = rft.force(rows, made)
    assert np.allclose(found, np.pi * RADIUS * DEPTH * np.array([3e5, -2e5]), rtol=1e-12)
    # 1e4 pi R h if all plates had the same error; eight independent errors give less, but at least this over sqrt(8).
    assert np.all(error < 1e4 * np.pi * RADIUS * DEPTH) and np.all(
        error > 1e4 * np.pi * RADIUS * DEPTH / np.sqrt(8.001)
    )


def test_a_stress_along_the_normal_lifts_by_buoyancy():
    """alpha = k n, a pressure k|z| on the leading half: its lift is k times the area, pi R^2/2, its drag k times 2 R h."""
    exact = {2: 2 * RADIUS * DEPTH, 1: np.pi * RADIUS**2 / 2}
    fine = np.linspace(-np.pi / 2, np.pi / 2, 721)[1:]
    made = rft.Plates(fine, np.array([np.abs(np.sin(fine)), np.sign(fine) * np.cos(fine)]), np.zeros((2, 720)), DEPTH)
    found, _ = rft.force(rft.as_published(rft.leading_elements(rft.circle(2 * RADIUS, 720)), made, DEPTH), made)
    # A polygon of 720 sides differs from the circle by (pi/720)^2, two in 1e5; the lift is a difference of large parts.
    assert found == pytest.approx([exact[2], exact[1]], rel=1e-4)


@pytest.mark.parametrize("k", range(8))
def test_a_plate_gives_its_own_force_back(k):
    made = plates(lambda beta: 3e5 + 1e5 * np.cos(beta), lambda beta: 2e5 * np.sin(3 * beta) - 1e4)
    one = rft.Elements(TILTS[k : k + 1], np.array([0.004]), np.array([0.0]))
    for rows in (rft.as_published, rft.as_split):  # at the depth of the plates both forms give the measured values
        found, _ = rft.force(rows(one, made, DEPTH), made)
        assert np.allclose(found, 0.004 * DEPTH * made.alpha[:, k], rtol=1e-12)


def test_the_fourier_fit_gives_its_own_terms_back():
    made = plates(
        lambda beta: 3 + np.cos(2 * beta) - 0.5 * np.sin(2 * beta), lambda beta: 1 + 2 * np.sin(2 * beta), error=0.1
    )
    beta = np.linspace(-1.5, 1.5, 7)
    weights = rft.fourier(beta, made)
    assert np.allclose(weights @ made.alpha[0], 3 + np.cos(2 * beta) - 0.5 * np.sin(2 * beta), atol=1e-12)
    assert np.allclose(rft.misfit(made), 0, atol=1e-20)
    bent = plates(lambda beta: np.cos(4 * beta), lambda beta: np.sin(4 * beta), error=0.1)
    # Orthogonal to all terms: chi^2 is sum cos^2/0.01 = 400 and sum sin^2/0.01 = 400, over 5 degrees of freedom.
    assert rft.misfit(bent) == pytest.approx([80, 80])


def test_linear_interpolation_goes_around():
    made = plates(lambda beta: beta, lambda beta: beta**2)
    middle = np.radians([11.25, -78.75])  # the latter between 90, which is -90, and -67.5
    weights = rft.linear(middle, made)
    assert weights @ made.alpha[0] == pytest.approx([np.radians(11.25), np.radians((90 - 67.5) / 2)])


def test_a_bed_turned_upside_down_lifts_only_by_the_gradient():
    """If alpha_z is odd, the published form has lift from the gradient only; an even part adds a lift that grows with depth."""
    elements = rft.leading_elements(rft.circle(2 * RADIUS))

    def lift(rows, made, depth):
        return rft.force(rows(elements, made, depth), made)[0][1]

    odd = plates(constant(3e5), lambda beta: 2e5 * np.sin(2 * beta))
    assert lift(rft.as_published, odd, DEPTH) == pytest.approx(lift(rft.as_published, odd, 5 * DEPTH), rel=1e-9)
    both = plates(constant(3e5), lambda beta: 2e5 * np.sin(2 * beta) + 1e5)
    more = 1e5 * np.pi * RADIUS * DEPTH
    assert lift(rft.as_published, both, 5 * DEPTH) - lift(rft.as_published, odd, DEPTH) == pytest.approx(5 * more)
    assert lift(rft.as_split, both, 5 * DEPTH) - lift(rft.as_published, odd, DEPTH) == pytest.approx(more)


def test_plates_without_a_mirror_image_are_refused_by_name():
    lonely = rft.Plates(np.radians([0.0, 30, 90]), np.ones((2, 3)), np.zeros((2, 3)), DEPTH)
    with pytest.raises(ValueError, match="none opposite 30 degrees"):
        rft.mirror(lonely)


# ---- outlines --------------------------------------------------------------------------------------------------------


def test_the_stored_outlines_are_those_that_the_module_makes():
    stored = {path.name: path.read_text() for path in outlines_for_lift.FOLDER.glob("*.csv")}
    assert stored == {
        name: outlines_for_lift.text_of(corners) for name, corners in outlines_for_lift.outlines().items()
    }


@pytest.mark.parametrize("tilt", outlines_for_lift.TILTS)
def test_a_plate_leads_with_its_face(tilt):
    """The long edge has the given tilt; for a tilt > 0 the leading face points down: the lower corner is the rear one."""
    outline = outlines_for_lift.plate(tilt)
    beta, length = rft.longest_edge(outline)
    assert (np.degrees(beta), length) == (pytest.approx(tilt), pytest.approx(outlines_for_lift.LENGTH))
    if tilt not in (0, 90):
        elements = rft.leading_elements(outline)
        assert np.degrees(elements.beta[np.argmax(elements.length)]) == pytest.approx(tilt)
        assert (outline[np.argmin(outline[:, 1]), 0] < 0) == (tilt > 0)


def test_the_curved_sides_of_half_cylinders_lead():
    """With the flat side up the front points down, beta is 0 to 90 degrees; with the flat side down it is the opposite."""
    up, down = (rft.leading_elements(outlines_for_lift.half_cylinder(flat_up)) for flat_up in (True, False))
    assert np.all((up.beta > 0) & (up.beta < np.pi / 2)) and np.all((down.beta < 0) & (down.beta > -np.pi / 2))
    quarter = np.pi / 4 * outlines_for_lift.DIAMETER
    assert up.length.sum() == pytest.approx(quarter, rel=1e-3) and down.length.sum() == pytest.approx(quarter, rel=1e-3)
