/// Kernels of spheres integrated over a whole axis, in closed form: what fields averaged along that axis are made of.
///
/// Distances rho are those across the axis; lines are given by their shadows in the plane across it, so that from, branch and point have the
/// same coordinate along the axis. A shadow may be a single point: the line is then along the axis.
#pragma once
#include "engines/base/real.hpp"

namespace graindrive {

/// int V(sqrt(rho^2 + y^2)) dy, V the volume that two spheres have in common and rho their distance across the axis [m^4].
///
/// V is a polynomial in t = sqrt(rho^2 + y^2) and 1/t (ball_overlap.hpp), whose powers integrate to y t, rho^2 and ln(y + t).
/// Exact to round-off of its greatest value, not of itself: next to a touch it may be zero instead.
Real sphere_overlap_along_axis(Real r, Real big_r, Real rho);

/// int exp(-(rho^2 + y^2)/w^2) dy over |y| < sqrt(c^2 w^2 - rho^2): sqrt(pi) w exp(-q) erf(sqrt(c^2 - q)), q = rho^2/w^2 [m].
Real gaussian_along_axis(Real square_rho, Real width, Real cutoff);

/// Mean over a line of the chord along the axis, 2 sqrt(R^2 - rho^2) [m]: the area of a circle's part between two parallel lines.
Real mean_chord_along_axis(const Vector3r& from, const Vector3r& branch, const Vector3r& point, Real radius);

/// Mean over a line of `gaussian_along_axis` [m]: a Gaussian over a circle's part between two parallel lines.
///
/// In polar coordinates the part is made of triangles and sectors, and a triangle's integral is Owen's T function (Owen, Ann. Math. Stat. 27,
/// 1075 (1956)).
Real mean_gaussian_along_axis(const Vector3r& from, const Vector3r& branch, const Vector3r& point, Real width, Real cutoff);

}  // namespace graindrive
