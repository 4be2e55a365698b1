/// The pressure equation of a half-filled drum, made up for benchmark and tests: the drum's geometry and densities, forces like a flow's.
#pragma once
#include <cmath>
#include <vector>

#include "engines/continuum/pressure/face_coefficients.hpp"

namespace graindrive::continuum {

/// A drum of diameter 75/107 of the box in a closed solid, half full; the surface is tilted and about a cell wide.
struct DrumExample {
	int n = 107;                  // cells each way
	double density_ratio = 1000;  // grains over gas
	double angle = 0.4;           // of the surface [rad]
	double phase = 0;             // of the forces [rad]

	double radius() const { return 37.5 / 107 * n; }
	/// By x and y in cells from the centre: share of the fluid, smooth across four cells.
	static double fluid_share(double outside)
	{
		const double half_width = 2;
		if (outside >= half_width) return 0;
		return outside <= -half_width ? 1 : (1 - std::sin(M_PI * outside / (2 * half_width))) / 2;
	}
	double chi(double x, double y) const { return fluid_share(std::hypot(x, y) - radius()); }
	double density(double x, double y) const
	{
		const double above = y * std::cos(angle) - x * std::sin(angle), full = 0.5 * (1 - std::tanh(2 * above));
		return full + (1 - full) / density_ratio;
	}
	double force_x(double x, double y) const
	{
		return 0.3 * std::sin(2.5 * y / radius() + phase) + 0.2 * std::cos(7 * x / radius() - 3 * y / radius() + 2 * phase);
	}
	double force_y(double x, double y) const
	{
		return -1 + 0.3 * std::cos(3 * x / radius() - phase) + 0.2 * std::sin(5 * (x + y) / radius() + phase);
	}

	FaceCoefficients coefficients() const
	{
		FaceCoefficients b(n, n, 1.0 / n);
		const double middle = 0.5 * n;
		for (int j = 0; j < n; ++j)
			for (int i = 1; i < n; ++i) {
				const double x = i - middle, y = j + 0.5 - middle;
				b.left(i, j) = chi(x, y) / (0.5 * (density(x - 0.5, y) + density(x + 0.5, y)));
				b.below(j, i) = chi(y, x) / (0.5 * (density(y, x - 0.5) + density(y, x + 0.5)));
			}
		return b;
	}

	/// The divergence of chi times the forces.
	std::vector<double> right_side() const
	{
		std::vector<double> rhs(std::size_t(n) * n);
		const double middle = 0.5 * n;
		for (int j = 0; j < n; ++j)
			for (int i = 0; i < n; ++i) {
				const double x = i + 0.5 - middle, y = j + 0.5 - middle;
				const auto fx = [&](double at) { return chi(at, y) * force_x(at, y); };
				const auto fy = [&](double at) { return chi(x, at) * force_y(x, at); };
				rhs[i + std::size_t(n) * j] = n * (fx(x + 0.5) - fx(x - 0.5) + fy(y + 0.5) - fy(y - 0.5));
			}
		return rhs;
	}
};

}  // namespace graindrive::continuum
