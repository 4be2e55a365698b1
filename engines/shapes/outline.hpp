/// `Outline`: the outer edge of an intruder as a checked simple polygon, or as an exact circle.
///
/// Lengths are in one unit of the caller's choice (the wiggle study's is the grain diameter d). Vertices run counter-clockwise.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "engines/base/real.hpp"

namespace graindrive::shapes {

using Points = std::vector<Vector2r>;

constexpr Real largest_length = 1e50;    ///< of coordinates and diameters: fourth powers of lengths must be finite numbers
constexpr Real smallest_length = 1e-50;  ///< of extents and diameters, for the same reason

/// It keeps its vertices relative to an origin near the shape, so that what is computed of it loses no digits far away.
class Outline {
public:
	/// A polygon from its vertices, in either sense. Clockwise order is reversed; repeated, closing and collinear vertices are dropped.
	/// @throws std::invalid_argument for vertices that are not finite, too large or too far away for the extent, for fewer than
	/// three different ones, for no area, and for edges that meet
	explicit Outline(const Points& vertices);

	/// A circle about the origin, kept exact: its polygon of 360 vertices is only for drawing.
	/// @throws std::invalid_argument unless the diameter is positive, finite and of a usual size
	static Outline disk(Real diameter);

	Points vertices() const;
	const Vector2r& origin() const { return origin_; }  ///< of `corners`; a disk's centre
	const Points& corners() const { return corners_; }  ///< the vertices relative to `origin`
	bool is_disk() const { return disk_radius_ > 0; }
	Real disk_radius() const { return disk_radius_; }  ///< 0 for a polygon

	/// The outline turned counter-clockwise about the point (0, 0) by `angle` [rad].
	Outline turned(Real angle) const;

	/// The outline with the point (0, 0) moved to `point`.
	Outline seen_from(const Vector2r& point) const;

	/// The outline with the centroid of its solid at (0, 0).
	Outline about_centroid() const;

	/// Largest side of the box around the outline: the length that round-off is measured against.
	Real extent() const;

private:
	Outline() = default;

	Points corners_;
	Vector2r origin_ = Vector2r::Zero();
	Real disk_radius_ = 0;
};

Real cross(const Vector2r& a, const Vector2r& b);

/// "vertex 3 (1.5, -2)", as every message names a vertex.
std::string vertex_name(std::size_t index, const Vector2r& at);

}  // namespace graindrive::shapes
