/// Random packings have no overlaps (checked by brute force), the same bits for one seed, a uniform distribution, and an error
/// for a full box.
#include "engines/packing/random_insertion.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "engines/base/complaint.hpp"
#include "engines/packing/random.hpp"

using namespace graindrive;
using namespace graindrive::packing;

namespace {

constexpr Real not_a_number = std::numeric_limits<Real>::quiet_NaN();

/// The deepest overlap by comparing all pairs, without a cell grid.
Real deepest_by_brute_force(const Box<2>& box, const Points<2>& centres, const std::vector<Real>& radii)
{
	Real deepest = 0;
	for (std::size_t i = 0; i < radii.size(); ++i)
		for (std::size_t j = 0; j < i; ++j)
			for (const Real image : { -1.0, 0.0, 1.0 }) {
				if (image != 0 && !box.periodic[0]) continue;
				const Vector2r way = centres[i] - centres[j] + Vector2r(image * box.side(0), 0);
				deepest = std::max(deepest, (radii[i] + radii[j] - way.norm()) / std::min(radii[i], radii[j]));
			}
	return deepest;
}

Points<2> random_points(const Box<2>& box, std::size_t n, std::uint64_t seed)
{
	Uniform random(seed, 9);
	Points<2> points(n);
	for (Vector2r& p : points) p.x() = random(box.low[0], box.high[0]), p.y() = random(box.low[1], box.high[1]);
	return points;
}

}  // namespace

TEST(RandomInsertion, leaves_no_overlaps_and_keeps_disks_inside)
{
	for (const bool periodic : { true, false })
		for (const Real width : { 2.3, 5.0, 40.0 }) {  // one, two and many columns of cells
			const Box<2> box = rectangle(-3, width - 3, 10, 35, periodic);
			const auto radii = uniform_radii(static_cast<std::size_t>(0.3 * width * 25), 0.9, 1.1, 7);
			const Points<2> centres = random_insertion<2>(box, radii, {}, 7);
			EXPECT_EQ(deepest_by_brute_force(box, centres, radii), 0) << periodic << width;
			for (std::size_t i = 0; i < radii.size(); ++i) {
				const Real margin = periodic ? 0 : radii[i] - 1e-14;  // the round-off of box sides of order 10
				EXPECT_TRUE(centres[i].x() >= box.low[0] + margin && centres[i].x() <= box.high[0] - margin);
				EXPECT_TRUE(centres[i].y() >= box.low[1] + radii[i] - 1e-14 && centres[i].y() <= box.high[1] - radii[i] + 1e-14);
			}
		}
}

TEST(RandomInsertion, keeps_clear_of_obstacles_across_the_periodic_side_and_outside_the_box)
{
	const Box<2> box = rectangle(0, 30, 0, 20, true);
	Obstacles<2> obstacles{ { { 29, 10 }, { 5, -2 } }, { 2.5, 3.0 } };
	for (int i = 0; i < 30; ++i) obstacles.centres.emplace_back(i + 0.5, 20), obstacles.radii.push_back(0.5);
	auto radii = uniform_radii(250, 0.9, 1.1, 3);
	Points<2> centres = random_insertion<2>(box, radii, obstacles, 3);
	for (std::size_t i = 0; i < radii.size(); ++i)
		for (std::size_t k = 0; k < obstacles.radii.size(); ++k)
			EXPECT_GE(box.between(centres[i], obstacles.centres[k]).norm(), (radii[i] + obstacles.radii[k]) * (1 - 1e-15));
}

TEST(RandomInsertion, is_the_same_for_a_seed_and_pinned_for_every_machine)
{
	const Box<2> box = rectangle(0, 20, 0, 20, true);
	const auto radii = uniform_radii(100, 0.9, 1.1, 42);
	const Points<2> centres = random_insertion<2>(box, radii, {}, 42);
	EXPECT_EQ(centres, random_insertion<2>(box, uniform_radii(100, 0.9, 1.1, 42), {}, 42));
	EXPECT_NE(centres, random_insertion<2>(box, radii, {}, 43));
	EXPECT_NE(radii, uniform_radii(100, 0.9, 1.1, 43));
	// The digits are exact: if they change, every bed made from a seed changes.
	EXPECT_EQ(radii[0], 0.46396720037641176);
	EXPECT_EQ(centres[99].x(), 18.955577469099303);
	EXPECT_EQ(centres[99].y(), 8.254182969892927);
}

TEST(RandomInsertion, fills_the_box_evenly)
{
	// Chi-square over 8 x 8 parts; hard disks at area fraction 0.3 vary less than Poisson points, for which chi-square is
	// 63 +- 11.
	const Box<2> box = rectangle(0, 80, 0, 80, true);
	const auto radii = uniform_radii(2400, 0.9, 1.1, 5);
	std::vector<int> count(64, 0);
	for (const Vector2r& c : random_insertion<2>(box, radii, {}, 5))
		++count[static_cast<int>(c.y() / 10) * 8 + static_cast<int>(c.x() / 10)];
	Real chi_square = 0;
	for (const int n : count) chi_square += (n - 37.5) * (n - 37.5) / 37.5;
	EXPECT_LT(chi_square, 63 + 3 * 11);
}

