/// Impacts of two disks under each law against closed forms: depth, force, duration, restitution, friction, rotation.
#include <gtest/gtest.h>

#include "engines/laws/registry.hpp"
#include "engines/laws/two_disks.hpp"

using namespace graindrive;
using namespace graindrive::laws;

namespace {

/// Two disks that approach at speed v. Their sizes and masses differ, because a symmetric pair would hide exchanged indices.
Pair approaching(Real v)
{
	Pair pair({ 0.5, 1.0 }, { 0.8, 2.5 });
	pair.i.v = Vector2r(v, 0);
	return pair;
}

/// Hertz: delta_max = (5 m v^2 / 4 k)^(2/5) with k = K_n sqrt(R_eff). The contact is stiff, so that its normal hardly turns.
struct Hertz {
	Real k, depth, force, duration;

	Hertz(const Pair& pair, Real k_n)
	{
		const Real v = pair.approach();
		k = k_n * std::sqrt(pair.effective_radius());
		depth = std::pow(5 * pair.effective_mass() * v * v / (4 * k), 0.4);
		force = k * std::pow(depth, 1.5);
		duration = 2 * std::sqrt(pi) * std::tgamma(1.4) / std::tgamma(0.9) * depth / v;  // 2.943 depth / v
	}
};

constexpr Real k_n = 2e6, v_0 = 0.3;

}  // namespace

TEST(HertzHistory, elastic_impact_has_the_depth_force_and_duration_of_hertz)
{
	Pair pair = approaching(v_0);
	const Hertz hertz(pair, k_n);
	const Impact impact = collide(pair, HertzHistory<Real>{ k_n, 1, 0, 0, 0 }, hertz.duration / 4000);
	const Real second_order = 1e-6;  // (2 pi / 4000)^2 is 2.5e-6; the factor before it is below 1/2
	EXPECT_NEAR(impact.deepest / hertz.depth, 1, second_order);
	EXPECT_NEAR(impact.hardest / hertz.force, 1, second_order);
	EXPECT_NEAR(impact.duration / hertz.duration, 1, second_order);
	EXPECT_NEAR(impact.restitution, 1, second_order);
}

TEST(HertzHistory, conserves_energy_to_second_order_in_the_step)
{
	Real coarser = 0;
	for (const int steps : { 100, 200, 400, 800 }) {
		Pair pair = approaching(v_0);
		const Hertz hertz(pair, k_n);
		const Real error = collide(pair, HertzHistory<Real>{ k_n, 1, 0, 0, 0 }, hertz.duration / steps, hertz.k).energy_error;
		if (coarser > 0) {
			EXPECT_NEAR(coarser / error, 4, 0.4) << steps;  // a tenth, because the greatest error lies between two steps
		}
		coarser = error;
	}
}

TEST(HertzHistory, restitution_falls_with_speed_as_the_viscoelastic_series_says)
{
	// e = 1 - a + (3/5) a^2 with a = (4/5) B(3/5, 3/2) c delta_max^(3/2) / (m v), c = m gamma sqrt(R): a grows as v^(1/5).
	// Schwager, Poeschel, Phys. Rev. E 57, 650 (1998). The force attracts at the end, as in the series and in LAMMPS.
	const Real beta = std::tgamma(0.6) * std::tgamma(1.5) / std::tgamma(2.1), gamma = 300;
	for (const Real v : { 0.01, 0.1, 1.0 }) {
		Pair pair = approaching(v);
		const Hertz hertz(pair, k_n);
		const Real a = 0.8 * beta * gamma * std::sqrt(pair.effective_radius()) * std::pow(hertz.depth, 1.5) / v;
		const Impact impact = collide(pair, HertzHistory<Real>{ k_n, 1, gamma, 0, 0 }, hertz.duration / 20000);
		EXPECT_TRUE(a > 0.005 && a < 0.06) << a;
		EXPECT_NEAR(impact.restitution, 1 - a + 0.6 * a * a, a * a * a + a / 5000) << v;  // next term; velocities lag half a step
	}
}

TEST(HertzRestitution, gives_the_restitution_asked_for_at_every_speed)
{
	// With b = -ln e / sqrt(ln^2 e + pi^2) and a contact that ends when the overlap is zero again, the law maps on a damped
	// linear oscillator, so e is exact: Antypov, Elliott, EPL 94, 50004 (2011).
	for (const Real e : { 0.3, 0.6, 0.9, 1.0 })
		for (const Real v : { 0.01, 0.1, 1.0 }) {
			Pair pair = approaching(v);
			const auto law = hertz_restitution(5e6, 0.45, e, 0.5);
			const Hertz hertz(pair, law.effective_young * 4 / 3);
			const Impact impact = collide(pair, law, hertz.duration / 50000);
			EXPECT_NEAR(impact.restitution, e, 2e-4) << v;  // first order in the step: velocities lag by half of one
		}
}

TEST(SpringDashpot, gives_the_restitution_asked_for_and_the_duration_of_a_damped_oscillator)
{
	for (const Real e : { 0.3, 0.6, 0.92, 1.0 }) {
		Pair pair = approaching(v_0);
		const Real b = damping_fraction(e), duration = pi * std::sqrt(pair.effective_mass() / (k_n * (1 - b * b)));
		const Impact impact = collide(pair, spring_dashpot(k_n, 0, e, 0), duration / 50000);
		EXPECT_NEAR(impact.restitution, e, 2e-4);  // first order in the step, pi / 50000 = 6e-5
		EXPECT_NEAR(impact.duration / duration, 1, 2e-4);
	}
}

