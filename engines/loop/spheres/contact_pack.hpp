/// A pack of contacts of spheres: geometry from sums and differences of rows, then forces by the law's terms.
///
///   n = d/r,  v_n = dv.n,  w = dv - v_n n,  v_t = (R_1 w_1 + R_2 w_2) x n - w,  F_1 = -F_n n + F_t,  torque_i = R_i (n x F_t)
///
/// d and dv are those of sphere 2 against 1. The force acts at each sphere's own surface, as in `respond` with LeverArm::radius.
///
/// The tangential spring turns with the contact: by the rotation that takes n_old to n without twist,
///
///   s' = s - (s.n)/(1 + n.n_old) (n + n_old) = s - (s.n) n + (s.n) w dt / (|d_old| + r - v_n dt),   d_old = d - dv dt (leapfrog)
///
/// where the divisor is taken as 2 r: s' is exactly tangent, and its length changes by less than the fourth power of the angle turned.
#pragma once
#include "engines/laws/sphere_terms.hpp"
#include "engines/loop/simd_pack.hpp"

namespace graindrive::loop {
namespace {

template <class S>
struct Vector3 {
	S x, y, z;
};

template <class S>
inline S dot(const Vector3<S>& a, const Vector3<S>& b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class S>
inline Vector3<S> cross(const Vector3<S>& a, const Vector3<S>& b)
{
	return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}
template <class S>
inline Vector3<S> operator*(const S& a, const Vector3<S>& b)
{
	return { a * b.x, a * b.y, a * b.z };
}
template <class S>
inline Vector3<S> operator+(const Vector3<S>& a, const Vector3<S>& b)
{
	return { a.x + b.x, a.y + b.y, a.z + b.z };
}
template <class S>
inline Vector3<S> operator-(const Vector3<S>& a, const Vector3<S>& b)
{
	return { a.x - b.x, a.y - b.y, a.z - b.z };
}
template <class S, class Mask>
inline Vector3<S> select(const Mask& where, const Vector3<S>& yes, const Vector3<S>& no)
{
	return { select(where, yes.x, no.x), select(where, yes.y, no.y), select(where, yes.z, no.z) };
}

/// The law's input for a pack of pairs, and the position of the pack.
template <class S>
struct ContactPack {
	Vector3<S> n, centres, rolling;  ///< w and (R_1 w_1 + R_2 w_2) x n
	S normal_velocity, half_inverse_distance;
	laws::Overlap<S> overlap;
	typename S::Mask touching;
	std::uint32_t at;
};

/// What a pack of pairs does to its owners.
template <class S>
struct ContactForces {
	Vector3<S> force, turn, spring;
};

/// Columns of row differences and sums -> geometry of the pairs that touch; false if none does.
template <class Law, bool Friction, class S>
inline bool contact_pack(const S* column, ContactPack<S>& contact)
{
	const Vector3<S> d{ column[0], column[1], column[2] };
	const S& reach = column[3];
	const S square = dot(d, d);
	contact.touching = square < reach * reach;
	if (!any(contact.touching)) return false;
	const S distance = sqrt(square), inverse = S(1) / distance;
	const Vector3<S> n = inverse * d, dv{ column[4], column[5], column[6] };
	contact.n = n;
	contact.normal_velocity = dot(dv, n);
	contact.overlap.overlap = max(reach - distance, S(0));
	if constexpr (laws::TermsOf<Law>::roots > 0) contact.overlap.root = sqrt(contact.overlap.overlap);
	if constexpr (laws::TermsOf<Law>::roots > 1) contact.overlap.fourth_root = sqrt(contact.overlap.root);
	if constexpr (Friction) {
		contact.half_inverse_distance = S(0.5) * inverse;
		contact.centres = dv - contact.normal_velocity * n;
		contact.rolling = cross(Vector3<S>{ column[7], column[8], column[9] }, n);
	}
	return true;
}

/// Forces on the owners, and the springs to keep.
template <bool Friction, class Law, class S>
inline ContactForces<S> contact_forces(
	const Law& law, const ContactPack<S>& c, const Vector3<S>& spring, const S& stiffness, const S& damping, const S& dt)
{
	const S zero(0);
	const Vector3<S> none{ zero, zero, zero };
	const auto terms = contact_terms(law, stiffness, damping, c.overlap);
	const S normal = select(c.touching, terms.elastic - terms.normal_dashpot * c.normal_velocity, zero);
	if constexpr (!Friction) return { { -(normal * c.n.x), -(normal * c.n.y), -(normal * c.n.z) }, none, none };

	const S out_of_plane = dot(spring, c.n);
	const Vector3<S> turned = (spring - out_of_plane * c.n) + (out_of_plane * (c.half_inverse_distance * dt)) * c.centres;
	const Vector3<S> v_t = c.rolling - c.centres;
	Vector3<S> kept = turned + dt * v_t;
	const S k = -terms.tangential_stiffness, g = terms.tangential_dashpot;
	Vector3<S> friction = k * kept - g * v_t;
	const S bound = abs(normal) * S(law.mu), square = dot(friction, friction);
	const auto beyond = square > bound * bound;
	if (any(beyond)) {
		friction = select(beyond, bound / sqrt(square), S(1)) * friction;
		if constexpr (laws::TermsOf<Law>::slipping_spring_stays)
			kept = select(beyond, turned, kept);
		else
			kept = select(beyond, (S(1) / k) * (friction + g * v_t), kept);
	}
	friction = select(c.touching, friction, none);
	return { friction - normal * c.n, cross(c.n, friction), select(c.touching, kept, none) };
}

}  // namespace
}  // namespace graindrive::loop
