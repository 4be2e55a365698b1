/// Exact overlap of a disk with a rectangle whose sides are parallel to the axes: area and first moment, in closed form.
///
/// Green's theorem: the rectangle's boundary is walked once. What lies inside the disk adds the triangle that it makes with the disk's
/// centre, what lies outside adds the sector that it is seen under. No term is larger than the rectangle's side times the radius, so
/// the area is exact to round-off of that, also for bins much smaller than the disk.
#pragma once
#include <algorithm>
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive {

struct Overlap {
	Real area = 0;                       ///< [m^2]
	Vector2r moment = Vector2r::Zero();  ///< integral of r over the overlap, r from the disk's centre [m^3]
};

namespace overlap_parts {

inline Real cross(const Vector2r& p, const Vector2r& q) { return p[0] * q[1] - p[1] * q[0]; }

/// The triangle (0, p, q): area p x q/2, centroid (p + q)/3.
inline void add_triangle(const Vector2r& p, const Vector2r& q, Overlap& sum)
{
	const Real area = cross(p, q) / 2;
	sum.area += area;
	sum.moment += area / 3 * (p + q);
}

/// The sector from the direction of p to that of q: area r^2 angle/2, moment r^3/3 (sin b - sin a, cos a - cos b).
inline void add_sector(const Vector2r& p, const Vector2r& q, Real radius, Overlap& sum)
{
	const Real angle = std::atan2(cross(p, q), p.dot(q));
	const Vector2r turn = q / q.norm() - p / p.norm();
	sum.area += radius * radius / 2 * angle;
	sum.moment += radius * radius * radius / 3 * Vector2r(turn[1], -turn[0]);
}

/// The straight edge from p to q, cut where it meets the circle.
inline void add_edge(const Vector2r& p, const Vector2r& q, Real radius, Overlap& sum)
{
	const Vector2r along = q - p;
	const Real a = along.squaredNorm(), b = p.dot(along), c = p.squaredNorm() - radius * radius, square = b * b - a * c;
	const Real root = square > 0 ? std::sqrt(square) : 0;
	const Real enters = std::max(Real(0), (-b - root) / a), leaves = std::min(Real(1), (-b + root) / a);
	if (!(enters < leaves)) return add_sector(p, q, radius, sum);
	const Vector2r in = p + enters * along, out = p + leaves * along;
	if (enters > 0) add_sector(p, in, radius, sum);
	add_triangle(in, out, sum);
	if (leaves < 1) add_sector(out, q, radius, sum);
}

}  // namespace overlap_parts

/// Overlap of a disk about the origin with the rectangle from `low` to `high`.
inline Overlap disk_square_overlap(Real radius, const Vector2r& low, const Vector2r& high)
{
	const auto nearest = [](Real a, Real b) { return std::max({ a, -b, Real(0) }); };
	const auto farthest = [](Real a, Real b) { return std::max(-a, b); };
	const Real near_x = nearest(low[0], high[0]), near_y = nearest(low[1], high[1]);
	const Real far_x = farthest(low[0], high[0]), far_y = farthest(low[1], high[1]);
	if (near_x * near_x + near_y * near_y >= radius * radius) return {};
	const Vector2r size = high - low;
	if (far_x * far_x + far_y * far_y <= radius * radius) {
		const Real area = size[0] * size[1];
		return { area, area / 2 * (low + high) };
	}
	Overlap sum;
	const Vector2r corners[4] = { low, { high[0], low[1] }, high, { low[0], high[1] } };
	for (int k = 0; k < 4; ++k) overlap_parts::add_edge(corners[k], corners[(k + 1) % 4], radius, sum);
	// A corner that a disk barely grazes is left to round-off: less than that is nothing.
	return sum.area > 1e-15 * size[0] * size[1] ? sum : Overlap{};
}

}  // namespace graindrive
