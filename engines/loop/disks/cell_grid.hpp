/// Cells that sort free grains along the shorter side of the box, so that neighbours in space are neighbours in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "engines/loop/disks/disk_row.hpp"
#include "engines/loop/grid_axis.hpp"
#include "engines/loop/scene.hpp"

namespace graindrive::loop {

/// Cells carry an empty border on both sides, so that looking one cell ahead needs no test.
struct CellGrid {
	GridAxis slow, fast;
	bool fast_is_x = false;
	std::vector<std::uint32_t> start;  ///< first grain of each cell, one entry more than cells

	int strip_height = 1;  ///< cells of a strip: memory runs along strips, so that a strip's width of rows fits the nearest cache

	int strips() const { return (fast.cells + strip_height - 1) / strip_height; }
	int stride() const { return strip_height + 2; }
	int index(int s, int f) const { return ((f / strip_height) * (slow.cells + 2) + s + 1) * stride() + f % strip_height + 1; }
	double slow_of(const Vec<2>& at) const { return fast_is_x ? at[1] : at[0]; }
	double fast_of(const Vec<2>& at) const { return fast_is_x ? at[0] : at[1]; }

	/// Lays the grid over the free grains; cells are at least `reach` wide.
	/// @throws std::invalid_argument where a periodic side is shorter than three cells
	void lay(const DiskRow* rows, std::uint32_t n_free, const Cell<2>& cell, double reach);

	/// Order in which the free grains should lie in memory: order[new place] = old place. Fills `start`.
	void sort(const DiskRow* rows, std::uint32_t n_free, std::vector<std::uint32_t>& order);
};

}  // namespace graindrive::loop
