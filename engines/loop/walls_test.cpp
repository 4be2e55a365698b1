/// Flat walls: closed forms of a bounce, a slide and a pile; walls that move; the same bits on any number of threads.
#include <gtest/gtest.h>

#include "engines/base/temporary_file.hpp"
#include "engines/base/complaint.hpp"
#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

Wall<2> wall(Side side, double position, double velocity = 0)
{
	Wall<2> w;
	w.side = side, w.position = position, w.velocity = velocity;
	return w;
}

Scene<2> box_of(std::vector<Wall<2>> walls)
{
	Scene<2> scene;
	scene.law = hertz();
	scene.dt = 1e-4;
	scene.walls = std::move(walls);
	return scene;
}

/// 500 disks without contacts between a floor and a lid, periodic in x.
Scene<2> loose_bed(double lid_velocity)
{
	Scene<2> scene = crowd(25, 3, 0.1);
	scene.grains.resize(500);  // 20 rows of 25
	scene.cell.periodic[1] = false;
	for (Grain<2>& g : scene.grains) g.place[1] *= 1.1;
	scene.walls = { wall(Side::y_low, 0), wall(Side::y_high, 22.1, lid_velocity) };
	scene.law = laws::HertzHistory<Real>{ 2e5, 2.46e5, 500, 500, 0.3 };
	return scene;
}

Wall<2> pressed_lid(double pressure)
{
	Wall<2> lid = wall(Side::y_high, 22.1);
	lid.pressed = true;
	lid.pressure = pressure, lid.mass = 20, lid.damping = 200, lid.speed_limit = 2;
	return lid;
}

bool same_walls(const Stepper<2>& a, const Stepper<2>& b)
{
	for (std::size_t w = 0; w < a.settings().walls.size(); ++w) {
		const Wall<2>&one = a.settings().walls[w], &other = b.settings().walls[w];
		if (one.position != other.position || one.velocity != other.velocity || one.force[0] != other.force[0] ||
			one.force[1] != other.force[1])
			return false;
	}
	return true;
}

}  // namespace

TEST(Walls, a_bounce_has_the_imposed_restitution_on_every_side)
{
	for (const Side side : { Side::x_low, Side::x_high, Side::y_low, Side::y_high }) {
		const double out = wall(side, 0).outward();
		const bool x = wall(side, 0).axis() == 0;
		Scene<2> scene = box_of({ wall(side, 0) });
		scene.law = laws::spring_dashpot(1e4, 3e3, 0.8, 0);
		scene.grains = { disk(x ? -0.501 * out : 3, x ? 3 : -0.501 * out) };
		(x ? scene.grains[0].velocity[0] : scene.grains[0].velocity[1]) = out;
		Stepper<2> loop(scene);
		loop.step(2000);
		// Leapfrog's error over half an oscillation, (omega dt)^2/24 = 5e-6, and an error of order omega dt damping from the last
		// step of contact.
		EXPECT_NEAR(x ? loop.grain(0).velocity[0] : loop.grain(0).velocity[1], -0.8 * out, 1e-3) << name_of(side);
	}
}

TEST(Walls, a_hertzian_bounce_stores_the_energy_in_the_overlap_and_gives_it_back)
{
	Scene<2> scene = box_of({ wall(Side::y_low, 0) });
	scene.law = hertz(0, 0);
	scene.friction = false;
	scene.dt = 1e-5;
	scene.grains = { disk(0, 0.501) };
	scene.grains[0].velocity[1] = -1;
	Stepper<2> loop(scene);
	double deepest = 0;
	for (int k = 0; k < 20000; ++k) {
		loop.step();
		deepest = std::max(deepest, 0.5 - loop.grain(0).place[1]);
	}
	const double mass = pi / 4, expected = std::pow(0.5 * mass / (0.4 * 2e5 * std::sqrt(0.5)), 0.4);
	// (omega dt)^2 with omega = 600/s is 4e-5; leapfrog's energy error during a contact is a fraction of it and vanishes
	// afterwards.
	EXPECT_NEAR(deepest, expected, 1e-4 * expected);
	EXPECT_NEAR(loop.grain(0).velocity[1], 1, 1e-5);
}

