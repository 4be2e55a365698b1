/// A grain that leaves the box stops the run, whatever defines the box; a grain inside does not.
#include <gtest/gtest.h>

#include "engines/base/complaint.hpp"
#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

/// A grain that falls through the gap between two frozen ones.
Scene<2> gap()
{
	Scene<2> s;
	s.law = hertz();
	s.dt = 1e-3;
	s.gravity[1] = -1;
	RigidBody<2> base;
	base.frozen = true;
	s.bodies = { base };
	s.grains = { disk(-2, 0, 0.5, 0), disk(2, 0, 0.5, 0), disk(0, 1) };
	return s;
}

/// The error message of the loop if it stops within so many steps; empty if it does not.
std::string last_words(Stepper<2>& loop, long steps)
{
	try {
		loop.step(steps);
	} catch (const std::runtime_error& error) {
		return error.what();
	}
	return "";
}

}  // namespace

TEST(Box, a_grain_that_falls_through_a_base_is_lost_three_diameters_below_it)
{
	Stepper<2> loop(gap());
	loop.speak_of({ 10, 11, 12 }, 5000);
	const std::string words = last_words(loop, 10000);
	EXPECT_TRUE(mentions(words, "grain 12 at")) << words;
	EXPECT_TRUE(mentions(words, "has left the box")) << words;
	EXPECT_TRUE(mentions(words, "step " + std::to_string(5000 + loop.steps_done()))) << words;
	const double lost = -0.5 - 3, g = 1, dt = 1e-3, fall = 1 - lost;
	EXPECT_LT(loop.grain(2).place[1], lost);
	EXPECT_GT(loop.grain(2).place[1], lost - std::sqrt(2 * g * (fall + 1)) * 101 * dt);  // the check runs every 100 steps
}

TEST(Box, bounds_take_the_place_of_the_base)
{
	Stepper<2> loop(gap());
	Guards<2>& guards = loop.guarding();
	guards.bounded = true;  // two equal numbers mean no bounds
	EXPECT_EQ(last_words(loop, 5000), "");
	EXPECT_LT(loop.grain(2).place[1], -10);
	guards.low[1] = -20, guards.high[1] = 10;
	const std::string words = last_words(loop, 5000);
	EXPECT_TRUE(mentions(words, "its y is below -20, the bounds that were set")) << words;
}

TEST(Box, a_grain_whose_centre_is_beyond_a_wall_is_named_with_the_wall)
{
	for (const Side side : { Side::x_low, Side::x_high, Side::y_low, Side::y_high }) {
		Scene<2> s = gap();
		Wall<2> wall;
		wall.side = side;
		wall.position = 3 * wall.outward();
		s.walls = { wall };
		s.grains[2] = wall.axis() == 0 ? disk(3.01 * wall.outward(), 3) : disk(0, 3.01 * wall.outward());
		Stepper<2> loop(s);
		const std::string words = last_words(loop, 1);
		EXPECT_TRUE(mentions(words, "wall " + name_of(side))) << words;
		EXPECT_TRUE(mentions(words, "step 0: grain 2 at") && mentions(words, "has left the box")) << words;
	}
}

TEST(Box, what_moves_where_nothing_bounds_it_goes_on)
{
	Scene<2> sideways = gap(), weightless = gap(), led = gap();
	sideways.grains[2].velocity[0] = 50, sideways.grains[2].velocity[1] = 50;
	weightless.gravity[1] = 0, weightless.grains[2].velocity[1] = -50;
	RigidBody<2> plunger;
	plunger.place[1] = 1, plunger.velocity[1] = -50;
	led.bodies.push_back(plunger);
	led.grains[2].body = 1;
	for (const Scene<2>& scene : { sideways, weightless, led }) {
		Stepper<2> loop(scene);
		EXPECT_EQ(last_words(loop, 1000), "");
	}
}

TEST(Box, periodic_sides_have_no_end)
{
	Scene<2> s = gap();
	s.cell = { { -4, -4 }, { 4, 4 }, { true, true } };
	s.grains[2].velocity[0] = -3;
	Stepper<2> loop(s);
	EXPECT_EQ(last_words(loop, 10000), "");
}

TEST(Overlaps, grains_that_would_pass_through_each_other_between_two_looks_are_seen)
{
	for (const double speed : { 30., 100., 300. }) {  // half a diameter in 17 to 2 steps, between the checks at steps 0 and 100
		Scene<2> s;
		s.law = hertz();
		s.dt = 1e-3;
		s.grains = { disk(0, 0), disk(5 * speed * s.dt + 1.01, 0) };
		s.grains[1].velocity[0] = -speed;
		Stepper<2> loop(s);
		EXPECT_TRUE(mentions(last_words(loop, 90), "overlap by")) << speed;
	}
}

TEST(Overlaps, the_step_must_bear_the_overlap_that_stops_the_run)
{
	Scene<2> s;
	s.law = hertz();
	s.grains = { disk(0, 0), disk(2, 0) };
	s.dt = 1;
	const double shallow = critical_time_step(s, 0.1), deep = critical_time_step(s, 0.4);
	EXPECT_NEAR(shallow / deep, std::sqrt(2.), 0.05);  // (0.4/0.1)^(1/4) without dashpots
	s.dt = 1.01 * deep;
	EXPECT_EQ(complaint([&] { Stepper<2> loop(s); }), "");
	Guards<2> guards;
	guards.largest_overlap = 0.4;
	EXPECT_TRUE(mentions(complaint([&] { Stepper<2> loop(s, guards); }), "at the largest allowed overlap of 0.4 R"));
	guards.largest_overlap = 0.01;
	s.dt = 1.01 * shallow;
	EXPECT_EQ(complaint([&] { Stepper<2> loop(s, guards); }), "");
}
