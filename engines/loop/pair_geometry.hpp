/// The geometry of contacts as the loop's rows, walls and solids have it, for all but the kernels.
///
/// Kernels take the same from packs of pairs, with one reciprocal in place of divisions: that differs in the last bit.
#pragma once
#include "engines/laws/contact.hpp"
#include "engines/laws/pair_geometry.hpp"
#include "engines/loop/state.hpp"

namespace graindrive::loop {

/// What is tangential: a signed number along t = z x n in the plane, a vector in space.
template <int D>
using Tangent = Spin<D>;

inline double length(const Vec<2>& v) { return std::hypot(v[0], v[1]); }
inline double length(const Vec<3>& v) { return geometry::norm(v); }
inline double length(double number) { return std::abs(number); }

inline double inner(double a, double b) { return a * b; }
inline double inner(const Vec<3>& a, const Vec<3>& b) { return geometry::dot(a, b); }

// The laws take Eigen's vectors.
inline double for_law(double number) { return number; }
inline Vector3r for_law(const Vec<3>& v) { return { v[0], v[1], v[2] }; }
inline double from_law(double number) { return number; }
inline Vec<3> from_law(const Vector3r& v) { return { v[0], v[1], v[2] }; }

/// Where two grains, or a grain and a surface, touch.
template <int D>
struct Placement {
	Vec<D> normal;   ///< n, from the first to the second [-]
	double overlap;  ///< [m]; they touch where it is positive
};

/// b - a by the nearest image [m].
template <int D>
Vec<D> separation(const Row<D>& a, const Row<D>& b, const Cell<D>& cell)
{
	return cell.nearest(b.x - a.x).at;
}

template <int D>
Placement<D> placement(const Row<D>& a, const Row<D>& b, const Cell<D>& cell)
{
	const Vec<D> d = separation<D>(a, b, cell);
	const double distance = length(d);
	return { d / distance, a.radius + b.radius - distance };
}

template <int D>
Placement<D> placement(const Row<D>& row, const Wall<D>& wall)
{
	const double outward = wall.outward();
	Placement<D> at{ {}, row.radius + outward * (row.x[wall.axis()] - wall.position) };
	at.normal[wall.axis()] = outward;
	return at;
}

/// What makes a grain or a surface move against another: the velocity of its centre, and of its surface by its spin [m/s].
template <int D>
struct SurfaceMotion {
	Vec<D> velocity;
	Spin<D> surface{};
};

template <class ARow>
auto motion_of(const ARow& row)
{
	return SurfaceMotion < std::is_same_v<ARow, DiskRow> ? 2 : 3 > { row.v, row.surface };
}

/// v_n, and v_t of the first one's surface against the second's [m/s].
template <int D>
struct RelativeMotion {
	double normal;
	Tangent<D> tangential;
};

inline RelativeMotion<2> relative_motion(const Vec<2>& n, const SurfaceMotion<2>& a, const SurfaceMotion<2>& b)
{
	const Vec<2> v = b.velocity - a.velocity;
	const auto motion = laws::relative_motion<double>({ n[0], n[1] }, { v[0], v[1] }, a.surface + b.surface);
	return { motion.normal, motion.tangential };
}
inline RelativeMotion<3> relative_motion(const Vec<3>& n, const SurfaceMotion<3>& a, const SurfaceMotion<3>& b)
{
	const Vec<3> v = b.velocity - a.velocity;
	const double separating = geometry::dot(v, n);
	return { separating, separating * n - v + geometry::cross(a.surface + b.surface, n) };
}

/// Force on the first grain [N]: -F_n n + F_t.
inline Vec<2> force_on_first(const Vec<2>& n, double normal, double tangential)
{
	const laws::Planar<double> force = laws::force_on_first(laws::Planar<double>{ n[0], n[1] }, normal, tangential);
	return { force.x, force.y };
}
inline Vec<3> force_on_first(const Vec<3>& n, double normal, const Vec<3>& tangential) { return tangential - normal * n; }

/// The torque of F_t on either grain over its radius, n x F_t [N].
inline double turning(const Vec<2>&, double tangential) { return tangential; }
inline Vec<3> turning(const Vec<3>& n, const Vec<3>& tangential) { return geometry::cross(n, tangential); }

/// A tangential vector in the plane of another normal: by the rotation that takes one normal to the other without twist.
inline double turned_along(double tangential, const Vec<2>&, const Vec<2>&) { return tangential; }
inline Vec<3> turned_along(const Vec<3>& tangential, const Vec<3>& from, const Vec<3>& to)
{
	const double facing = 1 + geometry::dot(from, to);
	if (!(facing > 1e-9)) return {};  // the normal has turned round: it is another contact
	return tangential - (geometry::dot(tangential, to) / facing) * (from + to);
}

/// The output of a law.
template <int D>
struct LawAnswer {
	double normal;                ///< F_n [N]
	Tangent<D> tangential, slip;  ///< F_t on the first [N]; the spring to keep [m]
	bool slipping;
};

template <class Mask>
LawAnswer<2> answer_of(const laws::Response<double, double, Mask>& r)
{
	return { r.normal, r.tangential, r.slip, bool(r.slipping) };
}
template <class Mask>
LawAnswer<3> answer_of(const laws::Response<double, Vector3r, Mask>& r)
{
	return { r.normal, from_law(r.tangential), from_law(r.slip), bool(r.slipping) };
}

/// The input of the law.
template <int D>
auto kinematics(
	const Placement<D>& at, const RelativeMotion<D>& motion, double effective_radius, double effective_mass, double dt)
{
	const auto tangential = for_law(motion.tangential);
	return laws::Kinematics<double, std::decay_t<decltype(tangential)>>{ at.overlap, motion.normal, tangential, effective_radius,
		effective_mass, dt };
}

}  // namespace graindrive::loop
