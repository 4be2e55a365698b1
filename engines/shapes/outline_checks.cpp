/// Checks and repairs of an outline; whether edges cross is decided by CGAL's exact predicates.
#include "engines/shapes/outline_checks.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "engines/shapes/plain_text.hpp"

namespace graindrive::shapes {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr Real one_point = 1e-9;   // vertices closer than this, over the extent, are one point [-]
constexpr Real round_off = 1e-12;  // vertices closer than this to a line, over the extent, lie on it [-]
constexpr Real coarsest = 1e-8;    // length, over the extent, that coordinates must resolve [-]

/// A vertex relative to the origin, as given, and its index in the input, so that messages after repairs still name the right
/// line.
struct Corner {
	Vector2r at, given;
	std::size_t index;
};
using Corners = std::vector<Corner>;

std::string name(const Corner& corner) { return vertex_name(corner.index, corner.given); }

void require_usual(const Vector2r& vertex, std::size_t index)
{
	for (const Real coordinate : { vertex.x(), vertex.y() }) {
		if (!std::isfinite(coordinate))
			throw std::invalid_argument(
				"outline vertices must be finite numbers, got " + vertex_name(index, vertex) + "; correct or remove it");
		if (std::abs(coordinate) > largest_length)
			throw std::invalid_argument(
				"outline vertices must be numbers up to 1e50, got " + vertex_name(index, vertex) + "; take a larger unit");
	}
}

Corners numbered(const Points& vertices, const Vector2r& origin)
{
	Corners corners;
	for (std::size_t i = 0; i < vertices.size(); ++i) corners.push_back({ vertices[i] - origin, vertices[i], i });
	return corners;
}

Real extent_of(const Corners& corners)
{
	Eigen::AlignedBox<Real, 2> box;
	for (const Corner& corner : corners) box.extend(corner.at);
	return corners.empty() ? 0 : box.sizes().maxCoeff();
}

Corners without_repeats(const Corners& corners, Real tolerance)
{
	Corners kept;
	for (const Corner& corner : corners)
		if (kept.empty() || (corner.at - kept.back().at).norm() > tolerance) kept.push_back(corner);
	while (kept.size() > 1 && (kept.back().at - kept.front().at).norm() <= tolerance) kept.pop_back();
	return kept;
}

/// True if b lies on the straight line between a and c, and the outline does not turn back on itself there.
bool on_the_way(const Vector2r& a, const Vector2r& b, const Vector2r& c, Real tolerance)
{
	return std::abs(cross(b - a, c - a)) <= tolerance * (c - a).norm() && (b - a).dot(c - b) > 0;
}

Corners without_collinear(const Corners& corners, Real tolerance)
{
	Corners kept;
	for (const Corner& corner : corners) {
		while (kept.size() > 1 && on_the_way(kept[kept.size() - 2].at, kept.back().at, corner.at, tolerance)) kept.pop_back();
		kept.push_back(corner);
	}
	while (kept.size() > 2 && on_the_way(kept[kept.size() - 2].at, kept.back().at, kept.front().at, tolerance)) kept.pop_back();
	while (kept.size() > 2 && on_the_way(kept.back().at, kept[0].at, kept[1].at, tolerance)) kept.erase(kept.begin());
	return kept;
}

/// Width across the line from the first corner to the one farthest from it; zero if all lie on one line.
Real breadth(const Corners& corners)
{
	const Vector2r origin = corners.front().at;
	Vector2r along = Vector2r::Zero();
	for (const Corner& corner : corners)
		if ((corner.at - origin).norm() > along.norm()) along = corner.at - origin;
	Real widest = 0;
	for (const Corner& corner : corners) widest = std::max(widest, std::abs(cross(along, corner.at - origin)) / along.norm());
	return widest;
}

Kernel::Point_2 cgal(const Corner& corner) { return { corner.at.x(), corner.at.y() }; }

/// Neighbouring edges share one corner; they meet elsewhere only if the outline turns back on itself there.
bool turns_back(const Corner& a, const Corner& b, const Corner& c)
{
	return CGAL::collinear(cgal(a), cgal(b), cgal(c)) && (b.at - a.at).dot(c.at - b.at) < 0;
}

/// Names the first two edges that meet; called only after CGAL has found that some do.
[[noreturn]] void throw_crossing(const Corners& corners)
{
	const std::size_t n = corners.size();
	const auto edge = [&](std::size_t i) { return Kernel::Segment_2(cgal(corners[i]), cgal(corners[(i + 1) % n])); };
	const std::string way_out = "; list the vertices in order round the shape, each edge touching only its neighbours";
	std::vector<CGAL::Bbox_2> boxes;
	for (std::size_t i = 0; i < n; ++i) boxes.push_back(edge(i).bbox());
	for (std::size_t i = 0; i < n; ++i) {
		if (turns_back(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]))
			throw std::invalid_argument(
				"outline must not cross or touch itself, but turns back at " + name(corners[(i + 1) % n]) + way_out);
		for (std::size_t j = i + 2; j < n; ++j) {
			if ((j + 1) % n == i || !CGAL::do_overlap(boxes[i], boxes[j])) continue;
			if (!CGAL::do_intersect(edge(i), edge(j))) continue;
			throw std::invalid_argument("outline must not cross or touch itself, but the edge from " + name(corners[i]) +
										" meets the edge from " + name(corners[j]) + way_out);
		}
	}
	throw std::invalid_argument("outline must not cross or touch itself" + way_out);
}