TEST(Walls, a_sliding_disk_is_braked_by_friction_until_it_rolls_at_two_thirds)
{
	const double mu = 0.3, g = 10, v0 = 1;
	Scene<2> scene = box_of({ wall(Side::y_low, 0) });
	scene.gravity[1] = -g;
	const double mass = pi / 4, rest = std::pow(mass * g / (2e5 * std::sqrt(0.5)), 2.0 / 3);
	scene.grains = { disk(0, 0.5 - rest) };
	scene.grains[0].velocity[0] = v0;
	Stepper<2> loop(scene);
	loop.step(500);
	// The first steps stretch the spring: k_t s = mu N after s = mu delta k_n/k_t, a millimetre of the 50 travelled.
	EXPECT_NEAR(loop.grain(0).velocity[0], v0 - mu * g * 0.05, 2e-3);
	EXPECT_TRUE(loop.surface_contacts()[0].slipping);
	EXPECT_NEAR(loop.settings().walls[0].force[0], mu * mass * g, 1e-9);
	EXPECT_NEAR(loop.settings().walls[0].force[1], -mass * g, 1e-9);
	loop.step(20000);
	EXPECT_NEAR(loop.grain(0).velocity[0], 2.0 / 3 * v0, 1e-3);
	EXPECT_NEAR(
		loop.grain(0).spin * 0.5, -loop.grain(0).velocity[0], 1e-3);  // the surfaces no longer slip; the spring still oscillates
}

TEST(Walls, a_sliding_wall_drags_a_disk_along)
{
	Scene<2> scene = box_of({ wall(Side::y_low, 0) });
	scene.walls[0].slide[0] = 1;
	scene.gravity[1] = -10;
	scene.grains = { disk(0, 0.499) };
	Stepper<2> loop(scene);
	loop.step(20000);
	// Angular momentum about the line of contact is conserved: v = 1/3, R w = 2/3.
	EXPECT_NEAR(loop.grain(0).velocity[0], 1.0 / 3, 1e-3);
	EXPECT_NEAR(loop.grain(0).spin * 0.5, 2.0 / 3, 1e-3);
}

TEST(Walls, a_column_of_disks_and_a_clump_weigh_what_they_weigh)
{
	Scene<2> scene = box_of({ wall(Side::y_low, 0), wall(Side::x_low, -1), wall(Side::x_high, 3) });
	scene.law = hertz(0.3, 5000);
	scene.gravity[1] = -1;
	double weight = 2;
	for (int k = 0; k < 8; ++k) scene.grains.push_back(disk(0, 0.5 + k)), weight += scene.grains.back().mass;
	RigidBody<2> clump;
	clump.place[0] = 1.8, clump.place[1] = 0.5, clump.mass = 2, clump.inertia = 0.5;
	clump.responds[0] = clump.responds[1] = clump.turns[0] = true;
	scene.bodies = { clump };
	for (const double side : { -0.2, 0.2 }) scene.grains.push_back(disk(1.8 + side, 0.5, 0.5, 0)), scene.grains.back().mass = 2;
	Stepper<2> loop(scene);
	loop.step(400000);
	EXPECT_NEAR(-loop.settings().walls[0].force[1], weight, 1e-8 * weight);
	EXPECT_NEAR(loop.bodies()[0].force[1], 2, 1e-8);
	std::vector<Touch<2>> touches;
	loop.touches_on(0, touches);
	EXPECT_EQ(touches.size(), 2u);
}

TEST(Walls, momentum_is_what_the_walls_gave)
{
	Scene<2> scene = loose_bed(-0.5);
	scene.gravity[1] = 0;
	Stepper<2> loop(scene);
	Vector2r given(0, 0);
	const auto momentum = [&] {
		Vector2r sum(0, 0);
		for (std::size_t i = 0; i < loop.size(); ++i)
			sum += loop.grain(i).mass * Vector2r(loop.grain(i).velocity[0], loop.grain(i).velocity[1]);
		return sum;
	};
	const Vector2r before = momentum();
	for (int k = 0; k < 5000; ++k) {
		loop.step();
		for (const Wall<2>& w : loop.settings().walls) given -= scene.dt * Vector2r(w.force[0], w.force[1]);
	}
	EXPECT_GT(given.norm(), 0.1);
	EXPECT_LT((momentum() - before - given).norm(), 1e-10);  // round-off of 5000 sums over 500 grains
}

TEST(Walls, a_lid_under_pressure_comes_to_rest_where_the_bed_bears_it)
{
	Scene<2> scene = loose_bed(0);
	const double pressure = 5;
	scene.walls[1] = pressed_lid(pressure);
	Stepper<2> loop(scene);
	loop.step(400000);
	const Wall<2>& lid = loop.settings().walls[1];
	EXPECT_NEAR(lid.force[1] / 25, pressure, 1e-3 * pressure);
	EXPECT_NEAR(-loop.settings().walls[0].force[1] / 25, pressure, 1e-3 * pressure);
	EXPECT_LT(std::abs(lid.velocity), 1e-4);
	EXPECT_GT(filled_fraction(loop.settings()), 0.75);
}

