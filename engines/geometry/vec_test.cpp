/// Vectors and orientations, in two and three dimensions with the same assertions where both exist.
#include "engines/geometry/turn.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace graindrive::geometry {
namespace {

constexpr double pi = 3.14159265358979323846;

template <int D>
Vec<D> some(double a, double b, double c)
{
	Vec<D> v{ a, b };
	if constexpr (D == 3) v[2] = c;
	return v;
}

/// A spin about an axis that is oblique in space.
template <int D>
Spin<D> some_spin(double speed)
{
	if constexpr (D == 2)
		return speed;
	else
		return speed * Vec<3>{ 2, -3, 6 } / 7;
}

template <class Test>
void in_both(Test test)
{
	test(std::integral_constant<int, 2>());
	test(std::integral_constant<int, 3>());
}

TEST(Vec, HasTheArithmeticOfItsCoordinates)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		const Vec<D> a = some<D>(1, -2, 3), b = some<D>(0.5, 4, -1);
		for (int k = 0; k < D; ++k) {
			EXPECT_EQ((a + b)[k], a[k] + b[k]);
			EXPECT_EQ((a - b)[k], a[k] - b[k]);
			EXPECT_EQ((3 * a)[k], 3 * a[k]);
			EXPECT_EQ((a * 3)[k], 3 * a[k]);
			EXPECT_EQ((a / 3)[k], a[k] / 3);
			EXPECT_EQ((-a)[k], -a[k]);
			EXPECT_EQ(Vec<D>::along(k)[k], 1);
			EXPECT_EQ(Vec<D>{}[k], 0);
		}
		EXPECT_EQ(largest(a), D);
		EXPECT_TRUE(a == a && a != b && !(a == b));
		EXPECT_FALSE(some<D>(std::nan(""), 0, 0) == some<D>(std::nan(""), 0, 0));
		EXPECT_TRUE(is_finite(a));
		EXPECT_FALSE(is_finite(some<D>(0, std::numeric_limits<double>::infinity(), 0)));
	});
}

TEST(Vec, SumsSquaresInTheOrderOfTheAxes)
{
	// 1e16 + 1 + 1: each 1 is lost if it is added alone to 1e16.
	EXPECT_EQ(squared_norm(Vec<3>{ 1e8, 1, 1 }), (1e16 + 1) + 1);
	EXPECT_EQ(squared_norm(Vec<3>{ 1, 1, 1e8 }), 1e16 + 2);
	EXPECT_EQ(norm(Vec<2>{ 3, 4 }), 5);
	EXPECT_EQ(norm(Vec<3>{ 2, 3, 6 }), 7);
	EXPECT_EQ(dot(Vec<3>{ 1, 2, 3 }, Vec<3>{ 4, -5, 6 }), 12);
}

TEST(Vec, FindsDirectionsOfVectorsWhoseSquareIsNoNumber)
{
	for (const double size : { 1e-200, 1.0, 1e200 }) {
		EXPECT_DOUBLE_EQ(unit(size * Vec<2>{ 3, -4 })[1], -0.8);
		EXPECT_DOUBLE_EQ(unit(size * Vec<3>{ 2, 3, -6 })[2], -6.0 / 7);
	}
}

TEST(Vec, VectorProductIsPerpendicularAndMeasuresTheArea)
{
	const Vec<3> a{ 1, 2, 3 }, b{ -2, 0.5, 4 }, c = cross(a, b);
	EXPECT_EQ(dot(a, c), 0);
	EXPECT_EQ(dot(b, c), 0);
	EXPECT_EQ(squared_norm(c), squared_norm(a) * squared_norm(b) - dot(a, b) * dot(a, b));  // Lagrange; exact in these numbers
	EXPECT_EQ(cross(Vec<2>{ 1, 2 }, Vec<2>{ -2, 0.5 }), c[2]);                              // the same as in space
	const Vec<2> flat = cross(2.0, Vec<2>{ 3, 4 });
	const Vec<3> there = cross(Vec<3>{ 0, 0, 2 }, Vec<3>{ 3, 4, 0 });
	EXPECT_TRUE(flat[0] == there[0] && flat[1] == there[1] && there[2] == 0);
}