void require_simple(const Corners& corners)
{
	std::vector<Kernel::Point_2> points;
	for (const Corner& corner : corners) points.push_back(cgal(corner));
	if (!CGAL::is_simple_2(points.begin(), points.end(), Kernel())) throw_crossing(corners);
}

void require_three(const Corners& corners)
{
	if (corners.size() >= 3) return;
	std::ostringstream message;
	message << "outline needs at least 3 different vertices, got " << corners.size();
	if (!corners.empty()) message << ", the first being " << name(corners.front());
	throw std::invalid_argument(message.str() + "; add vertices");
}

Real twice_area(const Corners& corners)
{
	Real sum = 0;
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
		sum += cross(corners[i].at - corners[0].at, corners[i + 1].at - corners[0].at);
	return sum;
}

/// Refuses coordinates so far from the origin that rounding has changed the shape.
void require_resolved(const Corners& corners, Real extent)
{
	if (corners.empty() || extent == 0) return;
	Real farthest = 0;
	for (const Corner& corner : corners) farthest = std::max(farthest, corner.given.cwiseAbs().maxCoeff());
	std::ostringstream message;
	if (extent < smallest_length) {
		message << "outline must be at least 1e-50 wide or high, got " << extent << "; take a smaller unit";
		throw std::invalid_argument(message.str());
	}
	if (farthest * std::numeric_limits<Real>::epsilon() <= coarsest * extent) return;
	message << "outline must lie so near the origin that its coordinates resolve 1e-8 of its extent " << extent << ", got "
			<< name(corners.front()) << "; shift it towards (0, 0)";
	throw std::invalid_argument(message.str());
}

/// The middle of the numbers, or zero if it is smaller than their range. If it is larger, all numbers are within a factor of two
/// of it, so that subtracting it has no round-off (Sterbenz).
Real middle_of(Real least, Real most)
{
	const Real middle = least / 2 + most / 2;
	return std::abs(middle) > most - least ? middle : 0;
}

}  // namespace

Vector2r origin_near(const Points& vertices)
{
	Eigen::AlignedBox<Real, 2> box;
	for (std::size_t i = 0; i < vertices.size(); ++i) {
		require_usual(vertices[i], i);
		box.extend(vertices[i]);
	}
	if (vertices.empty()) return Vector2r::Zero();
	return { middle_of(box.min().x(), box.max().x()), middle_of(box.min().y(), box.max().y()) };
}

Points checked_polygon(const Points& vertices, const Vector2r& origin)
{
	require_count(vertices.size(), most_given, "vertices in all");
	Corners corners = numbered(vertices, origin);
	const Real extent = extent_of(corners);
	require_resolved(corners, extent);
	corners = without_repeats(corners, one_point * extent);
	require_three(corners);
	if (breadth(corners) <= one_point * extent)
		throw std::invalid_argument("outline must enclose an area, but all its vertices lie on one line through " +
									name(corners.front()) + "; move one off the line");
	corners = without_collinear(corners, round_off * extent);
	require_count(corners.size(), most_vertices, "vertices");
	require_simple(corners);
	if (twice_area(corners) < 0) std::reverse(corners.begin(), corners.end());
	Points polygon;
	for (const Corner& corner : corners) polygon.push_back(corner.at);
	return polygon;
}

}  // namespace graindrive::shapes
