/// Lays the grid and sorts grains into it (counting sort: stable, linear).
#include "engines/loop/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace graindrive::loop {

namespace {

constexpr int cells_needed_when_periodic = 3;  // fewer, and a pair would be met through two of its images

constexpr int cells_across_strip = 80;  // two columns of rows and forces: some 30 kB

GridAxis axis(double low, double high, bool periodic, double reach, std::uint32_t n, const char* name)
{
	GridAxis a;
	a.low = low;
	a.length = high - low;
	a.periodic = periodic;
	a.cells = std::max(1, static_cast<int>(std::min(a.length / reach, 1e4 + n)));
	if (periodic && a.cells < cells_needed_when_periodic) {
		std::ostringstream message;
		message << "a periodic box must be at least " << cells_needed_when_periodic * reach << " m long in " << name
				<< " (three of the largest free grains, with skin), got " << a.length << " m; lengthen it";
		throw std::invalid_argument(message.str());
	}
	a.per_length = a.length > 0 ? a.cells / a.length : 0;
	return a;
}

}  // namespace

int GridAxis::cell(double at) const { return std::clamp(static_cast<int>((at - low) * per_length), 0, cells - 1); }

void CellGrid::lay(const GrainRow* rows, std::uint32_t n_free, const Box& box, double reach)
{
	double x_low = 0, x_high = 0, y_low = 0, y_high = 0;
	for (std::uint32_t i = 0; i < n_free; ++i) {
		x_low = i ? std::min(x_low, rows[i].x) : rows[i].x;
		x_high = i ? std::max(x_high, rows[i].x) : rows[i].x;
		y_low = i ? std::min(y_low, rows[i].y) : rows[i].y;
		y_high = i ? std::max(y_high, rows[i].y) : rows[i].y;
	}
	const auto along_x = [&](double r) {
		return box.periodic_x ? axis(box.x_low, box.x_high, true, r, n_free, "x") : axis(x_low, x_high, false, r, n_free, "x");
	};
	const auto along_y = [&](double r) {
		return box.periodic_y ? axis(box.y_low, box.y_high, true, r, n_free, "y") : axis(y_low, y_high, false, r, n_free, "y");
	};
	GridAxis x = along_x(reach), y = along_y(reach);
	const double crowd = double(x.cells) * y.cells / (4.0 * n_free + 100);  // a stray grain must not cost memory
	if (crowd > 1) {
		if (!box.periodic_x) x = along_x(reach * crowd);
		if (!box.periodic_y) y = along_y(reach * crowd);
	}
	fast_is_x = x.length < y.length;
	slow = fast_is_x ? y : x;
	fast = fast_is_x ? x : y;
	const int strips_wanted = (fast.cells + cells_across_strip - 1) / cells_across_strip;
	strip_height = (fast.cells + strips_wanted - 1) / strips_wanted;
}

void CellGrid::sort(const GrainRow* rows, std::uint32_t n_free, std::vector<std::uint32_t>& order)
{
	static thread_local std::vector<std::uint32_t> cell_of;
	cell_of.resize(n_free);
	order.resize(n_free);
	start.assign(std::size_t(strips()) * (slow.cells + 2) * stride() + 2, 0);
	for (std::uint32_t i = 0; i < n_free; ++i) {
		cell_of[i] = index(slow.cell(slow_of(rows[i].x, rows[i].y)), fast.cell(fast_of(rows[i].x, rows[i].y)));
		++start[cell_of[i] + 2];
	}
	for (std::size_t c = 2; c < start.size(); ++c) start[c] += start[c - 1];
	for (std::uint32_t i = 0; i < n_free; ++i) order[start[cell_of[i] + 1]++] = i;
}

}  // namespace graindrive::loop
