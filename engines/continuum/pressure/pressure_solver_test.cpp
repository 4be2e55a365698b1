/// Every solver against closed forms and a dense solve; refused input; one solve must not influence the next.
#include "engines/continuum/pressure/pressure_solver.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

#include "engines/base/complaint.hpp"
#include "engines/continuum/pressure/drum_example.hpp"
#include "engines/continuum/pressure/pressure_test_support.hpp"

namespace graindrive::continuum {
namespace {

// The solution of least norm, which has mean zero on every part. Eigenvalues that are 0 within round-off belong to the null
// space.
Eigen::VectorXd least_solution(const FaceCoefficients& b, const std::vector<double>& rhs)
{
	const long n = long(rhs.size());
	Eigen::MatrixXd a(n, n);
	std::vector<double> unit(rhs.size());
	for (long k = 0; k < n; ++k) {
		unit[std::size_t(k)] = 1;
		const std::vector<double> column = applied(b, unit);
		a.col(k) = Eigen::Map<const Eigen::VectorXd>(column.data(), n);
		unit[std::size_t(k)] = 0;
	}
	const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a);
	const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
	Eigen::VectorXd share = eigen.eigenvectors().transpose() * Eigen::Map<const Eigen::VectorXd>(rhs.data(), n);
	for (long k = 0; k < n; ++k)
		share[k] = std::abs(eigen.eigenvalues()[k]) > 1e-11 * largest ? share[k] / eigen.eigenvalues()[k] : 0;
	return eigen.eigenvectors() * share;
}

std::vector<double> solved(const std::string& name, const FaceCoefficients& b, const std::vector<double>& rhs, double tolerance)
{
	const auto solver = make_pressure_solver(name);
	solver->update(b);
	std::vector<double> p(rhs.size());
	solver->solve(rhs, p, tolerance);
	return p;
}

class EverySolver : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(By, EverySolver, testing::ValuesIn(pressure_solvers()), [](const auto& info) { return info.param; });

// The error is the residual, 1e-12, times the condition number of these matrices, up to about 1e4.
TEST_P(EverySolver, AgreesWithADenseSolveWhateverTheParts)
{
	const int sizes[][2] = { { 1, 1 }, { 1, 9 }, { 10, 1 }, { 2, 2 }, { 3, 5 }, { 8, 8 }, { 17, 6 }, { 11, 19 } };
	for (const auto& size : sizes)
		for (const double closed : { 0.0, 0.4, 0.7 }) {
			const FaceCoefficients b = random_coefficients(size[0], size[1], closed, 2, unsigned(size[0] + 100 * closed));
			const std::vector<double> rhs = random_numbers(std::size_t(b.nx) * b.ny, 7);
			std::vector<double> p(rhs.size(), 1);
			const auto solver = make_pressure_solver(GetParam());
			solver->update(b);
			EXPECT_LE(solver->solve(rhs, p, 1e-12).residual, 1e-12);
			const Eigen::VectorXd exact = least_solution(b, rhs), ours = Eigen::Map<Eigen::VectorXd>(p.data(), long(p.size()));
			EXPECT_LE((ours - exact).norm(), 1e-8 * exact.norm()) << b.nx << " x " << b.ny << ", closed " << closed;
		}
}

// Two layers, b_1 below and b_2 above y = 1/2, and rhs = cos(pi y): b p' = sin(pi y)/pi, so p = C - cos(pi y)/(pi^2 b), the same
// on both sides of the surface where the cosine is 0. The face in the surface has the harmonic mean.
double error_of_layers(const std::string& name, int n)
{
	const double b_1 = 1, b_2 = 1000, constant = (1 / b_1 - 1 / b_2) / (M_PI * M_PI * M_PI);
	FaceCoefficients b(7, n, 1.0 / n);
	std::vector<double> rhs(std::size_t(b.nx) * n);
	for (int j = 0; j < n; ++j)
		for (int i = 0; i < b.nx; ++i) {
			if (i > 0) b.left(i, j) = 2 * j < n ? b_1 : b_2;
			if (j > 0) b.below(i, j) = 2 * j == n ? 2 * b_1 * b_2 / (b_1 + b_2) : 2 * j < n ? b_1 : b_2;
			rhs[std::size_t(i + b.nx * j)] = std::cos(M_PI * (j + 0.5) / n);
		}
	const std::vector<double> p = solved(name, b, rhs, 1e-10);
	double worst = 0;
	for (int j = 0; j < n; ++j)
		for (int i = 0; i < b.nx; ++i) {
			const double exact = constant - std::cos(M_PI * (j + 0.5) / n) / (M_PI * M_PI * (2 * j < n ? b_1 : b_2));
			worst = std::max(worst, std::abs(p[std::size_t(i + b.nx * j)] - exact));
		}
	return worst;
}

TEST_P(EverySolver, FindsThePressureInTwoLayersAtSecondOrder)
{
	const double coarse = error_of_layers(GetParam(), 20), fine = error_of_layers(GetParam(), 40);
	EXPECT_LT(coarse, 3e-4);  // p is about 0.1; the relative error of second differences is (pi/20)^2/12 = 0.2 %
	EXPECT_NEAR(coarse / fine, 4, 0.05);
}

// p = cos(2 pi x) cos(pi y), b = exp(x + y/2): rhs = b (laplacian p + p_x + p_y/2).
double error_of_smooth(const std::string& name, int n)
{
	FaceCoefficients b(n, n, 1.0 / n);
	std::vector<double> rhs(std::size_t(n) * n), exact(rhs.size());
	for (int j = 0; j < n; ++j)
		for (int i = 0; i < n; ++i) {
			const double h = 1.0 / n, x = (i + 0.5) * h, y = (j + 0.5) * h, cx = std::cos(2 * M_PI * x), cy = std::cos(M_PI * y);
			if (i > 0) b.left(i, j) = std::exp(i * h + y / 2);
			if (j > 0) b.below(i, j) = std::exp(x + j * h / 2);
			exact[std::size_t(i + n * j)] = cx * cy;
			rhs[std::size_t(i + n * j)] =
				std::exp(x + y / 2) *
				(-5 * M_PI * M_PI * cx * cy - 2 * M_PI * std::sin(2 * M_PI * x) * cy - M_PI / 2 * cx * std::sin(M_PI * y));
		}
	const std::vector<double> p = solved(name, b, rhs, 1e-10);
	double worst = 0;
	for (std::size_t k = 0; k < p.size(); ++k) worst = std::max(worst, std::abs(p[k] - exact[k]));
	return worst;
}

TEST_P(EverySolver, FindsASmoothPressureAtSecondOrder)
{
	const double coarse = error_of_smooth(GetParam(), 24), fine = error_of_smooth(GetParam(), 48);
	EXPECT_LT(coarse, 0.02);  // the relative error of second differences is (2 pi/24)^2/12 = 0.6 %
	EXPECT_NEAR(coarse / fine, 4, 0.25);
}

TEST_P(EverySolver, MeetsTheToleranceInTheDrum)
{
	DrumExample drum;
	for (const double tolerance : { 1e-3, 1e-7 }) {
		const FaceCoefficients b = drum.coefficients();
		const std::vector<double> rhs = drum.right_side();
		const auto solver = make_pressure_solver(GetParam());
		solver->update(b);
		std::vector<double> p(rhs.size());
		const SolveReport report = solver->solve(rhs, p, tolerance);
		const double residual = relative_residual(b, rhs, p);
		EXPECT_LE(residual, tolerance);
		EXPECT_NEAR(report.residual, residual,
			1e-9);  // p is about 100 times its second difference, and its means are subtracted
		EXPECT_LT(report.outside, 1e-12);
	}
}

TEST_P(EverySolver, TakesOffTheMeanOfEachPart)
{
	FaceCoefficients b = random_coefficients(16, 9, 0, 2, 3);
	for (int j = 0; j < 9; ++j) b.left(5, j) = 0;  // two parts, 5 and 11 columns
	std::vector<double> rhs = random_numbers(16 * 9, 4), shifted = rhs;
	for (std::size_t k = 0; k < rhs.size(); ++k) shifted[k] += k % 16 < 5 ? 3 : -7;
	const auto solver = make_pressure_solver(GetParam());
	solver->update(b);
	std::vector<double> p(rhs.size()), q(rhs.size(), 1);
	const double mean = solver->solve(rhs, p, 1e-12).removed_mean;
	const double more = solver->solve(shifted, q, 1e-12).removed_mean;
	EXPECT_LT(mean, 1);
	EXPECT_NEAR(more, 7, mean);
	double left = 0, right = 0;
	for (std::size_t k = 0; k < p.size(); ++k) {
		EXPECT_NEAR(p[k], q[k], 1e-9);
		(k % 16 < 5 ? left : right) += p[k];
	}
	EXPECT_NEAR(left, 0, 1e-12);  // sums of 99 numbers of size 1
	EXPECT_NEAR(right, 0, 1e-12);
}

TEST_P(EverySolver, LeavesCellsOutsideAlone)
{
	FaceCoefficients b = random_coefficients(7, 6, 0, 1, 5);
	b.left(3, 2) = b.left(4, 2) = b.below(3, 2) = b.below(3, 3) = 0;
	std::vector<double> rhs = random_numbers(42, 6), p(42, 9);
	rhs[3 + 7 * 2] = 123;
	const auto solver = make_pressure_solver(GetParam());
	solver->update(b);
	const SolveReport report = solver->solve(rhs, p, 1e-10);
	EXPECT_EQ(p[3 + 7 * 2], 0);
	EXPECT_EQ(report.outside, 123);
	EXPECT_LT(report.removed_mean, 2);
}

TEST_P(EverySolver, NeedsNoIterationForAGoodGuessOrNoSource)
{
	const FaceCoefficients b = random_coefficients(9, 12, 0.2, 1, 8);
	const std::vector<double> rhs = random_numbers(9 * 12, 9);
	const auto solver = make_pressure_solver(GetParam());
	solver->update(b);
	std::vector<double> p(rhs.size());
	EXPECT_GT(solver->solve(rhs, p, 1e-10).iterations, 0);
	EXPECT_EQ(solver->solve(rhs, p, 1e-9).iterations, 0);
	const SolveReport report = solver->solve(std::vector<double>(rhs.size()), p, 1e-9);
	EXPECT_EQ(report.iterations, 0);
	EXPECT_EQ(report.residual, 0);
	EXPECT_EQ(p, std::vector<double>(rhs.size()));
}

TEST_P(EverySolver, RefusesWhatIsNotANumberByItsPlace)
{
	const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
	const FaceCoefficients good = random_coefficients(4, 3, 0, 1, 1);
	const auto solver = make_pressure_solver(GetParam());
	solver->update(good);
	std::vector<double> rhs = random_numbers(12, 2), p(12);
	for (const double bad : { nan, infinity }) {
		rhs[6] = bad;
		EXPECT_TRUE(mentions(complaint([&] { solver->solve(rhs, p, 1e-5); }), "right side of the pressure must be finite, got"));
		EXPECT_TRUE(mentions(complaint([&] { solver->solve(rhs, p, 1e-5); }), "cell (2, 1)"));
		rhs[6] = 1;
		p[11] = bad;
		EXPECT_TRUE(mentions(complaint([&] { solver->solve(rhs, p, 1e-5); }), "cell (3, 2)"));
		p[11] = 0;
		FaceCoefficients b = good;
		b.below(1, 2) = bad;
		EXPECT_TRUE(mentions(complaint([&] { solver->update(b); }), "y-face (1, 2)"));
	}
	FaceCoefficients b = good;
	b.left(2, 1) = -1e-9;
	EXPECT_TRUE(mentions(complaint([&] { solver->update(b); }), "not negative, got -1e-09; correct x-face (2, 1)"));
}

TEST(PressureSolver, RefusesWhatDoesNotFit)
{
	EXPECT_TRUE(mentions(complaint([] { make_pressure_solver("sor"); }), "got 'sor'"));
	const auto solver = make_pressure_solver();
	std::vector<double> rhs(12), p(12);
	EXPECT_THROW(solver->solve(rhs, p, 1e-5), std::logic_error);
	FaceCoefficients b(4, 3, 0.1);
	b.left(4, 1) = 2;
	EXPECT_TRUE(mentions(complaint([&] { solver->update(b); }), "boundary of the box must be 0, got 2; close x-face (4, 1)"));
	b.left(4, 1) = 0;
	b.y.pop_back();
	EXPECT_TRUE(mentions(complaint([&] { solver->update(b); }), "y-faces, got 15"));
	EXPECT_TRUE(mentions(complaint([&] { solver->update(FaceCoefficients(0, 3, 0.1)); }), "got 0 x 3"));
	EXPECT_TRUE(mentions(complaint([&] { solver->update(FaceCoefficients(4, 3, 0)); }), "spacing"));
	solver->update(FaceCoefficients(4, 3, 0.1));
	EXPECT_EQ(solver->solve(rhs, p, 1e-5).iterations, 0);  // all cells closed
	EXPECT_TRUE(mentions(complaint([&] { solver->solve(rhs, p, 0); }), "tolerance"));
	p.pop_back();
	EXPECT_TRUE(mentions(complaint([&] { solver->solve(rhs, p, 1e-5); }), "12 cells, got 11"));
}

TEST(PressureSolver, SaysThatItCannotBeatRounding)
{
	DrumExample drum;
	drum.n = 40;
	const auto solver = make_pressure_solver();
	solver->update(drum.coefficients());
	std::vector<double> p(1600);
	EXPECT_THROW(solver->solve(drum.right_side(), p, 1e-18), std::runtime_error);
	EXPECT_LT(relative_residual(drum.coefficients(), drum.right_side(), p), 1e-8);  // p holds the best solution
}

}  // namespace
}  // namespace graindrive::continuum