TEST(Walls, walls_halt_at_the_area_fraction_asked_for)
{
	for (const double asked : { 0.70, 0.80 }) {
		Scene<2> scene = loose_bed(-2);
		scene.target_fraction = asked;
		Stepper<2> loop(scene);
		loop.step(60000);
		double area = 0;
		for (const Grain<2>& g : scene.grains) area += pi * g.radius * g.radius;
		const auto& walls = loop.settings().walls;
		EXPECT_NEAR(area / (25 * (walls[1].position - walls[0].position)), asked, 1e-4);  // the lid's travel in a step over 20 d
		EXPECT_EQ(walls[1].velocity, 0);
	}
}

TEST(Walls, a_bed_under_a_lid_has_the_same_bits_on_any_number_of_threads_and_after_a_checkpoint)
{
	const graindrive::test::TemporaryFile file;
	Scene<2> scene = loose_bed(0);
	for (Grain<2>& g : scene.grains) g.place[1] /= 1.1;
	scene.walls[1] = pressed_lid(5);
	scene.walls[1].position = 20;
	scene.gravity[1] = -1;
	Stepper<2> one(scene);
	one.step(3000);
	EXPECT_GT(one.searches_done(), 2);
	EXPECT_GT(one.surface_contacts().size(), 3u);
	for (const int threads : { 2, 3 }) {
		scene.threads = threads;
		Stepper<2> many(scene);
		many.step(1000), many.step(1);
		many.save(file.path());
		const auto restored = Stepper<2>::restore(file.path(), 2);
		many.step(1999), restored->step(1999);
		EXPECT_TRUE(same_bits(one, many) && same_walls(one, many)) << threads << " threads";
		EXPECT_TRUE(same_bits(one, *restored) && same_walls(one, *restored));
	}
}

TEST(Walls, springs_at_walls_survive_searches)
{
	Scene<2> often = loose_bed(-1), seldom = often;
	for (Scene<2>* s : { &often, &seldom }) s->walls[0].slide[0] = 0.5, s->gravity[1] = -1;
	often.skin = 0.02;
	seldom.skin = 0.4;
	Stepper<2> a(often), b(seldom);
	a.step(4000), b.step(4000);
	EXPECT_GT(a.searches_done(), 3 * b.searches_done());
	// Only the order of sums differs; a lost spring would change results by 1e-3.
	EXPECT_LT(largest_difference(
				  often, [&](std::size_t i) { return a.grain(i); }, [&](std::size_t i) { return b.grain(i); }),
		1e-9);
}

TEST(Walls, frozen_disks_pushed_by_a_load_close_in_until_the_bed_bears_it)
{
	Scene<2> scene = loose_bed(0);
	scene.walls.pop_back();
	RigidBody<2> lid;
	lid.place[0] = 12.5, lid.place[1] = 22.6, lid.mass = 20, lid.responds[1] = true, lid.load[1] = -5 * 25;
	scene.bodies = { lid };
	for (int k = 0; k < 25; ++k) scene.grains.push_back(disk(k + 0.5, 22.6, 0.5, 0)), scene.grains.back().mass = 20;
	Stepper<2> loop(scene);
	loop.step(300000);
	double borne = 0, floor = 0;
	for (int k = 0; k < 100000; ++k) {
		loop.step();
		borne += loop.bodies()[0].force[1] / 1e5, floor -= loop.settings().walls[0].force[1] / 1e5;
	}
	EXPECT_NEAR(borne, 125, 0.5);  // the bed still oscillates: 400 kg at 1 cm/s over 10 s
	EXPECT_NEAR(floor, 125, 0.5);
}

TEST(Walls, refuses_what_cannot_be_and_says_why)
{
	const auto refusal = [](const Wall<2>& w) {
		Scene<2> scene = loose_bed(0);
		Stepper<2> loop(scene);
		return complaint([&] { loop.set_wall(w); });
	};
	EXPECT_TRUE(mentions(refusal(wall(Side::x_low, 0)), "wall x_low: the box must not be periodic across it"));
	EXPECT_TRUE(mentions(refusal(wall(Side::y_low, 50)), "wall y_low: must lie on its own side of the opposite wall"));
	Wall<2> light = pressed_lid(1);
	light.mass = 0;
	EXPECT_TRUE(mentions(refusal(light), "needs a positive mass [kg], got 0"));
	EXPECT_TRUE(mentions(complaint([] { side_named<2>("top"); }), "x_low, x_high, y_low or y_high, got top"));
	Scene<2> outside = loose_bed(0);
	outside.walls[1].position = 15;
	Stepper<2> loop(outside);
	EXPECT_THROW(loop.step(), std::runtime_error);
}
