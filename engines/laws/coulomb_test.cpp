/// The tangential force of every law: spring and dashpot, Coulomb's bound, and what a slipping contact remembers.
#include <gtest/gtest.h>

#include <algorithm>

#include "engines/laws/random_contacts.hpp"

using namespace graindrive;
using namespace graindrive::laws;

namespace {

/// F_t = -(stiffness s + damping v_t) before Coulomb's bound, with the two factors of the papers.
struct Tangential {
	Real stiffness, damping;  // [N/m], [N s/m]
};

Tangential tangential(const HertzHistory<Real>& law, Real overlap, Real radius, Real mass)
{
	return { std::sqrt(radius * overlap) * law.k_t, std::sqrt(radius * overlap) * mass * law.gamma_t };
}

Tangential tangential(const HertzRestitution<Real>& law, Real overlap, Real radius, Real mass)
{
	const Real k_t = law.tangential_ratio * law.effective_young * 4 / 3 * std::sqrt(radius);
	return { k_t * std::sqrt(overlap),
		std::sqrt(10.0 / 3) * law.damping_fraction * std::sqrt(mass * k_t) * std::pow(overlap, 0.25) };
}

Tangential tangential(const SpringDashpot<Real>& law, Real, Real, Real mass)
{
	return { law.k_t, law.damping * std::sqrt(mass) };
}

}  // namespace

TEST(ContactLaws, tangential_force_never_passes_coulombs_bound_and_is_the_bound_where_it_slips)
{
	int slipping = 0, sticking = 0;
	for_random_springs([&](const auto& law, const auto& c, const Vector3r& spring) {
		const auto r = law(c, spring);
		const Real bound = law.mu * std::abs(r.normal);
		EXPECT_LE(r.tangential.norm(), bound * (1 + round_off));
		if (r.slipping) {
			EXPECT_NEAR(r.tangential.norm(), bound, round_off * bound);
		}
		++(r.slipping ? slipping : sticking);
	});
	EXPECT_GT(slipping, 100);  // both sticking and slipping occur
	EXPECT_GT(sticking, 100);
}

TEST(ContactLaws, a_sticking_spring_grows_by_the_slip_of_the_step)
{
	for_random_springs([](const auto& law, const auto& c, const Vector3r& spring) {
		const auto r = law(c, spring);
		if (!r.slipping) {
			EXPECT_EQ(r.slip, Vector3r(spring + c.tangential_velocity * c.dt));
		}
	});
}

TEST(ContactLaws, tangential_force_is_spring_and_dashpot_cut_at_the_bound_against_the_slip)
{
	int attracting = 0;
	for_random_springs([&](const auto& law, const auto& c, const Vector3r& spring) {
		const auto r = law(c, spring);
		const auto [k, g] = tangential(law, c.overlap, c.effective_radius, c.effective_mass);
		const Vector3r trial = -(k * (spring + c.tangential_velocity * c.dt) + g * c.tangential_velocity);
		const Vector3r force = trial * std::min(1.0, law.mu * std::abs(r.normal) / trial.norm());
		const Real terms = k * spring.norm() + (k * c.dt + g) * c.tangential_velocity.norm();  // the two may nearly cancel
		EXPECT_NEAR((r.tangential - force).norm(), 0, round_off * terms);
		attracting += r.normal < 0;
	});
	EXPECT_GT(attracting, 20);  // the bound is mu |F_n| there too
}

/// Evaluated again without a further step, the spring that a slipping contact keeps gives the force of Coulomb's bound.
template <class Law>
void expect_shortened(const Law& law)
{
	RandomContacts draw;
	int slipping = 0;
	for (int i = 0; i < 500; ++i) {
		const auto c = draw.contact(draw.vector());
		const auto r = law(c, Vector3r(1e-3 * draw.vector()));
		const auto [k, g] = tangential(law, c.overlap, c.effective_radius, c.effective_mass);
		const Real terms = k * r.slip.norm() + g * c.tangential_velocity.norm();
		EXPECT_NEAR((r.tangential + k * r.slip + g * c.tangential_velocity).norm(), 0, round_off * terms);
		slipping += r.slipping;
	}
	EXPECT_GT(slipping, 50);
}

TEST(HertzHistory, a_slipping_spring_is_shortened_until_spring_and_dashpot_give_the_bound)
{
	expect_shortened(HertzHistory<Real>{ 2e6, 2.46e6, 2500, 2500, 0.5 });
}

TEST(HertzRestitution, a_slipping_spring_is_shortened_until_spring_and_dashpot_give_the_bound)
{
	expect_shortened(hertz_restitution(5e6, 0.45, 0.6, 0.5));
}

TEST(SpringDashpot, a_slipping_spring_waits)
{
	const auto law = spring_dashpot(2e5, 2e5 * 2 / 7, 0.92, 0.5);
	const Kinematics<Real, Real> c{ 1e-4, -0.1, 3.0, 0.5, 1.0, 1e-4 };
	const auto r = law(c, 2e-4);
	EXPECT_TRUE(r.slipping);
	EXPECT_EQ(r.slip, 2e-4);
}

TEST(ContactLaws, without_friction_have_no_tangential_force)
{
	const Kinematics<Real, Real> c{ 1e-4, -0.1, 3.0, 0.5, 1.0, 1e-4 };
	EXPECT_EQ((HertzHistory<Real>{ 2e6, 2e6, 10, 10, 0 }(c, 1e-4).tangential), 0);
	EXPECT_EQ(hertz_restitution(5e6, 0.45, 0.6, 0)(c, 1e-4).tangential, 0);
	EXPECT_EQ(spring_dashpot(2e5, 1e5, 0.9, 0)(c, 1e-4).tangential, 0);
}
