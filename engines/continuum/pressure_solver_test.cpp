/// Every solver against closed forms and against a dense solve.
#include "engines/continuum/pressure_solver.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "engines/base/complaint.hpp"

namespace graindrive::continuum {
namespace {

// Random coefficients over `decades`, a share of the faces closed.
FaceCoefficients random_coefficients(int nx, int ny, double closed, double decades, unsigned seed)
{
	std::mt19937 random(seed);
	std::uniform_real_distribution<double> uniform(0, 1);
	FaceCoefficients b(nx, ny, 0.25);
	const auto draw = [&] {
		const bool open = uniform(random) >= closed;
		const double size = std::pow(10, decades * (uniform(random) - 0.5));
		return open ? size : 0;
	};
	for (int j = 0; j < ny; ++j)
		for (int i = 1; i < nx; ++i) b.left(i, j) = draw();
	for (int j = 1; j < ny; ++j)
		for (int i = 0; i < nx; ++i) b.below(i, j) = draw();
	return b;
}

std::vector<double> random_numbers(std::size_t n, unsigned seed)
{
	std::mt19937 random(seed);
	std::normal_distribution<double> normal;
	std::vector<double> numbers(n);
	for (double& one : numbers) one = normal(random);
	return numbers;
}

// The operator as the header states it.
Eigen::MatrixXd dense(const FaceCoefficients& b)
{
	const int n = b.nx * b.ny;
	Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
	const auto link = [&](int k, int l, double size) {
		size /= b.spacing * b.spacing;
		a(k, l) += size, a(l, k) += size, a(k, k) -= size, a(l, l) -= size;
	};
	for (int j = 0; j < b.ny; ++j)
		for (int i = 0; i < b.nx; ++i) {
			const int k = i + b.nx * j;
			if (i > 0) link(k, k - 1, b.left(i, j));
			if (j > 0) link(k, k - b.nx, b.below(i, j));
		}
	return a;
}

// The solution of least norm, which has mean zero on every part; null space where eigenvalues are 0 but for rounding.
Eigen::VectorXd least_solution(const FaceCoefficients& b, const std::vector<double>& rhs)
{
	const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense(b));
	const Eigen::VectorXd f = Eigen::Map<const Eigen::VectorXd>(rhs.data(), long(rhs.size()));
	Eigen::VectorXd share = eigen.eigenvectors().transpose() * f;
	const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
	for (long k = 0; k < share.size(); ++k)
		share[k] = std::abs(eigen.eigenvalues()[k]) > 1e-12 * largest ? share[k] / eigen.eigenvalues()[k] : 0;
	return eigen.eigenvectors() * share;
}

class EverySolver : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(By, EverySolver, testing::ValuesIn(pressure_solvers()), [](const auto& info) { return info.param; });

// The residual is 1e-12; the condition of these matrices, up to about 1e4, multiplies it.
TEST_P(EverySolver, AgreesWithADenseSolveWhateverTheParts)
{
	const int sizes[][2] = { { 1, 1 }, { 1, 9 }, { 10, 1 }, { 2, 2 }, { 3, 5 }, { 8, 8 }, { 17, 6 }, { 13, 21 } };
	for (const auto& size : sizes)
		for (const double closed : { 0.0, 0.4, 0.7 }) {
			const FaceCoefficients b = random_coefficients(size[0], size[1], closed, 2, unsigned(size[0] + 100 * closed));
			const std::vector<double> rhs = random_numbers(std::size_t(b.nx) * b.ny, 7);
			std::vector<double> p(rhs.size(), 1);
			const auto solver = make_pressure_solver(GetParam());
			solver->update(b);
			const SolveReport report = solver->solve(rhs, p, 1e-12);
			EXPECT_LE(report.residual, 1e-12);
			const Eigen::VectorXd exact = least_solution(b, rhs), ours = Eigen::Map<Eigen::VectorXd>(p.data(), long(p.size()));
			EXPECT_LT((ours - exact).norm(), 1e-7 * (exact.norm() + 1e-300)) << b.nx << " x " << b.ny << ", closed " << closed;
		}
}

}  // namespace
}  // namespace graindrive::continuum
