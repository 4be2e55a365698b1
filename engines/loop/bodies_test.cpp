/// Rigid bodies in the fast loop: driven disks, frozen walls, glued clumps, drums.
#include <gtest/gtest.h>

#include "engines/loop/stepper.hpp"
#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

/// Two glued disks of the given mass, their centre at (x, y).
void add_dumbbell(Scene<2>& scene, double x, double y, RigidBody<2> body)
{
	body.place[0] = x, body.place[1] = y;
	scene.bodies.push_back(body);
	for (const double side : { -0.4, 0.4 }) {
		Grain<2> g = disk(x + side, y, 0.5, int(scene.bodies.size()) - 1);
		g.mass = body.mass;
		scene.grains.push_back(g);
	}
}

RigidBody<2> free_body(double mass, double inertia)
{
	RigidBody<2> body;
	body.mass = mass, body.inertia = inertia;
	body.responds[0] = body.responds[1] = body.turns[0] = true;
	return body;
}

Scene<2> empty()
{
	Scene<2> scene;
	scene.law = hertz();
	scene.dt = 1e-4;
	return scene;
}

}  // namespace

TEST(Bodies, a_lone_clump_falls_and_spins_as_a_rigid_body_should)
{
	Scene<2> scene = empty();
	scene.gravity[1] = -10;
	RigidBody<2> body = free_body(2, 0.5);
	body.spin = 3, body.velocity[0] = 1;
	add_dumbbell(scene, 0, 0, body);
	Stepper<2> loop(scene);
	loop.step(1000);
	const double t = 0.1;
	const RigidBody<2>& now = loop.bodies()[0];
	EXPECT_NEAR(now.place[0], t, 1e-12);
	EXPECT_NEAR(now.place[1], -10 * t * (t + scene.dt) / 2, 1e-12);  // leapfrog from v_{-1/2} = 0
	EXPECT_NEAR(now.turn.angle, 3 * t, 1e-12);
	const Grain<2> right = loop.grain(1);
	EXPECT_NEAR(right.place[0], now.place[0] + 0.4 * std::cos(0.3), 1e-12);
	EXPECT_NEAR(right.place[1], now.place[1] + 0.4 * std::sin(0.3), 1e-12);
	EXPECT_NEAR(right.velocity[1], now.velocity[1] + 3 * 0.4 * std::cos(0.3), 1e-12);
}

TEST(Bodies, a_clump_hit_by_a_grain_shares_its_momentum_and_angular_momentum)
{
	Scene<2> scene = empty();
	Grain<2> bullet = disk(0.55, -1.5, 0.5);
	bullet.velocity[1] = 2;
	scene.grains = { bullet };
	add_dumbbell(scene, 0, 0, free_body(2, 0.5));
	Stepper<2> loop(scene);
	const auto totals = [&] {
		const Grain<2> g = loop.grain(0);
		const RigidBody<2>& b = loop.bodies()[0];
		return Vector3r(g.mass * g.velocity[0] + b.mass * b.velocity[0], g.mass * g.velocity[1] + b.mass * b.velocity[1],
			g.mass * (g.place[0] * g.velocity[1] - g.place[1] * g.velocity[0]) + g.mass * g.radius * g.radius / 2 * g.spin +
				b.mass * (b.place[0] * b.velocity[1] - b.place[1] * b.velocity[0]) + b.inertia * b.spin);
	};
	const Vector3r before = totals();
	loop.step(6000);
	EXPECT_GT(std::abs(loop.bodies()[0].spin), 0.1);
	const Vector3r change = totals() - before;
	EXPECT_LT(std::hypot(change[0], change[1]), 1e-12);
	// Friction acts at each grain's own radius, so angular momentum changes by overlap times friction; the overlap is 1e-2 of a
	// radius here.
	EXPECT_LT(std::abs(change[2]), 0.02 * bullet.mass * 2 * 0.55);
}

