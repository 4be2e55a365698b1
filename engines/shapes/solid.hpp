/// Area, centroid, second moment and height of fall of the solid inside an outline, by exact integrals.
#pragma once
#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// What a uniform solid needs to move as a rigid body; multiply `second_moment` by the mass for its moment of inertia.
struct Solid {
	Real area;             ///< [length^2]
	Vector2r centroid;     ///< [length]
	Real second_moment;    ///< mean square distance from the centroid, I_z / m [length^2]
	Vector2r from_origin;  ///< the centroid relative to the outline's origin, with all its digits far away too [length]
};

Solid solid_of(const Outline& outline);

/// l of the wiggle paper's cavity model: from the lowest point where the outline is vertical up to its top [length].
/// A grain that has fallen past that point cannot come back; disk l = R, square and upright triangle l = their height.
/// An edge counts as vertical if its ends lie above each other within 4e-7 of the extent.
Real fall_height(const Outline& outline);

}  // namespace graindrive::shapes
