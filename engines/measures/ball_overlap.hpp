/// Exact overlap of two balls in closed form: the lens between two circles, or between two spheres.
#pragma once
#include <algorithm>
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive {

/// Area of a disk (D = 2) [m^2] or volume of a sphere (D = 3) [m^3].
template <int D>
Real ball_volume(Real radius)
{
	static_assert(D == 2 || D == 3, "balls have two or three dimensions");
	if constexpr (D == 2) return pi * radius * radius;
	return 4 * pi / 3 * radius * radius * radius;
}

/// Area of the lens of two disks whose centres are a distance apart: two circular segments, r^2 a - x h each.
///
/// Half the angle of a segment comes from atan2 of half the common chord h and the chord's distance x from the centre: near a
/// touch both are small and exact, where arccos would lose half the digits.
inline Real disk_disk_overlap(Real r, Real big_r, Real distance)
{
	if (distance >= r + big_r) return 0;
	const Real smaller = std::min(r, big_r);
	if (distance <= std::abs(big_r - r)) return pi * smaller * smaller;
	const Real product = (-distance + r + big_r) * (distance + r - big_r) * (distance - r + big_r) * (distance + r + big_r);
	const Real h = std::sqrt(std::max(product, Real(0))) / (2 * distance);
	const Real x = (distance * distance + (r - big_r) * (r + big_r)) / (2 * distance), other_x = distance - x;
	return r * r * std::atan2(h, x) - x * h + big_r * big_r * std::atan2(h, other_x) - other_x * h;
}

/// Volume of the lens of two spheres: pi (S - t)^2 (t^2 + 2 S t - 3 D^2)/(12 t), t the distance, S and D sum and difference of the radii.
///
/// Two spherical caps, h^2 (3 r - h) pi/3 each, added. Near a touch (S - t) is small and exact, and so is the volume.
inline Real sphere_sphere_overlap(Real r, Real big_r, Real distance)
{
	const Real sum = r + big_r, difference = big_r - r, t = distance;
	if (t >= sum) return 0;
	if (t <= std::abs(difference)) return ball_volume<3>(std::min(r, big_r));
	return pi * (sum - t) * (sum - t) * (t * t + 2 * sum * t - 3 * difference * difference) / (12 * t);
}

/// Overlap of two balls: area of two disks (D = 2), volume of two spheres (D = 3).
template <int D>
Real ball_overlap(Real r, Real big_r, Real distance)
{
	if constexpr (D == 2) return disk_disk_overlap(r, big_r, distance);
	return sphere_sphere_overlap(r, big_r, distance);
}

}  // namespace graindrive