TEST(RandomInsertion, says_what_was_reached_when_the_box_is_full)
{
	// Random insertion jams at an area fraction of 0.547, so 0.7 cannot be reached.
	const std::string message =
		complaint([] { random_insertion<2>(rectangle(0, 20, 0, 20, true), uniform_radii(360, 0.9, 1.1, 1), {}, 1, 2000); });
	EXPECT_TRUE(mentions(message, "2000 random trials") && mentions(message, "of 360 were placed (area fraction 0.5")) << message;
}

TEST(RandomInsertion, refuses_bad_input)
{
	const Box<2> box = rectangle(0, 10, 0, 10, true);
	EXPECT_TRUE(mentions(complaint([] { random_insertion<2>(rectangle(0, 0, 0, 10, true), { 1 }, {}, 1); }), "x_min < x_max"));
	EXPECT_TRUE(
		mentions(complaint([] { random_insertion<2>(rectangle(0, not_a_number, 0, 10, true), { 1 }, {}, 1); }), "finite sides"));
	EXPECT_TRUE(mentions(complaint([&] { random_insertion<2>(box, { 1, -1 }, {}, 1); }), "got -1 for disk 1"));
	EXPECT_TRUE(mentions(complaint([&] {
		random_insertion<2>(box, { 1 }, { { { not_a_number, 0 } }, { 1 } }, 1);
	}),
		"obstacle 0"));
	EXPECT_TRUE(mentions(complaint([&] { random_insertion<2>(box, { 1 }, { {}, { 1 } }, 1); }), "one centre per radius"));
	EXPECT_TRUE(mentions(complaint([&] { random_insertion<2>(box, { 5.1 }, {}, 1); }), "must hold the largest disk"));
	EXPECT_TRUE(mentions(complaint([&] { random_insertion<2>(box, { 1 }, {}, 1, 0); }), "at least 1, got 0"));
	EXPECT_TRUE(mentions(complaint([] { uniform_radii(3, 1.1, 0.9, 1); }), "0 < d_min <= d_max, got 1.1 and 0.9"));
	EXPECT_TRUE(random_insertion<2>(box, {}, {}, 1).empty());
}

TEST(UniformRadii, have_the_mean_and_spread_of_a_uniform_distribution)
{
	const std::size_t n = 100'000;
	Real sum = 0, squares = 0;
	for (const Real radius : uniform_radii(n, 0.9, 1.1, 11)) {
		EXPECT_TRUE(radius >= 0.45 && radius <= 0.55);
		sum += 2 * radius - 1;
		squares += (2 * radius - 1) * (2 * radius - 1);
	}
	const Real spread = 0.2 / std::sqrt(12.0);
	EXPECT_NEAR(sum / n, 0, 4 * spread / std::sqrt(n));                                   // four standard errors of the mean
	EXPECT_NEAR(squares / n, spread * spread, 4 * spread * spread * std::sqrt(0.8 / n));  // kurtosis 1.8
}

TEST(Overlaps, agree_with_brute_force)
{
	for (std::uint64_t seed = 0; seed < 40; ++seed) {
		const Box<2> box = rectangle(1, 1 + 2.2 * (1 + seed % 8), -5, 5, seed % 2 == 0);
		const auto radii = uniform_radii(5 + seed, 0.2, 1.8, seed);
		const Points<2> centres = random_points(box, radii.size(), seed);
		const Overlap deepest = overlaps<2>(box, centres, radii);
		EXPECT_DOUBLE_EQ(deepest.relative, deepest_by_brute_force(box, centres, radii)) << seed;
	}
}

TEST(Overlaps, name_the_pair)
{
	const Box<2> box = rectangle(0, 10, 0, 10, true);
	const Overlap across = overlaps<2>(box, { { 0.2, 5 }, { 5, 5 }, { 9.6, 5 } }, { 0.5, 1, 0.4 });
	EXPECT_TRUE(across.found);
	EXPECT_NEAR(across.relative, (0.9 - 0.6) / 0.4, 1e-14);
	EXPECT_EQ(across.first, 0u);
	EXPECT_EQ(across.second, 2u);
	EXPECT_FALSE(overlaps<2>(box, { { 1, 1 }, { 2, 1 } }, { 0.5, 0.5 }).found) << "touching is not overlapping";
	EXPECT_TRUE(mentions(complaint([&] { overlaps<2>(box, { { 1, 1 } }, { 1, 2 }); }), "got 2 radii and 1 centres"));
}
