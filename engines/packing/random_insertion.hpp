/// Random sequential insertion of disks or spheres into a box, and the check that a packing has no overlaps.
#pragma once
#include <cstdint>
#include <functional>

#include "engines/packing/box.hpp"

namespace graindrive::packing {

/// Grains that are already there: an intruder, walls of frozen grains.
template <int D>
struct Obstacles {
	Points<D> centres;        ///< [length]
	std::vector<Real> radii;  ///< [length]
};

/// Signed distance from a point of the box to a solid that must stay free, > 0 outside of it, to the nearest image where the
/// box is periodic [length]. A grain of radius R is put where the distance is at least R. Empty: nothing.
template <int D>
using KeepOut = std::function<Real(const Point<D>&)>;

/// Radii of n grains with diameters uniform in [d_min, d_max); the same for a seed on every machine.
/// @throws std::invalid_argument unless 0 < d_min <= d_max and both are finite
std::vector<Real> uniform_radii(std::size_t n, Real d_min, Real d_max, std::uint64_t seed);

/// Places for grains of the given radii, without overlaps, whole inside the box (across the sides where they are periodic).
///
/// Largest first, each at the first of its random places that is free (random sequential addition; equal disks jam at an area
/// fraction of 0.547: Feder, J. Theor. Biol. 87, 237 (1980), and 0.5 is practical; equal spheres at a volume fraction of 0.384:
/// Zhang, Torquato, Phys. Rev. E 88, 053312 (2013), and 0.35 is practical). The same for a seed on every machine. Centres come
/// in the order of `radii`. `keep_out` is asked last, once for each place that no other grain takes.
/// @throws std::invalid_argument for bad input, a nan of `keep_out` too, and if a grain finds no place in `attempts` trials,
/// with what was reached
template <int D>
Points<D> random_insertion(const Box<D>& box, const std::vector<Real>& radii, const Obstacles<D>& obstacles, std::uint64_t seed,
	long attempts = 100'000, const KeepOut<D>& keep_out = {});

/// The deepest overlap of a packing.
struct Overlap {
	Real relative = 0;  ///< (R_i + R_j - r_ij) / min(R_i, R_j) [-]; 0 if no two grains overlap
	std::size_t first = 0, second = 0;
	bool found = false;
};

/// @throws std::invalid_argument for bad input
template <int D>
Overlap overlaps(const Box<D>& box, const Points<D>& centres, const std::vector<Real>& radii);

}  // namespace graindrive::packing
