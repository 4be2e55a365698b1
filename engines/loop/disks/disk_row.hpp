/// What the loop over disks keeps in memory: one 64-byte row per grain, and for every pair a link, a tangential spring and a force.
///
/// Every changing quantity that a contact needs is a sum or a difference of two rows, so a kernel subtracts whole rows and transposes once.
#pragma once
#include <cstdint>

#include "engines/geometry/vec.hpp"
#include "engines/loop/big_pages.hpp"

namespace graindrive::loop {

struct alignas(64) DiskRow {
	geometry::Vec<2> x;   ///< centre [m]; not wrapped between two searches for neighbours
	geometry::Vec<2> v;   ///< velocity, half a step behind the position [m/s]
	double radius;        ///< [m]
	double surface;       ///< radius * spin [m/s], counter-clockwise positive
	double inverse_mass;  ///< 1/m [1/kg]; 0 stands for an infinite mass
	double unused;
};
static_assert(sizeof(DiskRow) == 64, "one row, one cache line");

/// Force of one pair on its owner; on the partner x and y change sign, the friction does not.
template <class P>
struct alignas(4 * sizeof(P)) PairForce {
	P x, y;      ///< [N]
	P friction;  ///< F_t along t = z x n [N]: its torque on either grain is radius * F_t
	P normal;  ///< F_n, > 0 repels [N]; with a law that acts at the contact point overlap/2 F_t [N m], by which torques are less
};

/// Where a grain finds its pair forces, in bytes from the first: three pairs it owns, then three it is partner in. 0 is no pair.
/// A grain with more has its surplus folded into one extra force beforehand, so that summing needs no branch.
struct ForceSlots {
	static constexpr int owned = 3, partnered = 3;
	std::uint32_t at[owned + partnered];
};

}  // namespace graindrive::loop
