/// Two disks or spheres in contact: what a law needs to know of them, and what its answer does to them.
#pragma once
#include "engines/laws/contact.hpp"
#include "engines/laws/pair_geometry.hpp"

namespace graindrive::laws {

/// Positions and motions of a touching pair; n points from grain 1 to grain 2.
struct SpherePair {
	Vector3r normal;        ///< n [-]
	Real overlap;           ///< delta [m]
	Real radius1, radius2;  ///< [m]
	Vector3r velocity1, velocity2;
	Vector3r spin1, spin2;
	Real effective_radius, effective_mass;
};

/// Where the tangential force acts.
///
/// `radius`: at each grain's own radius, as LAMMPS and the papers do; angular momentum then is conserved up to the torque
/// delta F_t of the overlap. `contact_point`: at the middle of the overlap, which conserves it to round-off.
enum class LeverArm { radius, contact_point };

/// By how much the tangential force's lever is shorter than the radius [m].
inline Real lever_loss(LeverArm lever, Real overlap) { return lever == LeverArm::contact_point ? overlap / 2 : 0; }

/// Forces and torques on the pair.
struct PairResponse {
	Vector3r normal_force2;      ///< on grain 2, F_n n; grain 1 gets the opposite [N]
	Vector3r tangential_force2;  ///< on grain 2; grain 1 gets the opposite [N]
	Vector3r torque1, torque2;   ///< [N m]
	Vector3r slip;               ///< new tangential spring of grain 1 against 2 [m]
	bool slipping;
};

/// Turns a tangential vector into the present tangent plane, keeping its length.
inline Vector3r into_tangent_plane(const Vector3r& slip, const Vector3r& normal)
{
	const Real length2 = slip.squaredNorm();
	if (length2 == 0) return slip;
	const Vector3r projected = slip - slip.dot(normal) * normal;
	const Real projected2 = projected.squaredNorm();
	return projected2 > 0 ? Vector3r(projected * std::sqrt(length2 / projected2)) : Vector3r(Vector3r::Zero());
}

/// One step of one contact.
template <class Law>
PairResponse respond(const Law& law, const SpherePair& pair, const Vector3r& slip, Real dt, LeverArm lever = LeverArm::radius)
{
	const Vector3r& n = pair.normal;
	const Real shorten = lever_loss(lever, pair.overlap);
	const Real arm1 = pair.radius1 - shorten, arm2 = pair.radius2 - shorten;
	const auto motion =
		relative_motion(n, Vector3r(pair.velocity2 - pair.velocity1), Vector3r(arm1 * pair.spin1 + arm2 * pair.spin2));
	const Kinematics<Real, Vector3r> contact{ pair.overlap, motion.normal, motion.tangential, pair.effective_radius,
		pair.effective_mass, dt };
	const auto answer = law(contact, into_tangent_plane(slip, n));
	const Vector3r twist = n.cross(answer.tangential);
	return { answer.normal * n, -answer.tangential, arm1 * twist, arm2 * twist, answer.slip, answer.slipping };
}

}  // namespace graindrive::laws
