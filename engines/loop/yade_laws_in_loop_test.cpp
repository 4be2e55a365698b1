/// YADE's own laws and damping in the fast loop: angular momentum, what a body's contacts add up to, what views tell, and refusals.
#include <gtest/gtest.h>

#include "engines/base/complaint.hpp"
#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

const ContactLaw yade_laws[] = { laws::cundall_strack(2e5, 0.3, 0.4), laws::hertz_mindlin(2e6, 0.3, 0.2, 0.1, 0.4) };

/// A crowd in the open with a clump that responds.
Scene open_crowd(const ContactLaw& law)
{
	Scene s = crowd(8, 3);
	s.law = law;
	s.box = {};
	for (std::size_t i = 0; i < s.grains.size(); ++i) {  // most touch
		const Grain g = s.grains[i];
		s.grains[i] = disk(0.985 * g.x, 0.985 * g.y, 0.5 - 0.004 * (i % 5));
		s.grains[i].vx = g.vx, s.grains[i].vy = g.vy, s.grains[i].spin = g.spin;
	}
	RigidBody clump;
	clump.x = 3.94, clump.y = 4.43, clump.mass = 2, clump.inertia = 0.6;
	clump.responds_x = clump.responds_y = clump.responds_spin = true;
	s.bodies = { clump };
	for (const std::size_t i : { 35u, 36u }) s.grains[i].body = 0, s.grains[i].mass = clump.mass;
	return s;
}

double angular_momentum(const Stepper& loop)
{
	double sum = 0;
	const auto add = [&](double x, double y, double vx, double vy, double mass, double spin, double inertia) {
		sum += mass * (x * vy - y * vx) + inertia * spin;
	};
	for (std::size_t i = 0; i < loop.size(); ++i) {
		const Grain g = loop.grain(i);
		if (g.body == free_grain) add(g.x, g.y, g.vx, g.vy, g.mass, g.spin, g.mass * g.radius * g.radius / 2);
	}
	for (const RigidBody& b : loop.settings().bodies) add(b.x, b.y, b.vx, b.vy, b.mass, b.spin, b.inertia);
	return sum;
}

}  // namespace

TEST(YadeLawsInLoop, conserve_angular_momentum_for_their_forces_act_at_one_point)
{
	for (const ContactLaw& law : yade_laws) {
		Stepper loop(open_crowd(law));
		const double before = angular_momentum(loop);
		loop.step(500);
		// 64 grains at up to 8, each rounded in 500 steps.
		EXPECT_NEAR(angular_momentum(loop), before, 64 * 8 * 500 * 1e-16 * 10) << law.index();
	}
	Scene other = open_crowd(hertz());  // at the radius instead: the torque of the overlap is left over
	Stepper loop(other);
	const double before = angular_momentum(loop);
	loop.step(500);
	EXPECT_GT(std::abs(angular_momentum(loop) - before), 1e-6);
}

TEST(YadeLawsInLoop, a_bodys_contacts_add_up_to_its_force_and_torque)
{
	for (const ContactLaw& law : yade_laws)
		for (const Precision precision : { Precision::double_, Precision::single }) {
			Scene scene = open_crowd(law);
			scene.precision = precision;
			Stepper loop(scene);
			loop.step(15);
			loop.compute_body_forces();
			std::vector<Touch> touches;
			loop.touches_on(0, touches);
			EXPECT_GE(touches.size(), 3u);
			double x = 0, y = 0, torque = 0, size = 0;
			for (const Touch& t : touches) {
				const double fx = -t.normal * t.n_x - t.friction * t.n_y, fy = -t.normal * t.n_y + t.friction * t.n_x;
				x += fx, y += fy, torque += t.arm_x * fy - t.arm_y * fx;
				size += std::hypot(fx, fy);
				EXPECT_NEAR(std::hypot(t.n_x, t.n_y), 1, 1e-12);
			}
			const RigidBody& body = loop.bodies()[0];
			// A normal that is recovered from a force in float is known to 1e-7.
			const double round_off = size * (precision == Precision::single ? 1e-5 : 1e-12);
			EXPECT_NEAR(x, body.force_x, round_off);
			EXPECT_NEAR(y, body.force_y, round_off);
			EXPECT_NEAR(torque, body.torque, round_off);
		}
}

