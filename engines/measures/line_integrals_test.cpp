/// Kernels integrated along lines, against quadrature and closed forms.
#include "engines/measures/line_integrals.hpp"

#include <gtest/gtest.h>

#include <random>

namespace graindrive {
namespace {

struct Line {
	Vector2r from, branch, point;
};

std::vector<Line> random_lines(int count)
{
	std::mt19937 random(3);
	std::uniform_real_distribution<Real> place(-2.5, 2.5), size(-1, 1);
	std::vector<Line> all(count);
	for (Line& line : all)
		line = { { place(random), place(random) }, { size(random), size(random) }, { place(random) / 5, place(random) / 5 } };
	return all;
}

/// Mean of f over the line by the midpoint rule.
template <class F>
Real along(const Line& line, F&& f)
{
	const int n = 20000;
	Real sum = 0;
	for (int k = 0; k < n; ++k) sum += f(Vector2r(line.from + (k + 0.5) / n * line.branch - line.point)) / n;
	return sum;
}

TEST(LineIntegrals, GaussianAgreesWithQuadrature)
{
	for (const Line& line : random_lines(200)) {
		const Real w = 0.8, exact = gaussian_along_line(line.from, line.branch, line.point, w, 3 * w);
		const Real numeric = along(
			line, [&](const Vector2r& r) { return r.squaredNorm() < 9 * w * w ? std::exp(-r.squaredNorm() / (w * w)) : 0; });
		EXPECT_NEAR(exact, numeric, std::exp(-9) / 20000 + 1e-8);  // the cut falls between two midpoints
	}
}

TEST(LineIntegrals, GaussianCutInTheMiddleOfALine)
{
	// A line through the centre with both ends far outside: w sqrt(pi) erf(c)/L in every direction.
	const Real w = 0.5;
	for (const Real angle : { 0.0, 0.4, 1.9, 3.0 }) {
		const Vector2r half(5 * std::cos(angle), 5 * std::sin(angle)), centre(0.3, -2);
		const Real exact = w * std::sqrt(pi) * std::erf(1.5) / 10;
		EXPECT_NEAR(gaussian_along_line<Vector2r>(centre - half, 2 * half, centre, w, 1.5 * w), exact, 1e-15);
	}
	EXPECT_EQ(gaussian_along_line<Vector2r>({ 0, 1.51 * w }, { 1, 0 }, { 0.2, 0 }, w, 1.5 * w), 0);
}

TEST(LineIntegrals, ASplitLineIsTheSumOfItsParts)
{
	for (const Line& line : random_lines(100)) {
		const auto both = [&](auto&& integral) {
			const Vector2r head = 0.3 * line.branch, tail = 0.7 * line.branch;
			return 0.3 * integral(line.from, head) + 0.7 * integral(Vector2r(line.from + head), tail) -
			       integral(line.from, line.branch);
		};
		EXPECT_NEAR(both([&](auto a, auto b) { return gaussian_along_line<Vector2r>(a, b, line.point, 1, 3); }), 0, 1e-14);
		EXPECT_NEAR(both([&](auto a, auto b) { return fraction_in_sphere<Vector2r>(a, b, line.point, 1); }), 0, 1e-14);
		EXPECT_NEAR(both([&](auto a, auto b) { return fraction_in_box<Vector2r>(a, b, { -1, -0.5 }, { 0.5, 1 }); }), 0, 1e-14);
	}
}

TEST(LineIntegrals, ChordsOfSpheres)
{
	EXPECT_DOUBLE_EQ(fraction_in_sphere<Vector2r>({ -2, 0.6 }, { 4, 0 }, { 0, 0 }, 1), 0.4);     // chord 1.6 of 4
	EXPECT_DOUBLE_EQ(fraction_in_sphere<Vector2r>({ 0.1, 0.1 }, { 0.2, 0.3 }, { 0, 0 }, 1), 1);  // inside
	EXPECT_EQ(fraction_in_sphere<Vector2r>({ 1, 1 }, { 3, 0 }, { 0, 0 }, 1), 0);                 // beside
	EXPECT_DOUBLE_EQ(fraction_in_sphere<Vector3r>({ -2, 0.6, 0 }, { 4, 0, 0 }, { 0, 0.36, 0.33 }, 0.4), 0);
	EXPECT_NEAR(fraction_in_sphere<Vector3r>({ 0, 0, 0 }, { 0, 2, 0 }, { 0.48, 0, 0.36 }, 1), 0.4, 1e-15);  // h = 0.6
}

TEST(LineIntegrals, ChordsOfBoxes)
{
	const Vector2r low(0, 0), high(1, 1);
	EXPECT_DOUBLE_EQ(fraction_in_box<Vector2r>({ -1, 0.5 }, { 4, 0 }, low, high), 0.25);
	EXPECT_DOUBLE_EQ(fraction_in_box<Vector2r>({ -0.5, 0 }, { 1, 1 }, low, high), 0.5);  // enters through the left side
	EXPECT_EQ(fraction_in_box<Vector2r>({ -1, 0 }, { 1, 3 }, low, high), 0);             // passes the corner
	// A line along the common edge of two boxes counts in one of them.
	EXPECT_EQ(fraction_in_box<Vector2r>({ 0, 1 }, { 1, 0 }, low, high) +
				  fraction_in_box<Vector2r>({ 0, 1 }, { 1, 0 }, { 0, 1 }, { 1, 2 }),
		1);
	for (const Line& line : random_lines(100)) {
		const auto inside = [&](const Vector2r& r) { return r.minCoeff() > -0.7 && r.maxCoeff() < 0.7 ? 1.0 : 0.0; };
		const Vector2r half(0.7, 0.7);
		EXPECT_NEAR(fraction_in_box<Vector2r>(line.from, line.branch, line.point - half, line.point + half), along(line, inside),
			2.0 / 20000);
	}
}

}  // namespace
}  // namespace graindrive
