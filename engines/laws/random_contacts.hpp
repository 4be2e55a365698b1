/// Random contacts, slipping and sticking, pressing and attracting, for every law: what the tests of the laws draw from.
#pragma once
#include <random>

#include "engines/laws/registry.hpp"

namespace graindrive::laws {

constexpr Real round_off = 1e-13;  // relative; a dozen operations, with a digit to spare

struct RandomContacts {
	std::mt19937_64 random{ 2014 };

	Real unit() { return (random() >> 11) * 0x1p-53; }
	Real in(Real low, Real high) { return low + (high - low) * unit(); }
	Vector3r vector() { return { in(-1, 1), in(-1, 1), in(-1, 1) }; }

	Kinematics<Real, Vector3r> contact(const Vector3r& v_t)
	{
		return { in(1e-6, 1e-3), in(-1, 1), v_t, in(0.1, 1), in(0.1, 5), 1e-4 };
	}
};

template <class T>
Kinematics<Real, T> with(const Kinematics<Real, Vector3r>& c, const T& v_t)
{
	return { c.overlap, c.normal_velocity, v_t, c.effective_radius, c.effective_mass, c.dt };
}

/// Calls check(law) for one law of each kind that remembers a length; stiffnesses such that about half of the random contacts slip.
template <class Check>
void for_laws_with_a_spring(Check check)
{
	check(HertzHistory<Real>{ 2e6, 2.46e6, 2500, 2500, 0.5 });
	check(hertz_restitution(5e6, 0.45, 0.6, 0.5));
	check(spring_dashpot(2e5, 2e5 * 2 / 7, 0.92, 0.5));
}

template <class Check>
void for_every_law(Check check)
{
	for_laws_with_a_spring(check);
	check(cundall_strack(1e4, 0.3, 0.5));  // what it remembers is a force: 1e-3 N is about Coulomb's bound at these overlaps
	check(hertz_mindlin(1e4, 0.3, 0.2, 0.1, 0.5));
}

template <class Law, class Check>
void check_random_contacts(const Law& law, Check check)
{
	RandomContacts draw;
	for (int i = 0; i < 500; ++i) {
		const Vector3r v_t = draw.vector();
		check(law, draw.contact(v_t), Vector3r(1e-3 * draw.unit() * draw.vector()));
	}
}

/// Calls check(law, contact, spring) for random contacts under every law; v_t and the spring are any vectors in the tangent plane.
template <class Check>
void for_random_contacts(Check check)
{
	for_every_law([&](const auto& law) { check_random_contacts(law, check); });
}

/// The same under the laws that remember a length.
template <class Check>
void for_random_springs(Check check)
{
	for_laws_with_a_spring([&](const auto& law) { check_random_contacts(law, check); });
}

}  // namespace graindrive::laws
