/// The terms of every law: forces are made of them, elastic forces derive from the energy, dashpots dissipate, and the critical
/// step is where leapfrog becomes unstable.
#include <gtest/gtest.h>

#include "engines/laws/critical_step.hpp"
#include "engines/laws/every_law.hpp"
#include "engines/laws/random_contacts.hpp"
#include "engines/laws/two_disks.hpp"

using namespace graindrive;
using namespace graindrive::laws;

namespace {

constexpr Squeezed<Real> pressed{ 1e-3, 0.2, 0.7 };
constexpr Real no_slip = 1e9;  // a friction coefficient that no contact here reaches

Squeezed<Real> with_overlap(Real overlap) { return { overlap, pressed.effective_radius, pressed.effective_mass }; }

Kinematics<Real, Real> moving(Real v_n, Real v_t, Real dt)
{
	return { pressed.overlap, v_n, v_t, pressed.effective_radius, pressed.effective_mass, dt };
}

/// What a contact with a spring of length s remembers.
template <class Law>
Real remembered(const Law&, const Terms<Real>& terms, Real s)
{
	return Law::remembers_force ? terms.tangential_stiffness * s : s;
}

}  // namespace

TEST(Terms, elastic_force_is_the_derivative_of_the_energy_and_stiffness_that_of_the_force)
{
	for_every_law_damped_and_not([](const auto& law) {
		for (const Real overlap : { 1e-5, 1e-3, 0.03 }) {
			const Real h = 1e-5 * overlap;
			const auto at = law.terms(with_overlap(overlap)), less = law.terms(with_overlap(overlap - h)),
					   more = law.terms(with_overlap(overlap + h));
			const Real tolerance = 1e-9;  // h^2 is 1e-10; round-off 1e-16 / 1e-5
			EXPECT_NEAR((more.energy - less.energy) / (2 * h) / at.elastic, 1, tolerance) << law.name;
			EXPECT_NEAR((more.elastic - less.elastic) / (2 * h) / at.stiffness, 1, tolerance) << law.name;
		}
	});
}

TEST(Terms, forces_consist_of_them)
{
	for_every_law_damped_and_not(
		[](const auto& law) {
			RandomContacts draw;
			for (int i = 0; i < 200; ++i) {
				const Vector3r v_t = draw.vector(), s = 1e-4 * draw.vector();
				const auto c = draw.contact(v_t);
				const auto at = law.terms(c);
				const auto force = law(c, law.remembers_force ? Vector3r(at.tangential_stiffness * s) : s);
				const Real normal = at.elastic - at.dashpot * c.normal_velocity;
				if (law.acts_at_contact_point && normal < 0) {
					EXPECT_EQ(force.normal, 0);  // so there is no friction either
					continue;
				}
				EXPECT_NEAR(force.normal, normal, round_off * (at.elastic + std::abs(at.dashpot * c.normal_velocity)));
				if (force.slipping) continue;
				const Vector3r spring = at.tangential_stiffness * (s + v_t * c.dt), dashpot = at.tangential_dashpot * v_t;
				EXPECT_NEAR((force.tangential + spring + dashpot).norm(), 0, round_off * (spring.norm() + dashpot.norm()));
			}
		},
		no_slip);
}

TEST(Terms, dashpots_oppose_the_motion)
{
	for_every_law_damped_and_not([](const auto& law) {
		const auto at = law.terms(pressed);
		for (const Real v_n : { -2.0, -0.1, 0.1, 2.0 })
			EXPECT_LE((law(moving(v_n, 0, 1e-9), 0.0).normal - at.elastic) * v_n, round_off * at.elastic) << law.name;
		EXPECT_GE(at.dashpot, 0);
		EXPECT_GE(at.tangential_dashpot, 0);
	});
}

/// Energy that a contact takes up in the second of two cycles of slip x = A sin(w t) [J].
template <class Law>
Real loss_of_a_cycle(const Law& law, Real amplitude, Real omega)
{
	constexpr int steps = 20000;
	const Real dt = 2 * pi / omega / steps;
	Real memory = 0, loss = 0, before = 0;
	for (int k = 1; k <= 2 * steps; ++k) {
		const Real v = amplitude * (std::sin(omega * k * dt) - std::sin(omega * (k - 1) * dt)) / dt;
		const auto answer = law(moving(0, v, dt), memory);
		memory = answer.slip;
		if (k > steps) loss -= (before + answer.tangential) / 2 * v * dt;
		before = answer.tangential;
	}
	return loss;
}

TEST(Terms, a_slipping_contact_dissipates_what_coulomb_says)
{
	// A spring k_t in series with friction B = mu F_n, driven by A > B/k_t, dissipates 4 B (A - B/k_t) in a cycle. The motion is
	// slow, so dashpots do not matter.
	for_every_law_damped_and_not([](const auto& law) {
		const auto at = law.terms(pressed);
		const Real bound = law.mu * at.elastic, yield = bound / at.tangential_stiffness;
		for (const Real amplitude : { 1.5 * yield, 6 * yield })
			EXPECT_NEAR(loss_of_a_cycle(law, amplitude, 1e-6) / (4 * bound * (amplitude - yield)), 1, 2e-3)
				<< law.name;  // a spring may stop a step, 2 pi A / 20000, early at both ends
	});
}

TEST(Terms, a_sticking_contact_dissipates_by_its_dashpot_alone)
{
	// In a cycle of x = A sin(w t) a dashpot c_t v dissipates pi c_t w A^2, a spring nothing.
	for_every_law_damped_and_not([](const auto& law) {
		const auto at = law.terms(pressed);
		const Real amplitude = 0.1 * law.mu * at.elastic / at.tangential_stiffness;
		const Real omega = 0.1 * std::sqrt(at.tangential_stiffness / pressed.effective_mass);
		const Real viscous = pi * at.tangential_dashpot * omega * amplitude * amplitude;
		const Real stored = tangential_energy(law, at, remembered(law, at, amplitude));
		EXPECT_NEAR(loss_of_a_cycle(law, amplitude, omega), viscous, 1e-3 * viscous + 1e-12 * stored) << law.name;
		EXPECT_GE(viscous, 0);
	});
}

