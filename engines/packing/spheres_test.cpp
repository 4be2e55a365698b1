/// Random packings of spheres have no overlaps (checked by brute force), keep out of given solids, have the same bits for one
/// seed, and are uniform.
#include <gtest/gtest.h>

#include <limits>

#include "engines/base/complaint.hpp"
#include "engines/packing/random.hpp"
#include "engines/packing/random_insertion.hpp"

using namespace graindrive;
using namespace graindrive::packing;

namespace {

/// The deepest overlap by comparing all pairs and images, without a cell grid.
Real deepest_by_brute_force(const Box<3>& box, const Points<3>& centres, const std::vector<Real>& radii)
{
	Real deepest = 0;
	for (std::size_t i = 0; i < radii.size(); ++i)
		for (std::size_t j = 0; j < i; ++j)
			for (int image = 0; image < 27; ++image) {
				const std::array<int, 3> n{ image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1 };
				Point<3> way = centres[i] - centres[j];
				bool there = true;
				for (int k = 0; k < 3; ++k) {
					there = there && (n[k] == 0 || box.periodic[k]);
					way[k] += n[k] * box.side(k);
				}
				if (there) deepest = std::max(deepest, (radii[i] + radii[j] - way.norm()) / std::min(radii[i], radii[j]));
			}
	return deepest;
}

Points<3> random_points(const Box<3>& box, std::size_t n, std::uint64_t seed)
{
	Uniform random(seed, 9);
	Points<3> points(n);
	for (Point<3>& p : points)
		for (int k = 0; k < 3; ++k) p[k] = random(box.low[k], box.high[k]);
	return points;
}

/// All eight ways of repeating along three axes.
std::array<bool, 3> axes(int which) { return { (which & 1) != 0, (which & 2) != 0, (which & 4) != 0 }; }

}  // namespace

TEST(InsertionInSpace, leaves_no_overlaps_and_keeps_spheres_inside)
{
	for (int which = 0; which < 8; ++which)
		for (const Real width : { 1.2, 2.3, 3.5, 12.0 }) {  // one, two, three and many cells along x
			const Box<3> box{ { -3, 10, 0 }, { width - 3, 15, 4.7 }, axes(which) };
			const auto radii = uniform_radii(static_cast<std::size_t>(0.3 * box.extent()), 0.9, 1.1, 7);
			const Points<3> centres = random_insertion<3>(box, radii, {}, 7);
			EXPECT_EQ(deepest_by_brute_force(box, centres, radii), 0) << which << " " << width;
			for (std::size_t i = 0; i < radii.size(); ++i)
				for (int k = 0; k < 3; ++k) {
					const Real margin = box.periodic[k] ? 0 : radii[i] - 1e-14;  // the round-off of box sides of order 10
					EXPECT_GE(centres[i][k], box.low[k] + margin);
					EXPECT_LE(centres[i][k], box.high[k] - margin);
				}
		}
}

TEST(InsertionInSpace, keeps_clear_of_obstacles_across_periodic_sides_and_outside_the_box)
{
	const Box<3> box{ { 0, 0, 0 }, { 8, 8, 6 }, { true, true, false } };
	const Obstacles<3> obstacles{ { { 7.5, 0.3, 3 }, { 4, 4, -1 } }, { 1.5, 2.5 } };
	const auto radii = uniform_radii(150, 0.9, 1.1, 3);
	const Points<3> centres = random_insertion<3>(box, radii, obstacles, 3);
	for (std::size_t i = 0; i < radii.size(); ++i)
		for (std::size_t k = 0; k < obstacles.radii.size(); ++k)
			EXPECT_GE(box.between(centres[i], obstacles.centres[k]).norm(), (radii[i] + obstacles.radii[k]) * (1 - 1e-15));
}

