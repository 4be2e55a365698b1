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

class Outline {
public:
	/// A polygon from its vertices, in either sense. Clockwise is turned round; repeated, closing and collinear vertices go.
	/// @throws std::invalid_argument for non-finite vertices, fewer than three different ones, no area, or edges that meet
	explicit Outline(const Points& vertices);

	/// A circle about the origin, kept exact: its polygon of 360 vertices is only for drawing.
	/// @throws std::invalid_argument unless the diameter is positive
	static Outline disk(Real diameter);

	const Points& vertices() const { return vertices_; }
	bool is_disk() const { return disk_radius_ > 0; }
	Real disk_radius() const { return disk_radius_; }  ///< 0 for a polygon
	const Vector2r& disk_centre() const { return disk_centre_; }

	/// The outline turned counter-clockwise about the origin by `angle` [rad].
	Outline turned(Real angle) const;

	/// The outline with its origin moved to `origin`.
	Outline seen_from(const Vector2r& origin) const;

	/// Largest side of the box around the outline: the length that round-off is measured against.
	Real extent() const;

private:
	Outline() = default;

	Points vertices_;
	Real disk_radius_ = 0;
	Vector2r disk_centre_ = Vector2r::Zero();
};

/// "vertex 3 (1.5, -2)", as every message names a vertex.
std::string vertex_name(std::size_t index, const Vector2r& at);

}  // namespace graindrive::shapes
