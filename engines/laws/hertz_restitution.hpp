/// Hertz's law with a given restitution: Guillard, Forterre, Pouliquen, Phys. Fluids 26, 043301 (2014).
#pragma once
#include "engines/laws/contact.hpp"

namespace graindrive::laws {

/// Hertz-Mindlin law with damping set by the coefficient of restitution: Guillard et al., Eq. (A1) and Table I.
///
///   F_n = k* delta^(3/2) - g_n delta^(1/4) v_n,                  k*   = (4/3) E_eff sqrt(R_eff), g_n = sqrt(5) b sqrt(m_eff k*)
///   F_t = -(k*_t delta^(1/2) s + g_t delta^(1/4) v_t), <= mu |F_n|,  k*_t = c k*,               g_t = sqrt(10/3) b sqrt(m_eff k*_t)
///
/// with E_eff = E/(2(1-nu^2)), c = 3(1-nu)/(2-nu) and b = -ln e/sqrt(ln^2 e + pi^2). Both columns of Table I are this one
/// formula: R_eff = d/4, m_eff = m/2 for two grains, R_eff = d/2, m_eff = m for a grain on the cylinder (a plane). In the
/// table's cylinder column the k*_n under the root is the grains' one (only that gives the printed 0.26 kg s^-1 m^-1/4).
/// The table writes gamma_t over delta_t^(1/4); the stiffness it damps grows as sqrt(delta_n), so a damping that stays a
/// constant fraction of critical needs delta_n, which is the reading here (LIGGGHTS takes the same).
template <class P = Real>
struct HertzRestitution {
	static constexpr const char* name = "hertzRestitution";
	static constexpr bool acts_at_contact_point = false, remembers_force = false, weighs_members_alone = false;

	P effective_young;   ///< E_eff = E / (2 (1 - nu^2)) [Pa]
	P tangential_ratio;  ///< c = k*_t / k*_n [-], > 0
	P damping_fraction;  ///< b, fraction of critical damping [-]
	P mu;                ///< friction coefficient [-]

	/// By default the paper's, in SI units.
	struct Given {
		Real young = 5e6, poisson = 0.45, restitution = 0.6;

		template <class Visit>
		static void quantities(Visit&& visit)
		{
			visit(young_modulus, &Given::young);
			visit(poisson_ratio, &Given::poisson);
			visit(coefficient_of_restitution, &Given::restitution);
		}
	};
	template <class Visit>
	static void constants(Visit&& visit)
	{
		using Self = HertzRestitution;
		visit(Quantity{ "effectiveYoung", "E_eff", "Pa", "effective modulus", positive }, &Self::effective_young);
		visit(Quantity{ "tangentialRatio", "c", "-", "ratio of tangential to normal stiffness", positive },
			&Self::tangential_ratio);
		visit(
			Quantity{ "dampingFraction", "b", "-", "fraction of critical damping", { "must lie in [0, 1)", 0, 1, true, false } },
			&Self::damping_fraction);
		visit(friction_coefficient, &Self::mu);
	}
	static HertzRestitution of(const Given& given, Real mu)
	{
		require_in_range(given);
		require(friction_coefficient, mu);
		const Real nu = given.poisson;
		return { P(given.young / (2 * (1 - nu * nu))), P(3 * (1 - nu) / (2 - nu)), P(laws::damping_fraction(given.restitution)),
			P(mu) };
	}

	template <class Contact>
	auto terms(const Contact& c) const
	{
		using S = std::decay_t<decltype(c.overlap)>;
		const Scales<S> at = scales<S>(c);
		return Terms<S>{ elastic(at, c.overlap), 0.4 * at.k_n * c.overlap * c.overlap * at.root, 1.5 * at.k_n * at.root,
			at.dashpot, at.tangential_stiffness, at.tangential_dashpot };
	}

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& slip) const
	{
		using std::abs;
		const Scales<S> at = scales<S>(c);
		const S stiffness = at.tangential_stiffness;
		const S normal = elastic(at, c.overlap) - at.dashpot * c.normal_velocity;
		const T dashpot = at.tangential_dashpot * c.tangential_velocity;
		const T spring = slip + c.tangential_velocity * c.dt;
		const auto bound = truncated(T(-(stiffness * spring + dashpot)), S(mu * abs(normal)));
		const T shortened = (bound.value + dashpot) * (S(-1) / stiffness);
		return Response<S, T, decltype(bound.cut)>{ normal, bound.value, select(bound.cut, shortened, spring), bound.cut };
	}

private:
	/// What the terms are made of. The elastic force is computed where it is needed: its place among the other products decides which of
	/// them the kernels fuse.
	template <class S>
	struct Scales {
		S k_n, root, dashpot, tangential_stiffness, tangential_dashpot;
	};
	template <class S, class Contact>
	Scales<S> scales(const Contact& c) const
	{
		using std::sqrt;
		const S k_n = (effective_young * (4.0 / 3.0)) * sqrt(c.effective_radius);
		const S k_t = tangential_ratio * k_n;
		const S root = sqrt(c.overlap);
		const S fourth_root = sqrt(root);
		const S g_n = (damping_fraction * std::sqrt(5.0)) * sqrt(c.effective_mass * k_n);
		const S g_t = (damping_fraction * std::sqrt(10.0 / 3.0)) * sqrt(c.effective_mass * k_t);
		return { k_n, root, g_n * fourth_root, k_t * root, g_t * fourth_root };
	}
	template <class S>
	static S elastic(const Scales<S>& at, const S& overlap)
	{
		return at.k_n * overlap * at.root;
	}
};

/// Hertz-Mindlin grains of one material: Young's modulus [Pa], Poisson's ratio, restitution, friction (Guillard Table I).
/// @throws std::invalid_argument for a value out of range
inline HertzRestitution<Real> hertz_restitution(Real young, Real poisson, Real restitution, Real mu)
{
	return HertzRestitution<Real>::of({ young, poisson, restitution }, mu);
}

}  // namespace graindrive::laws
