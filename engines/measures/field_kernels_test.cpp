/// Every kernel distributes exactly the whole area of a grain and the whole length of a line.
#include "engines/measures/field_kernels.hpp"

#include <gtest/gtest.h>

namespace graindrive {
namespace {

const Vector2r places[] = { { 0, 0 }, { 0.013, -0.37 }, { -0.5, 0.21 }, { 0.3, 0.3 } };

FieldGrid<2> grid_with(Real spacing)
{
	const int n = int(std::round(12 / spacing));
	return { { -6, -6 }, spacing, n, n };
}

template <class Kernel>
Real area_given(const Kernel& kernel, const FieldGrid<2>& grid, const Vector2r& at, Real radius)
{
	Real sum = 0;
	kernel.grain(grid, at, radius, [&](int, Real share, const Vector2r&) { sum += share; });
	return sum * grid.spacing * grid.spacing;
}

template <class Kernel>
Real line_given(const Kernel& kernel, const FieldGrid<2>& grid, const Vector2r& from, const Vector2r& branch)
{
	Real sum = 0;
	kernel.line(grid, from, branch, [&](int, Real share) { sum += share; });
	return sum * grid.spacing * grid.spacing;
}

TEST(FieldKernels, DiskBinsGiveTheWholeGrain)
{
	for (const Real spacing : { 0.05, 0.4, 3.0 })
		for (const Vector2r& at : places) {
			EXPECT_NEAR(area_given(DiskBinKernel{}, grid_with(spacing), at, 0.5), pi / 4, 1e-13);
			EXPECT_NEAR(line_given(DiskBinKernel{}, grid_with(spacing), at, { 0.4, -0.83 }), 1, 1e-13);
		}
}

TEST(FieldKernels, CutGaussianGivesTheWholeGrain)
{
	for (const Vector2r& at : places) {
		// The kernel ends with a step of e^-9 of its peak, so the sum's error is at most this step along its rim, 2 pi 3w, times
		// half a spacing.
		const Real step = std::exp(-9) / pi * 2 * pi * 3 * 0.05 / 2;
		EXPECT_NEAR(area_given(GaussianKernel<2>{ 1, 3 }, grid_with(0.05), at, 0.5), pi / 4, pi / 4 * step);
		EXPECT_NEAR(line_given(GaussianKernel<2>{ 1, 3 }, grid_with(0.05), at, { 0.4, -0.83 }), 1, step);
		// With a step of e^-25 the error is negligible (Poisson summation: 4 exp(-(pi w/spacing)^2)).
		EXPECT_NEAR(area_given(GaussianKernel<2>{ 0.8, 5 }, grid_with(0.4), at, 0.5), pi / 4, 1e-11);
		EXPECT_NEAR(line_given(GaussianKernel<2>{ 0.8, 5 }, grid_with(0.4), at, { 0.4, -0.83 }), 1, 2e-11);
	}
}

TEST(FieldKernels, CutGaussianIntegratesToOneInClosedForm)
{
	for (const Real c : { 0.7, 2.0, 3.0 }) {
		const GaussianKernel<2> kernel{ 1.3, c };
		Real sum = 0;
		const int n = 100000;
		for (int k = 0; k < n; ++k) {
			const Real step = kernel.radius() / n, r = (k + 0.5) * step;
			sum += 2 * pi * r * step * kernel.norm() * std::exp(-r * r / (1.3 * 1.3));
		}
		EXPECT_NEAR(sum, 1, 1e-9);
	}
}

TEST(FieldKernels, SpheresGiveTheWholeGrain)
{
	for (const Vector2r& at : places) {
		EXPECT_NEAR(area_given(SphereKernel<2>{ 1 }, grid_with(0.025), at, 0.5), pi / 4, 1e-5);
		// The kernel is 1 inside a disk and 0 outside; counted on a grid (Gauss's circle problem), its error is a thousandth of
		// the area.
		EXPECT_NEAR(line_given(SphereKernel<2>{ 1 }, grid_with(0.025), at, { 0.4, -0.83 }), 1, 1e-3);
	}
}

TEST(FieldKernels, OnlyTheWindowIsWrittenTo)
{
	const FieldGrid<2> small{ { 0, 0 }, 0.1, 4, 3 };
	const auto inside = [&](int point, auto&&...) { ASSERT_TRUE(point >= 0 && point < small.size()); };
	for (const Vector2r& at : { Vector2r(0, 0), Vector2r(0.4, 0.3), Vector2r(-0.45, 0.1), Vector2r(30, -2) }) {
		DiskBinKernel{}.grain(small, at, 0.5, inside);
		GaussianKernel<2>{ 1, 3 }.grain(small, at, 0.5, inside);
		SphereKernel<2>{ 1 }.line(small, at, { 0.4, 0.9 }, inside);
		DiskBinKernel{}.line(small, at, { 0.4, 0.9 }, inside);
	}
}

TEST(FieldGrid, ImagesOfAPeriodicBox)
{
	const FieldGrid<2> window{ { -2, -2 }, 1, 4, 4 };
	const auto images = [&](const Vector2r& at, const Vector2r& periods) {
		int found = 0;
		window.visit_images(at, { 0.5, 0.5 }, periods, [&](const Vector2r& shift) {
			const Vector2r there = at + shift;
			EXPECT_LE(there.cwiseAbs().maxCoeff(), 2.5);
			++found;
		});
		return found;
	};
	EXPECT_EQ(images({ 0, 0 }, { 0, 0 }), 1);
	EXPECT_EQ(images({ 2.6, 0 }, { 0, 0 }), 0);
	EXPECT_EQ(images({ 701.2, 0 }, { 7, 0 }), 1);  // however many windings away
	EXPECT_EQ(images({ 1.9, 0 }, { 4, 0 }), 2);    // cut by the periodic side: both parts
	EXPECT_EQ(images({ 1.9, -1.9 }, { 4, 4 }), 4);
	EXPECT_EQ(images({ 0.1, 0 }, { 1.5, 0 }), 3);  // a window larger than the box contains several images of a grain
}

}  // namespace
}  // namespace graindrive
