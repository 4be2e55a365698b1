/// Polygon integrals as sums over the triangles between the first vertex and each edge (Green's theorem).
#include "engines/shapes/solid.hpp"

#include <algorithm>
#include <limits>

namespace graindrive::shapes {

namespace {

Solid disk_solid(const Outline& outline)
{
	const Real r = outline.disk_radius();
	return { pi * r * r, outline.disk_centre(), r * r / 2 };
}

bool is_vertical_at(const Vector2r& before, const Vector2r& here, const Vector2r& after, Real tolerance)
{
	return (before.x() - here.x()) * (after.x() - here.x()) >= -tolerance;
}

}  // namespace

Solid solid_of(const Outline& outline)
{
	if (outline.is_disk()) return disk_solid(outline);
	const Points& v = outline.vertices();
	Real area = 0, polar = 0;
	Vector2r first = Vector2r::Zero();
	for (std::size_t i = 1; i + 1 < v.size(); ++i) {
		const Vector2r a = v[i] - v[0], b = v[i + 1] - v[0];  // triangle (0, a, b), about the first vertex
		const Real triangle = (a.x() * b.y() - a.y() * b.x()) / 2;
		area += triangle;
		first += triangle * (a + b) / 3;
		polar += triangle * (a.squaredNorm() + a.dot(b) + b.squaredNorm()) / 6;
	}
	const Vector2r centre = first / area;
	return { area, v[0] + centre, polar / area - centre.squaredNorm() };
}

Real fall_height(const Outline& outline)
{
	if (outline.is_disk()) return outline.disk_radius();
	const Points& v = outline.vertices();
	const Real tolerance = 1e-12 * outline.extent() * outline.extent();  // edges vertical up to the round-off of a turn
	Real top = v[0].y(), lowest = std::numeric_limits<Real>::infinity();
	for (std::size_t i = 0, n = v.size(); i < n; ++i) {
		top = std::max(top, v[i].y());
		if (is_vertical_at(v[(i + n - 1) % n], v[i], v[(i + 1) % n], tolerance)) lowest = std::min(lowest, v[i].y());
	}
	return top - lowest;
}

}  // namespace graindrive::shapes
