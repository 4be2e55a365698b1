/// YADE's linear law for disks of one material, as YADE 2023.02a computes it: Cundall, Strack, Geotechnique 29, 47 (1979).
///
/// It and `HertzMindlin` differ from the other laws in ways that the constants of a law announce:
///   - `acts_at_contact_point`: the force acts at the middle of the overlap, so its lever on grain i is R_i - delta/2, and F_n never
///     pulls. The tangential velocity is that of YADE's `Ig2_Sphere_Sphere_ScGeom` with avoidGranularRatcheting,
///     alpha (v_1 - v_2).t + R_1 w_1 + R_2 w_2 with alpha = (R_1 + R_2)/r.
///   - `remembers_force`: a contact remembers its elastic tangential force f [N], not a length: it grows by k_t v_t dt with the present
///     stiffness, and a slipping contact keeps Coulomb's bound. In `Kinematics` and `Response` it takes the place of the slip.
/// From one step to the next YADE turns the remembered force by n_old x n_new to first order, which makes it longer by s^2/2, where s is
/// the angle of that step. Here it is turned exactly. That is the only difference beyond round-off.
#pragma once
#include "engines/laws/contact.hpp"

namespace graindrive::laws {

/// YADE's Law2_ScGeom_FrictPhys_CundallStrack with Ip2_FrictMat_FrictMat_FrictPhys.
///
///   F_n = k_n delta,  dF_t = -k_t v_t dt, |F_t| <= mu F_n,  k_n = 2 E R_eff, k_t = nu k_n
template <class P = Real>
struct CundallStrack {
	static constexpr const char* name = "cundallStrack";
	static constexpr bool acts_at_contact_point = true, remembers_force = true, weighs_members_alone = false;

	P young;             ///< E [Pa]
	P tangential_ratio;  ///< nu = k_t / k_n [-]; YADE reads it from FrictMat.poisson
	P mu;                ///< friction coefficient [-]

	struct Given {
		Real young = 5e6, poisson = 0.45;

		template <class Visit>
		static void quantities(Visit&& visit)
		{
			visit(young_modulus, &Given::young);
			visit(stiffness_ratio, &Given::poisson);
		}
	};
	template <class Visit>
	static void constants(Visit&& visit)
	{
		visit(young_modulus, &CundallStrack::young);
		visit(stiffness_ratio, &CundallStrack::tangential_ratio);
		visit(friction_coefficient, &CundallStrack::mu);
	}
	static CundallStrack of(const Given& given, Real mu)
	{
		require_in_range(given);
		require(friction_coefficient, mu);
		return { P(given.young), P(given.poisson), P(mu) };
	}

	template <class Contact>
	auto terms(const Contact& c) const
	{
		using S = std::decay_t<decltype(c.overlap)>;
		const S k_n = (young * P(2)) * c.effective_radius;
		return Terms<S>{ k_n * c.overlap, 0.5 * k_n * c.overlap * c.overlap, k_n, S(P(0)), tangential_ratio * k_n, S(P(0)) };
	}

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& remembered) const
	{
		const Terms<S> at = terms(c);
		const S normal = at.elastic;
		const auto bound = truncated(T(-(remembered + (at.tangential_stiffness * c.dt) * c.tangential_velocity)), S(mu * normal));
		return Response<S, T, decltype(bound.cut)>{ normal, bound.value, T(-bound.value), bound.cut };
	}

private:
	static constexpr Quantity stiffness_ratio{ "poisson", "nu", "-", "k_t/k_n (YADE's poisson)", not_negative };
};

/// Disks of one material: Young's modulus [Pa], Poisson's ratio as YADE reads it (k_t/k_n), friction.
/// @throws std::invalid_argument for a value out of range
inline CundallStrack<Real> cundall_strack(Real young, Real poisson, Real mu)
{
	return CundallStrack<Real>::of({ young, poisson }, mu);
}

}  // namespace graindrive::laws
