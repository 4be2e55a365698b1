/// Shapes that a flow carries round and back: the area is kept to round-off, fractions stay in [0, 1], and the shape's error
/// falls with the grid's spacing.
#include "engines/continuum/volume_of_fluid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive::continuum {
namespace {

/// A unit square in n by n cells.
Grid unit_square(int n) { return { n, n, 1.0 / n, 0, 0, false }; }

/// The fraction of each cell in which `inside` holds, from 16 x 16 points.
template <class Inside>
Values painted(const Grid& grid, Inside&& inside)
{
	Values fraction = grid.zeros();
	grid.for_cells([&](int i, int j, std::size_t c) {
		int hits = 0;
		for (int k = 0; k < 256; ++k)
			hits += inside(
				grid.low_x + (i + (k % 16 + 0.5) / 16) * grid.spacing, grid.low_y + (j + (k / 16 + 0.5) / 16) * grid.spacing);
		fraction[c] = hits / 256.0;
	});
	return fraction;
}

/// Face velocities with zero divergence within round-off: differences of a stream function at the nodes.
template <class Stream>
FaceValues from_stream(const Grid& grid, Stream&& stream)
{
	FaceValues velocity = zero_faces(grid);
	const double h = grid.spacing;
	for (int j = 0; j <= grid.ny; ++j)
		for (int i = 0; i <= grid.nx; ++i) {
			const double x = grid.face_x(i), y = grid.face_y(j);
			if (j < grid.ny) velocity.x[grid.at(i, j)] = (stream(x, y + h) - stream(x, y)) / h;
			if (i < grid.nx) velocity.y[grid.at(i, j)] = -(stream(x + h, y) - stream(x, y)) / h;
		}
	return velocity;
}

double difference(const Grid& grid, const Values& a, const Values& b)
{
	double sum = 0;
	grid.for_cells([&](int, int, std::size_t c) { sum += std::abs(a[c] - b[c]); });
	return sum * grid.spacing * grid.spacing;
}

struct Carried {
	double shape_error, area_change, least, most;
};

/// The slotted disk of Zalesak (1979) after one turn about the middle of the square, far from the edges, which are at rest.
Carried zalesak(int n, double sharpness)
{
	const Grid grid = unit_square(n);
	const Values start = painted(grid, [](double x, double y) {
		const double dx = x - 0.5, dy = y - 0.75;
		return dx * dx + dy * dy < 0.15 * 0.15 && !(std::abs(dx) < 0.025 && y < 0.85);
	});
	// Rigid rotation within 0.48 of the middle, at rest on the edges.
	const FaceValues velocity = from_stream(grid, [](double x, double y) {
		const double r2 = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5), edge = 0.48 * 0.48;
		return -0.5 * std::min(r2, edge);
	});
	Values fraction = start;
	VolumeOfFluid transport(grid, Domain(grid), sharpness);
	const int steps = int(std::ceil(2 * pi * 0.5 * n / 0.25));
	for (int k = 0; k < steps; ++k) transport.advect(fraction, velocity, 2 * pi / steps, k % 2 == 0);
	const auto [least, most] = std::minmax_element(fraction.begin(), fraction.end());
	return { difference(grid, fraction, start), area_of(grid, fraction) / area_of(grid, start) - 1, *least, *most };
}

/// A disk that a vortex stretches and brings back (Rider, Kothe 1998), with period 2.
Carried vortex(int n)
{
	const Grid grid = unit_square(n);
	const Values start =
		painted(grid, [](double x, double y) { return (x - 0.5) * (x - 0.5) + (y - 0.75) * (y - 0.75) < 0.15 * 0.15; });
	const FaceValues once = from_stream(
		grid, [](double x, double y) { return std::sin(pi * x) * std::sin(pi * x) * std::sin(pi * y) * std::sin(pi * y) / pi; });
	Values fraction = start;
	VolumeOfFluid transport(grid, Domain(grid));
	const double period = 2;
	const int steps = 8 * n;
	for (int k = 0; k < steps; ++k) {
		FaceValues velocity = once;
		const double now = std::cos(pi * (k + 0.5) / steps);
		for (Values* part : { &velocity.x, &velocity.y })
			for (double& value : *part) value *= now;
		transport.advect(fraction, velocity, period / steps, k % 2 == 0);
	}
	const auto [least, most] = std::minmax_element(fraction.begin(), fraction.end());
	return { difference(grid, fraction, start), area_of(grid, fraction) / area_of(grid, start) - 1, *least, *most };
}

