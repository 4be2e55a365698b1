/// Beads: together they fill the outline and never exceed it; their steps are as requested; the clump has the solid's mass and
/// inertia.
#include "engines/shapes/clump.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engines/shapes/built_in.hpp"
#include "engines/shapes/solid.hpp"
#include "engines/shapes/test_support.hpp"

using namespace graindrive;
using namespace graindrive::shapes;

namespace {

constexpr Real round_off = 1e-12;  // for lengths of order 10: the trimming tolerance and a few round-offs

Eigen::AlignedBox<Real, 2> box_of(const Points& centres, Real radius)
{
	Eigen::AlignedBox<Real, 2> box;
	for (const Vector2r& c : centres) box.extend(c);
	return { Vector2r(box.min() - Vector2r::Constant(radius)), Vector2r(box.max() + Vector2r::Constant(radius)) };
}

Real longest_step(const Points& centres)
{
	Real longest = 0;
	for (std::size_t i = 0; i < centres.size(); ++i)
		longest = std::max(longest, (centres[(i + 1) % centres.size()] - centres[i]).norm());
	return longest;
}

Real largest_gap(const Outline& outline, const Points& centres, Real radius)
{
	Real largest = 0;
	for (const Vector2r& v : outline.vertices()) {
		Real nearest = outline.extent();
		for (const Vector2r& c : centres) nearest = std::min(nearest, (c - v).norm() - radius);
		largest = std::max(largest, nearest);
	}
	return largest;
}

bool is_inside(const Outline& outline, const Vector2r& p)
{
	bool inside = false;
	const Points& v = outline.vertices();
	for (std::size_t i = 0, j = v.size() - 1; i < v.size(); j = i++)
		if ((v[i].y() > p.y()) != (v[j].y() > p.y()) &&
			p.x() < v[i].x() + (p.y() - v[i].y()) / (v[j].y() - v[i].y()) * (v[j].x() - v[i].x()))
			inside = !inside;
	return inside;
}

void expect_envelope(const Outline& outline, const Points& centres, Real radius)
{
	for (const Vector2r& c : centres) {
		EXPECT_TRUE(outline.is_disk() || is_inside(outline, c));
		EXPECT_GE(distance_to(outline, c), radius - round_off);
	}
}

}  // namespace

TEST(Beads, give_the_outer_sizes_of_the_built_in_shapes_exactly)
{
	for (const char* name : { "disk", "square", "tall", "wide" }) {
		const Outline outline = outline_of(name);
		const Vector2r beaded = box_of(beads(outline, 0.5), 0.25).sizes(), drawn = box_of(outline.vertices(), 0).sizes();
		EXPECT_NEAR(beaded.x(), drawn.x(), round_off) << name;
		EXPECT_NEAR(beaded.y(), drawn.y(), round_off) << name;
	}
	// Beads round off a corner of 60 degrees: the top bead ends R/sin 30 - R = R below the apex, the lower ones R (sqrt 3 - 1)
	// inside.
	const Vector2r triangle = box_of(beads(outline_of("triangle"), 0.5), 0.25).sizes();
	EXPECT_NEAR(triangle.y(), 9.5 * std::sqrt(3.0) / 2 - 0.25, round_off);
	EXPECT_NEAR(triangle.x(), 9.5 - 2 * 0.25 * (std::sqrt(3.0) - 1), round_off);
}

TEST(Beads, touch_the_outline_from_inside_at_steps_no_longer_than_asked)
{
	for (const std::string& name : shape_names())
		for (const Real spacing : { 1.0, 0.5, 0.21 }) {
			const Outline outline = outline_of(name, {}, 0.3);
			const Points centres = beads(outline, 0.5, spacing);
			expect_envelope(outline, centres, 0.25);
			for (const Vector2r& c : centres) EXPECT_NEAR(distance_to(outline, c), 0.25, round_off) << name;
			EXPECT_LE(longest_step(centres), spacing * 0.5 * (1 + 1e-8))
				<< name;  // a step may be longer by round-off, see `step_slack`
		}
}

