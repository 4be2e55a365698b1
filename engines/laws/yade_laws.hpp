/// YADE's own contact laws for disks of one material: Cundall-Strack and the no-slip Hertz-Mindlin law, as YADE 2023.02a computes them.
///
/// They differ from the laws in `contact_laws.hpp` in three ways, which the constants of each law announce:
///   - The force acts at the middle of the overlap, so its lever on grain i is R_i - delta/2. The tangential velocity is that of YADE's
///     `Ig2_Sphere_Sphere_ScGeom` with avoidGranularRatcheting, alpha (v_1 - v_2).t + R_1 w_1 + R_2 w_2 with alpha = (R_1 + R_2)/r.
///   - What a contact remembers is its elastic tangential force [N], not a length: it grows by k_t v_t dt with the present stiffness, and
///     a slipping contact keeps Coulomb's bound. In `Kinematics` and `Response` it takes the place of the slip.
///   - F_n never pulls.
/// From one step to the next YADE turns the remembered force by n_old x n_new to first order, which makes it longer by s^2/2, where s is
/// the angle of that step. Here it is turned exactly. That is the only difference beyond round-off.
#pragma once
#include <algorithm>

#include "engines/laws/contact_laws.hpp"

namespace graindrive::laws {

/// YADE's Law2_ScGeom_FrictPhys_CundallStrack with Ip2_FrictMat_FrictMat_FrictPhys: Cundall, Strack, Geotechnique 29, 47 (1979).
///
///   F_n = k_n delta,  dF_t = -k_t v_t dt, |F_t| <= mu F_n,  k_n = 2 E R_eff, k_t = nu k_n
template <class P = Real>
struct CundallStrack {
	static constexpr bool acts_at_contact_point = true, remembers_force = true;

	P young;             ///< E [Pa]
	P tangential_ratio;  ///< nu = k_t / k_n [-]; YADE reads it from FrictMat.poisson
	P mu;                ///< friction coefficient [-]

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& remembered) const
	{
		const S k_n = (young * P(2)) * c.effective_radius;
		const S normal = k_n * c.overlap;
		const auto bound = truncated(T(-(remembered + (tangential_ratio * k_n * c.dt) * c.tangential_velocity)), S(mu * normal));
		return Response<S, T, decltype(bound.cut)>{ normal, bound.value, T(-bound.value), bound.cut };
	}
};

/// YADE's Law2_ScGeom_MindlinPhys_Mindlin with Ip2_FrictMat_FrictMat_MindlinPhys, without adhesion and moments.
///
///   F_n = max(0, 4/3 E_eff h delta - c_n v_n),  F_t = -(f + c_t v_t),  df = k_t v_t dt,  h = sqrt(R_eff delta)
///   c_n = 2 beta_n sqrt(m_eff k_n), k_n = 2 E_eff h;   c_t = 2 beta_t sqrt(m_eff k_t), k_t = 8 G_eff h
///
/// with E_eff = E/(2(1-nu^2)) and G_eff = E/(4(1+nu)(2-nu)). Where |f| exceeds mu F_n, f is cut to it and the dashpot is left out; a
/// sticking contact may exceed the bound by its dashpot. A member of a clump counts in m_eff with its own mass.
template <class P = Real>
struct HertzMindlin {
	static constexpr bool acts_at_contact_point = true, remembers_force = true;

	P effective_young;     ///< E_eff [Pa]
	P effective_shear;     ///< G_eff [Pa]
	P normal_dashpot;      ///< c_n / sqrt(m_eff h) = 2 beta_n sqrt(2 E_eff) [Pa^1/2]
	P tangential_dashpot;  ///< c_t / sqrt(m_eff h) = 2 beta_t sqrt(8 G_eff) [Pa^1/2]
	P mu;                  ///< friction coefficient [-]

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& remembered) const
	{
		using std::max;
		using std::sqrt;
		const S hertz = sqrt(c.effective_radius * c.overlap);
		const S dashpot = sqrt(c.effective_mass * hertz);
		const S normal =
			max(S((effective_young * P(4.0 / 3)) * hertz * c.overlap - normal_dashpot * dashpot * c.normal_velocity), S(P(0)));
		const T elastic = remembered + ((effective_shear * P(8)) * hertz * c.dt) * c.tangential_velocity;
		const auto bound = truncated(T(-elastic), S(mu * normal));
		const T damped = bound.value - (tangential_dashpot * dashpot) * c.tangential_velocity;
		return Response<S, T, decltype(bound.cut)>{ normal, select(bound.cut, bound.value, damped), T(-bound.value), bound.cut };
	}
};

/// Disks of one material: Young's modulus [Pa], Poisson's ratio as YADE reads it (k_t/k_n), friction.
/// @throws std::invalid_argument for a value out of range
CundallStrack<Real> cundall_strack(Real young, Real poisson, Real mu);

/// Disks of one material: Young's modulus [Pa], Poisson's ratio, ratios of the dashpots to critical damping (MindlinPhys.betan, betas), friction.
/// @throws std::invalid_argument for a value out of range
HertzMindlin<Real> hertz_mindlin(Real young, Real poisson, Real beta_n, Real beta_t, Real mu);

}  // namespace graindrive::laws
