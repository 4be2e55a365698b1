/// Two disks or spheres in contact, or a solid and a sphere: computes the input of a law, and applies its forces to them.
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

/// A solid, whose surface is given by distance and normal, and a sphere that touches it; n points from the solid to the sphere.
///
/// The solid's surface counts as flat and its force acts at the contact point c, the middle of the overlap: its material moves there
/// with v + omega x (c - x), and the torque about x is (c - x) x F, however long the lever c - x.
struct SolidAndSphere {
	Vector3r normal;          ///< n [-]
	Real overlap;             ///< delta = R - distance of the centre [m]
	Real radius;              ///< R of the sphere [m]
	Vector3r lever;           ///< c - x, from the solid's centre to the contact point [m]
	Vector3r solid_velocity;  ///< of its centre [m/s]
	Vector3r velocity;        ///< of the sphere's centre [m/s]
	Vector3r solid_spin, spin;
	Real effective_mass;  ///< the sphere's, if the solid is held [kg]
};

/// Where the tangential force acts on a sphere.
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

/// What the law says of a relative motion.
template <class Law>
auto answer_to(const Law& law, const Vector3r& n, const RelativeMotion<Real, Vector3r>& motion, Real overlap,
	Real effective_radius, Real effective_mass, const Vector3r& slip, Real dt)
{
	const Kinematics<Real, Vector3r> contact{ overlap, motion.normal, motion.tangential, effective_radius, effective_mass, dt };
	return law(contact, into_tangent_plane(slip, n));
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
	const auto answer = answer_to(law, n, motion, pair.overlap, pair.effective_radius, pair.effective_mass, slip, dt);
	const Vector3r twist = n.cross(answer.tangential);
	return { answer.normal * n, -answer.tangential, arm1 * twist, arm2 * twist, answer.slip, answer.slipping };
}

/// The same for a solid, body 1, and a sphere: the reduced radius is the sphere's own.
template <class Law>
PairResponse respond(const Law& law, const SolidAndSphere& pair, const Vector3r& slip, Real dt, LeverArm lever = LeverArm::radius)
{
	const Vector3r& n = pair.normal;
	const Real arm = pair.radius - lever_loss(lever, pair.overlap);
	const Vector3r material = pair.solid_velocity + pair.solid_spin.cross(pair.lever);
	const auto motion = relative_motion(n, Vector3r(pair.velocity - material), Vector3r(arm * pair.spin));
	const auto answer = answer_to(law, n, motion, pair.overlap, pair.radius, pair.effective_mass, slip, dt);
	const Vector3r force1 = answer.tangential - answer.normal * n;
	return { answer.normal * n, -answer.tangential, pair.lever.cross(force1), arm * n.cross(answer.tangential), answer.slip,
		answer.slipping };
}

}  // namespace graindrive::laws
