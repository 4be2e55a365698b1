"""Resistive-force theory (RFT): the forces on a body as the sum of those on plates that are tilted as its surface is.

A plate whose centre lies |z| below the surface, dragged sideways, meets the force alpha(beta) |z| per area (Li, Zhang, Goldman,
Science 339, 1408 (2013), with gamma = 0: all elements move horizontally). alpha_x acts against the motion and alpha_z upwards,
in N/m^3. The tilt beta is counted from the horizontal; it is > 0 where the leading face, the one that meets the grains,
looks down. Sums of plates for drag and lift: Ding, Gravish, Goldman, Phys. Rev. Lett. 106, 028001 (2011).

The published form makes all stress grow with |z|. `as_split` does it for the part alone that may: turned upside down, a bed under
a uniform pressure is the same bed, so what grows with pressure has alpha_z odd and alpha_x even in beta. The other part comes,
to first order, from the gradient of the pressure, which is the same at all depths.

RFT misleads where an element is shielded by the one before it, at faces along the motion, which it takes for free of force, and
at bodies not much larger than a grain.
"""

from dataclasses import dataclass

import numpy as np

HALF_TURN = np.pi
FORWARD = 1e-6  # least component of a leading face's normal along the motion


@dataclass(frozen=True)
class Elements:
    """Flat strips of a surface, (m,) each: tilt `beta` [rad], `length` [m] across y, middle `z` [m] above the axis."""

    beta: np.ndarray
    length: np.ndarray
    z: np.ndarray


@dataclass(frozen=True)
class Plates:
    """What plates of tilts `beta` (n,) [rad], rising, meet at `depth` [m].

    `alpha` and `error` [N/m^3] have shape (2, n): against the motion, upwards.
    """

    beta: np.ndarray
    alpha: np.ndarray
    error: np.ndarray
    depth: float


# ---- surfaces --------------------------------------------------------------------------------------------------------


def folded(angle):
    """Return angles of lines [rad] within (-pi/2, pi/2]."""
    return HALF_TURN / 2 - np.mod(HALF_TURN / 2 - np.asarray(angle, dtype=float), HALF_TURN)


def leading_elements(outline):
    """Return the `Elements` of a closed outline (m, 2), x forward and z up, whose normals point forward."""
    corners = np.asarray(outline, dtype=float)
    x, z = corners.T
    if np.sum(x * np.roll(z, -1) - np.roll(x, -1) * z) < 0:
        corners = corners[::-1]  # counter-clockwise, so that the outward normal is (t_z, -t_x)
    following = np.roll(corners, -1, axis=0)
    along = following - corners
    length = np.hypot(*along.T)
    leading = along[:, 1] > FORWARD * length
    middle = (0.5 * (corners + following))[leading, 1]
    return Elements(folded(np.arctan2(along[leading, 1], along[leading, 0])), length[leading], middle)


def circle(diameter, parts=360):
    """Return corners (parts, 2) of a polygon with the circumference of a circle; with `parts` even, half of its sides lead."""
    angle = np.pi / 2 + np.arange(parts) * 2 * np.pi / parts
    radius = diameter / 2 * (np.pi / parts) / np.sin(np.pi / parts)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def longest_edge(outline):
    """Return (tilt [rad], length) of the longest edge of an outline (m, 2): those of a thin plate."""
    along = np.roll(outline, -1, axis=0) - outline
    dx, dz = along[np.argmax(np.hypot(*along.T))]
    return float(folded(np.arctan2(dz, dx))), float(np.hypot(dx, dz))


# ---- alpha between the plates ----------------------------------------------------------------------------------------


def linear(beta, plates):
    """Return weights (m, n): alpha at `beta` (m,) is their product with that of the plates, linear in between, period pi."""
    tilts = plates.beta
    nodes = np.concatenate([[tilts[-1] - HALF_TURN], tilts, [tilts[0] + HALF_TURN]])
    columns = np.eye(len(tilts))[np.r_[-1, : len(tilts), 0]]
    return np.column_stack([np.interp(beta, nodes, column) for column in columns.T])


TERMS = 3  # of `fourier_terms`


def fourier_terms(beta):
    """Return (m, 3) the terms at `beta` (m,) that are left of Li's sum where gamma = 0: 1, cos 2 beta, sin 2 beta.

    alpha_z = sum_{m=-1..1, n=0..1} A_mn cos 2 pi(m beta/pi + n gamma/2 pi) + B_mn sin 2 pi(m beta/pi + n gamma/2 pi), and alpha_x
    with C_mn and D_mn. At gamma = 0: alpha_z = A_00 + A_10 cos 2 beta + (B_11 - B_-11) sin 2 beta and
    alpha_x = C_01 + (C_11 + C_-11) cos 2 beta + D_10 sin 2 beta with the terms that Li et al. keep.
    """
    return np.column_stack([np.ones_like(beta), np.cos(2 * beta), np.sin(2 * beta)])


def fourier(beta, plates):
    """Return weights (m, n) as `linear` does, of the least-squares fit of `fourier_terms` to plates of equal weight."""
    return fourier_terms(np.asarray(beta)) @ np.linalg.pinv(fourier_terms(plates.beta))


def misfit(plates):
    """Return chi^2 over its degrees of freedom (2,) of the Fourier fits, of alpha_x and alpha_z, weighted by errors."""
    found = []
    for alpha, error in zip(plates.alpha, plates.error):
        terms = fourier_terms(plates.beta) / error[:, None]
        rest = alpha / error - terms @ np.linalg.lstsq(terms, alpha / error, rcond=None)[0]
        found.append(float(np.sum(rest**2)) / (len(alpha) - terms.shape[1]))
    return np.array(found)


# ---- the sum ---------------------------------------------------------------------------------------------------------


def mirror(plates):
    """Return the matrix (n, n) that gives each plate what the plate of the opposite tilt meets.

    ValueError unless there is one of each.
    """
    apart = np.abs(folded(plates.beta[:, None] + plates.beta))
    apart = np.minimum(apart, HALF_TURN - apart)
    if np.any(apart.min(axis=1) > 1e-3):
        lonely = np.degrees(plates.beta[np.argmax(apart.min(axis=1))])
        raise ValueError(
            f"plates must come in pairs of opposite tilts, there is none opposite {lonely:.3g} degrees; add it"
        )
    return np.eye(len(plates.beta))[np.argmin(apart, axis=1)]


def as_published(elements, plates, depth, weights=linear):
    """Return rows (2, n) whose products with alpha_x and alpha_z are the forces per breadth [N/m]: alpha(beta) |z| over the body.

    The body's axis lies `depth` [m] below the surface.
    """
    row = elements.length * (depth - elements.z) @ weights(elements.beta, plates)
    return np.array([row, row])


def as_split(elements, plates, depth, weights=linear):
    """Return rows as `as_published` does: what is even (x) or odd (z) in beta grows with |z|, the rest stays as at the plates."""
    turned, same = mirror(plates), np.eye(len(plates.beta))
    by_weight = weights(elements.beta, plates)
    growing, fixed = elements.length * (depth - elements.z) @ by_weight, elements.length * plates.depth @ by_weight
    return np.array([0.5 * (growing @ (same + s * turned) + fixed @ (same - s * turned)) for s in (1, -1)])


def force(rows, plates):
    """Return forces per breadth [N/m], (2,) against the motion and upwards, and their errors, of rows as above."""
    return np.sum(rows * plates.alpha, axis=1), np.sqrt(np.sum((rows * plates.error) ** 2, axis=1))