TEST(Bodies, a_driven_disk_keeps_its_velocity_and_reports_the_force)
{
	Scene<2> scene = crowd(10, 1, 0);
	scene.cell.periodic[1] = false;
	RigidBody<2> driver;
	driver.place[0] = 5.1, driver.place[1] = 11.2, driver.velocity[1] = -2, driver.spin = 1;
	scene.bodies = { driver };
	scene.grains.push_back(disk(5.1, 11.2, 1, 0));
	scene.grains.back().mass = HUGE_VAL;
	Stepper<2> loop(scene);
	double impulse = 0, momentum = 0;
	for (int k = 0; k < 3000; ++k) {
		loop.step();
		impulse -= loop.bodies()[0].force[1] * scene.dt;
	}
	for (std::size_t i = 0; i < 100; ++i) momentum += loop.grain(i).mass * loop.grain(i).velocity[1];
	EXPECT_EQ(loop.bodies()[0].velocity[1], -2);
	EXPECT_EQ(loop.bodies()[0].spin, 1);
	EXPECT_LT(momentum, -1);
	EXPECT_NEAR(impulse, momentum, 1e-10);  // 3000 sums of impulses of order 0.1
}

TEST(Bodies, a_drum_of_beads_turns_and_carries_grains)
{
	Scene<2> scene = empty();
	scene.gravity[1] = -1;
	RigidBody<2> drum;
	drum.spin = 0.5;
	scene.bodies = { drum };
	for (int k = 0; k < 40; ++k) {
		scene.grains.push_back(disk(6 * std::cos(2 * pi * k / 40), 6 * std::sin(2 * pi * k / 40), 0.5, 0));
		scene.grains.back().mass = HUGE_VAL;
	}
	for (int k = 0; k < 30; ++k) scene.grains.push_back(disk(-2.5 + k % 6, -3 + k / 6, 0.48));
	Stepper<2> loop(scene);
	loop.step(40000);
	EXPECT_NEAR(loop.bodies()[0].turn.angle, 2, 1e-10);
	EXPECT_NEAR(loop.grain(0).place[0], 6 * std::cos(2.0), 1e-9);
	double spread = 0, mean_x = 0;
	for (std::size_t i = 40; i < 70; ++i) {
		spread = std::max(spread, std::hypot(loop.grain(i).place[0], loop.grain(i).place[1]));
		mean_x += loop.grain(i).place[0] / 30;
	}
	EXPECT_LT(spread, 5.2);  // no grain leaves through the wall
	EXPECT_GT(mean_x, 0.1);  // the drum turns counter-clockwise, so the bed rises on the right
}

TEST(Bodies, forces_are_known_before_the_step_and_the_step_goes_on_from_there)
{
	Scene<2> scene = crowd(10, 3);
	scene.cell.periodic[1] = false;
	scene.bodies.push_back({});
	for (std::size_t i = 0; i < 10; ++i)
		scene.grains[i].body = 0, scene.grains[i].velocity[0] = scene.grains[i].velocity[1] = scene.grains[i].spin = 0;
	Stepper<2> straight(scene), asked(scene);
	for (int k = 0; k < 200; ++k) {
		straight.step();
		asked.compute_body_forces();
		std::vector<Touch<2>> touches;
		asked.touches_on(0, touches);
		Vector2r sum(0, 0);
		for (const Touch<2>& t : touches)
			sum += Vector2r(-t.normal * t.n[0] - t.friction * t.n[1], -t.normal * t.n[1] + t.friction * t.n[0]);
		const double before_x = asked.bodies()[0].force[0], before_y = asked.bodies()[0].force[1];
		EXPECT_NEAR(sum[0], before_x, 1e-9 * (1 + std::abs(before_x)));
		EXPECT_NEAR(sum[1], before_y, 1e-9 * (1 + std::abs(before_y)));
		asked.step();
	}
	EXPECT_TRUE(same_bits(straight, asked));
}
