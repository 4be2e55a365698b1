/// Cells that sort free spheres so that neighbours in space are neighbours in memory: slabs along the longest side, within tiles of the
/// other two that are small enough for a cache.
#pragma once
#include <cstdint>
#include <vector>

#include "engines/geometry/cell.hpp"
#include "engines/loop/grid_axis.hpp"
#include "engines/loop/spheres/sphere_row.hpp"

namespace graindrive::loop {

/// Where a cell lies: slow, middle and fast.
struct CellPlace {
	int s, m, f;
};

struct SphereGrid {
	GridAxis along[3];                 ///< slow, middle, fast
	int axis[3] = { 0, 1, 2 };         ///< which of x, y, z they are
	int tile_m = 1, tile_f = 1;        ///< cells of a tile
	std::vector<std::uint32_t> start;  ///< first sphere of each cell, one entry more than cells

	int tiles_m() const { return (along[1].cells + tile_m - 1) / tile_m; }
	int tiles_f() const { return (along[2].cells + tile_f - 1) / tile_f; }
	std::size_t cells() const { return std::size_t(tiles_m()) * tiles_f() * along[0].cells * tile_m * tile_f; }
	/// Memory runs through a tile's slabs, rows of a slab, and cells of a row.
	std::uint32_t index(int s, int m, int f) const
	{
		const std::uint32_t tile = (m / tile_m) * tiles_f() + f / tile_f;
		return ((tile * along[0].cells + s) * tile_m + m % tile_m) * tile_f + f % tile_f;
	}
	CellPlace place(std::uint32_t cell) const;  ///< may lie beyond the grid's end, where a tile does
	std::uint32_t cell_of(const geometry::Vec<3>& x) const
	{
		return index(along[0].cell(x[axis[0]]), along[1].cell(x[axis[1]]), along[2].cell(x[axis[2]]));
	}

	/// Lays the grid over the free spheres; cells are at least `reach` wide.
	/// @throws std::invalid_argument where a periodic side is shorter than three cells
	void lay(const SphereRow* rows, std::uint32_t n_free, const geometry::Cell<3>& cell, double reach);

	/// Order in which the free spheres should lie in memory: order[new place] = old place. Fills `start`.
	void sort(const SphereRow* rows, std::uint32_t n_free, std::vector<std::uint32_t>& order);

private:
	std::vector<std::uint32_t> cell_of_row;
};

}  // namespace graindrive::loop
