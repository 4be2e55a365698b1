/// What the tests of this room share: random points, and what every surface must fulfil.
#pragma once
#include <gtest/gtest.h>

#include <random>

#include "engines/base/complaint.hpp"
#include "engines/geometry/surface.hpp"

namespace graindrive::geometry {

template <int D>
class RandomPoints {
public:
	explicit RandomPoints(double reach, Vec<D> about = {}, unsigned seed = 5)
		: random_(seed),
		  part_(-1, 1),
		  reach_(reach),
		  about_(about)
	{
	}

	Vec<D> operator()()
	{
		Vec<D> point = about_;
		for (int k = 0; k < D; ++k) point[k] += reach_ * part_(random_);
		return point;
	}
	double number() { return part_(random_); }  ///< in [-1, 1)

private:
	std::mt19937 random_;
	std::uniform_real_distribution<double> part_;
	double reach_;
	Vec<D> about_;
};

/// Central differences of the distance.
template <int D>
Vec<D> slope(const Surface<D>& surface, const Vec<D>& at, double step)
{
	Vec<D> slope;
	for (int k = 0; k < D; ++k) {
		const Vec<D> shift = step * Vec<D>::along(k);
		slope[k] = (surface.nearest(at + shift).distance - surface.nearest(at - shift).distance) / (2 * step);
	}
	return slope;
}

/// Errors that `expect_distance` allows [-]: of the distance over the size, of slopes and normals.
struct Allowed {
	double distance = 1e-13;
	double slope = 1e-7;
};

/// What a distance field is: normals of unit length along its slope, which is 1, and the surface where the normal leads to.
/// Points where the normal turns within a thirtieth of the size are passed over, for the nearest point jumps there, or the difference
/// is not exact enough; returns the share of points that were tested, for the test to see that it is most of them.
template <int D>
double expect_distance(const Surface<D>& surface, double size, Vec<D> about = {}, Allowed allowed = {}, int count = 400)
{
	RandomPoints<D> random(size, about);
	const double step = 1e-5 * size, coordinates = size + largest(about);
	int tested = 0;
	for (int i = 0; i < count; ++i) {
		const Vec<D> at = random();
		const Nearest<D> found = surface.nearest(at);
		EXPECT_NEAR(norm(found.normal), 1, 4e-16 * 4) << i;  // a few round-offs
		bool smooth = true;
		for (int k = 0; k < D; ++k)
			for (const double side : { -step, step })
				smooth = smooth && norm(surface.nearest(at + side * Vec<D>::along(k)).normal - found.normal) < 30 * step / size;
		if (!smooth) continue;
		++tested;
		// Differences of coordinates that are far out have their round-off, over the step.
		EXPECT_LT(norm(slope(surface, at, step) - found.normal), allowed.slope + 1e-15 * coordinates / step) << i;
		const Vec<D> on = at - found.distance * found.normal;
		EXPECT_LT(std::abs(surface.nearest(on).distance), allowed.distance * size + 2e-15 * coordinates) << i;
	}
	return tested / double(count);
}

}  // namespace graindrive::geometry