TEST(Beads, are_as_few_as_the_steps_allow)
{
	EXPECT_EQ(beads(outline_of("square"), 0.5).size(), 48u);  // inset side 6 = 12 steps of 0.5
	EXPECT_EQ(beads(outline_of("square"), 0.5, 0.5).size(), 96u);
	EXPECT_EQ(beads(outline_of("disk"), 0.5).size(), 44u);  // circumference 2 pi 3.25 / 0.5 = 40.8, to a multiple of 4
	EXPECT_EQ(beads(Outline::disk(0.5), 0.5).size(), 1u);
}

TEST(Beads, roll_round_a_reflex_corner)
{
	const Outline l({ { 0, 0 }, { 8, 0 }, { 8, 4 }, { 4, 4 }, { 4, 8 }, { 0, 8 } });
	const Points centres = beads(l, 0.5, 0.25);
	expect_envelope(l, centres, 0.25);
	for (const Vector2r& c : centres)
		EXPECT_NEAR(distance_to(l, c), 0.25, round_off);  // at a sharp corner of the inset it would be 0.25 (sqrt 2 - 1) more
	EXPECT_LE(longest_step(centres), 0.125 * (1 + 1e-8));
}

TEST(Beads, follow_a_finely_drawn_curve_without_crowding)
{
	const Outline drawn(Outline::disk(7).vertices());
	const Points centres = beads(drawn, 0.5);
	EXPECT_NEAR(centres.size(), 41, 1);  // not one bead for each of the 360 corners
	expect_envelope(drawn, centres, 0.25);
	// Deepest cusp between touching beads: sqrt(R_b^2 + 2 R (R - R_b) (1 - cos a)) - R_b with sin a = R_b / (R - R_b).
	const Real r = 0.25, inner = 3.5 - r,
			   cusp = std::sqrt(r * r + 2 * 3.5 * inner * (1 - std::sqrt(1 - r * r / (inner * inner)))) - r;
	EXPECT_LE(largest_gap(drawn, centres, r), cusp * 1.01);  // the drawn polygon lies 4e-5 R inside its circle
}

TEST(Beads, stand_on_all_sides_of_a_curve_that_is_short_for_their_steps)
{
	const Outline drawn(Outline::disk(7).vertices());
	for (const Real bead : { 5.0, 6.2, 6.9 }) {
		const Points centres = beads(drawn, bead);
		ASSERT_GE(centres.size(), 4u) << bead;
		// Four beads on a circle of radius a leave gaps of sqrt(R^2 + a^2 - sqrt 2 R a) - R_b, R the disk's radius.
		const Real inner = 3.5 - bead / 2, gap = std::sqrt(3.5 * 3.5 + inner * inner - std::sqrt(2.0) * 3.5 * inner) - bead / 2;
		EXPECT_LE(largest_gap(drawn, centres, bead / 2), gap * 1.1);  // beads are not exactly evenly spaced on the drawn polygon
	}
}

TEST(Beads, stay_inside_random_stars_and_reach_their_corners)
{
	int made = 0;
	for (unsigned seed = 0; seed < 300; ++seed) {
		const Outline outline(star(seed));
		Points centres;
		const std::string refused = complaint([&] { centres = beads(outline, 0.3, 0.5); });
		EXPECT_TRUE(refused.empty() || mentions(refused, "too thin")) << seed << ": " << refused;
		expect_envelope(outline, centres, 0.15);
		if (!refused.empty()) continue;
		++made;
		EXPECT_LE(largest_gap(outline, centres, 0.15), 2 * 0.3) << seed;
	}
	EXPECT_GT(made, 200);  // most stars are thick enough
}

TEST(Beads, stay_inside_teeth_exactly_one_bead_wide)
{
	const Outline comb({ { 0, 0 }, { 5, 0 }, { 5, 3 }, { 4, 3 }, { 4, 2 }, { 3, 2 }, { 3, 3 }, { 2, 3 }, { 2, 2 }, { 1, 2 },
		{ 1, 3 }, { 0, 3 } });
	for (const Real bead : { 1.0, 0.5 }) expect_envelope(comb, beads(comb, bead, 0.5), bead / 2 * (1 - 1e-9));
}

