/// YADE's own laws and damping in the fast loop: angular momentum, sums over a body's contacts, views of contacts, and refusals.
#include <gtest/gtest.h>

#include "engines/base/complaint.hpp"
#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

const ContactLaw yade_laws[] = { laws::cundall_strack(2e5, 0.3, 0.4), laws::hertz_mindlin(2e6, 0.3, 0.2, 0.1, 0.4) };

/// Grains without walls, and a clump that responds to forces.
Scene<2> open_crowd(const ContactLaw& law)
{
	Scene<2> s = crowd(8, 3);
	s.law = law;
	s.cell = {};
	for (std::size_t i = 0; i < s.grains.size(); ++i) {  // most grains touch
		const Grain<2> g = s.grains[i];
		s.grains[i] = disk(0.985 * g.place[0], 0.985 * g.place[1], 0.5 - 0.004 * (i % 5));
		s.grains[i].velocity[0] = g.velocity[0], s.grains[i].velocity[1] = g.velocity[1], s.grains[i].spin = g.spin;
	}
	RigidBody<2> clump;
	clump.place[0] = 3.94, clump.place[1] = 4.43, clump.mass = 2, clump.inertia = 0.6;
	clump.responds[0] = clump.responds[1] = clump.turns[0] = true;
	s.bodies = { clump };
	for (const std::size_t i : { 35u, 36u }) s.grains[i].body = 0, s.grains[i].mass = clump.mass;
	return s;
}

double angular_momentum(const Stepper<2>& loop)
{
	double sum = 0;
	const auto add = [&](double x, double y, double vx, double vy, double mass, double spin, double inertia) {
		sum += mass * (x * vy - y * vx) + inertia * spin;
	};
	for (std::size_t i = 0; i < loop.size(); ++i) {
		const Grain<2> g = loop.grain(i);
		if (g.body == free_grain)
			add(g.place[0], g.place[1], g.velocity[0], g.velocity[1], g.mass, g.spin, g.mass * g.radius * g.radius / 2);
	}
	for (const RigidBody<2>& b : loop.settings().bodies)
		add(b.place[0], b.place[1], b.velocity[0], b.velocity[1], b.mass, b.spin, b.inertia);
	return sum;
}

}  // namespace

TEST(YadeLawsInLoop, conserve_angular_momentum_for_their_forces_act_at_one_point)
{
	for (const ContactLaw& law : yade_laws) {
		Stepper<2> loop(open_crowd(law));
		const double before = angular_momentum(loop);
		loop.step(500);
		// Round-off of 64 grains at distances of up to 8 in 500 steps.
		EXPECT_NEAR(angular_momentum(loop), before, 64 * 8 * 500 * 1e-16 * 10) << law.index();
	}
	Scene<2> other = open_crowd(hertz());  // this law's force acts at the radius, so the torque of the overlap remains
	Stepper<2> loop(other);
	const double before = angular_momentum(loop);
	loop.step(500);
	EXPECT_GT(std::abs(angular_momentum(loop) - before), 1e-6);
}

TEST(YadeLawsInLoop, a_bodys_contacts_add_up_to_its_force_and_torque)
{
	for (const ContactLaw& law : yade_laws)
		for (const Precision precision : { Precision::double_, Precision::single }) {
			Scene<2> scene = open_crowd(law);
			scene.precision = precision;
			Stepper<2> loop(scene);
			loop.step(15);
			loop.compute_body_forces();
			std::vector<Touch<2>> touches;
			loop.touches_on(0, touches);
			EXPECT_GE(touches.size(), 3u);
			double x = 0, y = 0, torque = 0, size = 0;
			for (const Touch<2>& t : touches) {
				const double fx = -t.normal * t.n[0] - t.friction * t.n[1], fy = -t.normal * t.n[1] + t.friction * t.n[0];
				x += fx, y += fy, torque += t.arm[0] * fy - t.arm[1] * fx;
				size += std::hypot(fx, fy);
				EXPECT_NEAR(std::hypot(t.n[0], t.n[1]), 1, 1e-12);
			}
			const RigidBody<2>& body = loop.bodies()[0];
			// A normal that is computed from a force in single precision has an error of 1e-7.
			const double round_off = size * (precision == Precision::single ? 1e-5 : 1e-12);
			EXPECT_NEAR(x, body.force[0], round_off);
			EXPECT_NEAR(y, body.force[1], round_off);
			EXPECT_NEAR(torque, body.torque, round_off);
		}
}

TEST(YadeLawsInLoop, contacts_tell_the_laws_own_forces)
{
	for (const ContactLaw& law : yade_laws) {
		Stepper<2> loop(open_crowd(law));
		loop.step(15);
		loop.compute_body_forces();
		int slipping = 0, sticking = 0;
		for (const Contact<2>& c : loop.present_contacts()) {
			const Grain<2> a = loop.grain(c.first), b = loop.grain(c.second);
			const double dx = b.place[0] - a.place[0], dy = b.place[1] - a.place[1], r = std::hypot(dx, dy);
			EXPECT_NEAR(c.n[0], dx / r, 1e-11);
			EXPECT_NEAR(c.n[1], dy / r, 1e-11);
			EXPECT_NEAR(c.point[0], a.place[0] + a.radius * c.n[0], 1e-12);
			EXPECT_NEAR(c.point[1], a.place[1] + a.radius * c.n[1], 1e-12);
			EXPECT_LE(std::abs(c.slip), 0.4 * c.normal * (1 + 1e-12));
			EXPECT_EQ(c.slipping, std::abs(c.slip) >= 0.4 * c.normal * (1 - 1e-12));
			if (law.index() == 3) {
				EXPECT_NEAR(c.normal, 4e5 * a.radius * b.radius / (a.radius + b.radius) * c.overlap, 1e-9 * 4e5);
			}
			++(c.slipping ? slipping : sticking);
		}
		EXPECT_GT(slipping, 5);
		EXPECT_GT(sticking, 5);
	}
}

