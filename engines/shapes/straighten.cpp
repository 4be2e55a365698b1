/// Douglas and Peucker's simplification by Boost.Geometry.
#include "engines/shapes/straighten.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>

namespace graindrive::shapes {

namespace {

namespace bg = boost::geometry;
using Line = bg::model::linestring<bg::model::d2::point_xy<Real>>;

/// The corner farthest from the middle of the box. It cannot lie on a straight line between its neighbours, so it can be kept.
std::size_t surest_corner(const Points& corners)
{
	Eigen::AlignedBox<Real, 2> box;
	for (const Vector2r& corner : corners) box.extend(corner);
	const auto distance = [&](const Vector2r& corner) { return (corner - box.center()).squaredNorm(); };
	return std::max_element(corners.begin(), corners.end(), [&](const Vector2r& a, const Vector2r& b) {
		return distance(a) < distance(b);
	}) - corners.begin();
}

}  // namespace

Points straightened(const Points& corners, Real tolerance)
{
	const std::size_t start = surest_corner(corners);
	Line closed, kept;
	for (std::size_t i = 0; i <= corners.size(); ++i) {
		const Vector2r& corner = corners[(start + i) % corners.size()];
		closed.emplace_back(corner.x(), corner.y());
	}
	bg::simplify(closed, kept, tolerance);
	kept.pop_back();
	Points points;
	for (const auto& p : kept) points.emplace_back(p.x(), p.y());
	return points;
}

}  // namespace graindrive::shapes