TEST(Terms, an_impact_gains_no_energy)
{
	for_every_law_damped_and_not([](const auto& law) {
		Pair pair({ 0.5, 1.0 }, { 0.8, 2.5 });
		pair.i.v = Vector2r(0.3, 0);
		const Real dt = critical_step(law.terms(pressed).stiffness, 0, pair.effective_mass()) / 2000;
		EXPECT_LE(collide(pair, law, dt).restitution, 1 + 1e-5) << law.name;  // leapfrog's own error, (omega dt)^2
	});
}

namespace {

/// Two bodies pressed together by a constant force start near their equilibrium. Returns the distance from it after some steps
/// over that at the start.
template <class Law>
Real growth_of_normal_motion(const Law& law, Real dt)
{
	const auto rest = law.terms(pressed);
	const Real start = 1e-9 * pressed.overlap;
	Real overlap = pressed.overlap + start, v_n = 0, largest = 0;
	for (int k = 0; k < 400; ++k) {
		const Kinematics<Real, Real> contact{ overlap, v_n, 0, pressed.effective_radius, pressed.effective_mass, dt };
		v_n += (law(contact, 0.0).normal - rest.elastic) / pressed.effective_mass * dt;
		overlap -= v_n * dt;
		if (k > 300) largest = std::max(largest, std::abs(overlap - pressed.overlap));
		if (std::abs(overlap - pressed.overlap) > 1e3 * start) return 1e3;
	}
	return largest / start;
}

/// The same for motion against the tangential spring, with the effective mass of that direction.
template <class Law>
Real growth_of_sliding(const Law& law, Real mass, Real dt)
{
	const Real start = 1e-9;
	Real memory = remembered(law, law.terms(pressed), start), s = start, v_t = 0, largest = 0;
	for (int k = 0; k < 400; ++k) {
		const auto answer = law(moving(0, v_t, dt), memory);
		memory = answer.slip;
		v_t += answer.tangential / mass * dt;
		s += v_t * dt;
		if (k > 300) largest = std::max(largest, std::abs(s));
		if (std::abs(s) > 1e3 * start) return 1e3;
	}
	return largest / start;
}

}  // namespace

TEST(CriticalStep, parts_stable_contacts_from_unstable_ones_under_every_law)
{
	// At 1.01 times the limit the amplitude grows by factors of 1.005 (strongly damped) to 1.3 in each step; at the limit it does
	// not grow.
	for_every_law_damped_and_not(
		[](const auto& law) {
			const auto at = law.terms(pressed);
			const Real normal = critical_step(at.stiffness, at.dashpot, pressed.effective_mass);
			EXPECT_LT(growth_of_normal_motion(law, 0.99 * normal), 10) << law.name;
			EXPECT_EQ(growth_of_normal_motion(law, 1.03 * normal), 1e3) << law.name;
			const Real mass = pressed.effective_mass / 3,
					   sliding = critical_step(at.tangential_stiffness, at.tangential_dashpot, mass);
			EXPECT_LT(growth_of_sliding(law, mass, 0.99 * sliding), 10) << law.name;
			EXPECT_EQ(growth_of_sliding(law, mass, 1.03 * sliding), 1e3) << law.name;
		},
		no_slip);
}

TEST(CundallStrack, an_impact_is_elastic_and_lasts_half_a_period)
{
	Pair pair({ 0.5, 1.0 }, { 0.8, 2.5 });
	pair.i.v = Vector2r(0.3, 0);
	const auto law = cundall_strack(1e6, 0.3, 0.5);
	const Real k_n = 2 * 1e6 * pair.effective_radius(), duration = pi * std::sqrt(pair.effective_mass() / k_n);
	const Impact impact = collide(pair, law, duration / 20000);
	EXPECT_NEAR(impact.restitution, 1, 1e-6);  // second order in the step
	EXPECT_NEAR(impact.duration / duration, 1, 1e-6);
}

TEST(HertzMindlin, restitution_is_that_of_a_contact_that_ends_when_its_force_does)
{
	// The law maps on a linear oscillator with the damping ratio b = 2 sqrt(3/10) beta_n (Antypov, Elliott 2011). If the contact
	// of this oscillator ends at F_n = 0, e = exp(-b/w (pi - atan(2 b w/(w^2 - b^2)))) with w^2 = 1 - b^2 at every speed
	// (Schwager, Poeschel, Granular Matter 9, 465 (2007)).
	for (const Real beta : { 0.0, 0.05, 0.2, 0.5 })
		for (const Real v : { 0.01, 0.3 }) {
			Pair pair({ 0.5, 1.0 }, { 0.8, 2.5 });
			pair.i.v = Vector2r(v, 0);
			const auto law = hertz_mindlin(1e6, 0.3, beta, 0, 0.5);
			const Real k = 4.0 / 3 * law.effective_young * std::sqrt(pair.effective_radius());
			const Real depth = std::pow(5 * pair.effective_mass() * v * v / (4 * k), 0.4);
			const Real b = 2 * std::sqrt(0.3) * beta, w = std::sqrt(1 - b * b);
			const Real expected = std::exp(-b / w * (pi - std::atan2(2 * b * w, w * w - b * b)));
			EXPECT_NEAR(collide(pair, law, 2.94 * depth / v / 50000).restitution, expected, 2e-4)
				<< beta;  // first order in the step
		}
}
