/// `checked_polygon`: the vertices of an outline after repairs, or the reason why they are none.
#pragma once
#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

constexpr std::size_t most_vertices = 5000;  // of twice as many an inset takes a minute
constexpr std::size_t most_given = 200000;   // before those on straight lines are left out

/// A point from which the vertices are seen without loss of digits: a coordinate of it is 0 unless all vertices lie far out.
/// @throws std::invalid_argument for vertices that are not finite or too large
Vector2r origin_near(const Points& vertices);

/// Vertices relative to `origin`, counter-clockwise, without repeated, closing and collinear ones.
/// @throws std::invalid_argument as the constructor of `Outline`, naming vertices by their index in `vertices`
Points checked_polygon(const Points& vertices, const Vector2r& origin);

}  // namespace graindrive::shapes
