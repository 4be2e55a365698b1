/// YADE's no-slip Hertz-Mindlin law for disks of one material, as YADE 2023.02a computes it. How it differs: see cundall_strack.hpp.
#pragma once
#include "engines/laws/contact.hpp"

namespace graindrive::laws {

/// YADE's Law2_ScGeom_MindlinPhys_Mindlin with Ip2_FrictMat_FrictMat_MindlinPhys, without adhesion and moments.
///
///   F_n = max(0, 4/3 E_eff h delta - c_n v_n),  F_t = -(f + c_t v_t),  df = k_t v_t dt,  h = sqrt(R_eff delta)
///   c_n = 2 beta_n sqrt(m_eff k_n), k_n = 2 E_eff h;   c_t = 2 beta_t sqrt(m_eff k_t), k_t = 8 G_eff h
///
/// with E_eff = E/(2(1-nu^2)) and G_eff = E/(4(1+nu)(2-nu)). Where |f| exceeds mu F_n, f is cut to it and the dashpot is left out; a
/// sticking contact may exceed the bound by its dashpot. A member of a clump counts in m_eff with its own mass.
template <class P = Real>
struct HertzMindlin {
	static constexpr const char* name = "hertzMindlin";
	static constexpr bool acts_at_contact_point = true, remembers_force = true, weighs_members_alone = true;

	P effective_young;     ///< E_eff [Pa]
	P effective_shear;     ///< G_eff [Pa]
	P normal_dashpot;      ///< c_n / sqrt(m_eff h) = 2 beta_n sqrt(2 E_eff) [Pa^1/2]
	P tangential_dashpot;  ///< c_t / sqrt(m_eff h) = 2 beta_t sqrt(8 G_eff) [Pa^1/2]
	P mu;                  ///< friction coefficient [-]

	struct Given {
		Real young = 5e6, poisson = 0.45, beta_n = 0, beta_t = 0;

		template <class Visit>
		static void quantities(Visit&& visit)
		{
			visit(young_modulus, &Given::young);
			visit(poisson_ratio, &Given::poisson);
			visit(Quantity{ "normalDampingRatio", "beta_n", "-", "normal damping ratio", not_negative }, &Given::beta_n);
			visit(Quantity{ "tangentialDampingRatio", "beta_t", "-", "tangential damping ratio", not_negative }, &Given::beta_t);
		}
	};
	template <class Visit>
	static void constants(Visit&& visit)
	{
		using Self = HertzMindlin;
		visit(Quantity{ "effectiveYoung", "E_eff", "Pa", "effective modulus", positive }, &Self::effective_young);
		visit(Quantity{ "effectiveShear", "G_eff", "Pa", "effective shear modulus", positive }, &Self::effective_shear);
		visit(Quantity{ "normalDashpot", "c_n/sqrt(m_eff h)", "Pa^1/2", "normal dashpot", not_negative }, &Self::normal_dashpot);
		visit(Quantity{ "tangentialDashpot", "c_t/sqrt(m_eff h)", "Pa^1/2", "tangential dashpot", not_negative },
			&Self::tangential_dashpot);
		visit(friction_coefficient, &Self::mu);
	}
	static HertzMindlin of(const Given& given, Real mu)
	{
		require_in_range(given);
		require(friction_coefficient, mu);
		const Real nu = given.poisson, e_eff = given.young / (2 * (1 - nu * nu)), g_eff = given.young / (4 * (1 + nu) * (2 - nu));
		return { P(e_eff), P(g_eff), P(2 * given.beta_n * std::sqrt(2 * e_eff)), P(2 * given.beta_t * std::sqrt(8 * g_eff)),
			P(mu) };
	}

	template <class Contact>
	auto terms(const Contact& c) const
	{
		using S = std::decay_t<decltype(c.overlap)>;
		const Scales<S> at = scales<S>(c);
		return Terms<S>{ elastic(at, c.overlap), 0.4 * elastic(at, c.overlap) * c.overlap, 2 * effective_young * at.hertz,
			at.dashpot, at.tangential_stiffness, at.tangential_dashpot };
	}

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& remembered) const
	{
		using std::max;
		const Scales<S> at = scales<S>(c);
		const S normal = max(S(elastic(at, c.overlap) - at.dashpot * c.normal_velocity), S(P(0)));
		const T elastic = remembered + (at.tangential_stiffness * c.dt) * c.tangential_velocity;
		const auto bound = truncated(T(-elastic), S(mu * normal));
		const T damped = bound.value - at.tangential_dashpot * c.tangential_velocity;
		return Response<S, T, decltype(bound.cut)>{ normal, select(bound.cut, bound.value, damped), T(-bound.value), bound.cut };
	}

private:
	/// What the terms are made of; the elastic force apart, as in `HertzRestitution`.
	template <class S>
	struct Scales {
		S hertz, dashpot, tangential_stiffness, tangential_dashpot;
	};
	template <class S, class Contact>
	Scales<S> scales(const Contact& c) const
	{
		using std::sqrt;
		const S hertz = sqrt(c.effective_radius * c.overlap);
		const S root = sqrt(c.effective_mass * hertz);
		return { hertz, normal_dashpot * root, (effective_shear * P(8)) * hertz, tangential_dashpot * root };
	}
	template <class S>
	S elastic(const Scales<S>& at, const S& overlap) const
	{
		return (effective_young * P(4.0 / 3)) * at.hertz * overlap;
	}
};

/// Disks of one material: Young's modulus [Pa], Poisson's ratio, ratios of the dashpots to critical damping (MindlinPhys.betan, betas), friction.
/// @throws std::invalid_argument for a value out of range
inline HertzMindlin<Real> hertz_mindlin(Real young, Real poisson, Real beta_n, Real beta_t, Real mu)
{
	return HertzMindlin<Real>::of({ young, poisson, beta_n, beta_t }, mu);
}

}  // namespace graindrive::laws
