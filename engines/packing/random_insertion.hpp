/// Random sequential insertion of disks into a box, and the check that a packing has no overlaps.
#pragma once
#include <cstdint>

#include "engines/packing/box.hpp"

namespace graindrive::packing {

/// Disks that are already there: an intruder, walls of frozen grains.
struct Obstacles {
	Points centres;           ///< [length]
	std::vector<Real> radii;  ///< [length]
};

/// Radii of n disks with diameters uniform in [d_min, d_max); the same for a seed on every machine.
/// @throws std::invalid_argument unless 0 < d_min <= d_max and both are finite
std::vector<Real> uniform_radii(std::size_t n, Real d_min, Real d_max, std::uint64_t seed);

/// Places for disks of the given radii, without overlaps, whole inside the box (across the sides if periodic).
///
/// Largest first, each at the first of its random places that is free (random sequential addition; equal disks jam at an area
/// fraction of 0.547: Feder, J. Theor. Biol. 87, 237 (1980), and 0.5 is practical). The same for a seed on every machine.
/// Centres come in the order of `radii`.
/// @throws std::invalid_argument for bad input, and if a disk finds no place in `attempts` trials, with what was reached
Points random_insertion(
	const Box& box, const std::vector<Real>& radii, const Obstacles& obstacles, std::uint64_t seed, long attempts = 100'000);

/// The deepest overlap of a packing.
struct Overlap {
	Real relative = 0;  ///< (R_i + R_j - r_ij) / min(R_i, R_j) [-]; 0 if no two disks overlap
	std::size_t first = 0, second = 0;
	bool found = false;
};

/// @throws std::invalid_argument for bad input
Overlap overlaps(const Box& box, const Points& centres, const std::vector<Real>& radii);

}  // namespace graindrive::packing
