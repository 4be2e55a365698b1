/// Kernels integrated over an axis, against quadrature along the axis and along lines, and against known values.
#include "engines/measures/averaged_kernels.hpp"

#include <gtest/gtest.h>

#include <random>

#include "engines/measures/ball_overlap.hpp"
#include "engines/measures/line_integrals.hpp"

namespace graindrive {
namespace {

/// Midpoint rule between two limits.
template <class F>
Real integral(Real low, Real high, int n, F&& f)
{
	Real sum = 0;
	for (int k = 0; k < n; ++k) sum += f(low + (k + 0.5) * (high - low) / n);
	return sum * (high - low) / n;
}

struct Line {
	Vector3r from, branch, point;
};

/// Projected lines in the plane z = 0.3, some through the kernel and some beside it.
std::vector<Line> random_shadows(int count)
{
	std::mt19937 random(11);
	std::uniform_real_distribution<Real> place(-1.3, 1.3), size(-1, 1);
	std::vector<Line> all(count);
	for (Line& line : all)
		line = { { place(random), place(random), 0.3 }, { size(random), size(random), 0 },
			{ place(random) / 5, place(random) / 5, 0.3 } };
	return all;
}

/// Mean over a line of f(square of the distance from the point).
template <class F>
Real mean_over(const Line& line, F&& f)
{
	return integral(0, 1, 20000, [&](Real s) { return f((line.from + s * line.branch - line.point).squaredNorm()); });
}

TEST(AveragedKernels, SpheresAgreeWithQuadrature)
{
	const Real radii[][2] = { { 0.5, 1 }, { 1, 0.5 }, { 0.5, 0.5 }, { 0.3, 0.301 }, { 0.02, 2 } };
	for (const auto& [r, big_r] : radii)
		for (const Real part : { 0.0, 0.1, 0.33, 0.34, 0.6, 0.97, 1.0, 1.2 }) {
			const Real rho = part * (r + big_r), expected = integral(-3, 3, 40000,
													 [&](Real y) { return sphere_sphere_overlap(r, big_r, std::hypot(rho, y)); });
			EXPECT_NEAR(sphere_overlap_along_axis(r, big_r, rho), expected, 1e-8);
		}
}

TEST(AveragedKernels, SpheresGiveTheProductOfTheirVolumes)
{
	for (const Real r : { 0.5, 0.05, 1.0 }) {
		const Real total =
			integral(0, 1 + r, 20000, [&](Real rho) { return 2 * pi * rho * sphere_overlap_along_axis(r, 1, rho); });
		const Real step = (1 + r) / 20000, slope = 2 * pi * sphere_overlap_along_axis(r, 1, 0);     // at the axis; 0 at the rim
		EXPECT_NEAR(total, ball_volume<3>(r) * ball_volume<3>(1), 1.1 * step * step / 24 * slope);  // the midpoint rule's error
	}
}

TEST(AveragedKernels, GaussianAgreesWithQuadrature)
{
	const Real w = 0.7, c = 1.5;
	for (const Real rho : { 0.0, 0.3, 0.9, 1.04, 1.06 }) {
		const Real half = std::sqrt(std::max(c * c * w * w - rho * rho, Real(0)));
		const Real expected = integral(-half, half, 20000, [&](Real y) { return std::exp(-(rho * rho + y * y) / (w * w)); });
		EXPECT_NEAR(gaussian_along_axis(rho * rho, w, c), expected, 1e-9);
	}
}

TEST(AveragedKernels, LinesAgreeWithQuadrature)
{
	for (const Line& line : random_shadows(300)) {
		const auto chord = [](Real square) { return 2 * std::sqrt(std::max(0.81 - square, 0.0)); };
		// The chord begins as a square root, so the midpoint rule has an error of about 1/20000^(3/2) there.
		EXPECT_NEAR(mean_chord_along_axis(line.from, line.branch, line.point, 0.9), mean_over(line, chord), 2e-6);
		for (const Real c : { 0.8, 1.5, 3.0 }) {
			const auto across = [&](Real square) { return gaussian_along_axis(square, 0.6, c); };
			EXPECT_NEAR(mean_gaussian_along_axis(line.from, line.branch, line.point, 0.6, c), mean_over(line, across), 2e-6);
		}
	}
}

TEST(AveragedKernels, AWideCutLeavesTheGaussianOfThePlane)
{
	// Without a cut the integral over the axis is a factor sqrt(pi) w; at c = 6 the rest is exp(-36) = 2e-16.
	for (const Line& line : random_shadows(50)) {
		const Real flat = gaussian_along_line(line.from, line.branch, line.point, 0.6, 3.6) * std::sqrt(pi) * 0.6;
		EXPECT_NEAR(mean_gaussian_along_axis(line.from, line.branch, line.point, 0.6, 6), flat, 4e-15);
	}
}

TEST(AveragedKernels, ASplitShadowIsTheSumOfItsParts)
{
	for (const Line& line : random_shadows(100)) {
		const Vector3r head = 0.3 * line.branch, tail = 0.7 * line.branch, cut = line.from + head;
		const auto both = [&](auto&& mean) {
			return 0.3 * mean(line.from, head) + 0.7 * mean(cut, tail) - mean(line.from, line.branch);
		};
		EXPECT_NEAR(both([&](auto a, auto b) { return mean_chord_along_axis(a, b, line.point, 1); }), 0, 1e-14);
		EXPECT_NEAR(both([&](auto a, auto b) { return mean_gaussian_along_axis(a, b, line.point, 1, 1.2); }), 0, 1e-14);
	}
}

TEST(AveragedKernels, ALineAlongTheAxisIsAPoint)
{
	const Vector3r from(0.3, -0.2, 0), point(0.1, 0.5, 0), direction(0.6, -0.8, 0);
	const Real square = (from - point).squaredNorm();
	EXPECT_DOUBLE_EQ(mean_chord_along_axis(from, Vector3r::Zero(), point, 1), 2 * std::sqrt(1 - square));
	EXPECT_DOUBLE_EQ(mean_gaussian_along_axis(from, Vector3r::Zero(), point, 1, 2), gaussian_along_axis(square, 1, 2));
	// Lines almost along the axis: a mean over 1e-8 or 1e-6 differs by the slope times half of that, and by a round-off of
	// 1e-16/1e-6.
	for (const Real size : { 1e-8, 1e-6 }) {
		EXPECT_NEAR(mean_chord_along_axis(from, size * direction, point, 1), 2 * std::sqrt(1 - square), 2 * size);
		EXPECT_NEAR(mean_gaussian_along_axis(from, size * direction, point, 1, 2), gaussian_along_axis(square, 1, 2), 2 * size);
	}
}

}  // namespace
}  // namespace graindrive