TEST(Damping, of_a_body_is_the_formula_axis_by_axis)
{
	Scene<2> s;
	s.law = hertz();
	s.dt = 1e-3;
	s.gravity[1] = -10;
	s.damping = 0.2;
	RigidBody<2> body;
	body.mass = 2, body.inertia = 1, body.velocity[0] = 1, body.velocity[1] = 3, body.spin = 0.5, body.load[0] = 4;
	body.responds[0] = body.responds[1] = body.turns[0] = true;
	s.bodies = { body };
	s.grains = { disk(0, 0, 0.5, 0) };
	s.grains[0].mass = 2;
	for (const bool damps_gravity : { true, false }) {
		s.damps_gravity = damps_gravity;
		Stepper<2> loop(s);
		loop.step();
		EXPECT_DOUBLE_EQ(loop.bodies()[0].velocity[0], 1 + 4 / 2.0 * 0.8 * 1e-3);                     // speeds up
		EXPECT_DOUBLE_EQ(loop.bodies()[0].velocity[1], 3 - 10 * (damps_gravity ? 1.2 : 1.0) * 1e-3);  // slows down
		EXPECT_EQ(loop.bodies()[0].spin, 0.5);
	}
}

TEST(Damping, acts_on_the_sum_of_all_forces_at_a_wall)
{
	Scene<2> s;
	const auto law = hertz(0, 50);
	s.law = law;
	s.dt = 1e-4;
	s.gravity[1] = -10;
	s.damping = 0.3;
	Wall<2> floor;
	s.walls = { floor };
	s.walls[0].side = Side::y_low;
	s.grains = { disk(0, 0.51), disk(3, 0.51) };
	Stepper<2> loop(s);
	double y = 0.51, v = 0;
	for (int k = 0; k < 3000; ++k) {
		double a = -10;
		if (y < 0.5)
			a += law(laws::Kinematics<Real, Real>{ 0.5 - y, v, 0, 0.5, s.grains[0].mass, s.dt }, 0.0).normal / s.grains[0].mass;
		a *= a * (v + a * s.dt / 2) > 0 ? 0.7 : 1.3;
		v += a * s.dt, y += v * s.dt;
		loop.step();
		ASSERT_NEAR(loop.grain(0).place[1], y, 1e-12) << k;  // round-off of 3000 steps
	}
	EXPECT_LT(y, 0.5);
}

TEST(Damping, brings_a_crowd_to_rest_and_none_leaves_it_moving)
{
	const auto energy_after = [](double damping) {
		Scene<2> s = crowd(8, 3);
		s.law = laws::cundall_strack(2e5, 0.3, 0.1);
		s.damping = damping;
		Stepper<2> loop(s);
		const double before = loop.kinetic_energy();
		loop.step(10000);
		return loop.kinetic_energy() / before;
	};
	EXPECT_GT(energy_after(0), 0.02);
	EXPECT_LT(energy_after(0.2), 0.25 * energy_after(0));
}

TEST(YadeLawsInLoop, refuse_ledger_walls_and_damping_by_name)
{
	Scene<2> s = open_crowd(yade_laws[0]);
	Stepper<2> loop(s);
	EXPECT_TRUE(mentions(complaint([&] { loop.track_energy(true); }), "laws cundallStrack and hertzMindlin"));
	Wall<2> wall;
	wall.position = -5;
	EXPECT_TRUE(mentions(complaint([&] { loop.set_wall(wall); }), "the laws cundallStrack and hertzMindlin"))
		<< complaint([&] { loop.set_wall(wall); });
	s.law = hertz();
	s.damping = 0.2;
	Stepper<2> damped(s);
	EXPECT_TRUE(mentions(complaint([&] { damped.track_energy(true); }), "damping = 0, got 0.2"));
	s.damping = 1;
	EXPECT_TRUE(mentions(complaint([&] { Stepper<2> never(s); }), "damping must lie in [0, 1), got 1"));
}

TEST(YadeLawsInLoop, bear_the_time_step_of_their_stiffness)
{
	Scene<2> s = open_crowd(laws::cundall_strack(2e5, 0.3, 0.4));
	double lightest = 1e9, radius = 0;
	for (const Grain<2>& g : s.grains)
		if (g.body == free_grain && g.mass < lightest) lightest = g.mass, radius = g.radius;
	const double k = 2e5 * radius, normal = 2 / std::sqrt(k / (lightest / 2)), sliding = 2 / std::sqrt(0.3 * k / (lightest / 6));
	s.dt = 1.001 * std::min(normal, sliding);
	EXPECT_TRUE(mentions(complaint([&] { Stepper<2> loop(s); }), "time step must not exceed"));
	s.dt = 0.999 * std::min(normal, sliding);
	EXPECT_EQ(complaint([&] { Stepper<2> loop(s); }), "");
}
