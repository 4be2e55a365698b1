/// Shapes that a user defines, and rigid motion.
#include "engines/geometry/section.hpp"
#include "engines/geometry/surface.hpp"

#include "engines/geometry/rigid_motion.hpp"
#include "engines/geometry/solids.hpp"
#include "engines/geometry/test_support.hpp"

namespace graindrive::geometry {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A torus about z: points within r of a circle of radius R. It shows all that a user's shape has to define.
class Torus : public Surface<3> {
public:
	Torus(double ring, double thickness) : ring_(ring), thickness_(thickness) {}
	Nearest<3> nearest(const Vec<3>& at) const override
	{
		const Vec<3> core = ring_ * unit(Vec<3>{ at[0], at[1], 0 });  // the nearest point of the circle
		return { norm(at - core) - thickness_, unit(at - core) };
	}
	Bounds<3> bounds() const override
	{
		const Vec<3> reach{ ring_ + thickness_, ring_ + thickness_, thickness_ };
		return { -reach, reach };
	}

private:
	double ring_, thickness_;
};

TEST(Surface, AShapeOfOnesOwnIsAShortClass)
{
	const Torus torus(2, 0.5);
	EXPECT_EQ(torus.nearest({ 3, 0, 0 }).distance, 0.5);
	EXPECT_EQ(torus.nearest({ 2, 0, 0.25 }).distance, -0.25);
	EXPECT_GT(expect_distance(torus, 3), 0.9);
}

TEST(MovingSurface, IsSeenFromTheWorldAsFromItsFrame)
{
	MovingSurface<3> ring{ shared(Torus(2, 0.5)), {} };
	ring.motion.place = { 10, 20, 30 };
	ring.motion.turn = Turn<3>::about({ 1, 0, 0 }, pi / 2);  // its axis is now -y
	ring.check();
	EXPECT_DOUBLE_EQ(ring.nearest({ 10, 20, 33 }).distance, 0.5);
	EXPECT_NEAR(ring.nearest({ 10, 20, 33 }).normal[2], 1, 1e-15);
	EXPECT_NEAR(ring.nearest({ 12, 21, 30 }).distance, 0.5, 1e-14);
	EXPECT_NEAR(ring.bounds().high[1], 20.5, 1e-14);
	EXPECT_NEAR(ring.bounds().low[2], 27.5, 1e-14);
	const Placed<3> placed(ring.shape, ring.motion.place, ring.motion.turn);
	EXPECT_GT(expect_distance(placed, 3, ring.motion.place), 0.9);
}

TEST(MovingSurface, InTwoDimensionsIsTheSectionOfTheThirdWithItsAxis)
{
	MovingSurface<2> line{ shared(HalfSpace<2>({ 1, 0 }, { 1, 0 })), { { 5, 6 }, { 0.3 }, { 1, 2 }, 4 } };
	MovingSurface<3> plane{ shared(HalfSpace<3>({ 1, 0, 0 }, { 1, 0, 0 })),
		{ { 5, 6, 9 }, Turn<3>::about({ 0, 0, 1 }, 0.3), { 1, 2, 0 }, { 0, 0, 4 } } };
	for (int step = 0; step < 5; ++step) {
		const Nearest<2> flat = line.nearest({ 7, 8 });
		const Nearest<3> deep = plane.nearest({ 7, 8, -1 });
		EXPECT_NEAR(flat.distance, deep.distance, 1e-13);
		EXPECT_NEAR(flat.normal[1], deep.normal[1], 1e-13);
		EXPECT_NEAR(line.velocity_at({ 7, 8 })[0], plane.velocity_at({ 7, 8, -1 })[0], 1e-13);
		line.advance(0.1);
		plane.advance(0.1);
	}
}

TEST(MovingSurface, VelocityIsThatOfItsMaterial)
{
	RigidMotion<3> motion{ { 1, 2, 3 }, Turn<3>::by({ 0.3, 0.4, -1 }), { 5, -6, 7 }, { 0.5, 0.2, -0.9 } };
	const Vec<3> mark{ 0.3, -0.8, 0.4 };
	const double h = 1e-6;
	RigidMotion<3> ahead = motion, behind = motion;
	ahead.advance(h);
	behind.advance(-h);
	const Vec<3> difference = (ahead.to_world(mark) - behind.to_world(mark)) / (2 * h);
	EXPECT_LT(norm(difference - motion.velocity_at(motion.to_world(mark))), 1e-8);  // round-off of 10 over the step
	EXPECT_LT(norm(motion.to_frame(motion.to_world(mark)) - mark), 1e-14);
}

TEST(MovingSurface, KeepsInfiniteSidesWhereTheyAre)
{
	const MovingSurface<3> pipe{ shared(Cylinder({}, { 0, 0, 1 }, 2)), { {}, Turn<3>::about({ 0, 1, 0 }, pi / 2), {}, {} } };
	EXPECT_EQ(pipe.bounds().high[0], std::numeric_limits<double>::infinity());
	EXPECT_NEAR(pipe.bounds().high[1], 2, 1e-15);
	EXPECT_NEAR(pipe.bounds().low[2], -2, 1e-15);
}

TEST(Section, of_a_cylinder_along_z_is_a_disk_and_of_a_ball_nothing)
{
	const Section disk(shared(Cylinder({ 1, 2, 0 }, { 0, 0, 1 }, 0.5)));
	const Nearest<2> found = disk.nearest({ 1, 4 });
	EXPECT_NEAR(found.distance, 1.5, 1e-15);
	EXPECT_NEAR(found.normal[1], 1, 1e-15);
	EXPECT_EQ(disk.bounds().high[0], 1.5);
	const Section of_ball(shared(Ball<3>({ 0, 0, 0.1 }, 1)));
	EXPECT_THROW(of_ball.nearest({ 0.5, 0 }), std::invalid_argument);
}

TEST(MovingSurface, RefusesWhatIsNotThere)
{
	EXPECT_TRUE(mentions(complaint([] { MovingSurface<2>{}.check(); }), "needs a shape, got none; give one"));
	EXPECT_TRUE(mentions(complaint([] { Placed<3>(nullptr, {}); }), "needs a shape"));
	MovingSurface<3> surface{ shared(Ball<3>({}, 1)), {} };
	surface.motion.place[1] = std::nan("");
	EXPECT_TRUE(mentions(complaint([&] { surface.check(); }), "place must be finite numbers, got (0, nan, 0)"));
	surface.motion = {};
	surface.motion.spin[2] = INFINITY;
	EXPECT_TRUE(mentions(complaint([&] { surface.check(); }), "spin must be finite, got (0, 0, inf)"));
}

}  // namespace
}  // namespace graindrive::geometry
