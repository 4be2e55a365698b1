/// A multigrid cycle as preconditioner: Galerkin coarsening with interpolation that follows the coefficients (black-box multigrid,
/// Dendy, J. Comput. Phys. 48, 366, 1982).
///
/// A coarse grid keeps the cells of even x and even y. In between, u is interpolated so that the flux is continuous where b jumps; closed
/// cells get no weight. Operators are P^T A P: five-point on the finest grid, nine-point below. Constants stay in the null space on every
/// grid, since only links are stored and the diagonal is their sum.
/// The cycle is a V with one sweep of coloured Gauss-Seidel before and one, in opposite order, after: so it is symmetric.
#pragma once
#include "engines/continuum/pressure/preconditioner.hpp"

namespace graindrive::continuum {

/// One number a coarse cell, rows in natural order with zeros around them.
class PlainField {
public:
	PlainField() = default;
	PlainField(int nx, int ny) : stride(std::size_t(2 * rounded_up((nx + 1) / 2)) + 2 * lanes), numbers(stride * (ny + 3) + lanes)
	{
	}
	double* row(int y) { return numbers.data() + stride * (y + 1) + lanes; }
	const double* row(int y) const { return numbers.data() + stride * (y + 1) + lanes; }

private:
	std::size_t stride = 0;
	std::vector<double, OnCacheLines<double>> numbers;
};

/// What the cells between coarse cells take of them. Row Y, place X: cells (2X + 1, 2Y), (2X, 2Y + 1), (2X + 1, 2Y + 1).
struct Interpolation {
	PlainField west, east;                                      // on rows of coarse cells
	PlainField south, north;                                    // on columns of coarse cells
	PlainField south_west, south_east, north_west, north_east;  // in the middle of four
	Field<double> takes;     // of the finer grid: 1 where the weights add up to 1, 0 where all are 0
	Pack<double> gaps = {};  // how many open cells have no weights
};

/// Links of a nine-point operator; where the neighbours lie, see `FivePoint`.
struct NinePoint {
	SplitGrid grid;
	std::vector<Span> spans;
	Field<double> east, north, north_east, north_west;  // of a cell to these neighbours
	Field<double> inverse_diagonal;
};

class Multigrid : public Preconditioner {
public:
	std::string name() const override { return "multigrid"; }
	void update(const FivePoint& matrix, bool new_shape) override;
	double apply(const Field<double>& r, Field<double>& z) override;
	int grids() const { return int(coarse.size()) + 1; }

private:
	struct Coarse {
		NinePoint a;
		Interpolation p;   // from this grid to the finer one
		PlainField plain;  // residuals or corrections in natural order
		PlainField rows;   // links of one row in natural order, by kind
		Field<double> f, u, rest;
		void reshape(const SplitGrid& finer, const std::vector<Span>& finer_spans);
	};
	void solve_coarse(std::size_t level);

	const FivePoint* finest = nullptr;
	std::vector<std::unique_ptr<Coarse>> coarse;
	Field<double> rest;
};

}  // namespace graindrive::continuum
