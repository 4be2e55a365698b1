/// The grid of a field: square bins with a point in the middle of each, and the periodic images that its window sees.
#pragma once
#include <algorithm>
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive {

/// Bins of one size from `low` on; bin (i, j) has its place j nx + i. Positions are relative to the window's origin.
struct FieldGrid {
	Vector2r low = Vector2r::Zero();  ///< lower left corner of the window [m]
	Real spacing = 1;                 ///< [m]
	int nx = 1, ny = 1;

	int size() const { return nx * ny; }
	Vector2r high() const { return low + spacing * Vector2r(nx, ny); }
	Vector2r corner(int i, int j) const { return low + spacing * Vector2r(i, j); }
	Vector2r centre(int i, int j) const { return low + spacing * Vector2r(i + Real(0.5), j + Real(0.5)); }

	/// Calls visit(i, j) for the bins that the box from `from` to `to` meets, row by row.
	template <class Visit>
	void visit_bins(const Vector2r& from, const Vector2r& to, Visit&& visit) const
	{
		const auto bin = [&](Real x, int axis, int last) {
			return int(std::clamp(std::floor((x - low[axis]) / spacing), Real(-1), Real(last + 1)));
		};
		const int i_end = std::min(bin(to[0], 0, nx - 1), nx - 1), j_end = std::min(bin(to[1], 1, ny - 1), ny - 1);
		for (int j = std::max(bin(from[1], 1, ny - 1), 0); j <= j_end; ++j)
			for (int i = std::max(bin(from[0], 0, nx - 1), 0); i <= i_end; ++i) visit(i, j);
	}

	/// Calls visit(shift) for every multiple of the periods that brings the box centre +- reach into the window.
	template <class Visit>
	void visit_images(const Vector2r& centre, const Vector2r& reach, const Vector2r& periods, Visit&& visit) const
	{
		const Vector2r top = high();
		Real first[2], last[2];
		for (int k = 0; k < 2; ++k) {
			const Real least = low[k] - reach[k] - centre[k], most = top[k] + reach[k] - centre[k];
			first[k] = periods[k] > 0 ? std::ceil(least / periods[k]) : least <= 0 ? 0 : 1;
			last[k] = periods[k] > 0 ? std::floor(most / periods[k]) : most >= 0 ? 0 : -1;
		}
		for (Real m = first[1]; m <= last[1]; ++m)
			for (Real n = first[0]; n <= last[0]; ++n) visit(Vector2r(n * periods[0], m * periods[1]));
	}
};

}  // namespace graindrive
