/// Sets up the grid and sorts spheres into it (counting sort: stable, linear).
#include "engines/loop/spheres/sphere_grid.hpp"

#include <algorithm>

namespace graindrive::loop {

namespace {

constexpr int cells_across_tile = 16;  // the rows of 16 x 16 cells take some 50 kB

int tile_size(int cells)
{
	const int tiles = (cells + cells_across_tile - 1) / cells_across_tile;
	return (cells + tiles - 1) / tiles;
}

}  // namespace

CellPlace SphereGrid::place(std::uint32_t cell) const
{
	const int f = cell % tile_f, m = cell / tile_f % tile_m, s = cell / (tile_f * tile_m) % along[0].cells;
	const int tile = cell / (tile_f * tile_m * along[0].cells);
	return { s, tile / tiles_f() * tile_m + m, tile % tiles_f() * tile_f + f };
}

void SphereGrid::lay(const SphereRow* rows, std::uint32_t n_free, const geometry::Cell<3>& cell, double reach)
{
	double low[3], high[3];
	for (int k = 0; k < 3; ++k) {
		low[k] = cell.low[k], high[k] = cell.high[k];
		if (cell.periodic[k]) continue;
		low[k] = high[k] = n_free ? rows[0].x[k] : 0;
		for (std::uint32_t i = 0; i < n_free; ++i)
			low[k] = std::min(low[k], rows[i].x[k]), high[k] = std::max(high[k], rows[i].x[k]);
	}
	std::stable_sort(axis, axis + 3, [&](int a, int b) { return high[a] - low[a] > high[b] - low[b]; });
	double stretch = 1;  // cells grow, so that one sphere far from the others does not cost memory
	const double enough = 4.0 * n_free + 100;
	for (int attempt = 0; attempt < 60; ++attempt, stretch *= 1.3) {
		for (int q = 0; q < 3; ++q) {
			const int k = axis[q];
			along[q] =
				GridAxis::over(low[k], high[k], cell.periodic[k], reach * (cell.periodic[k] ? 1 : stretch), n_free, "xyz"[k]);
		}
		if (double(along[0].cells) * along[1].cells * along[2].cells <= enough) break;
	}
	tile_m = tile_size(along[1].cells);
	tile_f = tile_size(along[2].cells);
}

void SphereGrid::sort(const SphereRow* rows, std::uint32_t n_free, std::vector<std::uint32_t>& order)
{
	cell_of_row.resize(n_free);
	order.resize(n_free);
	start.assign(cells() + 2, 0);
	for (std::uint32_t i = 0; i < n_free; ++i) ++start[(cell_of_row[i] = cell_of(rows[i].x)) + 2];
	for (std::size_t c = 2; c < start.size(); ++c) start[c] += start[c - 1];
	for (std::uint32_t i = 0; i < n_free; ++i) order[start[cell_of_row[i] + 1]++] = i;
}

}  // namespace graindrive::loop