constexpr double disk_area = pi * 0.15 * 0.15;

TEST(VolumeOfFluid, slotted_disk_keeps_its_area_and_its_bounds)
{
	const Carried after = zalesak(100, 3.5);
	EXPECT_NEAR(after.area_change, 0, 1e-10);
	EXPECT_GT(after.least, -1e-10);
	EXPECT_LT(after.most, 1 + 1e-10);
}

TEST(VolumeOfFluid, slotted_disk_is_truer_on_a_finer_grid)
{
	const double coarse = zalesak(50, 3.5).shape_error, fine = zalesak(100, 3.5).shape_error;
	EXPECT_LT(fine, coarse / 1.6);
	EXPECT_LT(fine / disk_area, 0.1);
}

TEST(VolumeOfFluid, reversed_vortex_brings_the_disk_back)
{
	const Carried coarse = vortex(32), fine = vortex(64);
	EXPECT_NEAR(coarse.area_change, 0, 1e-10);
	EXPECT_NEAR(fine.area_change, 0, 1e-10);
	EXPECT_LT(fine.shape_error, coarse.shape_error / 1.8);
	EXPECT_LT(fine.shape_error / disk_area, 0.05);
	EXPECT_GT(fine.least, -1e-10);
	EXPECT_LT(fine.most, 1 + 1e-10);
}

TEST(VolumeOfFluid, a_band_in_a_periodic_channel_comes_back_after_a_period)
{
	const Grid grid{ 40, 4, 1, 0, 0, true };
	Values fraction = painted(grid, [](double x, double) { return x > 5 && x < 17.5; });
	const Values start = fraction;
	FaceValues velocity = zero_faces(grid);
	std::fill(velocity.x.begin(), velocity.x.end(), 0.25);
	VolumeOfFluid transport(grid, Domain(grid));
	for (int k = 0; k < 160; ++k) transport.advect(fraction, velocity, 1, k % 2 == 0);
	EXPECT_NEAR(area_of(grid, fraction), area_of(grid, start), 1e-10);
	EXPECT_LT(difference(grid, fraction, start) / 8, 0.5);  // cells per face, of four rows and two faces
}

TEST(VolumeOfFluid, what_a_projection_leaves_of_the_divergence_does_not_change_the_area)
{
	const Grid grid = unit_square(32);
	Values fraction = painted(grid, [](double x, double y) { return (x - 0.4) * (x - 0.4) + (y - 0.5) * (y - 0.5) < 0.04; });
	const double before = area_of(grid, fraction);
	FaceValues velocity = from_stream(grid, [](double x, double y) { return 0.3 * std::sin(pi * x) * std::sin(pi * y); });
	grid.for_x_faces([&](int i, int j, std::size_t f) { velocity.x[f] += 1e-4 * std::sin(3.0 * i + 7.0 * j); });
	VolumeOfFluid transport(grid, Domain(grid));
	for (int k = 0; k < 200; ++k) transport.advect(fraction, velocity, 0.005, k % 2 == 0);
	EXPECT_NEAR(area_of(grid, fraction) / before, 1, 1e-12);
}

TEST(VolumeOfFluid, refuses_a_surface_without_sharpness)
{
	const Grid grid = unit_square(4);
	EXPECT_THROW(VolumeOfFluid(grid, Domain(grid), 0), std::invalid_argument);
}

}  // namespace
}  // namespace graindrive::continuum
