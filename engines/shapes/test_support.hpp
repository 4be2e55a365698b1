/// What the tests of outlines share: star-shaped polygons from a seed.
#pragma once
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "engines/base/complaint.hpp"
#include "engines/shapes/edge_index.hpp"
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

/// Distance from a point to the nearest edge of the outline.
inline Real distance_to(const Outline& outline, const Vector2r& point)
{
	if (outline.is_disk()) return std::abs(outline.disk_radius() - (point - outline.origin()).norm());
	const Vector2r seen = point - outline.origin();
	const Points& v = outline.corners();
	Real nearest = 1e300;
	for (std::size_t i = 0; i < v.size(); ++i)
		nearest = std::min(nearest, distance_to_segment(seen, v[i], v[(i + 1) % v.size()]));
	return nearest;
}

}  // namespace graindrive::shapes
