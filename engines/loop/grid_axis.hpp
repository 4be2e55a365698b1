/// One direction of a grid of cells.
#pragma once
#include <cstdint>

namespace graindrive::loop {

struct GridAxis {
	double low = 0, length = 0;  ///< [m]
	int cells = 1;               ///< without a border
	double per_length = 0;       ///< cells per length [1/m]
	bool periodic = false;

	int cell(double at) const;  ///< 0 … cells - 1, nearest for positions outside
	/// Cells at least `reach` wide from low to high, not many more than there are grains.
	/// @throws std::invalid_argument where a periodic side is shorter than three cells
	static GridAxis over(double low, double high, bool periodic, double reach, std::uint32_t grains, char name);
};

}  // namespace graindrive::loop
