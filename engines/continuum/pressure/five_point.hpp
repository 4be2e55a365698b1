/// The matrix of the pressure equation on the finest grid: (A u)_c = sum over faces b (u_c - u_neighbour), symmetric, positive semidefinite.
#pragma once
#include "engines/continuum/pressure/parts.hpp"

namespace graindrive::continuum {

/// Where the neighbours of a half row lie, seen from place k of (y, parity).
struct NeighbourRows {
	std::size_t here, west, east, south, north;  // `west` also holds the link to the west, `south` that to the south
	NeighbourRows(const SplitGrid& grid, int y, int parity)
		: here(grid.offset(y, parity)),
		  west(grid.offset(y, 1 - parity) + parity - 1),
		  east(west + 1),
		  south(grid.offset(y - 1, parity)),
		  north(grid.offset(y + 1, parity))
	{
	}
};

class FivePoint {
public:
	/// @return true if grid or parts have changed, so that arrays of the grid's shape must be allocated again
	/// @throws std::invalid_argument if the coefficients are not allowed
	bool update(const FaceCoefficients& b);

	const SplitGrid& grid() const { return shape; }
	const Parts& parts() const { return connected; }
	const std::vector<Span>& spans() const { return connected.spans(); }
	double spacing() const { return width; }
	double largest() const { return largest_link; }

	/// product = A u; the result is u A u.
	double multiply(const Field<double>& u, Field<double>& product) const;
	/// u = z + share u, then product = A u; the result is u A u.
	double turn_and_multiply(const Field<double>& z, double share, Field<double>& u, Field<double>& product) const;
	/// r = f - A u; the result is r r.
	double residual(const Field<double>& f, const Field<double>& u, Field<double>& r) const;

	Field<double> east, north;       // b of the face to the east and to the north of a cell
	Field<double> inverse_diagonal;  // 0 where a cell is closed

private:
	void load(const FaceCoefficients& b, double least);
	void invert_diagonal();
	void multiply_row(const Field<double>& u, Field<double>& product, int y, Pack<double>& sum) const;

	SplitGrid shape;
	Parts connected;
	double width = 1, largest_link = 0;
	std::vector<double> row;
};

}  // namespace graindrive::continuum
