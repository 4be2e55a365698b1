/// The parts of a solve that all Krylov methods share: checks, scaling, restarts, errors.
#include "engines/continuum/pressure/krylov.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "engines/geometry/refuse.hpp"

namespace graindrive::continuum {

using geometry::require;

void KrylovSolver::update(const FaceCoefficients& b)
{
	const bool new_shape = matrix.update(b);
	if (new_shape) {
		x = best = r = f = Field<double>(matrix.grid());
		row.resize(b.nx);
		mean.reserve(matrix.parts().count());
		reshape(matrix.grid());
	}
	preconditioner->update(matrix, new_shape);
}

SolveReport KrylovSolver::solve(const std::vector<double>& rhs, std::vector<double>& p, double relative_tolerance)
{
	check(rhs, p, relative_tolerance);
	SolveReport report;
	const double ff = load_right_side(rhs, report), target = relative_tolerance * relative_tolerance * ff;
	load_guess(p);
	if (ff == 0) x.clear();
	double rr = matrix.residual(f, x, r);
	if (!std::isfinite(rr)) refuse_not_finite("the first guess of the pressure", p);
	const int limit = 1000 + 20 * (matrix.grid().nx + matrix.grid().ny);
	// By round-off the residual of the iteration departs from the true one, so after eight decades the iteration restarts from
	// the true one.
	double before = HUGE_VAL;
	bool again = false;
	while (rr > target && rr < 0.25 * before && report.iterations < limit) {
		if (before < HUGE_VAL) again = true, best = x;
		before = least_rr = rr;
		since_least = 0;
		report.iterations += iterate(std::max(target, 1e-16 * rr), limit - report.iterations);
		rr = matrix.residual(f, x, r);
	}
	if (rr > before) {  // the last iterations only added round-off: return to the solution before
		if (again)
			x = best;
		else
			load_guess(p);
		rr = matrix.residual(f, x, r);
	}
	preconditioner->took(report.iterations);
	store(p);
	report.residual = ff > 0 ? std::sqrt(rr / ff) : 0;
	if (rr <= target) return report;
	std::ostringstream message;
	message << "the pressure must reach a relative residual of " << relative_tolerance << ", got " << report.residual << " after "
			<< report.iterations << " iterations of " << name() << "; give a larger tolerance or another solver";
	throw std::runtime_error(message.str());
}

bool KrylovSolver::stalled(double rr)
{
	since_least = rr < least_rr ? 0 : since_least + 1;
	least_rr = std::min(least_rr, rr);
	return since_least > 100 + 2 * (matrix.grid().nx + matrix.grid().ny);
}

void KrylovSolver::check(const std::vector<double>& rhs, const std::vector<double>& p, double relative_tolerance) const
{
	if (matrix.grid().nx == 0) throw std::logic_error("a pressure solver needs coefficients first; call update before solve");
	const std::size_t n = std::size_t(matrix.grid().nx) * matrix.grid().ny;
	const auto refuse = [&](const char* what, std::size_t size) {
		require(false, std::string(what) + " must have a number for each of the " + std::to_string(n) + " cells", size,
			"make it fit the grid");
	};
	if (rhs.size() != n) refuse("the right side of the pressure", rhs.size());
	if (p.size() != n) refuse("the first guess of the pressure", p.size());
	if (relative_tolerance > 0 && relative_tolerance < 1) return;
	require(false, "the relative tolerance must lie between 0 and 1", relative_tolerance, "try 1e-5");
}

void KrylovSolver::refuse_not_finite(const char* what, const std::vector<double>& numbers) const
{
	const std::size_t nx = matrix.grid().nx;
	for (std::size_t k = 0; k < numbers.size(); ++k)
		require(std::isfinite(numbers[k]), std::string(what) + " must be finite", numbers[k],
			"correct cell (" + std::to_string(k % nx) + ", " + std::to_string(k / nx) + ")");
	throw std::invalid_argument(std::string(what) + " is too large for double precision; use other units");
}

// f = -spacing^2 (rhs - its mean over each connected part), because the matrix has a positive diagonal and leaves out
// 1/spacing^2. Returns the square of f.
double KrylovSolver::load_right_side(const std::vector<double>& rhs, SolveReport& report)
{
	const Parts& parts = matrix.parts();
	const SplitGrid& grid = matrix.grid();
	parts.means(rhs.data(), mean);
	for (const double m : mean) report.removed_mean = std::max(report.removed_mean, std::abs(m));
	report.outside = parts.largest_outside(rhs.data());
	const double scale = -matrix.spacing() * matrix.spacing();
	auto run = parts.runs().begin();
	while (run != parts.runs().end()) {
		const int y = run->row;
		const double* from = &rhs[std::size_t(grid.nx) * y];
		std::fill(row.begin(), row.end(), 0);
		for (; run != parts.runs().end() && run->row == y; ++run)
			for (int i = run->first; i < run->last; ++i) row[i] = scale * (from[i] - mean[run->part]);
		split_row(row.data(), grid.nx, f.row(y, 0), f.row(y, 1));
	}
	const double ff = dot(grid, matrix.spans(), f, f);
	if (!std::isfinite(ff) || !std::isfinite(report.outside)) refuse_not_finite("the right side of the pressure", rhs);
	return ff;
}

void KrylovSolver::load_guess(const std::vector<double>& p)
{
	const SplitGrid& grid = matrix.grid();
	auto run = matrix.parts().runs().begin();
	while (run != matrix.parts().runs().end()) {
		const int y = run->row;
		const double* from = &p[std::size_t(grid.nx) * y];
		std::fill(row.begin(), row.end(), 0);
		for (; run != matrix.parts().runs().end() && run->row == y; ++run)
			std::copy(from + run->first, from + run->last, row.begin() + run->first);
		split_row(row.data(), grid.nx, x.row(y, 0), x.row(y, 1));
	}
}

void KrylovSolver::store(std::vector<double>& p)
{
	const SplitGrid& grid = matrix.grid();
	for (int y = 0; y < grid.ny; ++y) merge_row(x.row(y, 0), x.row(y, 1), grid.nx, &p[std::size_t(grid.nx) * y]);
	matrix.parts().means(p.data(), mean);
	for (const Run& run : matrix.parts().runs())
		for (int i = run.first; i < run.last; ++i) p[std::size_t(grid.nx) * run.row + i] -= mean[run.part];
}

}  // namespace graindrive::continuum
