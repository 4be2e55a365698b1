/// Outlines: which faults are repaired, which are refused, and whether the message names the vertex.
#include <gtest/gtest.h>

#include <algorithm>

#include "engines/shapes/built_in.hpp"
#include "engines/shapes/solid.hpp"
#include "engines/shapes/test_support.hpp"

using namespace graindrive;
using namespace graindrive::shapes;

namespace {

const Points square{ { 0, 0 }, { 2, 0 }, { 2, 2 }, { 0, 2 } };

std::string refusal(const Points& vertices)
{
	return complaint([&] { Outline outline(vertices); });
}

}  // namespace

TEST(Outline, turns_clockwise_vertices_round)
{
	const Points clockwise(square.rbegin(), square.rend());
	EXPECT_DOUBLE_EQ(solid_of(Outline(clockwise)).area, 4);  // negative if it had stayed clockwise
}

TEST(Outline, drops_repeated_closing_and_collinear_vertices)
{
	const Points littered{ { 1, 0 }, { 2, 0 }, { 2, 0 }, { 2, 1 }, { 2, 1.5 }, { 2, 2 }, { 0, 2 }, { 0, 0 }, { 0.5, 0 },
		{ 1, 0 } };
	EXPECT_EQ(Outline(littered).vertices().size(), 4u);
	EXPECT_DOUBLE_EQ(solid_of(Outline(littered)).area, 4);
}

TEST(Outline, refuses_what_is_not_finite_by_vertex)
{
	Points bad = square;
	bad[2].y() = std::nan("");
	EXPECT_TRUE(mentions(refusal(bad), "vertex 2 (2, nan)")) << refusal(bad);
}

TEST(Outline, refuses_fewer_than_three_different_vertices)
{
	EXPECT_TRUE(mentions(refusal({}), "at least 3 different vertices, got 0"));
	EXPECT_TRUE(mentions(refusal({ { 1, 2 }, { 3, 4 }, { 3, 4 }, { 1, 2 } }), "got 2, the first being vertex 0 (1, 2)"));
}

TEST(Outline, refuses_more_vertices_than_an_inset_can_be_made_of)
{
	Points many;
	for (int i = 0; i < 5001; ++i) many.emplace_back(std::cos(2 * pi * i / 5001), std::sin(2 * pi * i / 5001));
	EXPECT_TRUE(mentions(refusal(many), "at most 5000 vertices, got 5001")) << refusal(many);
}

TEST(Outline, refuses_a_line) { EXPECT_TRUE(mentions(refusal({ { 0, 0 }, { 1, 1 }, { 3, 3 }, { 2, 2 } }), "enclose an area")); }

TEST(Outline, names_the_edges_that_cross_by_the_callers_indices)
{
	// The repeated vertex 1 is dropped first; the message still counts it.
	const std::string message = refusal({ { 0, 0 }, { 0, 0 }, { 2, 2 }, { 2, 0 }, { 0, 3 } });
	EXPECT_TRUE(mentions(message, "vertex 0 (0, 0)") && mentions(message, "vertex 3 (2, 0)")) << message;
}

TEST(Outline, refuses_edges_that_touch_and_edges_that_turn_back)
{
	EXPECT_TRUE(mentions(refusal({ { 0, 0 }, { 4, 0 }, { 4, 4 }, { 2, 0 }, { 0, 4 } }), "touch")) << "corner on an edge";
	EXPECT_TRUE(mentions(refusal({ { 0, 0 }, { 4, 0 }, { 6, 0 }, { 4, 0 }, { 4, 4 } }), "vertex 2 (6, 0)"))
		<< "spike without width";
}

TEST(Outline, refuses_numbers_that_its_integrals_cannot_hold)
{
	EXPECT_TRUE(mentions(refusal({ { 0, 0 }, { 1e154, 0 }, { 0, 1e154 } }), "up to 1e50, got vertex 1 (1e+154, 0)"));
	EXPECT_TRUE(mentions(refusal({ { 0, 0 }, { 1e-300, 0 }, { 0, 1e-300 } }), "at least 1e-50 wide or high, got 1e-300"));
	EXPECT_TRUE(mentions(refusal({ { 0, 0 }, { 5e-324, 0 }, { 0, 5e-324 } }), "at least 1e-50"));
	for (const Real size : { 1e49, 1e-49 }) {
		const Solid solid = solid_of(Outline({ { 0, 0 }, { size, 0 }, { size, size }, { 0, size } }));
		EXPECT_DOUBLE_EQ(solid.area, size * size);
		EXPECT_DOUBLE_EQ(solid.second_moment, size * size / 6);
	}
}

TEST(Outline, refuses_a_place_so_far_out_that_the_shape_is_rounded_away)
{
	Points far;
	for (const Vector2r& v : square) far.push_back(v + Vector2r(1e9, 0));
	EXPECT_TRUE(mentions(refusal(far), "resolve 1e-8 of its extent 2, got vertex 0 (1000000000, 0)")) << refusal(far);
}

