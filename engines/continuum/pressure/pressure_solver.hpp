/// Solvers of the pressure equation  sum over the faces of a cell b (p_neighbour - p_cell)/spacing^2 = rhs.
///
/// b = chi/rho on the faces varies by 1000 across a free surface and falls to 0 in a solid; the box is closed. Cells without an open
/// face lie outside and keep p = 0. On each connected part of the others p is known up to a constant: its mean there is 0.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engines/continuum/pressure/face_coefficients.hpp"

namespace graindrive::continuum {

struct SolveReport {
	int iterations = 0;
	double residual = 0;  // |rhs - A p|_2 / |rhs|_2 of the p that is returned, rhs without its means [-]
	double removed_mean =
		0;  // the largest |mean of rhs over a part|: there the right side had no solution, and its mean was taken off
	double outside = 0;  // the largest |rhs| in a cell outside of all parts: it was ignored
};

class PressureSolver {
public:
	virtual ~PressureSolver() = default;
	virtual std::string name() const = 0;

	/// Takes new coefficients. Once a step: all systems of the step share them.
	/// Memory is allocated only if the grid changes, or faces open or close.
	/// @throws std::invalid_argument if they are negative, not finite, not 0 on the boundary, or do not fit the grid
	virtual void update(const FaceCoefficients& b) = 0;

	/// Solves until |rhs - A p|_2 <= relative_tolerance |rhs|_2, norms over all cells, checked with the true residual.
	/// @param rhs nx ny numbers in the unit of b p/spacing^2; cell (i, j) has number i + nx j
	/// @param p in: a first guess, such as the last solution; out: the solution
	/// @throws std::invalid_argument if sizes are wrong, a number is not finite, or the tolerance is not between 0 and 1
	/// @throws std::logic_error before the first update
	/// @throws std::runtime_error if the tolerance is not reached; p is then the best that was found
	virtual SolveReport solve(const std::vector<double>& rhs, std::vector<double>& p, double relative_tolerance) = 0;
};

/// The fastest on the drum's grids by `pressure_bench`: multigrid. Its cost a cell hardly depends on the grid or the densities, and what it
/// returns depends on nothing but coefficients, right side, guess and tolerance: no state is kept from step to step.
std::string default_pressure_solver();
/// Names that `make_pressure_solver` knows in this build.
std::vector<std::string> pressure_solvers();
/// @throws std::invalid_argument if the name is unknown, or the build lacks the solver's library
std::unique_ptr<PressureSolver> make_pressure_solver(const std::string& name = default_pressure_solver());

}  // namespace graindrive::continuum
