/// Area, centroid and second moment against closed forms, and how they change with shifts, rotations and scaling.
#include "engines/shapes/solid.hpp"

#include <gtest/gtest.h>

#include "engines/shapes/built_in.hpp"
#include "engines/shapes/test_support.hpp"

using namespace graindrive;
using namespace graindrive::shapes;

TEST(Solid, matches_closed_forms)
{
	const Real relative = 1e-14;  // sums of at most a few terms
	EXPECT_NEAR(solid_of(Outline::disk(7)).second_moment, 3.5 * 3.5 / 2, relative * 6);
	EXPECT_NEAR(solid_of(outline_of("square", { 3 })).second_moment, 9.0 / 6, relative * 1.5);
	EXPECT_NEAR(solid_of(outline_of("tall", { 2, 5 })).second_moment, (4.0 + 25.0) / 12, relative * 3);
	EXPECT_NEAR(solid_of(outline_of("triangle", { 4 })).second_moment, 16.0 / 12, relative * 2);
}

TEST(Solid, of_a_concave_shape_is_the_difference_of_two_rectangles)
{
	// A square of side 4 without its upper right quarter.
	const Solid l = solid_of(Outline({ { 0, 0 }, { 4, 0 }, { 4, 2 }, { 2, 2 }, { 2, 4 }, { 0, 4 } }));
	const Real first = (16 * 2 - 4 * 3) / 12.0;                                            // x of the centroid
	const Real polar = 16 * (16.0 / 6 + 8) - 4 * (4.0 / 6 + 18) - 12 * 2 * first * first;  // parallel axes
	EXPECT_NEAR(l.area, 12, 1e-14 * 12);
	EXPECT_NEAR(l.centroid.x(), first, 1e-14);
	EXPECT_NEAR(l.centroid.y(), first, 1e-14);
	EXPECT_NEAR(l.second_moment, polar / 12, 1e-13);
}

TEST(Solid, does_not_depend_on_where_the_shape_stands_or_how_it_is_turned)
{
	for (unsigned seed = 0; seed < 50; ++seed) {
		const Outline shape(star(seed));
		const Vector2r shift(30 - 1.0 * seed, 17);
		const Solid here = solid_of(shape), there = solid_of(shape.turned(0.1 * seed).seen_from(shift));
		EXPECT_NEAR(there.area, here.area, 1e-12 * here.area);  // a shift by 10 extents costs one or two digits
		EXPECT_NEAR(there.second_moment, here.second_moment, 1e-12 * here.second_moment);
		EXPECT_NEAR((there.centroid + shift - Eigen::Rotation2D<Real>(0.1 * seed) * here.centroid).norm(), 0, 1e-12);
	}
}

TEST(Solid, keeps_its_digits_far_from_the_origin)
{
	for (unsigned seed = 0; seed < 20; ++seed) {
		Points near = star(seed), far;
		const Vector2r shift(5e6, -3.5e6);
		for (Vector2r& v : near) {
			far.push_back(v + shift);
			v = far.back() - shift;  // the vertex with the digits that are left at this distance
		}
		const Solid here = solid_of(Outline(near)), there = solid_of(Outline(far));
		EXPECT_NEAR(there.area, here.area, 1e-13 * here.area);
		EXPECT_NEAR(there.second_moment, here.second_moment, 1e-13 * here.second_moment);
		EXPECT_NEAR((there.centroid - shift - here.centroid).norm(), 0, 2e-9);  // the distance of two doubles near 5e6
	}
}

TEST(Solid, of_a_sliver_keeps_its_digits)
{
	const Real length = 1e4, width = 1e-3;
	const Solid solid = solid_of(Outline({ { 0, 0 }, { length, 0 }, { length, width }, { 0, width } }));
	EXPECT_NEAR(solid.area, 10, 1e-13 * 10);
	EXPECT_NEAR(solid.second_moment, (length * length + width * width) / 12, 1e-13 * length * length / 12);
}

TEST(Solid, of_a_polygon_tends_to_the_disk_as_its_corners_grow_in_number)
{
	// The area of an inscribed n-gon is too small by (2/3)(pi/n)^2: 5.1e-5 for the 360 corners with which a disk is drawn.
	const Outline disk = Outline::disk(2);
	EXPECT_NEAR(solid_of(Outline(disk.vertices())).area / pi, 1 - 2.0 / 3 * std::pow(pi / 360, 2), 1e-8);
}
