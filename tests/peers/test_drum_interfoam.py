"""The half full drum of a Newtonian fluid in our continuum and in OpenFOAM's interFoam (Debian's `openfoam`).

Both are of first order at the wall and at the surface, so 40 squares across give errors of several percent; its decrease
is shown by `scripts/bench --scene drum_newtonian`.
"""

import numpy as np
import pytest

from graindrive.benchmark import drum_newtonian, interfoam

pytestmark = pytest.mark.skipif(not interfoam.available(), reason="needs interFoam: apt-get install openfoam")

CELLS, STEP = 40, 0.2
OFF = 0.07  # of u(z): half a cell, 0.025 R, times a mean du/dz of 1.2 Omega R, over a mean |u| of 0.4


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    """The results of both codes on the same squares."""
    numbers = drum_newtonian.drum()
    other = drum_newtonian.theirs(numbers, CELLS, 2 * STEP, drum_newtonian.END, tmp_path_factory.mktemp("drum"))
    return drum_newtonian.ours(numbers, CELLS, STEP, drum_newtonian.END), other


def test_both_find_the_velocity_of_the_closed_form(both):
    for found in both:
        assert found.error < OFF


def test_velocities_are_the_same_within_the_errors_of_both(both):
    own, other = both
    assert drum_newtonian.difference(own.u, other.u) < 2 * OFF


def test_the_surface_stands_at_the_same_angle(both):
    """Away from the contact lines the pressure of the flow bears the surface, so the angle has the error of u(z)."""
    own, other = both
    assert 0 < own.angle and abs(own.angle / other.angle - 1) < 2 * OFF


def test_the_drum_holds_the_bed_in_both(both):
    """At a level surface the wall's stress is 4 eta Omega/(pi sin theta), so that its torque grows with the logarithm of
    the smallest angle that is resolved, (8/pi) eta Omega ln(2/epsilon). In our code this is the wall's transition, two cells; in
    interFoam a part of a cell, and there the wall drags a film up, sqrt(nu Omega R/g) = 0.02 or 0.4 cells thick.
    """
    spacing = 2 / CELLS
    low, high = (8 / np.pi * 0.02**2 * np.log(2 / cut) for cut in (2 * spacing, spacing / 16))
    own, other = both
    assert low < own.torque < other.torque < high


def test_the_comparison_can_fail(tmp_path):
    """A gas as viscous as the fluid keeps the surface at rest by symmetry, so u(z) differs from the closed form in both codes.

    The gas has half the fluid's density, because interFoam is unstable with a light and viscous gas at this time step.
    """
    numbers = drum_newtonian.drum(viscosity_ratio=1.0, density_ratio=2.0)
    own = drum_newtonian.ours(numbers, 28, 0.2, 30.0)
    other = drum_newtonian.theirs(numbers, 28, 0.2, 30.0, tmp_path)
    for found in (own, other):
        assert found.error > 0.3
        assert abs(found.u[0]) < 0.15


def test_meshes_of_odd_numbers_of_squares_are_refused():
    with pytest.raises(ValueError, match="even number from 4 on, got 41"):
        interfoam.Mesh(1.0, 41)


def test_a_mesh_covers_the_drum_and_its_wall_lets_through_nothing_in_sum():
    mesh = interfoam.Mesh(2.0, 40)
    assert mesh.inside.sum() * mesh.spacing**2 == pytest.approx(
        np.pi * 4, rel=0.01
    )  # Gauss's circle problem: error < cells
    inner = len(mesh.faces["between"])
    assert 4 * mesh.inside.sum() == 2 * inner + len(
        mesh.faces["wall"]
    )  # every side of a square is counted once, or twice
    assert np.abs(mesh.walls.sum(axis=0)).max() < 1e-12


def test_a_run_that_fails_says_why(tmp_path):
    interfoam.write(tmp_path, drum_newtonian.drum(), 8, 0.1, 0.1)
    (tmp_path / "constant/g").unlink()
    with pytest.raises(RuntimeError, match="interFoam failed"):
        interfoam.run(tmp_path)
