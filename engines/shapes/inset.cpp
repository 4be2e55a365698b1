/// Inset by CGAL's straight skeleton (Aichholzer, Aurenhammer, Alberts, Gaertner, J. UCS 1, 752 (1995)), arcs added.
#include "engines/shapes/inset.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/create_offset_polygons_2.h>
#include <CGAL/create_straight_skeleton_2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace graindrive::shapes {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;

Real cross(const Vector2r& a, const Vector2r& b) { return a.x() * b.y() - a.y() * b.x(); }

Vector2r left_of(const Vector2r& edge) { return Vector2r(-edge.y(), edge.x()).normalized(); }

[[noreturn]] void throw_too_thin(const std::string& what, Real distance)
{
	std::ostringstream message;
	message << "outline is too thin for beads of diameter " << 2 * distance << ": " << what
			<< "; take smaller beads or a thicker shape";
	throw std::invalid_argument(message.str());
}

using Skeleton = CGAL::Straight_skeleton_2<Kernel>;
using Builder = CGAL::Straight_skeleton_builder_2<CGAL::Straight_skeleton_builder_traits_2<Kernel>, Skeleton>;

/// The part of the skeleton within `depth` of the outline: the whole of one with a thousand vertices takes 75 times as long.
boost::shared_ptr<Skeleton> skeleton_up_to(Real depth, const Polygon& polygon)
{
	Builder builder{ boost::optional<Real>(depth) };
	builder.enter_contour(polygon.vertices_begin(), polygon.vertices_end());
	return builder.construct_skeleton();
}

/// Corners of the offset polygon. The skeleton is asked for by itself, since CGAL's one-call form dereferences a failed one.
Points mitred(const Outline& outline, Real distance)
{
	Polygon polygon;
	for (const Vector2r& v : outline.vertices()) polygon.push_back({ v.x(), v.y() });
	const auto skeleton = skeleton_up_to(2 * distance, polygon);
	if (!skeleton)
		throw std::invalid_argument(
			"outline has no straight skeleton: some of its vertices are almost on one line or almost equal; remove them");
	const auto pieces = CGAL::create_offset_polygons_2<Polygon>(distance, *skeleton);
	if (pieces.empty()) throw_too_thin("not one bead fits inside", distance);
	if (pieces.size() > 1) {
		const auto& stray = pieces.back()->vertex(0);
		throw_too_thin("their centres fall into " + std::to_string(pieces.size()) + " separate rings, one at " +
						   vertex_name(0, Vector2r(stray.x(), stray.y())).substr(9),
			distance);
	}
	Points corners;
	for (const auto& p : *pieces.front()) corners.emplace_back(p.x(), p.y());
	return corners;
}

/// A reflex corner of the outline, the tip of its mitre, and the two feet between which a bead rolls round it.
struct Reflex {
	Vector2r corner, mitre, first_foot, second_foot;
};

std::vector<Reflex> reflex_corners(const Outline& outline, Real distance)
{
	std::vector<Reflex> found;
	const Points& v = outline.vertices();
	for (std::size_t i = 0, n = v.size(); i < n; ++i) {
		const Vector2r in = v[i] - v[(i + n - 1) % n], out = v[(i + 1) % n] - v[i];
		if (cross(in, out) >= 0) continue;
		const Vector2r a = left_of(in), b = left_of(out);
		found.push_back({ v[i], v[i] + distance * (a + b) / (1 + a.dot(b)), v[i] + distance * a, v[i] + distance * b });
	}
	return found;
}

bool lies_between(const Vector2r& point, const Vector2r& from, const Vector2r& to)
{
	const Real along = (point - from).dot(to - from);
	return along >= 0 && along <= (to - from).squaredNorm();
}

/// The reflex corner whose mitre is `at`, if a bead can roll round it between the inset's neighbouring corners.
const Reflex* rollable(
	const std::vector<Reflex>& reflexes, const Vector2r& before, const Vector2r& at, const Vector2r& after, Real tolerance)
{
	for (const Reflex& reflex : reflexes)
		if ((reflex.mitre - at).norm() <= tolerance && lies_between(reflex.first_foot, before, at) &&
			lies_between(reflex.second_foot, at, after))
			return &reflex;
	return nullptr;
}

/// An arc leaves the mitred inset, so another part of the outline may be in its way.
bool is_free(const Stretch& bend, const Outline& outline)
{
	constexpr int samples = 32;
	for (int i = 0; i <= samples; ++i)
		if (distance_to(outline, bend.at(bend.length * i / samples)) < bend.radius * (1 - 1e-9)) return false;
	return true;
}

}  // namespace

Stretch straight(const Vector2r& from, const Vector2r& to) { return { from, to, Vector2r::Zero(), 0, (to - from).norm() }; }

Stretch arc(const Vector2r& from, const Vector2r& to, const Vector2r& centre)
{
	const Vector2r a = from - centre, b = to - centre;
	return { from, to, centre, a.norm(), a.norm() * std::atan2(std::abs(cross(a, b)), a.dot(b)) };
}

Vector2r Stretch::at(Real distance) const
{
	if (radius == 0) return from + (to - from) * (distance / length);
	return centre + Eigen::Rotation2D<Real>(-distance / radius) * (from - centre);
}

Vector2r Stretch::heading(Real distance) const
{
	return radius == 0 ? Vector2r((to - from) / length) : Vector2r(-left_of(at(distance) - centre));
}

Real distance_to(const Outline& outline, const Vector2r& point)
{
	if (outline.is_disk()) return std::abs(outline.disk_radius() - (point - outline.disk_centre()).norm());
	const Points& v = outline.vertices();
	Real nearest = std::numeric_limits<Real>::infinity();
	for (std::size_t i = 0; i < v.size(); ++i) {
		const Vector2r edge = v[(i + 1) % v.size()] - v[i], to = point - v[i];
		const Real along = std::clamp(to.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
		nearest = std::min(nearest, (to - along * edge).norm());
	}
	return nearest;
}

std::vector<Stretch> inset(const Outline& outline, Real distance)
{
	const Points corners = mitred(outline, distance);
	const auto reflexes = reflex_corners(outline, distance);
	const std::size_t n = corners.size();
	const Real tolerance = 1e-9 * outline.extent();
	std::vector<Stretch> bends(n);  // length 0 where the corner stays a corner
	for (std::size_t i = 0; i < n; ++i) {
		const Reflex* reflex = rollable(reflexes, corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n], tolerance);
		const Stretch bend =
			reflex ? arc(reflex->first_foot, reflex->second_foot, reflex->corner) : straight(corners[i], corners[i]);
		bends[i] = is_free(bend, outline) ? bend : straight(corners[i], corners[i]);
	}
	std::vector<Stretch> path;
	for (std::size_t i = 0; i < n; ++i) {
		if (bends[i].length > 0) path.push_back(bends[i]);
		const Stretch edge = straight(bends[i].to, bends[(i + 1) % n].from);
		if (edge.length > tolerance) path.push_back(edge);
	}
	return path;
}

}  // namespace graindrive::shapes
