/// Symmetry of the preconditioners, iterations that depend on neither grid nor density, and warm starts.
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

#include "engines/base/complaint.hpp"
#include "engines/continuum/pressure/drum_example.hpp"
#include "engines/continuum/pressure/extrapolation.hpp"
#include "engines/continuum/pressure/preconditioner.hpp"
#include "engines/continuum/pressure/pressure_solver.hpp"
#include "engines/continuum/pressure/pressure_test_support.hpp"

namespace graindrive::continuum {
namespace {

// A field of random numbers on the open cells with mean zero over each part.
Field<double> random_field(const FivePoint& matrix, unsigned seed)
{
	const SplitGrid& grid = matrix.grid();
	const std::vector<double> numbers = random_numbers(std::size_t(grid.nx) * grid.ny, seed);
	std::vector<double> mean;
	matrix.parts().means(numbers.data(), mean);
	Field<double> field(grid);
	for (const Run& run : matrix.parts().runs())
		for (int x = run.first; x < run.last; ++x)
			field.at(x, run.row) = numbers[std::size_t(x + grid.nx * run.row)] - mean[run.part];
	return field;
}

void expect_symmetric(Preconditioner& m, const FaceCoefficients& b)
{
	FivePoint matrix;
	matrix.update(b);
	m.update(matrix, true);
	const Field<double> x = random_field(matrix, 1), y = random_field(matrix, 2);
	Field<double> mx(matrix.grid()), my(matrix.grid());
	const double xx = m.apply(x, mx), yy = m.apply(y, my);
	EXPECT_GT(xx, 0);
	EXPECT_GT(yy, 0);
	EXPECT_NEAR(xx, dot(matrix.grid(), matrix.spans(), x, mx), 1e-13 * xx);
	EXPECT_NEAR(dot(matrix.grid(), matrix.spans(), x, my), dot(matrix.grid(), matrix.spans(), y, mx), 1e-13 * std::sqrt(xx * yy))
		<< m.name();
}

TEST(Preconditioner, IsSymmetricAndPositive)
{
	const std::unique_ptr<Preconditioner> all[] = { make_multigrid_preconditioner(), make_jacobi_preconditioner(),
		make_cholesky_preconditioner() };
	for (const auto& m : all) {
		for (const int n : { 30, 107 }) {
			DrumExample drum;
			drum.n = n;
			expect_symmetric(*m, drum.coefficients());
		}
		for (const double closed : { 0.0, 0.3, 0.6 }) expect_symmetric(*m, random_coefficients(23, 38, closed, 2, 11));
	}
}

int iterations_of_multigrid(int n, double density_ratio)
{
	DrumExample drum;
	drum.n = n, drum.density_ratio = density_ratio;
	const auto solver = make_pressure_solver("multigrid");
	solver->update(drum.coefficients());
	std::vector<double> p(std::size_t(n) * n);
	return solver->solve(drum.right_side(), p, 1e-8).iterations;
}

// Each iteration reduces the error by a factor of 10 on any grid, so 8 to 10 are needed. A coarse operator other than P^T A P
// would need more.
TEST(Multigrid, NeedsTheSameIterationsForAnyGridAndDensity)
{
	for (const double ratio : { 1.0, 1e3, 1e6 })
		for (const int n : { 60, 107, 214, 300 }) EXPECT_LE(iterations_of_multigrid(n, ratio), 11) << n << ", " << ratio;
}

TEST(Multigrid, AlsoSolvesThinAndOddGrids)
{
	const int sizes[][2] = { { 1, 200 }, { 333, 1 }, { 2, 77 }, { 3, 128 }, { 107, 107 }, { 65, 33 } };
	for (const auto& size : sizes) {
		const FaceCoefficients b = random_coefficients(size[0], size[1], 0, 2, 21);
		std::vector<double> wanted = random_numbers(std::size_t(size[0]) * size[1], 22);
		const std::vector<double> rhs = applied(b, wanted);
		const auto solver = make_pressure_solver("multigrid");
		solver->update(b);
		std::vector<double> p(rhs.size());
		const SolveReport report = solver->solve(rhs, p, 1e-9);
		EXPECT_LE(relative_residual(b, rhs, p), 1e-9);
		EXPECT_LE(report.iterations, 40) << size[0] << " x " << size[1];
	}
}

// A restarted run has a new solver, which must not change a bit.
TEST(Multigrid, RemembersNothingOfEarlierSteps)
{
	DrumExample drum;
	const FaceCoefficients now = drum.coefficients();
	const std::vector<double> rhs = drum.right_side();
	drum.angle += 0.3;
	const FaceCoefficients before = drum.coefficients();
	const FaceCoefficients other_parts = random_coefficients(107, 107, 0.5, 1, 2);
	std::vector<double> fresh(rhs.size()), used(rhs.size());
	const auto a = make_pressure_solver("multigrid"), b = make_pressure_solver("multigrid");
	a->update(now);
	a->solve(rhs, fresh, 1e-6);
	for (const FaceCoefficients* earlier : { &other_parts, &before }) {
		b->update(*earlier);
		b->solve(rhs, used, 1e-6);
	}
	std::fill(used.begin(), used.end(), 0);
	b->update(now);
	b->solve(rhs, used, 1e-6);
	EXPECT_EQ(fresh, used);
}

TEST(Extrapolation, PredictsPolynomialsOfItsDegree)
{
	for (const int degree : { 0, 1, 2 }) {
		const auto at = [&](int t) {
			return std::vector<double>{ 3, degree > 0 ? 3 - 2.0 * t : 1, degree > 1 ? 5 - 3.0 * t + 0.5 * t * t : 2 };
		};
		Extrapolation past(degree);
		std::vector<double> guess{ 7, 7, 7 };
		past.predict(guess);
		EXPECT_EQ(guess[0], 7);
		for (int t = 0; t < 6; ++t) {
			past.remember(at(t));
			past.predict(guess);
			if (t >= degree) {
				EXPECT_EQ(guess, at(t + 1)) << degree;  // small integers and halves have no round-off
			}
			EXPECT_EQ(past.solution(0), at(t));
		}
		EXPECT_EQ(past.count(), degree + 1);
		past.forget();
		past.remember(at(9));
		past.predict(guess);
		EXPECT_EQ(guess, at(9));
	}
	EXPECT_TRUE(mentions(complaint([] { Extrapolation(3); }), "got 3"));
}

// The surface turns by 0.01 cells in a step: starting from the last pressure saves iterations, a linear extrapolation saves more.
TEST(Extrapolation, SavesIterations)
{
	int iterations[3] = {};
	for (const int guess : { 0, 1, 2 }) {
		DrumExample drum;
		const auto solver = make_pressure_solver();
		Extrapolation past(guess == 2 ? 1 : 0);
		std::vector<double> p(std::size_t(drum.n) * drum.n);
		for (int step = 0; step < 6; ++step) {
			solver->update(drum.coefficients());
			std::fill(p.begin(), p.end(), 0);
			if (guess > 0) past.predict(p);
			iterations[guess] += solver->solve(drum.right_side(), p, 1e-6).iterations;
			past.remember(p);
			drum.angle += 0.01 / drum.radius();
			drum.phase += 0.01 / drum.radius();
		}
	}
	EXPECT_LT(iterations[1], iterations[0]);
	EXPECT_LT(iterations[2], iterations[1]);
}

}  // namespace
}  // namespace graindrive::continuum
