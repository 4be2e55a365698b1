/// Parts of a line or an arc that are too close to an edge, compared with the distances of points along them.
#include "engines/shapes/stretch.hpp"

#include <gtest/gtest.h>

#include <random>

#include "engines/shapes/edge_index.hpp"

using namespace graindrive;
using namespace graindrive::shapes;

namespace {

bool holds(const std::optional<Interval>& found, Real place, Real circumference)
{
	if (!found) return false;
	for (const int turns : { -1, 0, 1 })
		if (place > found->begin + turns * circumference && place < found->end + turns * circumference) return true;
	return false;
}

}  // namespace

TEST(Stretch, is_forbidden_just_where_its_points_are_closer_than_the_reach)
{
	std::mt19937_64 random(1);
	const auto place = [&] { return Vector2r((random() >> 11) * 0x1p-51 - 2, (random() >> 11) * 0x1p-51 - 2); };
	int forbidden = 0;
	for (int trial = 0; trial < 20000; ++trial) {
		const Vector2r a = place(), b = place();
		const Vector2r out = left_of(place()), back = left_of(place());
		const Stretch stretch = trial % 2              ? straight(place(), place())
		                        : cross(out, back) < 0 ? arc(out, back, Vector2r::Zero())
		                                               : arc(back, out, Vector2r::Zero());
		const auto found = closer_than(1, stretch, a, b);
		for (int k = 0; k <= 10; ++k) {
			const Real along = stretch.length * k / 10, off = distance_to_segment(stretch.at(along), a, b) - 1;
			if (std::abs(off) < 1e-9) continue;  // within round-off of the limit both results are right
			ASSERT_EQ(holds(found, along, 2 * pi * stretch.radius), off < 0) << trial << " at " << k;
			forbidden += off < 0;
		}
	}
	EXPECT_GT(forbidden, 20000);  // both results occur
	EXPECT_LT(forbidden, 200000);
}

TEST(Stretch, is_cut_by_holes)
{
	const std::vector<Interval> cut = without(without({ { 0, 10 } }, { 2, 3 }), { 8, 12 });
	ASSERT_EQ(cut.size(), 2u);
	EXPECT_EQ(cut[0].begin, 0);
	EXPECT_EQ(cut[0].end, 2);
	EXPECT_EQ(cut[1].begin, 3);
	EXPECT_EQ(cut[1].end, 8);
	EXPECT_TRUE(without(cut, { -1, 11 }).empty());
	EXPECT_EQ(without(cut, { 20, 21 }).size(), 2u);
}
