/// The fast loop against a plain loop over all pairs, conservation laws, and the same bits on any number of threads.
#include "engines/loop/stepper.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

double difference_from_plain(const Scene<2>& scene, int steps)
{
	Stepper<2> fast(scene);
	PlainLoop plain(scene);
	for (int k = 0; k < steps; ++k) plain.step();
	fast.step(steps);
	return largest_difference(
		scene, [&](std::size_t i) { return fast.grain(i); }, [&](std::size_t i) { return plain.s.grains[i]; });
}

// The round-off of one step, 1e-16, grows to less than this over some tens of collision times, with forces of 1e4 per unit mass
// and dt = 1e-4.
constexpr double grown_round_off = 1e-9;

}  // namespace

TEST(Stepper, follows_the_plain_loop_with_each_law)
{
	for (const ContactLaw& law : { ContactLaw(hertz()), ContactLaw(laws::hertz_restitution(2e5, 0.3, 0.7, 0.4)),
			 ContactLaw(laws::spring_dashpot(1e5, 3e4, 0.8, 0.5)) }) {
		Scene<2> scene = crowd(9, 1);
		scene.law = law;
		EXPECT_LT(difference_from_plain(scene, 400), grown_round_off);
	}
}

TEST(Stepper, follows_the_plain_loop_in_every_box)
{
	for (const bool x : { false, true })
		for (const bool y : { false, true }) {
			Scene<2> scene = crowd(8, 2);
			scene.cell.periodic[0] = x, scene.cell.periodic[1] = y;
			scene.gravity[1] = -1, scene.gravity[0] = 0.3;
			EXPECT_LT(difference_from_plain(scene, 400), grown_round_off);
		}
}

TEST(Stepper, follows_the_plain_loop_around_frozen_grains_and_uneven_sizes)
{
	Scene<2> scene = crowd(9, 3);
	scene.cell.periodic[1] = false;
	for (std::size_t i = 0; i < 9; ++i)
		scene.grains[i].body = 0, scene.grains[i].velocity[0] = scene.grains[i].velocity[1] = scene.grains[i].spin = 0;
	for (std::size_t i = 9; i < scene.grains.size(); i += 7)
		scene.grains[i].radius *= 0.4;  // beside small disks large ones have more contacts than slots
	scene.bodies.push_back({});
	EXPECT_LT(difference_from_plain(scene, 400), grown_round_off);
}

TEST(Stepper, finds_every_pair_where_memory_runs_in_strips)
{
	for (const bool y : { false, true }) {
		Scene<2> scene = crowd(92, 12, 10);  // more cells across than one strip has
		scene.cell.periodic[1] = y;
		EXPECT_LT(difference_from_plain(scene, 3), grown_round_off);
	}
}

TEST(Stepper, springs_survive_searches_and_sorting)
{
	Scene<2> often = crowd(10, 4, 3), seldom = often;
	often.skin = 0.01;
	seldom.skin = 0.3;
	Stepper<2> a(often), b(seldom);
	a.step(600), b.step(600);
	EXPECT_GT(a.searches_done(), 5 * b.searches_done());
	// Only the order of sums differs; a lost spring would change results by 1e-3.
	EXPECT_LT(largest_difference(
				  often, [&](std::size_t i) { return a.grain(i); }, [&](std::size_t i) { return b.grain(i); }),
		grown_round_off);
}

TEST(Stepper, gives_the_same_bits_on_any_number_of_threads_and_in_any_portions)
{
	for (const Precision precision : { Precision::double_, Precision::single }) {
		Scene<2> scene = crowd(16, 5, 2);
		scene.precision = precision;
		Stepper<2> one(scene);
		one.step(300);
		for (const int threads : { 2, 3, 5 }) {
			scene.threads = threads;
			Stepper<2> many(scene);
			many.step(100), many.step(1), many.step(199);
			EXPECT_TRUE(same_bits(one, many)) << threads << " threads";
		}
	}
}

TEST(Stepper, shows_before_a_step_the_contacts_that_the_step_will_find)
{
	for (const Precision precision : { Precision::double_, Precision::single })
		for (const int threads : { 1, 2 }) {
			Scene<2> scene = crowd(16, 5, 2);
			scene.precision = precision;
			scene.threads = threads;
			Stepper<2> looking(scene), plain(scene);
			std::size_t seen = 0;
			for (int k = 0; k < 200; ++k) {
				const auto before = looking.present_contacts();
				looking.step(1), plain.step(1);
				const auto after = looking.contacts();
				ASSERT_EQ(before.size(), after.size());
				seen += before.size();
				for (std::size_t c = 0; c < before.size(); ++c) {
					ASSERT_EQ(before[c].normal, after[c].normal);
					ASSERT_EQ(before[c].friction, after[c].friction);
				}
			}
			EXPECT_GT(seen, 1000u);
			EXPECT_TRUE(same_bits(looking, plain)) << "looking changed the motion";
		}
}

