/// Volume of the lens of two spheres, against the sum of its slices and known values. (For disks see
/// disk_square_overlap_test.cpp.)
#include "engines/measures/ball_overlap.hpp"

#include <gtest/gtest.h>

namespace graindrive {
namespace {

/// The volume as a sum over slices across the line of centres; each slice is the smaller of the two spheres' sections.
Real sliced(Real r, Real big_r, Real distance)
{
	const int n = 200000;
	Real sum = 0;
	for (int k = 0; k < n; ++k) {
		const Real x = -r + (k + 0.5) * 2 * r / n, other = x - distance;
		sum += pi * std::max(std::min(r * r - x * x, big_r * big_r - other * other), Real(0)) * 2 * r / n;
	}
	return sum;
}

TEST(BallOverlap, SpheresAgreeWithTheirSlices)
{
	const Real cases[][3] = { { 0.5, 1, 0.6 }, { 0.5, 1, 1.2 }, { 0.5, 0.5, 0.3 }, { 1, 0.7, 1.69 }, { 0.2, 3, 2.9 },
		{ 0.4, 0.4, 1e-3 } };
	for (const auto& [r, big_r, distance] : cases) {
		EXPECT_NEAR(sphere_sphere_overlap(r, big_r, distance), sliced(r, big_r, distance), 1e-9);  // kinks between two slices
		EXPECT_NEAR(sphere_sphere_overlap(r, big_r, distance), sphere_sphere_overlap(big_r, r, distance), 1e-15);
	}
}

TEST(BallOverlap, SpheresInsideBesideAndTouching)
{
	EXPECT_DOUBLE_EQ(sphere_sphere_overlap(0.5, 2, 1.5), pi / 6);
	EXPECT_DOUBLE_EQ(sphere_sphere_overlap(2, 0.5, 0), pi / 6);
	EXPECT_DOUBLE_EQ(sphere_sphere_overlap(1, 1, 0), 4 * pi / 3);
	EXPECT_EQ(sphere_sphere_overlap(1, 2, 3), 0);
	EXPECT_NEAR(sphere_sphere_overlap(0.5, 2, 1.5 + 1e-9), pi / 6, 1e-15);  // continuous where the small one leaves
	// A lens of depth h: pi h^2 R_eff to first order, with R_eff = r R/(r + R); h = 2^-30 is exact.
	const Real h = std::ldexp(1, -30);
	EXPECT_NEAR(sphere_sphere_overlap(0.5, 0.25, 0.75 - h) / (pi * h * h / 6), 1, 10 * h);
}

}  // namespace
}  // namespace graindrive
