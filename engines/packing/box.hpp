/// `Box`, the rectangle or cuboid that a packing fills, and `CellGrid`, which finds the grains near a point of it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engines/base/real.hpp"

namespace graindrive::packing {

template <int D>
using Point = Eigen::Matrix<Real, D, 1>;
template <int D>
using Points = std::vector<Point<D>>;

template <int D>
struct Box {
	std::array<Real, D> low, high;  ///< [length]
	std::array<bool, D> periodic;   ///< along an axis: its two sides are one

	Real side(int axis) const { return high[axis] - low[axis]; }

	/// Area [length^2] or volume [length^3].
	Real extent() const
	{
		Real product = 1;
		for (int k = 0; k < D; ++k) product *= side(k);
		return product;
	}

	/// From one point to another; across periodic sides if that is nearer.
	Point<D> between(const Point<D>& from, const Point<D>& to) const
	{
		Point<D> way = to - from;
		for (int k = 0; k < D; ++k)
			if (periodic[k]) way[k] -= side(k) * std::round(way[k] / side(k));
		return way;
	}
};

/// A box in the plane whose left and right sides may be one.
inline Box<2> rectangle(Real x_min, Real x_max, Real y_min, Real y_max, bool periodic_x)
{
	return { { x_min, y_min }, { x_max, y_max }, { periodic_x, false } };
}

/// @throws std::invalid_argument unless the sides are finite and in order
template <int D>
void require_box(const Box<D>& box);

/// @throws std::invalid_argument naming the first grain whose radius or, if `centres` is not empty, centre is no usable number
template <int D>
void require_grains(const std::vector<Real>& radii, const Points<D>& centres, const char* role);

/// Grains sorted into square or cubic cells at least `reach` wide, so that whatever is nearer than `reach` lies in a cell or
/// beside it. Points outside the box belong to its outermost cells.
template <int D>
class CellGrid {
public:
	CellGrid(const Box<D>& box, Real reach, std::size_t expected);

	void add(std::size_t grain, const Point<D>& centre);

	/// Calls visit(grain) for the grains in the cell of `centre` and those around it, until one call returns true.
	template <class Visit>
	bool any_near(const Point<D>& centre, Visit visit) const
	{
		std::array<Three, D> around;
		for (int k = 0; k < D; ++k) around[k] = beside(k, place(k, centre[k]));
		return any_in<D - 1>(around, 0, visit);
	}

private:
	using Three = std::array<long, 3>;  // places along an axis; -1: none

	/// Goes through the axes from the last to the first; `row` is the place in the axes that are fixed already.
	template <int axis, class Visit>
	bool any_in(const std::array<Three, D>& around, long row, Visit& visit) const
	{
		for (const long at : around[axis]) {
			if (at < 0) continue;
			const long cell = row * cells_[axis] + at;
			if constexpr (axis > 0) {
				if (any_in<axis - 1>(around, cell, visit)) return true;
			} else {
				for (long grain = first_[cell]; grain >= 0; grain = next_[grain])
					if (visit(static_cast<std::size_t>(grain))) return true;
			}
		}
		return false;
	}

	long place(int axis, Real coordinate) const;
	Three beside(int axis, long place) const;

	Box<D> box_;
	std::array<long, D> cells_;
	std::vector<long> first_, next_;  // linked lists: first grain of a cell, next of a grain; -1 ends
};

}  // namespace graindrive::packing
