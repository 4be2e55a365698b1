/// `straightened`: a polygon without the vertices that lie on the straight way between others.
#pragma once
#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// The corners of a closed polygon but for those that the rest misses by less than `tolerance` (Douglas, Peucker 1973).
/// A vertex within `tolerance` of another one goes too. The polygon starts anew at the corner farthest from its middle.
Points straightened(const Points& corners, Real tolerance);

}  // namespace graindrive::shapes
