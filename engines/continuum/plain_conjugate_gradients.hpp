/// Conjugate gradients for symmetric positive systems whose unknowns are arrays of a grid.
#pragma once
#include <cmath>
#include <stdexcept>
#include <string>

#include "engines/continuum/grid.hpp"

namespace graindrive::continuum {

/// Sums of products in one order, eight at a time.
inline double dot(const Values& a, const Values& b)
{
	double sums[8] = {};
	const std::size_t whole = a.size() / 8 * 8;
	for (std::size_t k = 0; k < whole; k += 8)
		for (std::size_t lane = 0; lane < 8; ++lane) sums[lane] += a[k + lane] * b[k + lane];
	for (std::size_t k = whole; k < a.size(); ++k) sums[0] += a[k] * b[k];
	return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}
inline double dot(const FaceValues& a, const FaceValues& b) { return dot(a.x, b.x) + dot(a.y, b.y); }

inline void add(double factor, const Values& what, Values& to)
{
	for (std::size_t k = 0; k < to.size(); ++k) to[k] += factor * what[k];
}
inline void add(double factor, const FaceValues& what, FaceValues& to)
{
	add(factor, what.x, to.x);
	add(factor, what.y, to.y);
}

/// to = what + factor to
inline void scale_and_add(double factor, const Values& what, Values& to)
{
	for (std::size_t k = 0; k < to.size(); ++k) to[k] = what[k] + factor * to[k];
}
inline void scale_and_add(double factor, const FaceValues& what, FaceValues& to)
{
	scale_and_add(factor, what.x, to.x);
	scale_and_add(factor, what.y, to.y);
}

struct GradientReport {
	int iterations = 0;
	double residual = 0;  ///< residual over `scale` [-]
};

/// Lessens `rest` = given - A x, and moves x, until (rest, M rest)^1/2 <= tolerance scale, where z = M r is what `precondition(r, z)`
/// does, a symmetric approximate inverse. `apply(p, Ap)` multiplies; `rest` and what both return must be 0 where nothing is unknown.
/// @throws std::runtime_error naming `what` if so many iterations do not suffice, or a number is not finite
template <class Unknowns, class Apply, class Precondition>
GradientReport conjugate_gradients(const char* what, Apply&& apply, Precondition&& precondition, Unknowns& x, Unknowns& rest,
	Unknowns& direction, Unknowns& image, Unknowns& preconditioned, double scale, double tolerance, int most_iterations = 2000)
{
	GradientReport report;
	double before = 0;
	for (;; ++report.iterations) {
		precondition(rest, preconditioned);
		const double rho = dot(rest, preconditioned), left = std::sqrt(rho);
		report.residual = scale > 0 ? left / scale : left;
		if (left <= tolerance * scale) return report;
		if (!std::isfinite(left) || report.iterations == most_iterations)
			throw std::runtime_error(std::string(what) + " did not converge: " + std::to_string(report.residual) +
									 " of it is left after " + std::to_string(report.iterations) +
									 " iterations; take a smaller time step");
		if (report.iterations == 0)
			direction = preconditioned;
		else
			scale_and_add(rho / before, preconditioned, direction);
		before = rho;
		apply(direction, image);
		const double step = rho / dot(direction, image);
		add(step, direction, x);
		add(-step, image, rest);
	}
}

}  // namespace graindrive::continuum
