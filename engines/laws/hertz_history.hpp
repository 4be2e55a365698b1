/// Hertz's law with history: Brilliantov et al., Phys. Rev. E 53, 5382 (1996); Silbert et al., Phys. Rev. E 64, 051302 (2001).
#pragma once
#include "engines/laws/contact.hpp"

namespace graindrive::laws {

/// Brilliantov-Silbert law (LAMMPS `gran/hertz/history`): the Magnus and wiggle papers' Eqs (2.1), (2.2).
///
///   F_n = sqrt(R_eff delta) (K_n delta - m_eff gamma_n v_n)
///   F_t = -min(mu |F_n|, sqrt(R_eff delta) |K_t s + m_eff gamma_t v_t|) t
///
/// F_n may attract at the end of an impact: the papers and LAMMPS do not cut it. A slipping spring is shortened so that spring and
/// dashpot together give the bound. Cutting comes before the factor sqrt(R_eff delta), common to both sides, which saves a division.
template <class P = Real>
struct HertzHistory {
	static constexpr const char* name = "hertzHistory";
	static constexpr bool acts_at_contact_point = false, remembers_force = false, weighs_members_alone = false;

	P k_n;      ///< normal stiffness K_n [Pa]
	P k_t;      ///< tangential stiffness K_t [Pa], > 0
	P gamma_n;  ///< normal damping [1/(m s)]
	P gamma_t;  ///< tangential damping [1/(m s)]
	P mu;       ///< friction coefficient [-]

	/// By default the wiggle paper's, in units of d, rho, g.
	struct Given {
		Real k_n = 2e6, k_t = 2.46e6, gamma_n = 2500, gamma_t = 2500;

		template <class Visit>
		static void quantities(Visit&& visit)
		{
			HertzHistory::list<Given>(visit);
		}
	};
	template <class Visit>
	static void constants(Visit&& visit)
	{
		list<HertzHistory>(visit);
		visit(friction_coefficient, &HertzHistory::mu);
	}
	static HertzHistory of(const Given& given, Real mu)
	{
		require_in_range(given);
		require(friction_coefficient, mu);
		return { P(given.k_n), P(given.k_t), P(given.gamma_n), P(given.gamma_t), P(mu) };
	}

	template <class Contact>
	auto terms(const Contact& c) const
	{
		using std::sqrt;
		using S = std::decay_t<decltype(c.overlap)>;
		const S hertz = sqrt(c.effective_radius * c.overlap);
		return Terms<S>{ k_n * hertz * c.overlap, 0.4 * k_n * hertz * c.overlap * c.overlap, 1.5 * k_n * hertz,
			gamma_n * c.effective_mass * hertz, k_t * hertz, gamma_t * c.effective_mass * hertz };
	}

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& slip) const
	{
		using std::abs;
		using std::sqrt;
		const S hertz = sqrt(c.effective_radius * c.overlap);
		const S normal = k_n * c.overlap - c.effective_mass * gamma_n * c.normal_velocity;
		const T dashpot = (c.effective_mass * gamma_t) * c.tangential_velocity;
		const T spring = slip + c.tangential_velocity * c.dt;
		const auto bound = truncated(T(-(k_t * spring + dashpot)), S(mu * abs(normal)));
		const T shortened = (bound.value + dashpot) * (S(-1) / k_t);
		return Response<S, T, decltype(bound.cut)>{ hertz * normal, hertz * bound.value, select(bound.cut, shortened, spring),
			bound.cut };
	}

private:
	template <class Holder, class Visit>
	static void list(Visit&& visit)
	{
		visit(Quantity{ "normalStiffness", "K_n", "Pa", "normal stiffness", positive }, &Holder::k_n);
		visit(Quantity{ "tangentialStiffness", "K_t", "Pa", "tangential stiffness", positive,
				  " (friction=0 switches tangential forces off)" },
			&Holder::k_t);
		visit(Quantity{ "normalDamping", "gamma_n", "1/(m s)", "normal damping", not_negative }, &Holder::gamma_n);
		visit(Quantity{ "tangentialDamping", "gamma_t", "1/(m s)", "tangential damping", not_negative }, &Holder::gamma_t);
	}
};

}  // namespace graindrive::laws
