/// Rows of grains in memory, by dimension, and what of them the loop asks whatever the dimension.
#pragma once
#include <type_traits>

#include "engines/loop/disks/disk_row.hpp"
#include "engines/loop/spheres/sphere_row.hpp"

namespace graindrive::loop {

/// Centre `x` [m], velocity `v` half a step behind [m/s], `radius` [m], `surface` = radius * spin [m/s].
template <int D>
using Row = std::conditional_t<D == 2, DiskRow, SphereRow>;

/// Rows lie on cache lines, many of them in large pages.
template <int D>
using RowVector = StreamedVector<Row<D>>;

}  // namespace graindrive::loop
