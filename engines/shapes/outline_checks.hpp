/// `checked_polygon`: the vertices of an outline after repairs, or the reason why they are none.
#pragma once
#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// Vertices counter-clockwise, without repeated, closing and collinear ones.
/// @throws std::invalid_argument as the constructor of `Outline`, naming vertices by their index in `vertices`
Points checked_polygon(const Points& vertices);

}  // namespace graindrive::shapes