TEST(InsertionInSpace, keeps_spheres_whole_outside_of_what_is_kept_out)
{
	// Spheres must stay outside a vertical cylinder of radius 2 and inside a ball that touches the box's sides.
	const Box<3> box{ { -5, -5, -5 }, { 5, 5, 5 }, { false, false, false } };
	const KeepOut<3> cylinder = [](const Point<3>& x) { return std::hypot(x[0], x[1]) - 2; };
	const KeepOut<3> around_ball = [](const Point<3>& x) { return 5 - x.norm(); };
	const auto radii = uniform_radii(180, 0.9, 1.1, 4);
	for (const KeepOut<3>& solid : { cylinder, around_ball }) {
		const Points<3> centres = random_insertion<3>(box, radii, {}, 4, 100'000, solid);
		Real nearest = 10;
		for (std::size_t i = 0; i < radii.size(); ++i) {
			EXPECT_GE(solid(centres[i]), radii[i]);
			nearest = std::min(nearest, solid(centres[i]) - radii[i]);
		}
		EXPECT_LT(nearest, 0.05) << "the room beside it is used";
		EXPECT_EQ(deepest_by_brute_force(box, centres, radii), 0);
	}
}

TEST(InsertionInSpace, a_solid_asked_as_distance_or_as_obstacle_gives_the_same_packing)
{
	const Box<3> box{ { 0, 0, 0 }, { 6, 6, 6 }, { false, false, false } };
	const auto radii = uniform_radii(80, 0.9, 1.1, 8);
	const Point<3> middle(3, 3, 3);
	const KeepOut<3> ball = [&](const Point<3>& x) { return (x - middle).norm() - 1.5; };
	EXPECT_EQ(random_insertion<3>(box, radii, {}, 8, 100'000, ball), random_insertion<3>(box, radii, { { middle }, { 1.5 } }, 8));
}

TEST(InsertionInSpace, is_the_same_for_a_seed_and_pinned_for_every_machine)
{
	const Box<3> box{ { 0, 0, 0 }, { 8, 8, 8 }, { true, true, false } };
	const auto radii = uniform_radii(100, 0.9, 1.1, 42);
	const Points<3> centres = random_insertion<3>(box, radii, {}, 42);
	EXPECT_EQ(centres, random_insertion<3>(box, radii, {}, 42));
	EXPECT_NE(centres, random_insertion<3>(box, radii, {}, 43));
	// The digits are exact: if they change, every bed made from a seed changes.
	EXPECT_EQ(centres[99], Point<3>(6.4527909836262749, 6.021194705124314, 2.7940863835783909));
}

TEST(InsertionInSpace, fills_the_box_evenly)
{
	// Chi-square over 4 x 4 x 4 parts; hard spheres at 0.2 vary less than Poisson points, for which chi-square is 63 +- 11.
	const Box<3> box{ { 0, 0, 0 }, { 20, 20, 20 }, { true, true, true } };
	const std::vector<Real> radii(3200, 0.5);
	std::vector<int> count(64, 0);
	for (const Point<3>& c : random_insertion<3>(box, radii, {}, 5))
		++count[16 * static_cast<int>(c[2] / 5) + 4 * static_cast<int>(c[1] / 5) + static_cast<int>(c[0] / 5)];
	Real chi_square = 0;
	for (const int n : count) chi_square += (n - 50.0) * (n - 50.0) / 50.0;
	EXPECT_LT(chi_square, 63 + 3 * 11);
	EXPECT_GT(chi_square, 5) << "a lattice would have 0";
}

TEST(InsertionInSpace, says_what_was_reached_when_the_box_is_full)
{
	// Random insertion jams at a solid fraction of 0.384, so 0.5 cannot be reached.
	const Box<3> box{ { 0, 0, 0 }, { 8, 8, 8 }, { true, true, true } };
	const std::string message = complaint([&] { random_insertion<3>(box, std::vector<Real>(489, 0.5), {}, 1, 2000); });
	EXPECT_TRUE(mentions(message, "spheres must find a free place in 2000 random trials")) << message;
	EXPECT_TRUE(mentions(message, "of 489 were placed (volume fraction 0.3")) << message;
	const std::string nowhere =
		complaint([&] { random_insertion<3>(box, { 0.5 }, {}, 1, 10, [](const Point<3>&) { return -1; }); });
	EXPECT_TRUE(mentions(nowhere, "0 of 1 were placed")) << nowhere;
}

TEST(InsertionInSpace, refuses_bad_input)
{
	const Real not_a_number = std::numeric_limits<Real>::quiet_NaN();
	const Box<3> box{ { 0, 0, 0 }, { 10, 10, 2 }, { true, true, true } }, flat{ { 0, 0, 1 }, { 9, 9, 1 }, {} };
	EXPECT_TRUE(mentions(complaint([&] { random_insertion<3>(flat, { 1 }, {}, 1); }), "y_min < y_max and z_min < z_max"));
	EXPECT_TRUE(mentions(complaint([&] { random_insertion<3>(box, { 1, -1 }, {}, 1); }), "got -1 for sphere 1"));
	EXPECT_TRUE(mentions(complaint([&] { random_insertion<3>(box, { 1.1 }, {}, 1); }), "for a box of 10 x 10 x 2; enlarge"));
	const KeepOut<3> unknown = [&](const Point<3>&) { return not_a_number; };
	EXPECT_TRUE(
		mentions(complaint([&] { random_insertion<3>(box, { 1 }, {}, 1, 9, unknown); }), "keep_out must give a distance"));
}

TEST(OverlapsInSpace, agree_with_brute_force)
{
	for (std::uint64_t seed = 0; seed < 40; ++seed) {
		const Box<3> box{ { 1, -2, 0 }, { 1 + 2.2 * (1 + seed % 8), 2, 4 }, axes(seed % 8) };
		const auto radii = uniform_radii(5 + seed, 0.2, 1.8, seed);
		const Points<3> centres = random_points(box, radii.size(), seed);
		EXPECT_DOUBLE_EQ(overlaps<3>(box, centres, radii).relative, deepest_by_brute_force(box, centres, radii)) << seed;
	}
}

TEST(OverlapsInSpace, name_the_pair_across_a_corner)
{
	const Box<3> box{ { 0, 0, 0 }, { 10, 10, 10 }, { true, true, true } };
	const Overlap across = overlaps<3>(box, { { 0.2, 0.1, 0.2 }, { 5, 5, 5 }, { 9.9, 9.9, 9.9 } }, { 0.5, 1, 0.4 });
	EXPECT_TRUE(across.found);
	EXPECT_NEAR(across.relative, (0.9 - std::sqrt(0.09 + 0.04 + 0.09)) / 0.4, 1e-13);
	EXPECT_EQ(across.first, 0u);
	EXPECT_EQ(across.second, 2u);
}