TEST(Outline, gives_back_the_vertices_that_it_was_given_to_the_last_bit)
{
	for (const Vector2r& at : { Vector2r(0.1, -0.7), Vector2r(5e6, -3.3e6), Vector2r(0.3, 7e6) }) {
		Points given;
		for (const Vector2r& v : square) given.push_back(v * 1.37 + at);
		EXPECT_EQ(Outline(given).vertices(), given);
	}
}

TEST(Outline, is_turned_far_out_as_exactly_as_about_the_origin)
{
	Points far;
	for (const Vector2r& v : square) far.push_back(v + Vector2r(0x1p22, -0x3p20));  // sums without round-off
	const Points near = Outline(square).turned(0.7).corners(), there = Outline(far).turned(0.7).about_centroid().corners();
	for (std::size_t i = 0; i < near.size(); ++i)
		EXPECT_LT((near[i] - near[0] - (there[i] - there[0])).norm(), 3e-15) << i;  // a few round-offs of lengths up to 3
}

TEST(FallHeight, does_not_feel_mid_points_and_rounded_digits)
{
	// Sides that are vertical except for the sixth digit, with points in their middle that are off the line by as much.
	const Outline littered(
		{ { -3, -3 }, { 0, -3.000001 }, { 3, -3 }, { 3.000001, 0 }, { 3, 3 }, { 0, 3 }, { -3, 3 }, { -3.000001, 1 } });
	EXPECT_NEAR(fall_height(littered), 6, 2e-6);
	// A circle with edges so short that the product of two neighbours' widths is small compared with the square of the extent.
	Points fine;
	for (int i = 0; i < 5000; ++i) fine.emplace_back(std::cos(2 * pi * i / 5000), std::sin(2 * pi * i / 5000));
	// Arcs whose height is below 4e-7 are straightened; such an arc is 1.8e-3 long.
	EXPECT_NEAR(fall_height(Outline(fine)), 1, 2 * 1.8e-3);
}

TEST(BuiltIn, has_the_papers_sizes_about_the_centroid)
{
	const Real areas[] = { pi * 49 / 4, 6.5 * 6.5, 4.5 * 9.5, 9.5 * 4.5, std::sqrt(3.0) / 4 * 9.5 * 9.5 };
	const Real falls[] = { 3.5, 6.5, 9.5, 4.5, 9.5 * std::sqrt(3.0) / 2 };  // l in Table 1 of the wiggle paper
	int i = 0;
	for (const std::string& name : shape_names()) {
		const Outline outline = outline_of(name);
		const Solid solid = solid_of(outline);
		EXPECT_NEAR(solid.area, areas[i], 1e-12) << name;  // a few round-offs of numbers of order 50
		EXPECT_NEAR(solid.centroid.norm(), 0, 1e-14) << name;
		EXPECT_NEAR(fall_height(outline), falls[i], 1e-14) << name;
		EXPECT_EQ(outline_of("OS" + std::to_string(++i)).vertices(), outline.vertices());
	}
}

TEST(BuiltIn, turns_counter_clockwise)
{
	const Outline tall = outline_of("tall", { 2, 6 }, pi / 2);
	EXPECT_NEAR(tall.vertices()[0].x(), 3, 1e-15);  // (-1, -3) turned
	EXPECT_NEAR(tall.vertices()[0].y(), -1, 1e-15);
	EXPECT_NEAR(fall_height(tall), 2, 1e-14);
	EXPECT_NEAR(fall_height(outline_of("triangle", {}, pi)), 0, 1e-14);  // apex down: widest at the top
}

TEST(BuiltIn, lists_the_choices_for_an_unknown_name_and_the_sizes_it_takes)
{
	EXPECT_TRUE(mentions(complaint([] { outline_of("circle"); }), "disk (OS1), square (OS2)"));
	EXPECT_TRUE(mentions(complaint([] { outline_of("wide", { 3 }); }), "takes 2 size(s) (width, height), got 1"));
	EXPECT_TRUE(mentions(complaint([] { outline_of("disk", { -7 }); }), "positive and finite, from 1e-50 to 1e+50, got -7"));
	EXPECT_TRUE(mentions(complaint([] { outline_of("disk", {}, std::nan("")); }), "finite angle"));
	EXPECT_TRUE(mentions(complaint([] { outline_of("disk", { 1e308 }); }), "from 1e-50 to 1e+50"));
	EXPECT_TRUE(mentions(complaint([] { outline_of("triangle", { 1e308 }); }), "from 1e-50 to 1e+50, got 1e+308"));
	EXPECT_TRUE(mentions(complaint([] { outline_of("square", { 5e-324 }); }), "from 1e-50 to 1e+50"));
}
