/// Exact overlap of two disks: the lens between two circles, in closed form.
#pragma once
#include <algorithm>
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive {

/// Area of the lens of two disks whose centres are a distance apart: two circular segments, r^2 a - x h each.
///
/// Half the angle of a segment comes from atan2 of half the common chord h and the chord's distance x from the centre: near a
/// touch both are small and exact, where arccos would lose half the digits. (In three dimensions two caps take their place.)
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

}  // namespace graindrive
