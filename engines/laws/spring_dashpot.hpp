/// Linear spring-dashpot with a given restitution: Oba, Otsuki (2025).
#pragma once
#include "engines/laws/contact.hpp"

namespace graindrive::laws {

/// Linear spring-dashpot with a spring that is integrated only while the contact sticks: Oba, Otsuki (2025).
///
///   F_n = k_n delta - eta_n v_n,  F_t = -(k_t s + eta_t v_t), cut at mu F_n,  ds/dt = v_t while sticking, else 0
///   eta = -2 ln e sqrt(m_eff k_n / (pi^2 + ln^2 e))
template <class P = Real>
struct SpringDashpot {
	static constexpr const char* name = "springDashpot";
	static constexpr bool acts_at_contact_point = false, remembers_force = false, weighs_members_alone = false;

	P k_n;      ///< normal stiffness [N/m]
	P k_t;      ///< tangential stiffness [N/m]
	P damping;  ///< eta / sqrt(m_eff): -2 ln e sqrt(k_n / (pi^2 + ln^2 e)) [kg^1/2 s^-1], see `of`
	P mu;       ///< friction coefficient [-]

	/// By default the paper's, in units of m, g, d.
	struct Given {
		Real k_n = 2e5, k_t = 2e5 * 2 / 7, restitution = 0.92;

		template <class Visit>
		static void quantities(Visit&& visit)
		{
			SpringDashpot::list<Given>(visit);
			visit(coefficient_of_restitution, &Given::restitution);
		}
	};
	template <class Visit>
	static void constants(Visit&& visit)
	{
		list<SpringDashpot>(visit);
		visit(Quantity{ "damping", "eta/sqrt(m_eff)", "kg^1/2/s", "damping", not_negative }, &SpringDashpot::damping);
		visit(friction_coefficient, &SpringDashpot::mu);
	}
	static SpringDashpot of(const Given& given, Real mu)
	{
		require_in_range(given);
		require(friction_coefficient, mu);
		return { P(given.k_n), P(given.k_t), P(2 * damping_fraction(given.restitution) * std::sqrt(given.k_n)), P(mu) };
	}

	template <class Contact>
	auto terms(const Contact& c) const
	{
		using S = std::decay_t<decltype(c.overlap)>;
		const S eta = dashpot(c.effective_mass);
		return Terms<S>{ elastic(c.overlap), 0.5 * k_n * c.overlap * c.overlap, S(k_n), eta, S(k_t), eta };
	}

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& slip) const
	{
		using std::abs;
		const S eta = dashpot(c.effective_mass);
		const S normal = elastic(c.overlap) - eta * c.normal_velocity;
		const T spring = slip + c.tangential_velocity * c.dt;
		const auto bound = truncated(T(-(k_t * spring + eta * c.tangential_velocity)), S(mu * abs(normal)));
		return Response<S, T, decltype(bound.cut)>{ normal, bound.value, select(bound.cut, slip, spring), bound.cut };
	}

private:
	template <class S>
	S elastic(const S& overlap) const
	{
		return k_n * overlap;
	}
	/// eta, of both directions
	template <class S>
	S dashpot(const S& mass) const
	{
		using std::sqrt;
		return damping * sqrt(mass);
	}
	template <class Holder, class Visit>
	static void list(Visit&& visit)
	{
		visit(Quantity{ "normalStiffness", "k_n", "N/m", "normal stiffness", positive }, &Holder::k_n);
		visit(Quantity{ "tangentialStiffness", "k_t", "N/m", "tangential stiffness", not_negative }, &Holder::k_t);
	}
};

/// Spring-dashpot from stiffnesses [N/m] and restitution in (0, 1].
/// @throws std::invalid_argument for a value out of range
inline SpringDashpot<Real> spring_dashpot(Real k_n, Real k_t, Real restitution, Real mu)
{
	return SpringDashpot<Real>::of({ k_n, k_t, restitution }, mu);
}

}  // namespace graindrive::laws