TEST(Beads, refuse_shapes_that_are_too_thin_for_them)
{
	EXPECT_TRUE(mentions(complaint([] { beads(outline_of("wide", { 9, 0.4 }), 0.5); }), "not one bead fits"));
	EXPECT_TRUE(mentions(complaint([] { beads(outline_of("wide", { 9, 0.4 }), 10); }), "not one bead fits"));
	const Outline dumbbell({ { 0, 0 }, { 4, 0 }, { 4, 1.9 }, { 6, 1.9 }, { 6, 0 }, { 10, 0 }, { 10, 4 }, { 6, 4 }, { 6, 2.1 },
		{ 4, 2.1 }, { 4, 4 }, { 0, 4 } });
	EXPECT_TRUE(mentions(complaint([&] { beads(dumbbell, 0.5); }), "2 separate rings"));
	const Outline flag({ { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0.3, 4 }, { 0.3, 9 }, { 0, 9 } });
	const std::string pole = complaint([&] { beads(flag, 0.5); });
	EXPECT_TRUE(mentions(pole, "(0.3, 9)") || mentions(pole, "(0, 9)")) << pole;
	EXPECT_TRUE(mentions(complaint([] { beads(Outline::disk(0.4), 0.5); }), "must not exceed the outline's extent"));
}

TEST(Beads, refuse_sizes_and_spacings_out_of_range)
{
	const Outline square = outline_of("square");
	for (const Real bad : { 0.0, -0.5, std::nan("") }) {
		EXPECT_TRUE(mentions(complaint([&] { beads(square, bad); }), "bead diameter must be positive"));
		EXPECT_TRUE(mentions(complaint([&] { beads(square, 0.5, bad); }), "spacing must lie in (0, 1]"));
		EXPECT_TRUE(mentions(complaint([&] { clump_of(square, 0.5, bad); }), "mass must be positive"));
	}
	EXPECT_TRUE(mentions(complaint([&] { beads(square, 0.5, 1.01); }), "got 1.01"));
	EXPECT_TRUE(mentions(complaint([&] { beads(square, 0.5, 1e-12); }), "at most 1e5 beads"));
	EXPECT_TRUE(mentions(complaint([&] { beads(outline_of("disk"), 1e-9); }), "at most 1e5 beads"));
	for (const Real tiny : { 1e-300, 5e-324 }) {
		EXPECT_TRUE(mentions(complaint([&] { beads(square, tiny); }), "at most 1e5 beads"));
		EXPECT_TRUE(mentions(complaint([&] { beads(square, 0.5, tiny); }), "at most 1e5 beads"));
	}
	for (const Real huge : { 1e154, 1e308 })
		EXPECT_TRUE(mentions(complaint([&] { beads(square, huge); }), "must not exceed the outline's extent"));
	EXPECT_TRUE(mentions(complaint([&] { clump_of(square, 0.5, 5e-324); }), "moment of inertia"));
	EXPECT_TRUE(mentions(complaint([&] { clump_of(square, 0.5, 1.7e308); }), "moment of inertia"));
}

namespace {

Real rounded(Real value, int digits) { return std::round(value * std::pow(10, digits)) / std::pow(10, digits); }

/// A rotated square of side 6 with points between its corners, rounded to `digits` decimals as in a file.
Points littered_square(int points_per_side, int digits, const Vector2r& at)
{
	const Points corners = outline_of("square", { 6 }, 0.35).vertices();
	Points vertices;
	for (int i = 0; i < 4; ++i)
		for (int k = 0; k < points_per_side; ++k) {
			const Vector2r p = at + corners[i] + (corners[(i + 1) % 4] - corners[i]) * k / points_per_side;
			vertices.emplace_back(rounded(p.x(), digits), rounded(p.y(), digits));
		}
	return vertices;
}

void expect_touching(const Outline& outline, Real bead_diameter)
{
	for (const Vector2r& c : beads(outline, bead_diameter))
		EXPECT_NEAR(distance_to(outline, c), bead_diameter / 2, 1e-5 * bead_diameter / 2);  // the tolerance of `beads`
}

}  // namespace

