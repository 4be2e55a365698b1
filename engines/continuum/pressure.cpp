/// Closed grids by the solvers of `pressure_solver.hpp`, periodic ones by conjugate gradients.
#include "engines/continuum/pressure.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engines/continuum/plain_conjugate_gradients.hpp"

namespace graindrive::continuum {

Pressure::Pressure(const Grid& g, const std::string& name) : grid(g), has_equation(g.zeros())
{
	if (grid.periodic_x) {
		if (!name.empty() && name != "jacobi")
			throw std::invalid_argument(
				"on a periodic grid the pressure's solver is jacobi, got " + name + "; leave it out, or close the grid");
		periodic = zero_faces(grid);
		for (Values* list : { &rest, &direction, &image, &preconditioned, &over_diagonal }) *list = grid.zeros();
		return;
	}
	solver = name.empty() ? make_pressure_solver() : make_pressure_solver(name);
	closed = FaceCoefficients(grid.nx, grid.ny, grid.spacing);
	rhs.resize(std::size_t(grid.nx) * std::size_t(grid.ny));
	solution = rhs;
}

void Pressure::update(const FaceValues& coefficients)
{
	const std::size_t up = grid.stride();
	grid.for_cells([&](int, int, std::size_t c) {
		has_equation[c] = coefficients.x[c] + coefficients.x[c + 1] + coefficients.y[c] + coefficients.y[c + up] > 0;
	});
	if (solver) {
		grid.for_x_faces([&](int i, int j, std::size_t f) { closed.left(i, j) = coefficients.x[f]; });
		grid.for_y_faces([&](int i, int j, std::size_t f) { closed.below(i, j) = coefficients.y[f]; });
		return solver->update(closed);
	}
	periodic = coefficients;
	const double scale = 1 / (grid.spacing * grid.spacing);
	grid.for_cells([&](int, int, std::size_t c) {
		const double sum = periodic.x[c] + periodic.x[c + 1] + periodic.y[c] + periodic.y[c + up];
		over_diagonal[c] = sum > 0 ? 1 / (scale * sum) : 0;
	});
}

double Pressure::size_of(const Values& right_side) const
{
	double sum = 0;
	grid.for_cells([&](int, int, std::size_t c) { sum += has_equation[c] * right_side[c] * right_side[c]; });
	return std::sqrt(sum);
}

int Pressure::solve(const Values& right_side, Values& p, double tolerance, double scale)
{
	const double size = size_of(right_side), target = tolerance * scale;
	int iterations = 0;
	if (size <= target)
		std::fill(p.begin(), p.end(), 0.0);
	else if (solver) {
		std::size_t k = 0;
		grid.for_cells([&](int, int, std::size_t c) {
			rhs[k] = has_equation[c] * right_side[c];
			solution[k++] = p[c];
		});
		iterations = solver->solve(rhs, solution, target / size).iterations;
		k = 0;
		grid.for_cells([&](int, int, std::size_t c) { p[c] = solution[k++]; });
	} else
		iterations = solve_periodic(right_side, p, target / size);
	fill_ghosts(grid, p);
	return iterations;
}

int Pressure::solve_periodic(const Values& right_side, Values& p, double tolerance)
{
	const std::size_t up = grid.stride();
	const double scale = 1 / (grid.spacing * grid.spacing);
	const auto apply = [&](Values& of, Values& result) {
		fill_ghosts(grid, of);
		grid.for_cells([&](int, int, std::size_t c) {
			result[c] = scale * (periodic.x[c] * (of[c] - of[c - 1]) + periodic.x[c + 1] * (of[c] - of[c + 1]) +
									periodic.y[c] * (of[c] - of[c - up]) + periodic.y[c + up] * (of[c] - of[c + up]));
		});
	};
	const auto precondition = [&](const Values& r, Values& z) {
		for (std::size_t k = 0; k < z.size(); ++k) z[k] = over_diagonal[k] * r[k];
	};
	double mean = 0, count = 0;
	grid.for_cells([&](int, int, std::size_t c) {
		if (over_diagonal[c] <= 0) return;
		mean += right_side[c];
		++count;
	});
	mean /= count;
	grid.for_cells([&](int, int, std::size_t c) { rest[c] = over_diagonal[c] > 0 ? mean - right_side[c] : 0; });
	precondition(rest, preconditioned);
	const double size = std::sqrt(dot(rest, preconditioned));
	apply(p, image);
	add(-1, image, rest);
	grid.for_cells([&](int, int, std::size_t c) { rest[c] = over_diagonal[c] > 0 ? rest[c] : 0; });
	return conjugate_gradients(
		"the pressure", apply, precondition, p, rest, direction, image, preconditioned, size, tolerance, 20000)
	    .iterations;
}

}  // namespace graindrive::continuum
