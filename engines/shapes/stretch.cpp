/// Finds the parts of lines and arcs that are closer to an edge than `reach`: those in the edge's capsule, two disks and the
/// strip between.
///
/// The capsule is convex, so it contains one interval of a line. It also contains one interval of a circle that is no wider than
/// itself: around the directions of the edge's points as seen from the circle's centre.
#include "engines/shapes/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graindrive::shapes {

namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();

bool is_empty(const Interval& i) { return i.begin >= i.end; }
Interval common(const Interval& a, const Interval& b) { return { std::max(a.begin, b.begin), std::min(a.end, b.end) }; }

/// The smallest interval that contains both; an empty one is ignored.
Interval joined(const Interval& a, const Interval& b)
{
	if (is_empty(a)) return b;
	if (is_empty(b)) return a;
	return { std::min(a.begin, b.begin), std::max(a.end, b.end) };
}

/// The interval of s in which low < value + slope s < high.
Interval between(Real low, Real high, Real value, Real slope)
{
	if (slope == 0) return value > low && value < high ? Interval{ -infinity, infinity } : Interval{ 0, 0 };
	const Real a = (low - value) / slope, b = (high - value) / slope;
	return { std::min(a, b), std::max(a, b) };
}

Interval line_in_disk(const Vector2r& from, const Vector2r& heading, const Vector2r& centre, Real radius)
{
	const Real aside = std::abs(cross(heading, from - centre)), middle = heading.dot(centre - from);
	if (aside >= radius) return { 0, 0 };
	const Real half = std::sqrt((radius - aside) * (radius + aside));
	return { middle - half, middle + half };
}

Interval line_in_capsule(const Vector2r& from, const Vector2r& heading, const Vector2r& a, const Vector2r& b, Real reach)
{
	const Real length = (b - a).norm();
	const Vector2r along = (b - a) / length, to = from - a;
	const Interval strip = common(
		between(0, length, to.dot(along), heading.dot(along)), between(-reach, reach, cross(along, to), cross(along, heading)));
	return joined(strip, joined(line_in_disk(from, heading, a, reach), line_in_disk(from, heading, b, reach)));
}

Real angle_between(const Vector2r& a, const Vector2r& b) { return std::atan2(cross(a, b), a.dot(b)); }

/// The angles, measured from `reference`, at which a circle about (0, 0) lies in the disk of radius `reach` about `point`.
Interval circle_in_disk(Real radius, const Vector2r& reference, const Vector2r& point, Real reach)
{
	const Real away = point.norm();
	if (away >= radius + reach) return { 0, 0 };
	const Real half = std::acos(std::clamp((away * away + radius * radius - reach * reach) / (2 * radius * away), -1.0, 1.0));
	const Real middle = angle_between(reference, point);
	return { middle - half, middle + half };
}

/// The same for the strip along the edge from a to b: the angles between which the circle is beyond the strip's side next to (0,
/// 0).
Interval circle_in_strip(Real radius, const Vector2r& reference, const Vector2r& a, const Vector2r& b, Real reach)
{
	const Real length = (b - a).norm();
	const Vector2r along = (b - a) / length;
	const Vector2r foot = a - along * along.dot(a);
	const Real cosine = (foot.norm() - reach) / radius;
	if (cosine >= 1) return { 0, 0 };
	const Real half = std::acos(std::max(cosine, -1.0)), shift = radius * std::sin(half), start = -along.dot(a);
	const Vector2r across = cross(along, -a) > 0 ? Vector2r(along.y(), -along.x()) : Vector2r(-along.y(), along.x());
	const Real middle = angle_between(reference, across), turn = cross(across, along) > 0 ? 1 : -1;
	Interval found{ 0, 0 };
	for (const Real side : { -1.0, 1.0 }) {
		const Real where = start + side * shift;
		if (where < 0 || where > length) continue;
		const Real angle = middle + turn * side * half;
		found = joined(found, { angle, std::nextafter(angle, infinity) });
	}
	return found;
}

/// The point of the edge from a to b that is nearest to (0, 0).
Vector2r nearest_of(const Vector2r& a, const Vector2r& b)
{
	return a + (b - a) * std::clamp(-a.dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
}

}  // namespace

Vector2r left_of(const Vector2r& edge) { return Vector2r(-edge.y(), edge.x()).normalized(); }

Stretch straight(const Vector2r& from, const Vector2r& to) { return { from, to, Vector2r::Zero(), 0, (to - from).norm() }; }

Stretch arc(const Vector2r& from, const Vector2r& to, const Vector2r& centre)
{
	const Vector2r a = from - centre, b = to - centre;
	return { from, to, centre, a.norm(), a.norm() * std::abs(angle_between(a, b)) };
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

Stretch Stretch::part(Real begin, Real end) const
{
	return { begin > 0 ? at(begin) : from, end < length ? at(end) : to, centre, radius, end - begin };
}

Eigen::AlignedBox<Real, 2> Stretch::box() const
{
	const Real rise = radius == 0 ? 0 : radius * (1 - std::cos(length / radius / 2));  // height of the arc above its chord
	const Vector2r margin = Vector2r::Constant(rise);
	return { Vector2r(from.cwiseMin(to) - margin), Vector2r(from.cwiseMax(to) + margin) };
}

std::optional<Interval> closer_than(Real reach, const Stretch& stretch, const Vector2r& a, const Vector2r& b)
{
	Interval found{ 0, 0 };
	if (stretch.radius == 0) {
		found = line_in_capsule(stretch.from, stretch.heading(0), a, b, reach);
	} else {
		const Vector2r seen_a = a - stretch.centre, seen_b = b - stretch.centre, reference = nearest_of(seen_a, seen_b);
		if (reference.norm() == 0) return Interval{ -infinity, infinity };
		const Interval angles = joined(circle_in_strip(stretch.radius, reference, seen_a, seen_b, reach),
			joined(circle_in_disk(stretch.radius, reference, seen_a, reach),
				circle_in_disk(stretch.radius, reference, seen_b, reach)));
		const Real start = angle_between(reference, stretch.from - stretch.centre);  // the arc runs clockwise from here
		found = { stretch.radius * (start - angles.end), stretch.radius * (start - angles.begin) };
	}
	if (is_empty(found)) return std::nullopt;
	return found;
}

std::vector<Interval> without(const std::vector<Interval>& parts, const Interval& hole)
{
	std::vector<Interval> left;
	for (const Interval& part : parts)
		for (const Interval& piece :
			{ Interval{ part.begin, std::min(part.end, hole.begin) }, Interval{ std::max(part.begin, hole.end), part.end } })
			if (piece.begin < piece.end) left.push_back(piece);
	return left;
}

}  // namespace graindrive::shapes
