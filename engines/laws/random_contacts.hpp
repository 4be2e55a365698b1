/// Random contacts, slipping and sticking, pressing and attracting, for every law: what the tests of the laws draw from.
#pragma once
#include <random>

#include "engines/laws/contact_laws.hpp"

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

/// Calls check(law) for one law of each kind; stiffnesses such that about half of the random contacts slip.
template <class Check>
void for_every_law(Check check)
{
	check(HertzHistory<Real>{ 2e6, 2.46e6, 2500, 2500, 0.5 });
	check(hertz_restitution(5e6, 0.45, 0.6, 0.5));
	check(spring_dashpot(2e5, 2e5 * 2 / 7, 0.92, 0.5));
}

/// Calls check(law, contact, spring) for random contacts under every law; v_t and the spring are any vectors in the tangent plane.
template <class Check>
void for_random_contacts(Check check)
{
	for_every_law([&](const auto& law) {
		RandomContacts draw;
		for (int i = 0; i < 500; ++i) {
			const Vector3r v_t = draw.vector();
			check(law, draw.contact(v_t), Vector3r(1e-3 * draw.unit() * draw.vector()));
		}
	});
}

}  // namespace graindrive::laws
