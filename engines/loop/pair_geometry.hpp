/// The geometry of contacts as the loop's rows and walls have it, for all but the kernels.
///
/// Kernels take the same from packs of pairs, with one reciprocal in place of divisions: that differs in the last bit.
#pragma once
#include "engines/laws/contact.hpp"
#include "engines/laws/pair_geometry.hpp"
#include "engines/loop/pair_search.hpp"

namespace graindrive::loop {

using Plane = laws::Planar<double>;
using Placement = laws::Placement<Plane>;

inline Placement placement(const GrainRow& a, const GrainRow& b, const Box& box)
{
	const Separation d = separation(a, b, box);
	return laws::placement(Plane{ d.x, d.y }, a.radius, b.radius);
}

inline Placement placement(const GrainRow& row, const Wall& wall)
{
	const double outward = wall.outward();
	return { { wall.across_x() ? outward : 0, wall.across_x() ? 0 : outward },
		row.radius + outward * ((wall.across_x() ? row.x : row.y) - wall.position) };
}

/// What of a row or a wall makes it move against another: its velocity, and that of its surface.
struct SurfaceMotion {
	double vx, vy, surface_speed;  ///< [m/s]
};

inline SurfaceMotion motion_of(const GrainRow& row) { return { row.vx, row.vy, row.surface_speed }; }
inline SurfaceMotion motion_of(const Wall& wall) { return { wall.velocity_x(), wall.velocity_y(), 0 }; }

inline laws::RelativeMotion<double, double> relative_motion(const Plane& n, const SurfaceMotion& a, const SurfaceMotion& b)
{
	return laws::relative_motion<double>(n, { b.vx - a.vx, b.vy - a.vy }, a.surface_speed + b.surface_speed);
}

inline double effective_radius(const GrainRow& a, const GrainRow& b) { return laws::effective_radius(a.radius, b.radius); }
inline double effective_mass(const GrainRow& a, const GrainRow& b)
{
	return laws::effective_mass(a.inverse_mass + b.inverse_mass);
}
/// A wall is a grain of infinite radius and mass.
inline double effective_radius(const GrainRow& row, const Wall&) { return row.radius; }
inline double effective_mass(const GrainRow& row, const Wall&) { return laws::effective_mass(row.inverse_mass); }

/// What the law is told, of two grains or of a grain and a wall.
template <class Other>
laws::Kinematics<double, double> kinematics(const Placement& at, const GrainRow& row, const Other& other, double dt)
{
	const auto motion = relative_motion(at.normal, motion_of(row), motion_of(other));
	return { at.overlap, motion.normal, motion.tangential, effective_radius(row, other), effective_mass(row, other), dt };
}

}  // namespace graindrive::loop
