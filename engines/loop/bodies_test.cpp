/// Rigid bodies in the fast loop: driven disks, frozen walls, glued clumps, drums.
#include <gtest/gtest.h>

#include "engines/loop/stepper.hpp"
#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

/// Two glued disks of the given mass, their centre at (x, y).
void add_dumbbell(Scene& scene, double x, double y, RigidBody body)
{
	body.x = x, body.y = y;
	scene.bodies.push_back(body);
	for (const double side : { -0.4, 0.4 }) {
		Grain g = disk(x + side, y, 0.5, int(scene.bodies.size()) - 1);
		g.mass = body.mass;
		scene.grains.push_back(g);
	}
}

RigidBody free_body(double mass, double inertia)
{
	RigidBody body;
	body.mass = mass, body.inertia = inertia;
	body.responds_x = body.responds_y = body.responds_spin = true;
	return body;
}

Scene empty()
{
	Scene scene;
	scene.law = hertz();
	scene.dt = 1e-4;
	return scene;
}

}  // namespace

TEST(Bodies, a_lone_clump_falls_and_spins_as_a_rigid_body_should)
{
	Scene scene = empty();
	scene.gravity_y = -10;
	RigidBody body = free_body(2, 0.5);
	body.spin = 3, body.vx = 1;
	add_dumbbell(scene, 0, 0, body);
	Stepper loop(scene);
	loop.step(1000);
	const double t = 0.1;
	const RigidBody& now = loop.bodies()[0];
	EXPECT_NEAR(now.x, t, 1e-12);
	EXPECT_NEAR(now.y, -10 * t * (t + scene.dt) / 2, 1e-12);  // leapfrog from v_{-1/2} = 0
	EXPECT_NEAR(now.angle, 3 * t, 1e-12);
	const Grain right = loop.grain(1);
	EXPECT_NEAR(right.x, now.x + 0.4 * std::cos(0.3), 1e-12);
	EXPECT_NEAR(right.y, now.y + 0.4 * std::sin(0.3), 1e-12);
	EXPECT_NEAR(right.vy, now.vy + 3 * 0.4 * std::cos(0.3), 1e-12);
}

TEST(Bodies, a_clump_hit_by_a_grain_shares_its_momentum_and_angular_momentum)
{
	Scene scene = empty();
	Grain bullet = disk(0.55, -1.5, 0.5);
	bullet.vy = 2;
	scene.grains = { bullet };
	add_dumbbell(scene, 0, 0, free_body(2, 0.5));
	Stepper loop(scene);
	const auto totals = [&] {
		const Grain g = loop.grain(0);
		const RigidBody& b = loop.bodies()[0];
		return Vector3r(g.mass * g.vx + b.mass * b.vx, g.mass * g.vy + b.mass * b.vy,
			g.mass * (g.x * g.vy - g.y * g.vx) + g.mass * g.radius * g.radius / 2 * g.spin + b.mass * (b.x * b.vy - b.y * b.vx) +
				b.inertia * b.spin);
	};
	const Vector3r before = totals();
	loop.step(6000);
	EXPECT_GT(std::abs(loop.bodies()[0].spin), 0.1);
	const Vector3r change = totals() - before;
	EXPECT_LT(std::hypot(change[0], change[1]), 1e-12);
	// Friction acts at each grain's own radius, so angular momentum changes by overlap times friction: 1e-2 of a radius here.
	EXPECT_LT(std::abs(change[2]), 0.02 * bullet.mass * 2 * 0.55);
}

TEST(Bodies, a_driven_disk_keeps_its_velocity_and_reports_the_force)
{
	Scene scene = crowd(10, 1, 0);
	scene.box.periodic_y = false;
	RigidBody driver;
	driver.x = 5.1, driver.y = 11.2, driver.vy = -2, driver.spin = 1;
	scene.bodies = { driver };
	scene.grains.push_back(disk(5.1, 11.2, 1, 0));
	scene.grains.back().mass = HUGE_VAL;
	Stepper loop(scene);
	double impulse = 0, momentum = 0;
	for (int k = 0; k < 3000; ++k) {
		loop.step();
		impulse -= loop.bodies()[0].force_y * scene.dt;
	}
	for (std::size_t i = 0; i < 100; ++i) momentum += loop.grain(i).mass * loop.grain(i).vy;
	EXPECT_EQ(loop.bodies()[0].vy, -2);
	EXPECT_EQ(loop.bodies()[0].spin, 1);
	EXPECT_LT(momentum, -1);
	EXPECT_NEAR(impulse, momentum, 1e-10);  // 3000 sums of impulses of order 0.1
}

TEST(Bodies, a_drum_of_beads_turns_and_carries_grains)
{
	Scene scene = empty();
	scene.gravity_y = -1;
	RigidBody drum;
	drum.spin = 0.5;
	scene.bodies = { drum };
	for (int k = 0; k < 40; ++k) {
		scene.grains.push_back(disk(6 * std::cos(2 * pi * k / 40), 6 * std::sin(2 * pi * k / 40), 0.5, 0));
		scene.grains.back().mass = HUGE_VAL;
	}
	for (int k = 0; k < 30; ++k) scene.grains.push_back(disk(-2.5 + k % 6, -3 + k / 6, 0.48));
	Stepper loop(scene);
	loop.step(40000);
	EXPECT_NEAR(loop.bodies()[0].angle, 2, 1e-10);
	EXPECT_NEAR(loop.grain(0).x, 6 * std::cos(2.0), 1e-9);
	double spread = 0, mean_x = 0;
	for (std::size_t i = 40; i < 70; ++i) {
		spread = std::max(spread, std::hypot(loop.grain(i).x, loop.grain(i).y));
		mean_x += loop.grain(i).x / 30;
	}
	EXPECT_LT(spread, 5.2);  // nobody leaves through the wall
	EXPECT_GT(mean_x, 0.1);  // counter-clockwise: the bed is carried up on the right
}

TEST(Bodies, forces_are_known_before_the_step_and_the_step_goes_on_from_there)
{
	Scene scene = crowd(10, 3);
	scene.box.periodic_y = false;
	scene.bodies.push_back({});
	for (std::size_t i = 0; i < 10; ++i)
		scene.grains[i].body = 0, scene.grains[i].vx = scene.grains[i].vy = scene.grains[i].spin = 0;
	Stepper straight(scene), asked(scene);
	for (int k = 0; k < 200; ++k) {
		straight.step();
		asked.compute_body_forces();
		std::vector<Touch> touches;
		asked.touches_on(0, touches);
		Vector2r sum(0, 0);
		for (const Touch& t : touches)
			sum += Vector2r(-t.normal * t.n_x - t.friction * t.n_y, -t.normal * t.n_y + t.friction * t.n_x);
		const double before_x = asked.bodies()[0].force_x, before_y = asked.bodies()[0].force_y;
		EXPECT_NEAR(sum[0], before_x, 1e-9 * (1 + std::abs(before_x)));
		EXPECT_NEAR(sum[1], before_y, 1e-9 * (1 + std::abs(before_y)));
		asked.step();
	}
	EXPECT_TRUE(same_bits(straight, asked));
}
