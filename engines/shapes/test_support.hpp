/// What the tests of outlines share: star-shaped polygons from a seed.
#pragma once
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "engines/base/complaint.hpp"
#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// A polygon of 5 to 24 corners about the origin, at radii between 3 and 6: convex and reflex corners, never crossing.
inline Points star(unsigned seed)
{
	std::mt19937_64 random(seed);
	const auto unit = [&] { return (random() >> 11) * 0x1p-53; };
	const int n = 5 + static_cast<int>(20 * unit());
	Points corners;
	for (int i = 0; i < n; ++i) {
		const Real angle = 2 * pi * (i + 0.8 * unit()) / n, radius = 3 + 3 * unit();
		corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
	}
	return corners;
}

}  // namespace graindrive::shapes
