/// What the tests of the pressure share: random problems, and the equation as the interface states it, cell by cell.
#pragma once
#include <cmath>
#include <random>
#include <vector>

#include "engines/continuum/pressure/face_coefficients.hpp"

namespace graindrive::continuum {

/// Random coefficients over so many decades; a share of the faces is closed.
inline FaceCoefficients random_coefficients(int nx, int ny, double closed, double decades, unsigned seed)
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

inline std::vector<double> random_numbers(std::size_t n, unsigned seed)
{
	std::mt19937 random(seed);
	std::normal_distribution<double> normal;
	std::vector<double> numbers(n);
	for (double& one : numbers) one = normal(random);
	return numbers;
}

/// Sum over the faces of each cell b (p_neighbour - p_cell)/spacing^2.
inline std::vector<double> applied(const FaceCoefficients& b, const std::vector<double>& p)
{
	std::vector<double> sums(p.size());
	const auto link = [&](int cell, int neighbour, double coefficient) {
		const double flux = coefficient * (p[neighbour] - p[cell]) / (b.spacing * b.spacing);
		sums[cell] += flux;
		sums[neighbour] -= flux;
	};
	for (int j = 0; j < b.ny; ++j)
		for (int i = 0; i < b.nx; ++i) {
			if (i > 0) link(i + b.nx * j, i - 1 + b.nx * j, b.left(i, j));
			if (j > 0) link(i + b.nx * j, i + b.nx * (j - 1), b.below(i, j));
		}
	return sums;
}

/// |rhs - A p|/|rhs| for a right side that has a solution.
inline double relative_residual(const FaceCoefficients& b, const std::vector<double>& rhs, const std::vector<double>& p)
{
	const std::vector<double> sums = applied(b, p);
	double rest = 0, whole = 0;
	for (std::size_t k = 0; k < p.size(); ++k) {
		rest += (rhs[k] - sums[k]) * (rhs[k] - sums[k]);
		whole += rhs[k] * rhs[k];
	}
	return std::sqrt(rest / whole);
}

}  // namespace graindrive::continuum
