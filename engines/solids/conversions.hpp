/// YADE's vectors and orientations as the geometry room has them, and back.
#pragma once
#include "engines/base/real.hpp"
#include "engines/geometry/rigid_motion.hpp"

namespace graindrive {

inline geometry::Vec<3> vec(const Vector3r& v) { return { v[0], v[1], v[2] }; }
inline Vector3r vector(const geometry::Vec<3>& v) { return { v[0], v[1], v[2] }; }

/// A body's frame at rest.
inline geometry::RigidMotion<3> motion_of(const Vector3r& position, const Quaternionr& orientation)
{
	return { vec(position), { orientation.w(), { orientation.x(), orientation.y(), orientation.z() } }, {}, {} };
}

}  // namespace graindrive
