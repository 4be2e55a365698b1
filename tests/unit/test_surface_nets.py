"""Meshes of solids that are given by a distance function: closed, on the surface, with the solid's volume."""

import numpy as np

from graindrive.solids import surface_nets, surfaces


def volume(points, quads):
    """Volume within a closed mesh of quads, > 0 if they are seen counter-clockwise from outside."""
    a, b, c, d = (points[quads[:, k]] for k in range(4))
    triangles = np.sum(a * np.cross(b, c), axis=1) + np.sum(a * np.cross(c, d), axis=1)
    return triangles.sum() / 6


def sides_of(quads):
    return np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)])


def test_a_ball_gets_a_closed_mesh_on_its_surface():
    ball = surfaces.ball((0.3, -0.2, 0.1), 0.5)
    points, quads = surface_nets.mesh(ball, (-0.2, -0.7, -0.4), (0.8, 0.3, 0.6))
    assert np.abs(ball.distance(points)).max() < 1e-12  # a step along the normal of a ball ends on it
    sides = sides_of(quads)
    assert len(np.unique(sides, axis=0)) == len(sides)
    assert {tuple(side) for side in sides} == {(b, a) for a, b in sides}, "each side has one quad on either hand"
    # Flat facets of size h lie inside by h^2/(8 R): the volume lacks about 3 h^2/(8 R^2) of a 48th of the diameter, 0.1 %.
    assert np.isclose(volume(points, quads), 4 / 3 * np.pi * 0.5**3, rtol=2e-3)


def test_a_box_in_a_box_that_is_no_cube_keeps_its_volume_but_for_its_edges():
    brick = surfaces.swept_outline([(-1, -0.5), (1, -0.5), (1, 0.5), (-1, 0.5)], low=-0.25, high=0.25)
    points, quads = surface_nets.mesh(brick, (-1, -0.5, -0.25), (1, 0.5, 0.25))
    assert np.isclose(volume(points, quads), 1.0, rtol=0.05)  # edges are rounded by 2/48
    assert (np.abs(points) <= np.array([1, 0.5, 0.25]) + 1e-9).all()


def test_what_is_not_there_gets_no_mesh():
    points, quads = surface_nets.mesh(surfaces.ball((0, 0, 0), 1e-3), (1, 1, 1), (2, 2, 2))
    assert points.shape == (0, 3) and quads.shape == (0, 4)
