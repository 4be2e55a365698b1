/// Input and output of a contact law: kinematics of one contact, forces, and the terms of which they consist.
///
/// A law gets the kinematics of one contact and the tangential spring from the previous step, and returns the forces and the
/// new spring. It has no access to bodies and no state, so YADE's functors, GrainLoop and the tests all call this code.
///
/// `S` is the scalar (double, float or a SIMD pack), `T` the tangential vector: a signed `S` along t = z x n in two
/// dimensions, `Vector3r` in three. `n` points from the grain that the force acts on (i) to its partner (j).
///
/// Signs: normal force F_n > 0 repels. v_n > 0 separates (v_n = -d(overlap)/dt). v_t is the velocity of i's surface relative
/// to j's in the tangent plane; the tangential force on i is returned with its sign, i.e. opposing slip.
#pragma once
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "engines/base/branchless.hpp"
#include "engines/laws/quantity.hpp"

namespace graindrive::laws {

/// Input of a law: one contact at one step.
template <class S, class T>
struct Kinematics {
	S overlap;              ///< delta = R_i + R_j - r_ij [m], > 0
	S normal_velocity;      ///< v_n, > 0 when separating [m/s]
	T tangential_velocity;  ///< v_t of i's surface against j's [m/s]
	S effective_radius;     ///< R_i R_j / (R_i + R_j) [m]
	S effective_mass;       ///< m_i m_j / (m_i + m_j) [kg]
	S dt;                   ///< time step [s]
};

/// The part of it that the terms of a law depend on.
template <class S>
struct Squeezed {
	S overlap, effective_radius, effective_mass;  ///< as in `Kinematics`
};

/// Output of a law: forces on grain i, and the tangential spring for the next step.
template <class S, class T, class Mask>
struct Response {
	S normal;       ///< F_n, along -n on i [N]
	T tangential;   ///< F_t on i [N]
	T slip;         ///< tangential spring s [m], to be kept with the contact; a law that `remembers_force` keeps a force f [N]
	Mask slipping;  ///< true where Coulomb's bound was active
};

/// The terms of a law at one overlap. Of these consist its forces, before Coulomb's bound and, where it never pulls, that of F_n:
///
///   F_n = F_el(delta) - c_n v_n,  F_el = dU/d(delta),   F_t = -(k_t s + c_t v_t),  k_t s = f for a law that remembers a force
template <class S>
struct Terms {
	S elastic;               ///< F_el [N]
	S energy;                ///< U, stored by it [J]
	S stiffness;             ///< dF_el/d(delta) [N/m]
	S dashpot;               ///< c_n [N s/m]: the damping part of F_n is -c_n v_n
	S tangential_stiffness;  ///< k_t [N/m]
	S tangential_dashpot;    ///< c_t [N s/m]
};

inline Real inner(Real a, Real b) { return a * b; }
inline Real inner(const Vector3r& a, const Vector3r& b) { return a.dot(b); }

/// Energy of the tangential spring, 1/2 k_t s^2 or f^2 / 2 k_t [J].
template <class Law, class T>
Real tangential_energy(const Law&, const Terms<Real>& terms, const T& remembered)
{
	if constexpr (Law::remembers_force) return inner(T(0.5 / terms.tangential_stiffness * remembered), remembered);
	return inner(T(0.5 * terms.tangential_stiffness * remembered), remembered);
}

}  // namespace graindrive::laws
