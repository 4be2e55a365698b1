/// Sets up the grid and sorts grains into it (counting sort: stable, linear).
#include "engines/loop/disks/cell_grid.hpp"

#include <algorithm>

namespace graindrive::loop {

namespace {

constexpr int cells_across_strip = 80;  // rows and forces of two columns take some 30 kB

}  // namespace

void CellGrid::lay(const DiskRow* rows, std::uint32_t n_free, const Cell<2>& cell, double reach)
{
	Vec<2> low, high;
	for (std::uint32_t i = 0; i < n_free; ++i)
		for (int k = 0; k < 2; ++k) {
			low[k] = i ? std::min(low[k], rows[i].x[k]) : rows[i].x[k];
			high[k] = i ? std::max(high[k], rows[i].x[k]) : rows[i].x[k];
		}
	const auto along = [&](int k, double r) {
		const bool periodic = cell.periodic[k];
		return GridAxis::over(periodic ? cell.low[k] : low[k], periodic ? cell.high[k] : high[k], periodic, r, n_free, "xy"[k]);
	};
	GridAxis x = along(0, reach), y = along(1, reach);
	const double crowd = double(x.cells) * y.cells / (4.0 * n_free + 100);  // a far grain must not cost memory
	if (crowd > 1) {
		if (!cell.periodic[0]) x = along(0, reach * crowd);
		if (!cell.periodic[1]) y = along(1, reach * crowd);
	}
	fast_is_x = x.length < y.length;
	slow = fast_is_x ? y : x;
	fast = fast_is_x ? x : y;
	const int strips_wanted = (fast.cells + cells_across_strip - 1) / cells_across_strip;
	strip_height = (fast.cells + strips_wanted - 1) / strips_wanted;
}

void CellGrid::sort(const DiskRow* rows, std::uint32_t n_free, std::vector<std::uint32_t>& order)
{
	static thread_local std::vector<std::uint32_t> cell_of;
	cell_of.resize(n_free);
	order.resize(n_free);
	start.assign(std::size_t(strips()) * (slow.cells + 2) * stride() + 2, 0);
	for (std::uint32_t i = 0; i < n_free; ++i) {
		cell_of[i] = index(slow.cell(slow_of(rows[i].x)), fast.cell(fast_of(rows[i].x)));
		++start[cell_of[i] + 2];
	}
	for (std::size_t c = 2; c < start.size(); ++c) start[c] += start[c - 1];
	for (std::uint32_t i = 0; i < n_free; ++i) order[start[cell_of[i] + 1]++] = i;
}

}  // namespace graindrive::loop
