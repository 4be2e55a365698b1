/// The equation div(chi/rho grad p) = right side on the flow's grid, whichever solver does it.
#pragma once
#include <memory>
#include <string>

#include "engines/continuum/domain.hpp"
#include "engines/continuum/pressure/pressure_solver.hpp"

namespace graindrive::continuum {

class Pressure {
public:
	/// @throws std::invalid_argument for an unknown name of a solver, and for a named one on a periodic grid
	Pressure(const Grid& grid, const std::string& solver);

	/// b = chi/rho on faces; once a step.
	void update(const FaceValues& coefficients);
	/// The norm of a right side, over the cells that have an equation.
	double size_of(const Values& right_side) const;
	/// Until the norm of the residual is at most `tolerance` `scale`. `p` in: first guess, out: solution, ghosts filled; 0 where the right
	/// side is as small as that itself. Returns the number of iterations.
	int solve(const Values& right_side, Values& p, double tolerance, double scale);

	std::string name() const { return solver ? solver->name() : "jacobi"; }

private:
	Grid grid;
	std::unique_ptr<PressureSolver> solver;  ///< none on a periodic grid
	FaceCoefficients closed;
	std::vector<double> rhs, solution;
	FaceValues periodic;
	Values has_equation;
	Values rest, direction, image, preconditioned, over_diagonal;

	int solve_periodic(const Values& right_side, Values& p, double target);
};

}  // namespace graindrive::continuum
