/// What the loop over spheres keeps in memory: one row of two cache lines a sphere, and groups of eight pairs (sixteen in single precision).
///
/// A contact needs differences of positions and velocities and sums of radii and surface speeds: a kernel adds or subtracts whole rows
/// and transposes. Forces are added to the rows of both spheres, in the order of (owner, partner).
#pragma once
#include <cstdint>

#include "engines/geometry/vec.hpp"
#include "engines/loop/processor.hpp"
#include "engines/loop/spheres/row_layout.hpp"

namespace graindrive::loop {

struct alignas(128) SphereRow {
	geometry::Vec<3> x;        ///< centre [m]; not wrapped between two searches for neighbours
	double radius;             ///< [m]
	geometry::Vec<3> v;        ///< velocity, half a step behind the position [m/s]
	geometry::Vec<3> surface;  ///< radius * spin [m/s]
	geometry::Vec<3> force;    ///< sum of the contact forces so far [N]
	geometry::Vec<3> turn;     ///< sum of n x F_t: torque over radius [N]
};
static_assert(sizeof(SphereRow) == 128, "one row, two cache lines");

/// x y z r | vx vy vz and the surface's x | its y and z; forces and turns, from column 10 on, are not read by pairs.
template <>
struct RowLayout<SphereRow> {
	static constexpr int groups = 3, axes = 3, first_force = 10;
	static constexpr int sign[12] = { -1, -1, -1, 1, -1, -1, -1, 1, 1, 1, 1, 1 };
};

/// A few pairs, number by number, as many as the widest pack holds: each number fills a cache line, and lines follow each other in the order
/// in which a step reads them.
template <class P>
struct alignas(64) PairGroup {
	static constexpr std::uint32_t size = 64 / sizeof(P);
	PairLink links[size];
	P spring[3][size];  ///< tangential spring of the owner's surface against the partner's [m]
	P stiffness[size];  ///< the law's constants of the pair, see sphere_terms.hpp
	P damping[size];
};

/// The force of a pair as it is added to the second line of a row: nothing, nothing, F on the owner [N], n x F_t [N].
struct alignas(64) ForceLine {
	double number[8];
};

}  // namespace graindrive::loop
