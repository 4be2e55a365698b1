/// Overlaps of disks with squares and with disks, against closed forms and against quadrature.
#include "engines/measures/disk_square_overlap.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "engines/measures/ball_overlap.hpp"

namespace graindrive {
namespace {

constexpr Real round_off = 16 * std::numeric_limits<Real>::epsilon();

/// Length of a disk's chord at height y inside [low, high], and its first moment in x.
Vector2r cut(Real radius, Real y, Real low, Real high)
{
	const Real half = std::sqrt(std::max(radius * radius - y * y, Real(0)));
	const Real a = std::max(low, -half), b = std::min(high, half);
	return b > a ? Vector2r(b - a, (b * b - a * a) / 2) : Vector2r(Vector2r::Zero());
}

/// Midpoint rule in the angle t, y = r sin t, in which the integrand has no vertical tangents.
Overlap by_quadrature(Real radius, const Vector2r& low, const Vector2r& high)
{
	const int n = 40000;
	const auto angle = [&](Real y) { return std::asin(std::clamp(y / radius, Real(-1), Real(1))); };
	const Real begin = angle(low[1]), step = (angle(high[1]) - begin) / n;
	Overlap sum;
	for (int k = 0; k < n; ++k) {
		const Real t = begin + (k + 0.5) * step, y = radius * std::sin(t), dy = radius * std::cos(t) * step;
		const Vector2r at_y = cut(radius, y, low[0], high[0]);
		sum.area += at_y[0] * dy;
		sum.moment += Vector2r(at_y[1], at_y[0] * y) * dy;
	}
	return sum;
}

TEST(DiskSquareOverlap, DiskInsideBinIsTheDisk)
{
	const Overlap all = disk_square_overlap(0.7, { -1, -0.8 }, { 2, 3 });
	EXPECT_NEAR(all.area, pi * 0.49, round_off);
	EXPECT_NEAR(all.moment.norm(), 0, round_off);
}

TEST(DiskSquareOverlap, HalfAndQuarterDisks)
{
	const Real r = 1.3;
	const Overlap half = disk_square_overlap(r, { 0, -5 }, { 5, 5 }), quarter = disk_square_overlap(r, { 0, 0 }, { 2, 2 });
	EXPECT_NEAR(half.area, pi * r * r / 2, round_off);
	EXPECT_NEAR(half.moment[0], 2 * r * r * r / 3, round_off);  // centroid 4r/(3 pi)
	EXPECT_NEAR(half.moment[1], 0, round_off);
	EXPECT_NEAR(quarter.area, pi * r * r / 4, round_off);
	EXPECT_NEAR(quarter.moment[0], r * r * r / 3, round_off);
	EXPECT_NEAR(quarter.moment[1], r * r * r / 3, round_off);
}

TEST(DiskSquareOverlap, CircularSegment)
{
	const Real r = 2, h = 1.2, half_angle = std::acos(h / r), chord = 2 * std::sqrt(r * r - h * h);
	const Overlap cap = disk_square_overlap(r, { h, -3 }, { 4, 3 });
	EXPECT_NEAR(cap.area, r * r * half_angle - h * chord / 2, r * r * round_off);
	EXPECT_NEAR(cap.moment[0], std::pow(chord, 3) / 12, r * r * r * round_off);
}

TEST(DiskSquareOverlap, BinInsideDiskIsTheBin)
{
	const Overlap bin = disk_square_overlap(1, { 0.2, -0.5 }, { 0.3, -0.4 });
	EXPECT_NEAR(bin.area, 0.01, round_off);
	EXPECT_NEAR(bin.moment[0], 0.01 * 0.25, round_off);
	EXPECT_NEAR(bin.moment[1], 0.01 * -0.45, round_off);
}

TEST(DiskSquareOverlap, NothingOutside)
{
	EXPECT_EQ(disk_square_overlap(1, { 1, -1 }, { 2, 1 }).area, 0);       // touches the side
	EXPECT_EQ(disk_square_overlap(1, { 0.71, 0.71 }, { 2, 2 }).area, 0);  // near the corner
	EXPECT_GT(disk_square_overlap(1, { 0.70, 0.70 }, { 2, 2 }).area, 0);  // over the corner
	EXPECT_EQ(disk_square_overlap(1, { -9, -9 }, { -8, 8 }).moment.norm(), 0);
}

TEST(DiskSquareOverlap, AgreesWithQuadratureAnywhere)
{
	std::mt19937 random(11);
	std::uniform_real_distribution<Real> place(-1.5, 1.2), size(0.05, 1.5);
	int cut_bins = 0;
	for (int k = 0; k < 400; ++k) {
		const Vector2r low(place(random), place(random)), high = low + Vector2r(size(random), size(random));
		const Overlap exact = disk_square_overlap(1, low, high), numeric = by_quadrature(1, low, high);
		// Where the chord's length has kinks the midpoint rule has an error of step^2: (pi/4e4)^2 = 6e-9.
		EXPECT_NEAR(exact.area, numeric.area, 2e-8) << low.transpose() << " to " << high.transpose();
		EXPECT_NEAR((exact.moment - numeric.moment).norm(), 0, 4e-8) << low.transpose() << " to " << high.transpose();
		cut_bins += exact.area > 0 && exact.area < 0.999 * (high - low).prod();
	}
	EXPECT_GT(cut_bins, 200);
}

TEST(DiskSquareOverlap, BinsOfAGridAddUpToTheDisk)
{
	std::mt19937 random(5);
	std::uniform_real_distribution<Real> place(-0.05, 0.05);
	for (const Real bin : { 0.05, 0.13, 0.5, 1.7 })
		for (int k = 0; k < 20; ++k) {
			const Vector2r shift(place(random), place(random));
			const int n = int(std::ceil(1.2 / bin));
			Overlap sum;
			for (int i = -n; i < n; ++i)
				for (int j = -n; j < n; ++j) {
					const Vector2r low = shift + bin * Vector2r(i, j);
					const Overlap one = disk_square_overlap(1, low, low + Vector2r(bin, bin));
					sum.area += one.area;
					sum.moment += one.moment;
				}
			EXPECT_NEAR(sum.area, pi, 1e-12);
			EXPECT_NEAR(sum.moment.norm(), 0, 1e-12);
		}
}

TEST(DiskSquareOverlap, CentroidLiesInTheBin)
{
	std::mt19937 random(7);
	std::uniform_real_distribution<Real> angle(0, 2 * pi), depth(1e-6, 0.05);
	for (int k = 0; k < 2000; ++k) {  // bins at the rim, some with a sliver of the disk
		const Real a = angle(random), rim = 1 - depth(random);
		const Vector2r low = rim * Vector2r(std::cos(a), std::sin(a)) - Vector2r(0.025, 0.025);
		const Overlap one = disk_square_overlap(1, low, low + Vector2r(0.05, 0.05));
		ASSERT_GT(one.area, 0);
		const Vector2r inside = (one.moment / one.area - low) / 0.05;
		EXPECT_TRUE(inside.minCoeff() > -1e-9 && inside.maxCoeff() < 1 + 1e-9) << inside.transpose();
	}
}

// ---- two disks ----

TEST(DiskDiskOverlap, LensOfEqualDisks)
{
	const Real d = 0.8;  // 2 r^2 arccos(d/2r) - d/2 sqrt(4r^2 - d^2)
	EXPECT_NEAR(disk_disk_overlap(1, 1, d), 2 * std::acos(d / 2) - d / 2 * std::sqrt(4 - d * d), round_off);
}

TEST(DiskDiskOverlap, InsideOutsideAndTouching)
{
	EXPECT_EQ(disk_disk_overlap(0.5, 1, 0.4), pi * 0.25);
	EXPECT_EQ(disk_disk_overlap(1, 0.5, 0.5), pi * 0.25);
	EXPECT_EQ(disk_disk_overlap(0.5, 1, 1.5), 0);
	// A shallow lens: 2/3 chord depth each, A = 4/3 sqrt(2 R_eff e) e, corrections of order e.
	const Real e = 1e-7, r_eff = 0.5 / 1.5;
	EXPECT_NEAR(disk_disk_overlap(0.5, 1, 1.5 - e) / (4 * std::sqrt(2 * r_eff * e) * e / 3), 1, 1e-6);
}

TEST(DiskDiskOverlap, CentreBeyondTheChordAndSumOverThePlane)
{
	// Integrated over all places of the large disk the overlap is the product of the areas.
	const int n = 4000;
	const Real r = 0.5, big_r = 1.1, step = (r + big_r) / n;
	Real sum = 0;
	for (int k = 0; k < n; ++k) sum += 2 * pi * (k + 0.5) * step * step * disk_disk_overlap(r, big_r, (k + 0.5) * step);
	EXPECT_NEAR(sum, pi * r * r * pi * big_r * big_r, 1e-5);
}

}  // namespace
}  // namespace graindrive