TEST(Beads, of_a_square_do_not_feel_points_between_its_corners)
{
	for (const auto& [points, digits] : { std::pair{ 2, 6 }, { 3, 9 }, { 7, 6 }, { 50, 9 }, { 2, 12 } })
		for (const Vector2r& at : { Vector2r(0, 0), Vector2r(5e6, -3.5e6) }) {
			const Points clean = clump_of(outline_of("square", { 6 }, 0.35), 0.5, 1).beads;
			const Points found = clump_of(Outline(littered_square(points, digits, at)), 0.5, 1).beads;
			ASSERT_EQ(found.size(), clean.size()) << points << " points, " << digits << " digits";
			for (const Vector2r& bead : found) {
				Real nearest = 1;
				for (const Vector2r& other : clean) nearest = std::min(nearest, (bead - other).norm());
				// Rounding moves corners by 0.7e-6, coordinates of 5e6 are exact to 1e-9, and beads move by at most twice as much
				// as corners.
				EXPECT_LT(nearest, 3e-6 + 3e-9);
			}
		}
}

TEST(Beads, touch_an_outline_far_away_from_the_origin)
{
	for (const Real bead : { 1.0, 0.5 }) {
		expect_touching(Outline(littered_square(3, 9, { 5e6, -3.5e6 })), bead);
		expect_touching(Outline(littered_square(3, 9, { 0, 1e7 })), bead);
	}
}

TEST(Beads, touch_stars_with_thousands_of_vertices)
{
	for (const int corners : { 500, 5000 }) {
		Points star, circle;
		for (int i = 0; i < corners; ++i) {
			const Real angle = 2 * pi * i / corners;
			circle.emplace_back(3.5 * std::cos(angle), 3.5 * std::sin(angle));
			star.push_back(circle.back() * (i % 2 ? 1 : 0.93));
		}
		for (const Real bead : { 0.5, 2.0 }) {
			expect_touching(Outline(star), bead);
			expect_touching(Outline(circle), bead);
		}
	}
}

TEST(Beads, touch_where_the_inset_is_cut_by_edges_that_are_not_neighbours)
{
	// A groove narrower than the bead: beads touch the two corners of its opening and do not reach its bottom.
	const Outline groove({ { 0, 0 }, { 8, 0 }, { 8, 4 }, { 4.3, 4 }, { 4.3, 3 }, { 3.7, 3 }, { 3.7, 4 }, { 0, 4 } });
	expect_touching(groove, 1);
	expect_touching(groove, 0.5);
	// A short edge between two long ones that vanishes in the inset.
	expect_touching(Outline({ { 0, 0 }, { 8, 0 }, { 8, 3.9 }, { 7.9, 4 }, { 0.1, 4 }, { 0, 3.9 } }), 1);
}

TEST(Clump, has_the_solids_mass_and_inertia_about_its_centroid)
{
	const Outline off_centre = outline_of("square", { 4 }).seen_from({ -10, 3 });
	const Clump clump = clump_of(off_centre, 0.5, 12, 0.5);
	EXPECT_DOUBLE_EQ(clump.mass, 12);
	EXPECT_NEAR(clump.inertia, 12 * 16.0 / 6, round_off);
	EXPECT_NEAR(box_of(clump.beads, clump.bead_radius).center().norm(), 0, round_off);
}

TEST(Clump, stands_about_the_centroid_far_out_as_about_the_origin)
{
	const Points boot{ { 0, 0 }, { 9, 0 }, { 9, 3 }, { 4, 3 }, { 4, 10 }, { 0, 10 } };
	Points far;
	for (const Vector2r& v : boot) far.push_back(v + Vector2r(0x1p23, -0x3p21));  // sums without round-off
	const Clump here = clump_of(Outline(boot), 0.5, 7), there = clump_of(Outline(far), 0.5, 7);
	ASSERT_EQ(here.beads.size(), there.beads.size());
	EXPECT_NEAR(here.inertia, there.inertia, 1e-13 * here.inertia);
	for (std::size_t i = 0; i < here.beads.size(); ++i) EXPECT_LT((here.beads[i] - there.beads[i]).norm(), round_off);
	// The beads' lowest left point is that of the outline, (0, 0); the outline's centroid is (3.22727, 4.04545).
	const Vector2r lowest_left = box_of(here.beads, here.bead_radius).min();
	EXPECT_LT((lowest_left + Vector2r(355.0 / 110, 445.0 / 110)).norm(), round_off);
}
