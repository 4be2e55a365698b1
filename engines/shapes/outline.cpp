/// Polygons and circles, and how they move.
#include "engines/shapes/outline.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "engines/shapes/outline_checks.hpp"
#include "engines/shapes/solid.hpp"

namespace graindrive::shapes {

namespace {

constexpr int drawn_vertices = 360;
constexpr int digits_in_messages = 10;  // enough to find a vertex among coordinates of a map

}  // namespace

Real cross(const Vector2r& a, const Vector2r& b) { return a.x() * b.y() - a.y() * b.x(); }

std::string vertex_name(std::size_t index, const Vector2r& at)
{
	std::ostringstream text;
	text.precision(digits_in_messages);
	text << "vertex " << index << " (" << at.x() << ", " << at.y() << ")";
	return text.str();
}

Outline::Outline(const Points& vertices) : origin_(origin_near(vertices)) { corners_ = checked_polygon(vertices, origin_); }

Outline Outline::disk(Real diameter)
{
	if (!(std::isfinite(diameter) && diameter >= smallest_length && diameter <= largest_length)) {
		std::ostringstream message;
		message << "disk diameter must be positive and finite, from " << smallest_length << " to " << largest_length << ", got "
				<< diameter << "; give the outer diameter";
		throw std::invalid_argument(message.str());
	}
	Outline disk;
	disk.disk_radius_ = diameter / 2;
	for (int i = 0; i < drawn_vertices; ++i) {
		const Real angle = 2 * pi * i / drawn_vertices;
		disk.corners_.emplace_back(disk.disk_radius_ * std::cos(angle), disk.disk_radius_ * std::sin(angle));
	}
	return disk;
}

Points Outline::vertices() const
{
	Points vertices = corners_;
	for (Vector2r& vertex : vertices) vertex += origin_;
	return vertices;
}

Outline Outline::turned(Real angle) const
{
	if (!std::isfinite(angle))
		throw std::invalid_argument("orientation must be a finite angle [rad], got " + std::to_string(angle));
	if (angle == 0) return *this;
	const Eigen::Rotation2D<Real> turn(angle);
	Outline result = *this;
	for (Vector2r& corner : result.corners_) corner = turn * corner;
	result.origin_ = turn * origin_;
	return result;
}

Outline Outline::seen_from(const Vector2r& point) const
{
	Outline result = *this;
	result.origin_ -= point;
	return result;
}

Outline Outline::about_centroid() const
{
	Outline result = *this;
	const Vector2r centroid = solid_of(*this).from_origin;
	for (Vector2r& corner : result.corners_) corner -= centroid;
	result.origin_ = Vector2r::Zero();
	return result;
}

Real Outline::extent() const
{
	Eigen::AlignedBox<Real, 2> box;
	for (const Vector2r& corner : corners_) box.extend(corner);
	return box.sizes().maxCoeff();
}

}  // namespace graindrive::shapes
