/// Complements, intersections and unions: blocks, lenses and rims with known distances, and edges found by brute force.
#include "engines/geometry/set_algebra.hpp"

#include "engines/geometry/rigid_motion.hpp"
#include "engines/geometry/solids.hpp"
#include "engines/geometry/test_support.hpp"

namespace graindrive::geometry {
namespace {

constexpr double pi = 3.14159265358979323846;

template <int D>
using Shapes = std::vector<SharedSurface<D>>;

/// The half-spaces whose intersection is a block about a point.
template <int D>
Shapes<D> sides(const Vec<D>& half, const Vec<D>& middle = {})
{
	Shapes<D> all;
	for (int k = 0; k < D; ++k)
		for (const double side : { -1.0, 1.0 })
			all.push_back(shared(HalfSpace<D>(middle + side * half[k] * Vec<D>::along(k), side * Vec<D>::along(k))));
	return all;
}

/// A block's distance: |max(|x| - h, 0)| outside, the largest of |x| - h inside.
template <int D>
double block_distance(const Vec<D>& half, const Vec<D>& at)
{
	Vec<D> beyond;
	double inside = -1e300;
	for (int k = 0; k < D; ++k) {
		beyond[k] = std::max(0.0, std::abs(at[k]) - half[k]);
		inside = std::max(inside, std::abs(at[k]) - half[k]);
	}
	return inside > 0 ? norm(beyond) : inside;
}

template <int D>
void expect_block(double unit, const Vec<D>& middle)
{
	Vec<D> half = unit * Vec<D>{ 1, 0.4 };
	if constexpr (D == 3) half[2] = 0.7 * unit;
	const Intersection<D> block(sides(half, middle));
	const auto outside = shared(Complement<D>(shared(block)));
	Shapes<D> beyond;
	for (const auto& side : sides(half, middle)) beyond.push_back(shared(Complement<D>(side)));
	const Union<D> beyond_a_side(beyond);
	RandomPoints<D> random(2 * unit);
	const double allowed = 1e-14 * unit + 2e-15 * largest(middle);
	for (int i = 0; i < 1000; ++i) {
		const Vec<D> at = random();
		const double exact = block_distance(half, at);
		const Nearest<D> found = block.nearest(middle + at);
		EXPECT_NEAR(found.distance, exact, allowed);
		EXPECT_NEAR(outside->nearest(middle + at).distance, -exact, allowed);
		EXPECT_NEAR(beyond_a_side.nearest(middle + at).distance, -exact, allowed);
		EXPECT_LT(block_distance(half, at - found.distance * found.normal), 3 * allowed);  // the nearest point lies on the block
	}
}

TEST(Intersection, OfHalfSpacesIsABlock)
{
	for (const double unit : { 1.0, 1e-6, 1e6 }) {
		expect_block<2>(unit, {});
		expect_block<3>(unit, {});
	}
	expect_block<2>(1, { 1e6, -3e6 });
	expect_block<3>(1e-6, { 1, -3, 2 });
}

TEST(Intersection, HasTheBoundsOfItsParts)
{
	const Bounds<3> box = Intersection<3>(sides<3>({ 1, 2, 3 }, { 5, 5, 5 })).bounds();
	EXPECT_TRUE((box.low == Vec<3>{ 4, 3, 2 } && box.high == Vec<3>{ 6, 7, 8 }));
	const Bounds<2> both = Union<2>({ shared(Ball<2>({ 0, 0 }, 1)), shared(Ball<2>({ 5, 1 }, 2)) }).bounds();
	EXPECT_TRUE((both.low == Vec<2>{ -1, -1 } && both.high == Vec<2>{ 7, 3 }));
}

/// Two balls of radius 1 whose centres are 1.2 apart along x: their surfaces meet where x = 0, 0.8 from the axis.
template <int D>
Shapes<D> two_balls()
{
	const Vec<D> shift = 0.6 * Vec<D>::along(0);
	return { shared(Ball<D>(-shift, 1)), shared(Ball<D>(shift, 1)) };
}

/// The distance from the edge where the two surfaces meet.
template <int D>
double from_their_edge(const Vec<D>& at)
{
	const double across = std::sqrt(std::max(0.0, squared_norm(at) - at[0] * at[0]));
	return std::hypot(at[0], across - 0.8);
}

template <int D>
void expect_lens_and_union()
{
	const Intersection<D> lens(two_balls<D>());
	const Union<D> pair(two_balls<D>());
	RandomPoints<D> random(D == 2 ? 2 : 1.5);
	int edges = 0, creases = 0;
	for (int i = 0; i < 3000; ++i) {
		const Vec<D> at = random(), left = at + 0.6 * Vec<D>::along(0), right = at - 0.6 * Vec<D>::along(0);
		const double from_left = norm(left) - 1, from_right = norm(right) - 1, farther = std::max(from_left, from_right);
		// The nearest point of the farther ball is inside the other ball if it lies on that ball's side of x = 0.
		const Vec<D> foot =
			from_left > from_right ? left / norm(left) - 0.6 * Vec<D>::along(0) : right / norm(right) + 0.6 * Vec<D>::along(0);
		const bool at_edge = farther > 0 && (from_left > from_right ? foot[0] < 0 : foot[0] > 0);
		edges += at_edge;
		EXPECT_NEAR(lens.nearest(at).distance, at_edge ? from_their_edge(at) : farther, 1e-14) << i;
		// Inside the union: the nearest surface point of the ball in which `at` is deeper, unless that point is inside the other
		// ball.
		const double nearer = std::min(from_left, from_right);
		const Vec<D> way_out =
			from_left < from_right ? left / norm(left) - 0.6 * Vec<D>::along(0) : right / norm(right) + 0.6 * Vec<D>::along(0);
		const bool at_crease = nearer < 0 && (from_left < from_right ? way_out[0] > 0 : way_out[0] < 0);
		creases += at_crease;
		EXPECT_NEAR(pair.nearest(at).distance, at_crease ? -from_their_edge(at) : nearer, 1e-14) << i;
	}
	EXPECT_GT(edges, 100);
	EXPECT_GT(creases, 30);
	EXPECT_GT(expect_distance<D>(lens, 2), 0.9);
	EXPECT_GT(expect_distance<D>(pair, 2), 0.9);
}

TEST(SetAlgebra, TwoDisksMeetInCorners) { expect_lens_and_union<2>(); }
TEST(SetAlgebra, TwoBallsMeetInACircle) { expect_lens_and_union<3>(); }

TEST(SetAlgebra, ACylinderBetweenPlanesIsACylinderWithEnds)
{
	const Vec<3> axis = unit(Vec<3>{ 1, 2, -1 });
	for (const double size : { 1.0, 1e-6 })
		for (const Vec<3>& middle : { Vec<3>{}, size * Vec<3>{ 1e6, -2e6, 5e5 } }) {
			const double radius = 0.6 * size, half = 0.5 * size;
			const Intersection<3> cut({ shared(Cylinder(middle, axis, radius)), shared(HalfSpace<3>(middle + half * axis, axis)),
				shared(HalfSpace<3>(middle - half * axis, -axis)) });
			const Cylinder whole(middle, axis, radius, 2 * half);
			RandomPoints<3> random(1.5 * size, middle);
			for (int i = 0; i < 1000; ++i) {
				const Vec<3> at = random();
				EXPECT_NEAR(cut.nearest(at).distance, whole.nearest(at).distance, 1e-13 * size + 2e-15 * largest(middle)) << i;
				EXPECT_LT(norm(cut.nearest(at).normal - whole.nearest(at).normal), 1e-7)
					<< i << " " << whole.nearest(at).distance;
			}
		}
}

/// The smallest distance to a closed curve by search, refined around the best of many points.
template <class Curve>
double distance_to_curve(const Vec<3>& at, const Curve& curve)
{
	double best = 0, width = 2 * pi / 2000;
	for (int i = 1; i < 2000; ++i)
		if (norm(at - curve(i * width)) < norm(at - curve(best))) best = i * width;
	double low = best - width, high = best + width;  // golden section
	const double part = (std::sqrt(5.0) - 1) / 2;
	for (int i = 0; i < 60; ++i) {
		const double a = high - part * (high - low), b = low + part * (high - low);
		if (norm(at - curve(a)) < norm(at - curve(b)))
			high = b;
		else
			low = a;
	}
	return norm(at - curve((low + high) / 2));
}

TEST(SetAlgebra, AnObliqueCutThroughACylinderIsAnEllipse)
{
	// A cylinder of unit radius about z below the plane z = x: its only edge is the rim (cos t, sin t, cos t).
	const SharedSurface<3> pipe = shared(Cylinder({}, { 0, 0, 1 }, 1));
	const SharedSurface<3> below = shared(HalfSpace<3>({}, { -1, 0, 1 }));
	const Intersection<3> stump({ pipe, below });
	const Union<3> both({ pipe, below });
	RandomPoints<3> random(2);
	int outside = 0, inside = 0;
	for (int i = 0; i < 1500; ++i) {
		const Vec<3> at = random();
		const double rim = distance_to_curve(at, [](double t) { return Vec<3>{ std::cos(t), std::sin(t), std::cos(t) }; });
		const Nearest<3> mantle = pipe->nearest(at), plane = below->nearest(at);
		// The nearest point of the farther part (inside: of the deeper one) is the solution if the other part contains (does not
		// contain) it.
		const auto foot_beside = [&](bool on_mantle) {
			const Nearest<3>& part = on_mantle ? mantle : plane;
			return (on_mantle ? below : pipe)->nearest(at - part.distance * part.normal).distance;
		};
		const double farther = std::max(mantle.distance, plane.distance), nearer = std::min(mantle.distance, plane.distance);
		const bool at_rim = farther > 0 && foot_beside(mantle.distance == farther) > 0;
		const bool at_crease = nearer < 0 && foot_beside(mantle.distance == nearer) < 0;
		outside += at_rim;
		inside += at_crease;
		EXPECT_NEAR(stump.nearest(at).distance, at_rim ? rim : farther, 1e-12) << i;
		EXPECT_NEAR(both.nearest(at).distance, at_crease ? -rim : nearer, 1e-12) << i;
	}
	EXPECT_GT(outside, 100);
	EXPECT_GT(inside, 100);
}

TEST(SetAlgebra, ACornerOfThreeCurvedSurfaces)
{
	// Three unit balls with centres at 0.5 on each axis meet where x = y = z, |x|^2 - x = 0.75: two corners.
	Shapes<3> balls;
	for (int k = 0; k < 3; ++k) balls.push_back(shared(Ball<3>(0.5 * Vec<3>::along(k), 1)));
	const Intersection<3> pebble(balls);
	const double x = (1 + std::sqrt(10.0)) / 6;  // 3 x^2 - x = 0.75
	for (const double away : { 1e-3, 0.1, 1.0, 10.0 }) {
		const Nearest<3> found = pebble.nearest(Vec<3>::all(x) + away * Vec<3>{ 2, 3, 6 } / 7);
		EXPECT_LE(found.distance, away);
	}
	const Nearest<3> found = pebble.nearest(Vec<3>::all(x + 0.3));
	EXPECT_NEAR(found.distance, 0.3 * std::sqrt(3.0), 1e-14);
	EXPECT_GT(expect_distance(pebble, 1.5), 0.9);
}

TEST(SetAlgebra, MayBeNestedTurnedAndFarAway)
{
	// A drum with a block in it, from blocks and cylinders, turned, placed far away.
	const auto block = shared(Intersection<3>(sides<3>({ 0.3, 0.2, 0.25 }, { 0, -0.5, 0 })));
	const auto drum = shared(Complement<3>(shared(Cylinder({}, { 0, 0, 1 }, 1, 2))));
	const auto solid = shared(Union<3>({ drum, block }));
	EXPECT_GT(expect_distance<3>(*solid, 1.2, {}, { 1e-12, 1e-7 }), 0.9);
	const Vec<3> far{ 1e6, 2e6, -1e6 };
	const Placed<3> placed(solid, far, Turn<3>::about({ 1, 2, 3 }, 1));
	EXPECT_GT(expect_distance<3>(placed, 1.2, far, { 1e-12, 1e-7 }), 0.9);
}

TEST(SetAlgebra, GivesABoundWhereThereIsNoEdge)
{
	const Intersection<2> nothing({ shared(Ball<2>({ -3, 0 }, 1)), shared(Ball<2>({ 3, 0 }, 1)) });
	EXPECT_EQ(nothing.nearest({ -1, 0 }).distance, 3);  // the distance from the farther ball
	EXPECT_GT(nothing.nearest({ -3, 0 }).distance, 0);  // no point lies inside
}

TEST(SetAlgebra, RefusesToMakeSomethingOfNothing)
{
	EXPECT_TRUE(mentions(complaint([] { Intersection<2>({}); }), "an intersection needs at least one part, got none; give the"));
	EXPECT_TRUE(mentions(complaint([] { Union<3>({ nullptr }); }), "a union needs a shape for each part, got none for part 0"));
	EXPECT_TRUE(mentions(complaint([] { Complement<3>(nullptr); }), "a complement needs a shape"));
}

/// A ball that gives distances only for spheres up to some radius.
class Doubtful : public Ball<3> {
public:
	explicit Doubtful(double largest) : Ball<3>({}, 1), largest_(largest) {}
	double largest_sphere() const override { return largest_; }

private:
	double largest_;
};

TEST(SetAlgebra, TrustsSpheresAsItsLeastTrustedPart)
{
	const SharedSurface<3> ball = shared(Ball<3>({}, 1)), doubtful = shared(Doubtful(0.2));
	EXPECT_EQ(ball->largest_sphere(), std::numeric_limits<double>::infinity());
	EXPECT_EQ(Union<3>({ ball, doubtful }).largest_sphere(), 0.2);
	EXPECT_EQ(Intersection<3>({ doubtful, ball }).largest_sphere(), 0.2);
	EXPECT_EQ(Placed<3>(doubtful, { 1, 2, 3 }).largest_sphere(), 0.2);
	EXPECT_EQ(Complement<3>(doubtful).largest_sphere(), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace graindrive::geometry
