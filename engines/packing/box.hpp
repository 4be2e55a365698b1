/// `Box`, the rectangle that a packing fills, and `CellGrid`, which finds the disks near a point of it.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engines/base/real.hpp"

namespace graindrive::packing {

using Points = std::vector<Vector2r>;

struct Box {
	Real x_min, x_max, y_min, y_max;  ///< [length]
	bool periodic_x;                  ///< the sides at x_min and x_max are one line

	Real width() const { return x_max - x_min; }
	Real height() const { return y_max - y_min; }

	/// From one point to another; across the periodic side if that is nearer.
	Vector2r between(const Vector2r& from, const Vector2r& to) const
	{
		Vector2r way = to - from;
		if (periodic_x) way.x() -= width() * std::round(way.x() / width());
		return way;
	}
};

/// @throws std::invalid_argument unless the sides are finite and in order
void require_box(const Box& box);

/// @throws std::invalid_argument naming the first disk whose radius or, if `centres` is not empty, centre is no usable number
void require_disks(const std::vector<Real>& radii, const Points& centres, const char* role);

/// Disks sorted into square cells at least `reach` wide, so that whatever is nearer than `reach` lies in a cell or beside it.
/// Points outside the box belong to its outermost cells.
class CellGrid {
public:
	CellGrid(const Box& box, Real reach, std::size_t expected);

	void add(std::size_t disk, const Vector2r& centre);

	/// Calls visit(disk) for the disks in the cell of `centre` and the eight around it, until one call answers true.
	template <class Visit>
	bool any_near(const Vector2r& centre, Visit visit) const
	{
		const long column = column_of(centre.x()), row = row_of(centre.y());
		for (long r = std::max(row - 1, 0L); r <= std::min(row + 1, rows_ - 1); ++r)
			for (const long c : columns_around(column))
				if (c >= 0)
					for (long disk = first_[r * columns_ + c]; disk >= 0; disk = next_[disk])
						if (visit(static_cast<std::size_t>(disk))) return true;
		return false;
	}

private:
	struct Three {
		long column[3];  // -1: none
		const long* begin() const { return column; }
		const long* end() const { return column + 3; }
	};

	long column_of(Real x) const;
	long row_of(Real y) const;
	Three columns_around(long column) const;

	Box box_;
	long columns_, rows_;
	std::vector<long> first_, next_;  // linked lists: first disk of a cell, next of a disk; -1 ends
};

}  // namespace graindrive::packing