TEST(Turn, IsRigidAndComesBack)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		const Turn<D> turn = Turn<D>::by(some_spin<D>(2.3));
		const Vec<D> a = some<D>(1, -2, 3), b = some<D>(0.5, 4, -1);
		EXPECT_NEAR(dot(turn.apply(a), turn.apply(b)), dot(a, b), 1e-14);  // round-off of numbers of order 10
		EXPECT_LT(norm(turn.undo(turn.apply(a)) - a), 2e-15);
		EXPECT_LT(norm(turn.then(turn.inverse()).apply(a) - a), 2e-15);
		EXPECT_TRUE(Turn<D>{}.apply(a) == a);
		EXPECT_TRUE(turn.is_finite());
	});
}

TEST(Turn, AQuarterTurnTakesXToY)
{
	EXPECT_LT(norm(Turn<2>::by(pi / 2).apply({ 1, 0 }) - Vec<2>{ 0, 1 }), 1e-15);
	EXPECT_LT(norm(Turn<3>::about({ 0, 0, 5 }, pi / 2).apply({ 1, 0, 0 }) - Vec<3>{ 0, 1, 0 }), 1e-15);
	EXPECT_LT(norm(Turn<3>::about({ 1, 1, 1 }, 2 * pi / 3).apply({ 1, 2, 3 }) - Vec<3>{ 3, 1, 2 }), 2e-15);
	// First about z, then about the world's x.
	const Turn<3> both = Turn<3>::about({ 0, 0, 1 }, pi / 2).then(Turn<3>::about({ 1, 0, 0 }, pi / 2));
	EXPECT_LT(norm(both.apply({ 1, 0, 0 }) - Vec<3>{ 0, 0, 1 }), 1e-15);
}

TEST(Turn, AdvancesExactlyAtConstantSpin)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		const Turn<D> start = Turn<D>::by(some_spin<D>(0.7));
		const Vec<D> v = some<D>(1, -2, 3);
		const Turn<D> at_once = start.advanced(some_spin<D>(1.9), 3.0);
		Turn<D> in_steps = start;
		for (int i = 0; i < 3000; ++i) in_steps = in_steps.advanced(some_spin<D>(1.9), 1e-3);
		EXPECT_LT(norm(in_steps.apply(v) - at_once.apply(v)), 3000 * 1e-15);  // a round-off each step, no integration error
		// One revolution takes the time 2 pi/1.9 and ends at the start.
		EXPECT_LT(norm(start.advanced(some_spin<D>(1.9), 2 * pi / 1.9).apply(v) - start.apply(v)), 1e-14);
		// The velocity of a point is omega x r; the central difference over 1e-6 has an error of 1e-12 |omega|^3 |r|.
		const double h = 1e-6;
		const Vec<D> r = start.apply(v), ahead = start.advanced(some_spin<D>(1.9), h).apply(v),
					 behind = start.advanced(some_spin<D>(1.9), -h).apply(v);
		EXPECT_LT(norm((ahead - behind) / (2 * h) - cross(some_spin<D>(1.9), r)), 1e-8);
	});
}

TEST(Turn, StaysAUnitQuaternionAndTakesTheSmallestSpins)
{
	Turn<3> turn;
	for (int i = 0; i < 100000; ++i) turn = turn.advanced({ 1, 2, 3 }, 0.01);
	EXPECT_NEAR(turn.w * turn.w + squared_norm(turn.u), 1, 1e-15);
	EXPECT_EQ(Turn<3>{}.advanced({ 0, 0, 0 }, 1).w, 1);
	EXPECT_DOUBLE_EQ(Turn<3>{}.advanced({ 1e-200, 0, 0 }, 1).u[0], 0.5e-200);
	// On both sides of the angle below which the ratio is replaced by its limit.
	for (const double angle : { 1.9e-8, 2.1e-8 }) EXPECT_DOUBLE_EQ(Turn<3>::by({ 0, angle, 0 }).u[1], std::sin(angle / 2));
}

}  // namespace
}  // namespace graindrive::geometry
