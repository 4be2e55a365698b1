/// Half-spaces, balls and cylinders: closed forms, edges, far places and odd units.
#include "engines/geometry/solids.hpp"

#include "engines/geometry/test_support.hpp"

namespace graindrive::geometry {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

TEST(HalfSpace, IsAsFarAsItsPlane)
{
	const HalfSpace<3> slope({ 1, 2, 3 }, { 0, 3, 4 });
	EXPECT_DOUBLE_EQ(slope.nearest({ 9, 2, 8 }).distance, 4);
	EXPECT_DOUBLE_EQ(slope.nearest({ 9, 2, -2 }).distance, -4);
	EXPECT_DOUBLE_EQ(slope.nearest({}).normal[2], 0.8);
	const HalfSpace<2> line({ 0, 1 }, { 0, -2 });
	EXPECT_EQ(line.nearest({ 5, 3 }).distance, -2);
	EXPECT_EQ(line.bounds().low[1], 1);
	EXPECT_EQ(line.bounds().high[1], inf);
	EXPECT_EQ(slope.bounds().low[1], -inf);
}

TEST(Ball, IsAsFarAsItsCentreLessTheRadius)
{
	const Ball<3> ball({ 1, 2, 3 }, 2);
	EXPECT_DOUBLE_EQ(ball.nearest({ 3, 5, 9 }).distance, 5);
	EXPECT_DOUBLE_EQ(ball.nearest({ 3, 5, 9 }).normal[2], 6.0 / 7);
	EXPECT_EQ(ball.nearest({ 1, 2, 3 }).distance, -2);
	EXPECT_EQ(norm(ball.nearest({ 1, 2, 3 }).normal), 1);
	EXPECT_DOUBLE_EQ(Ball<2>({ 0, 0 }, 1).nearest({ 3, -4 }).distance, 4);
	EXPECT_EQ(ball.bounds().low[0], -1);
	EXPECT_EQ(ball.bounds().high[2], 5);
}

TEST(Cylinder, WithoutEndsKnowsOnlyTheDistanceFromItsAxis)
{
	const Cylinder cylinder({ 1, 1, 1 }, { 2, -1, 2 }, 1.5);
	const Vec<3> axis = Vec<3>{ 2, -1, 2 } / 3, across = unit(Vec<3>{ 1, 2, 0 });
	for (const double along : { -1e3, 0.0, 7.0 }) {
		const Nearest<3> found = cylinder.nearest(Vec<3>{ 1, 1, 1 } + along * axis + 4 * across);
		EXPECT_NEAR(found.distance, 2.5, 1e-12);
		EXPECT_LT(norm(found.normal - across), 1e-12);
	}
	EXPECT_EQ(cylinder.bounds().low[0], -inf);
	const Cylinder upright({ 1, 2, 3 }, { 0, 0, -7 }, 0.5);
	EXPECT_EQ(upright.bounds().high[0], 1.5);
	EXPECT_EQ(upright.bounds().high[2], inf);
	EXPECT_EQ(upright.nearest({ 1, 2, 88 }).distance, -0.5);
	EXPECT_DOUBLE_EQ(norm(upright.nearest({ 1, 2, 88 }).normal), 1);
}

TEST(Cylinder, WithEndsHasAnEdge)
{
	const Cylinder pill_box({ 0, 0, 10 }, { 0, 0, 1 }, 3, 4);
	EXPECT_EQ(pill_box.nearest({ 4, 0, 10 }).distance, 1);
	EXPECT_EQ(pill_box.nearest({ 1, 0, 15 }).distance, 3);
	EXPECT_EQ(pill_box.nearest({ 1, 0, 15 }).normal[2], 1);
	EXPECT_EQ(pill_box.nearest({ 0, 6, 16 }).distance, 5);  // 3 and 4 off the edge
	EXPECT_DOUBLE_EQ(pill_box.nearest({ 0, 6, 16 }).normal[1], 0.6);
	EXPECT_EQ(pill_box.nearest({ 0.5, 0, 8.25 }).distance, -0.25);
	EXPECT_EQ(pill_box.nearest({ 0.5, 0, 8.25 }).normal[2], -1);
	const Cylinder oblique({ 0, 0, 0 }, { 3, 0, 4 }, 1, 10);
	EXPECT_DOUBLE_EQ(oblique.bounds().high[0], 5 * 0.6 + 0.8);  // end's middle and the disk's reach
	EXPECT_DOUBLE_EQ(oblique.bounds().high[1], 1);
	EXPECT_DOUBLE_EQ(oblique.bounds().low[2], -(5 * 0.8 + 0.6));
}

TEST(Solids, AreDistanceFields)
{
	EXPECT_EQ(expect_distance(HalfSpace<2>({ 0.2, 0.1 }, { 1, 2 }), 1), 1);
	EXPECT_EQ(expect_distance(HalfSpace<3>({ 0.2, 0.1, 0 }, { 1, 2, -1 }), 1), 1);
	EXPECT_GT(expect_distance(Ball<2>({ 0.2, 0.1 }, 0.7), 1), 0.9);
	EXPECT_GT(expect_distance(Ball<3>({ 0.2, 0.1, 0 }, 0.7), 1), 0.9);
	EXPECT_GT(expect_distance(Cylinder({ 0.2, 0.1, 0 }, { 1, 2, -1 }, 0.4), 1), 0.9);
	EXPECT_GT(expect_distance(Cylinder({ 0.2, 0.1, 0 }, { 1, 2, -1 }, 0.4, 0.9), 1), 0.9);
}

TEST(Solids, AreTheSameFarAwayAndInMicrometres)
{
	for (const double unit : { 1e-6, 1e6 }) {
		EXPECT_GT(expect_distance(Cylinder({ 0.2 * unit, 0.1 * unit, 0 }, { 1, 2, -1 }, 0.4 * unit, 0.9 * unit), unit), 0.9);
		EXPECT_GT(expect_distance(Ball<3>({ 0.2 * unit, 0.1 * unit, 0 }, 0.4 * unit), unit), 0.9);
	}
	const Vec<3> far{ 1e6, -3e6, 2e6 };
	EXPECT_GT(expect_distance(Cylinder(far, { 1, 2, -1 }, 0.4, 0.9), 1, far), 0.9);
	const Vec<3> near_edge{ 0.3, 0.25, -0.5 };
	EXPECT_NEAR(Cylinder(far, { 1, 2, -1 }, 0.4, 0.9).nearest(far + near_edge).distance,
		Cylinder({}, { 1, 2, -1 }, 0.4, 0.9).nearest(near_edge).distance, 1e-9);  // coordinates hold 5e-10
}

TEST(Solids, RefuseWhatIsNone)
{
	EXPECT_TRUE(mentions(complaint([] {
		HalfSpace<2>({ 0, 0 }, { 0, 0 });
	}),
		"half-space normal must not be zero, got (0, 0); give a direction"));
	EXPECT_TRUE(mentions(complaint([] { HalfSpace<3>({ 0, inf, 0 }, { 0, 0, 1 }); }), "half-space point must be finite"));
	EXPECT_TRUE(mentions(complaint([] { Ball<2>({ 0, 0 }, 0); }), "ball radius must be positive and finite, got 0; give"));
	EXPECT_TRUE(mentions(complaint([] { Ball<3>({ 0, 0, std::nan("") }, 1); }), "got (0, 0, nan)"));
	EXPECT_TRUE(mentions(complaint([] { Cylinder({ 0, 0, 0 }, { 0, 0, 0 }, 1); }), "cylinder axis must not be zero"));
	EXPECT_TRUE(mentions(complaint([] { Cylinder({ 0, 0, 0 }, { 0, 0, 1 }, -1); }), "cylinder radius must be positive"));
	EXPECT_TRUE(mentions(complaint([] { Cylinder({ 0, 0, 0 }, { 0, 0, 1 }, 1, 0); }), "got 0; give a length > 0, or Cylinder"));
	EXPECT_TRUE(mentions(complaint([] { Cylinder({ 0, 0, 0 }, { 0, 0, 1 }, 1, std::nan("")); }), "got nan"));
}

}  // namespace
}  // namespace graindrive::geometry