TEST(SpringDashpot, error_of_the_restitution_is_first_order_in_the_step)
{
	Real coarser = 0;
	for (const int steps : { 500, 1000, 2000, 4000 }) {
		Pair pair = approaching(v_0);
		const Real b = damping_fraction(0.6), duration = pi * std::sqrt(pair.effective_mass() / (k_n * (1 - b * b)));
		const Real error = std::abs(collide(pair, spring_dashpot(k_n, 0, 0.6, 0), duration / steps).restitution - 0.6);
		if (coarser > 0) {
			EXPECT_NEAR(coarser / error, 2, 0.2) << steps;
		}
		coarser = error;
	}
}

/// Elastic along the normal, so that F_n never attracts and Coulomb's bound is mu F_n to the end.
/// Returns whether every step slipped.
template <class Law>
bool expect_gross_sliding(const Law& law, Real mu, Real dt)
{
	Pair pair = approaching(v_0);
	pair.i.v.y() = 5 * v_0;
	pair.j.omega = 2;
	const Vector2r v = pair.i.v;
	const Real spin = pair.j.omega;
	collide(pair, law, dt);
	const Vector2r impulse = pair.i.mass * (pair.i.v - v);
	// The line of centres turns by v_t times half the duration over the distance, about 1e-3 here.
	EXPECT_NEAR(impulse.y() / impulse.x(), mu, 3e-3);
	const Real turning = pair.i.inertia() * pair.i.omega;
	EXPECT_NEAR(turning / (pair.i.radius * mu * std::abs(impulse.x())), -1, 3e-3);
	EXPECT_NEAR(pair.i.omega, -2 * mu * std::abs(impulse.x()) / (pair.i.mass * pair.i.radius),
		3e-3 * std::abs(pair.i.omega));  // I = m R^2 / 2
	EXPECT_NEAR((pair.j.omega - spin) * pair.j.inertia() / pair.j.radius, turning / pair.i.radius, 1e-12);
	return pair.always_slid;
}

TEST(Friction, of_a_sliding_impact_is_mu_times_the_normal_impulse_under_every_law)
{
	const Real mu = 0.2, stiff = 2e9, duration = Hertz(approaching(v_0), stiff).duration;
	EXPECT_TRUE(expect_gross_sliding(HertzHistory<Real>{ stiff, 1.2 * stiff, 0, 100, mu }, mu, duration / 2000));
	EXPECT_TRUE(expect_gross_sliding(HertzRestitution<Real>{ stiff, 0.8, 0, mu }, mu, duration / 2000));
	// The spring of this law stays as it is while the contact slips, so the contact sticks for a step whenever the bound has
	// grown: its force follows the bound a step late.
	expect_gross_sliding(spring_dashpot(stiff, stiff * 2 / 7, 1, mu), mu, 1e-8);
}

TEST(Friction, of_a_sticking_impact_turns_the_slip_as_a_linear_oscillator)
{
	// Without slip: v_t = v_t0 cos(w t), w^2 = k_t (1/m_eff + sum R^2/I) = 3 k_t / m_eff for disks, over pi sqrt(m_eff / k_n).
	const Real stiff = 2e10, mu = 100;
	for (const Real k_t_over_k_n : { 0.05, 1.0 / 12, 2.0 / 7 }) {
		Pair pair = approaching(v_0);
		pair.i.v.y() = 0.1 * v_0;
		pair.i.omega = 0.3;
		const Real slip_0 = pair.kinematics(1).tangential_velocity;
		const Real duration = pi * std::sqrt(pair.effective_mass() / stiff);
		collide(pair, spring_dashpot(stiff, k_t_over_k_n * stiff, 1, mu), duration / 20000);
		EXPECT_NEAR(pair.kinematics(1).tangential_velocity / slip_0, std::cos(pi * std::sqrt(3 * k_t_over_k_n)),
			1e-3);  // overlap / R = 1e-5, dt
	}
}

template <class Law>
void expect_conservation(const Law& law, Real dt)
{
	Pair pair = approaching(v_0);
	pair.i.v.y() = 0.4;
	pair.j.v = Vector2r(-0.2, 0.7);
	pair.i.omega = -3;
	pair.j.omega = 1.5;
	pair.i.x += Vector2r(2, -1), pair.j.x += Vector2r(2, -1);  // levers about the origin
	const Vector2r p = pair.momentum();
	const Real l = pair.angular_momentum();
	collide(pair, law, dt);
	EXPECT_NEAR((pair.momentum() - p).norm(), 0, 1e-13);  // a thousand steps' round-off of numbers of order one
	EXPECT_NEAR(pair.angular_momentum(), l, 1e-12);
}

TEST(Impact, conserves_momentum_and_angular_momentum_to_round_off_under_every_law)
{
	const Real dt = Hertz(approaching(v_0), k_n).duration / 1000;
	expect_conservation(HertzHistory<Real>{ k_n, 1.2 * k_n, 300, 300, 0.5 }, dt);
	expect_conservation(hertz_restitution(5e6, 0.45, 0.6, 0.5), dt);
	expect_conservation(spring_dashpot(k_n, k_n * 2 / 7, 0.92, 0.5), dt);
}
