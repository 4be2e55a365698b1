/// How the kernels of multigrid read an operator and find the neighbours of a cell.
#pragma once
#include "engines/continuum/pressure/multigrid.hpp"

namespace graindrive::continuum {

using Lanes = Pack<double>;

// What a kernel reads of an operator; the finest has no diagonal links.
struct Links {
	const SplitGrid* grid;
	const std::vector<Span>* spans;
	const double *east, *north, *north_east, *north_west, *inverse;
};

inline Links links_of(const FivePoint& a)
{
	return { &a.grid(), &a.spans(), a.east.data(), a.north.data(), nullptr, nullptr, a.inverse_diagonal.data() };
}
inline Links links_of(const NinePoint& a)
{
	return { &a.grid, &a.spans, a.east.data(), a.north.data(), a.north_east.data(), a.north_west.data(),
		a.inverse_diagonal.data() };
}

// Sums of link times neighbour, by kind of neighbour.
struct Neighbours : NeighbourRows {
	std::size_t north_west, north_east, south_west, south_east;
	Neighbours(const SplitGrid& grid, int y, int parity)
		: NeighbourRows(grid, y, parity),
		  north_west(grid.offset(y + 1, 1 - parity) + parity - 1),
		  north_east(north_west + 1),
		  south_west(grid.offset(y - 1, 1 - parity) + parity - 1),
		  south_east(south_west + 1)
	{
	}
	Lanes of_row(const Links& a, const double* u, int k) const
	{
		return pack(a.east + here + k) * pack(u + east + k) + pack(a.east + west + k) * pack(u + west + k);
	}
	Lanes of_column(const Links& a, const double* u, int k) const
	{
		return pack(a.north + here + k) * pack(u + north + k) + pack(a.north + south + k) * pack(u + south + k);
	}
	Lanes of_diagonals(const Links& a, const double* u, int k) const
	{
		return (pack(a.north_east + here + k) * pack(u + north_east + k) +
				   pack(a.north_east + south_west + k) * pack(u + south_west + k)) +
		       (pack(a.north_west + here + k) * pack(u + north_west + k) +
				   pack(a.north_west + south_east + k) * pack(u + south_east + k));
	}
};

enum Kinds { none = 0, row = 1, column = 2, diagonals = 4, all = 7 };

template <int kinds>
Lanes gather(const Neighbours& at, const Links& a, const double* u, int k)
{
	Lanes sum = {};
	if constexpr (kinds & row) sum += at.of_row(a, u, k);
	if constexpr (kinds & column) sum += at.of_column(a, u, k);
	if constexpr (kinds & diagonals) sum += at.of_diagonals(a, u, k);
	return sum;
}

inline bool has_row(const Links& a, int y) { return y >= 0 && y < a.grid->ny; }

inline Span span_or_none(const Links& a, int y) { return has_row(a, y) ? (*a.spans)[y] : Span{}; }

}  // namespace graindrive::continuum
