/// The geometry of a contact: normal, overlap, relative motion, reduced radius and mass, and the force on the first grain.
///
/// Two grains, or a grain and a wall; n points from the first to the second. `S` is a number or a pack of numbers. In the plane vectors
/// are `Planar<S>` and what is tangential is a signed number along t = z x n; in space both are `Vector3r`.
#pragma once
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive::laws {

template <class S>
struct Planar {
	S x, y;
};

inline Real length(const Planar<Real>& d) { return std::hypot(d.x, d.y); }
inline Real length(const Vector3r& d) { return d.norm(); }
inline Planar<Real> unit(const Planar<Real>& d, Real length) { return { d.x / length, d.y / length }; }
inline Vector3r unit(const Vector3r& d, Real length) { return d / length; }

/// Where two grains touch.
template <class V>
struct Placement {
	V normal;      ///< n [-]
	Real overlap;  ///< delta = R_1 + R_2 - |d| [m]; they touch where it is positive
};

/// d is the way from the first centre to the second one [m].
template <class V>
Placement<V> placement(const V& d, Real radius1, Real radius2)
{
	const Real distance = length(d);
	return { unit(d, distance), radius1 + radius2 - distance };
}

/// How the second grain moves against the first.
template <class S, class T>
struct RelativeMotion {
	S normal;      ///< v_n, > 0 when separating [m/s]
	T tangential;  ///< v_t of the first one's surface against the second's [m/s]
};

/// In the plane: v = v_2 - v_1 and R_1 w_1 + R_2 w_2 [m/s]. `stretch` multiplies v in v_t, as YADE's own laws have it.
template <class S>
inline RelativeMotion<S, S> relative_motion(const Planar<S>& n, const Planar<S>& v, const S& surface_speed)
{
	return { v.x * n.x + v.y * n.y, surface_speed + (v.x * n.y - v.y * n.x) };
}
template <class S>
inline RelativeMotion<S, S> relative_motion(const Planar<S>& n, const Planar<S>& v, const S& surface_speed, const S& stretch)
{
	return { v.x * n.x + v.y * n.y, surface_speed + stretch * (v.x * n.y - v.y * n.x) };
}

/// In space: the same with the vector R_1 w_1 + R_2 w_2.
inline RelativeMotion<Real, Vector3r> relative_motion(const Vector3r& n, const Vector3r& v, const Vector3r& surface_spin)
{
	const Real separating = v.dot(n);
	return { separating, separating * n - v + surface_spin.cross(n) };
}

/// Force on the first grain in the plane [N]: -F_n n + F_t (z x n).
template <class S>
inline Planar<S> force_on_first(const Planar<S>& n, const S& normal, const S& tangential)
{
	return { -(normal * n.x) - tangential * n.y, tangential * n.x - normal * n.y };
}

/// R_1 R_2 / (R_1 + R_2) [m]
inline Real effective_radius(Real radius1, Real radius2) { return radius1 * radius2 / (radius1 + radius2); }

/// 1 / (1/m_1 + 1/m_2) [kg] from that sum; 0 for two infinite masses: neither responds, so nothing is damped.
inline Real effective_mass(Real sum_of_inverse_masses) { return sum_of_inverse_masses > 0 ? 1 / sum_of_inverse_masses : 0; }

}  // namespace graindrive::laws
