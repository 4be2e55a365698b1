/// Polygons and circles, and how they move.
#include "engines/shapes/outline.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "engines/shapes/outline_checks.hpp"

namespace graindrive::shapes {

namespace {

constexpr int drawn_vertices = 360;

}  // namespace

std::string vertex_name(std::size_t index, const Vector2r& at)
{
	std::ostringstream text;
	text << "vertex " << index << " (" << at.x() << ", " << at.y() << ")";
	return text.str();
}

Outline::Outline(const Points& vertices) : vertices_(checked_polygon(vertices)) {}

Outline Outline::disk(Real diameter)
{
	if (!(diameter > 0 && std::isfinite(diameter))) {
		std::ostringstream message;
		message << "disk diameter must be positive and finite, got " << diameter << "; give the outer diameter";
		throw std::invalid_argument(message.str());
	}
	Outline disk;
	disk.disk_radius_ = diameter / 2;
	for (int i = 0; i < drawn_vertices; ++i) {
		const Real angle = 2 * pi * i / drawn_vertices;
		disk.vertices_.emplace_back(disk.disk_radius_ * std::cos(angle), disk.disk_radius_ * std::sin(angle));
	}
	return disk;
}

Outline Outline::turned(Real angle) const
{
	if (!std::isfinite(angle))
		throw std::invalid_argument("orientation must be a finite angle [rad], got " + std::to_string(angle));
	if (angle == 0) return *this;
	const Eigen::Rotation2D<Real> turn(angle);
	Outline result = *this;
	for (Vector2r& vertex : result.vertices_) vertex = turn * vertex;
	result.disk_centre_ = turn * disk_centre_;
	return result;
}

Outline Outline::seen_from(const Vector2r& origin) const
{
	Outline result = *this;
	for (Vector2r& vertex : result.vertices_) vertex -= origin;
	result.disk_centre_ -= origin;
	return result;
}

Real Outline::extent() const
{
	Eigen::AlignedBox<Real, 2> box;
	for (const Vector2r& vertex : vertices_) box.extend(vertex);
	return box.sizes().maxCoeff();
}

}  // namespace graindrive::shapes
