/// Outlines: what is repaired, what is refused, and how the refusal names the vertex.
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
	EXPECT_DOUBLE_EQ(solid_of(Outline(clockwise)).area, 4);  // signed: negative if it had stayed clockwise
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

TEST(BuiltIn, has_the_papers_sizes_about_the_centroid)
{
	const Real areas[] = { pi * 49 / 4, 6.5 * 6.5, 4.5 * 9.5, 9.5 * 4.5, std::sqrt(3.0) / 4 * 9.5 * 9.5 };
	const Real falls[] = { 3.5, 6.5, 9.5, 4.5, 9.5 * std::sqrt(3.0) / 2 };  // l of the wiggle paper's Table 1
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
	EXPECT_TRUE(mentions(complaint([] { outline_of("disk", { -7 }); }), "positive and finite, got -7"));
	EXPECT_TRUE(mentions(complaint([] { outline_of("disk", {}, std::nan("")); }), "finite angle"));
}