TEST(YadeLawsInLoop, contacts_tell_the_laws_own_forces)
{
	for (const ContactLaw& law : yade_laws) {
		Stepper loop(open_crowd(law));
		loop.step(15);
		loop.compute_body_forces();
		int slipping = 0, sticking = 0;
		for (const Contact& c : loop.present_contacts()) {
			const Grain a = loop.grain(c.first), b = loop.grain(c.second);
			const double dx = b.x - a.x, dy = b.y - a.y, r = std::hypot(dx, dy);
			EXPECT_NEAR(c.n_x, dx / r, 1e-11);
			EXPECT_NEAR(c.n_y, dy / r, 1e-11);
			EXPECT_NEAR(c.point_x, a.x + a.radius * c.n_x, 1e-12);
			EXPECT_NEAR(c.point_y, a.y + a.radius * c.n_y, 1e-12);
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
	Scene s;
	s.law = hertz();
	s.dt = 1e-3;
	s.gravity_y = -10;
	s.damping = 0.2;
	RigidBody body;
	body.mass = 2, body.inertia = 1, body.vx = 1, body.vy = 3, body.spin = 0.5, body.load_x = 4;
	body.responds_x = body.responds_y = body.responds_spin = true;
	s.bodies = { body };
	s.grains = { disk(0, 0, 0.5, 0) };
	s.grains[0].mass = 2;
	for (const bool damps_gravity : { true, false }) {
		s.damps_gravity = damps_gravity;
		Stepper loop(s);
		loop.step();
		EXPECT_DOUBLE_EQ(loop.bodies()[0].vx, 1 + 4 / 2.0 * 0.8 * 1e-3);                     // speeds up
		EXPECT_DOUBLE_EQ(loop.bodies()[0].vy, 3 - 10 * (damps_gravity ? 1.2 : 1.0) * 1e-3);  // slows down
		EXPECT_EQ(loop.bodies()[0].spin, 0.5);
	}
}

TEST(Damping, acts_on_the_sum_of_all_forces_at_a_wall)
{
	Scene s;
	const auto law = hertz(0, 50);
	s.law = law;
	s.dt = 1e-4;
	s.gravity_y = -10;
	s.damping = 0.3;
	Wall floor;
	s.walls = { floor };
	s.walls[0].side = Side::y_low;
	s.grains = { disk(0, 0.51), disk(3, 0.51) };
	Stepper loop(s);
	double y = 0.51, v = 0;
	for (int k = 0; k < 3000; ++k) {
		double a = -10;
		if (y < 0.5)
			a += law(laws::Kinematics<Real, Real>{ 0.5 - y, v, 0, 0.5, s.grains[0].mass, s.dt }, 0.0).normal / s.grains[0].mass;
		a *= a * (v + a * s.dt / 2) > 0 ? 0.7 : 1.3;
		v += a * s.dt, y += v * s.dt;
		loop.step();
		ASSERT_NEAR(loop.grain(0).y, y, 1e-12) << k;  // round-off of 3000 steps
	}
	EXPECT_LT(y, 0.5);
}

TEST(Damping, brings_a_crowd_to_rest_and_none_leaves_it_moving)
{
	const auto energy_after = [](double damping) {
		Scene s = crowd(8, 3);
		s.law = laws::cundall_strack(2e5, 0.3, 0.1);
		s.damping = damping;
		Stepper loop(s);
		const double before = loop.kinetic_energy();
		loop.step(10000);
		return loop.kinetic_energy() / before;
	};
	EXPECT_GT(energy_after(0), 0.02);
	EXPECT_LT(energy_after(0.2), 0.25 * energy_after(0));
}

TEST(YadeLawsInLoop, refuse_ledger_walls_and_damping_by_name)
{
	Scene s = open_crowd(yade_laws[0]);
	Stepper loop(s);
	EXPECT_TRUE(mentions(complaint([&] { loop.track_energy(true); }), "laws cundallStrack and hertzMindlin"));
	Wall wall;
	wall.position = -5;
	EXPECT_TRUE(mentions(complaint([&] { loop.set_wall(wall); }), "the laws cundallStrack and hertzMindlin"))
		<< complaint([&] { loop.set_wall(wall); });
	s.law = hertz();
	s.damping = 0.2;
	Stepper damped(s);
	EXPECT_TRUE(mentions(complaint([&] { damped.track_energy(true); }), "damping = 0, got 0.2"));
	s.damping = 1;
	EXPECT_TRUE(mentions(complaint([&] { Stepper never(s); }), "damping must lie in [0, 1), got 1"));
}

TEST(YadeLawsInLoop, bear_the_time_step_of_their_stiffness)
{
	Scene s = open_crowd(laws::cundall_strack(2e5, 0.3, 0.4));
	double lightest = 1e9, radius = 0;
	for (const Grain& g : s.grains)
		if (g.body == free_grain && g.mass < lightest) lightest = g.mass, radius = g.radius;
	const double k = 2e5 * radius, normal = 2 / std::sqrt(k / (lightest / 2)), sliding = 2 / std::sqrt(0.3 * k / (lightest / 6));
	s.dt = 1.001 * std::min(normal, sliding);
	EXPECT_TRUE(mentions(complaint([&] { Stepper loop(s); }), "time step must not exceed"));
	s.dt = 0.999 * std::min(normal, sliding);
	EXPECT_EQ(complaint([&] { Stepper loop(s); }), "");
}