TEST(Stepper, can_be_saved_after_a_look_between_steps_and_goes_on_with_the_same_bits)
{
	for (const Precision precision : { Precision::double_, Precision::single }) {
		Scene<2> scene = crowd(16, 5, 2);
		scene.precision = precision;
		Wall<2> wall;
		wall.side = Side::y_low;  // at y = 0
		scene.cell.periodic[1] = false;
		Stepper<2> looking(scene), plain(scene);
		looking.set_wall(wall), plain.set_wall(wall);
		std::size_t seen = 0, at_wall = 0;
		for (int k = 0; k < 300; ++k) {
			const auto sight = looking.look_between_steps();
			EXPECT_FALSE(looking.step_under_way());
			looking.step(1), plain.step(1);
			const auto after = looking.contacts();
			ASSERT_EQ(sight.pairs.size(), after.size());
			for (std::size_t c = 0; c < after.size(); ++c) {
				ASSERT_EQ(sight.pairs[c].normal, after[c].normal);
				ASSERT_EQ(sight.pairs[c].friction, after[c].friction);
				ASSERT_EQ(sight.pairs[c].slip, after[c].slip);
			}
			seen += after.size(), at_wall += sight.surfaces.size();
		}
		EXPECT_GT(seen, 1000u);
		EXPECT_GT(at_wall, 10u);
		EXPECT_TRUE(same_bits(looking, plain)) << "looking changed the motion";
	}
}

TEST(Stepper, conserves_momentum)
{
	Stepper<2> loop(crowd(12, 6));
	const auto momentum = [&] {
		Vector2r sum(0, 0);
		for (std::size_t i = 0; i < loop.size(); ++i)
			sum += loop.grain(i).mass * Vector2r(loop.grain(i).velocity[0], loop.grain(i).velocity[1]);
		return sum;
	};
	const Vector2r before = momentum();
	loop.step(1000);
	// 144 grains, 1000 steps, force impulses up to 1: sums of 1e5 roundings of 1e-16 each.
	EXPECT_LT((momentum() - before).norm(), 1e-11);
}

TEST(Stepper, bounces_without_damping_keep_the_energy)
{
	Scene<2> scene = crowd(10, 7, 0.5);
	scene.law = hertz(0, 0);
	scene.friction = false;
	scene.dt = 2e-5;
	for (Grain<2>& g : scene.grains) g.radius *= 0.85, g.mass *= 0.85 * 0.85;  // no contacts at the start
	Stepper<2> loop(scene);
	const double before = loop.kinetic_energy();
	double lowest = before, highest = 0;
	for (int k = 0; k < 4000; ++k) {
		loop.step(10);
		lowest = std::min(lowest, loop.kinetic_energy());
		highest = std::max(highest, loop.kinetic_energy());
	}
	EXPECT_LT(lowest, 0.999 * before);  // part of the energy is elastic during collisions
	// During a collision leapfrog's error is (omega dt)^2/24 = 1e-5 of its energy; afterwards it is zero again.
	EXPECT_NEAR(highest, before, 1e-4 * before);
}

TEST(Stepper, single_precision_stays_near_double_and_does_not_care_where_a_grain_is)
{
	const auto far_from_near = [](double shift) {
		Scene<2> scene;
		scene.law = hertz();
		scene.dt = 1e-4;
		scene.precision = Precision::single;
		scene.grains = { disk(shift, 0), disk(shift + 0.99, 0.1) };
		scene.grains[0].velocity[0] = 1;
		Stepper<2> loop(scene);
		loop.step(200);
		return loop.grain(0).place[0] - shift;
	};
	// Differences of positions are computed in double precision; only the round-off of forces, 6e-8, is in single precision.
	EXPECT_NEAR(far_from_near(0), far_from_near(300), 1e-6);
	Scene<2> scene = crowd(10, 9);
	Stepper<2> twice(scene);
	scene.precision = Precision::single;
	Stepper<2> once(scene);
	twice.step(100), once.step(100);
	EXPECT_LT(largest_difference(
				  scene, [&](std::size_t i) { return once.grain(i); }, [&](std::size_t i) { return twice.grain(i); }),
		1e-3);
}

TEST(Stepper, refuses_what_cannot_run_and_says_why)
{
	const auto message = [](Scene<2> scene) -> std::string {
		try {
			Stepper<2>{ scene };
		} catch (const std::invalid_argument& error) {
			return error.what();
		}
		return "";
	};
	Scene<2> scene = crowd(4, 1);
	scene.dt = 1;
	EXPECT_NE(message(scene).find("critical"), std::string::npos);
	scene = crowd(4, 1);
	scene.grains[3].radius = -1;
	EXPECT_NE(message(scene).find("radius must be positive, got -1 in grain 3"), std::string::npos);
	scene = crowd(4, 1);
	scene.cell.high[0] = 2;
	Stepper<2> narrow(scene);
	EXPECT_THROW(narrow.step(), std::invalid_argument);  // too few cells across
}

TEST(Stepper, a_deep_overlap_stops_the_run_with_step_and_grain)
{
	Scene<2> scene;
	scene.law = hertz();
	scene.dt = 1e-4;
	scene.threads = 2;  // the other thread must stop too
	scene.grains = { disk(0, 0), disk(0.7, 0) };
	Stepper<2> deep(scene);
	try {
		deep.step(200);
		FAIL() << "an overlap of 0.6 of a radius went unnoticed";
	} catch (const std::runtime_error& error) {
		EXPECT_NE(std::string(error.what()).find("step 0: grain 0 at (0, 0)"), std::string::npos) << error.what();
		EXPECT_NE(std::string(error.what()).find("overlap by 0.6 of a radius"), std::string::npos) << error.what();
	}
}
