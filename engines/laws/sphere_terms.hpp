/// The contact laws for spheres, written as terms: two constants of a pair, computed once, and what of the force depends on the overlap.
///
///   F_n = elastic - c_n v_n,   F_t = -(k_t s + c_t v_t), cut at mu |F_n|
///
/// with the symbols of the laws. The constants take the roots and divisions of radii and masses out of the step.
#pragma once
#include <cmath>

#include "engines/laws/registry.hpp"

namespace graindrive::laws {

/// Two constants of a pair in contact; each law explains their meaning.
struct PairConstants {
	Real stiffness, damping;
};

/// The overlap and its roots; a law uses those that it asks for.
template <class S>
struct Overlap {
	S overlap, root, fourth_root;  ///< delta [m], delta^(1/2), delta^(1/4)
};

template <class S>
struct ContactTerms {
	S elastic;               ///< [N]
	S normal_dashpot;        ///< c_n [kg/s]
	S tangential_stiffness;  ///< k_t [N/m]
	S tangential_dashpot;    ///< c_t [kg/s]
};

/// How many roots of the overlap a law's terms need, and whether a slipping spring stays as long as it is (true), or is made so long that
/// spring and dashpot together give the bound.
template <class Law>
struct TermsOf;

template <class P>
struct TermsOf<HertzHistory<P>> {
	static constexpr int roots = 1;
	static constexpr bool slipping_spring_stays = false;
};
template <class P>
struct TermsOf<HertzRestitution<P>> {
	static constexpr int roots = 2;
	static constexpr bool slipping_spring_stays = false;
};
template <class P>
struct TermsOf<SpringDashpot<P>> {
	static constexpr int roots = 0;
	static constexpr bool slipping_spring_stays = true;
};

template <class Law>
constexpr bool has_terms_of(decltype(TermsOf<Law>::roots)*)
{
	return true;
}
template <class Law>
constexpr bool has_terms_of(...)
{
	return false;
}

/// True for the laws of the loop over spheres; only the type of the argument matters.
constexpr auto is_for_spheres = [](const auto& law) constexpr { return has_terms_of<std::decay_t<decltype(law)>>(nullptr); };

/// sqrt(R_eff) and m_eff.
inline PairConstants pair_constants(const HertzHistory<Real>&, Real effective_radius, Real effective_mass)
{
	return { std::sqrt(effective_radius), effective_mass };
}

template <class P, class S>
ContactTerms<S> contact_terms(const HertzHistory<P>& law, const S& root_radius, const S& effective_mass, const Overlap<S>& c)
{
	const S hertz = root_radius * c.root, damped = hertz * effective_mass;
	return { (law.k_n * hertz) * c.overlap, law.gamma_n * damped, law.k_t * hertz, law.gamma_t * damped };
}

/// k* = 4/3 E_eff sqrt(R_eff) and g_n = sqrt(5) b sqrt(m_eff k*).
inline PairConstants pair_constants(const HertzRestitution<Real>& law, Real effective_radius, Real effective_mass)
{
	const Real k = law.effective_young * (4.0 / 3.0) * std::sqrt(effective_radius);
	return { k, law.damping_fraction * std::sqrt(5 * effective_mass * k) };
}

/// g_t / g_n = sqrt(10/3) sqrt(c) / sqrt(5).
template <class P, class S>
ContactTerms<S> contact_terms(const HertzRestitution<P>& law, const S& k, const S& g, const Overlap<S>& c)
{
	const P tangential = std::sqrt(P(2.0 / 3.0) * law.tangential_ratio);
	const S stiffness = k * c.root, dashpot = g * c.fourth_root;
	return { stiffness * c.overlap, dashpot, law.tangential_ratio * stiffness, tangential * dashpot };
}

/// Nothing (the stiffness is the same for all pairs) and eta.
inline PairConstants pair_constants(const SpringDashpot<Real>& law, Real, Real effective_mass)
{
	return { 0, law.damping * std::sqrt(effective_mass) };
}

template <class P, class S>
ContactTerms<S> contact_terms(const SpringDashpot<P>& law, const S&, const S& eta, const Overlap<S>& c)
{
	return { law.k_n * c.overlap, eta, S(law.k_t), eta };
}

}  // namespace graindrive::laws
