/// Divides one axis of a grid into cells.
#include "engines/loop/grid_axis.hpp"

#include <algorithm>

#include "engines/loop/guards.hpp"

namespace graindrive::loop {

namespace {

constexpr int cells_needed_when_periodic = 3;  // with fewer a pair would be found through two of its images

}  // namespace

GridAxis GridAxis::over(double low, double high, bool periodic, double reach, std::uint32_t grains, char name)
{
	GridAxis a;
	a.low = low;
	a.length = high - low;
	a.periodic = periodic;
	a.cells = std::max(1, static_cast<int>(std::min(a.length / reach, 1e4 + grains)));
	if (periodic && a.cells < cells_needed_when_periodic)
		throw std::invalid_argument(sentence("a periodic box must be at least ", cells_needed_when_periodic * reach,
			" m long in ", name, " (three of the largest free grains, with skin), got ", a.length, " m; lengthen it"));
	a.per_length = a.length > 0 ? a.cells / a.length : 0;
	return a;
}

int GridAxis::cell(double at) const { return std::clamp(static_cast<int>((at - low) * per_length), 0, cells - 1); }

}  // namespace graindrive::loop
