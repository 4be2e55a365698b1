/// Polygon integrals as sums over the triangles between one point and each edge (Green's theorem).
#include "engines/shapes/solid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engines/shapes/straighten.hpp"

namespace graindrive::shapes {

namespace {

constexpr Real rounding = 2e-7;  // over the extent: error of coordinates with six digits [-]

Solid disk_solid(const Outline& outline)
{
	const Real r = outline.disk_radius();
	return { pi * r * r, outline.origin(), r * r / 2, Vector2r::Zero() };
}

struct Sums {
	Real area = 0;
	Vector2r first = Vector2r::Zero();
	Real polar = 0;
};

/// Integrals of 1, r and r^2 over the polygon, with r measured from `point`.
Sums integrals(const Points& corners, const Vector2r& point)
{
	Sums sums;
	for (std::size_t i = 0; i < corners.size(); ++i) {
		const Vector2r a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
		const Real triangle = cross(a, b) / 2;
		sums.area += triangle;
		sums.first += triangle * (a + b) / 3;
		sums.polar += triangle * (a.squaredNorm() + a.dot(b) + b.squaredNorm()) / 6;
	}
	return sums;
}

bool is_vertical(const Vector2r& edge, Real extent)
{
	return std::abs(edge.x()) <= std::min(2 * rounding * extent, std::abs(edge.y()) / 2);
}

/// True at a corner where the outline turns back along x, and at both ends of a vertical edge.
bool is_vertical_at(const Vector2r& before, const Vector2r& here, const Vector2r& after, Real extent)
{
	return is_vertical(before - here, extent) || is_vertical(after - here, extent) ||
	       (before.x() > here.x()) == (after.x() > here.x());
}

}  // namespace

/// Integrates twice, first about a corner, then about the centroid, where round-off is smaller: the second moment about the
/// centroid would otherwise be a difference of two larger numbers.
Solid solid_of(const Outline& outline)
{
	if (outline.is_disk()) return disk_solid(outline);
	const Points& corners = outline.corners();
	const Sums about_corner = integrals(corners, corners[0]);
	const Vector2r centre = corners[0] + about_corner.first / about_corner.area;
	const Sums about_centre = integrals(corners, centre);
	const Vector2r rest = about_centre.first / about_centre.area;
	const Vector2r from_origin = centre + rest;
	return { about_centre.area, outline.origin() + from_origin, about_centre.polar / about_centre.area - rest.squaredNorm(),
		from_origin };
}

Real fall_height(const Outline& outline)
{
	if (outline.is_disk()) return outline.disk_radius();
	const Real extent = outline.extent();
	const Points v = straightened(outline.corners(), rounding * extent);
	Real top = v[0].y(), lowest = std::numeric_limits<Real>::infinity();
	for (std::size_t i = 0, n = v.size(); i < n; ++i) {
		top = std::max(top, v[i].y());
		if (is_vertical_at(v[(i + n - 1) % n], v[i], v[(i + 1) % n], extent)) lowest = std::min(lowest, v[i].y());
	}
	return top - lowest;
}

}  // namespace graindrive::shapes
