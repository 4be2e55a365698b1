/// Cells that sort free grains along the shorter side of the box, so that neighbours in space are neighbours in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "engines/loop/scene.hpp"

namespace graindrive::loop {

/// One direction of the grid. Cells carry an empty border on both sides, so that looking one cell ahead needs no test.
struct GridAxis {
	double low = 0, length = 0;  ///< [m]
	int cells = 1;               ///< without the border
	double per_length = 0;       ///< cells per length [1/m]
	bool periodic = false;

	int cell(double at) const;  ///< 0 … cells - 1, nearest for positions outside
};

struct CellGrid {
	GridAxis slow, fast;
	bool fast_is_x = false;
	std::vector<std::uint32_t> start;  ///< first grain of each cell, one entry more than cells

	int strip_height = 1;  ///< cells of a strip: memory runs along strips, so that a strip's width of rows fits the nearest cache

	int strips() const { return (fast.cells + strip_height - 1) / strip_height; }
	int stride() const { return strip_height + 2; }
	int index(int s, int f) const { return ((f / strip_height) * (slow.cells + 2) + s + 1) * stride() + f % strip_height + 1; }
	double slow_of(double x, double y) const { return fast_is_x ? y : x; }
	double fast_of(double x, double y) const { return fast_is_x ? x : y; }

	/// Lays the grid over the free grains; cells are at least `reach` wide.
	/// @throws std::invalid_argument where a periodic side is shorter than three cells
	void lay(const GrainRow* rows, std::uint32_t n_free, const Box& box, double reach);

	/// Order in which the free grains should lie in memory: order[new place] = old place. Fills `start`.
	void sort(const GrainRow* rows, std::uint32_t n_free, std::vector<std::uint32_t>& order);
};

}  // namespace graindrive::loop
