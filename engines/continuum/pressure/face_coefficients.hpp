/// The coefficients b = chi/rho on the faces of a staggered grid, from which the pressure equation is made.
#pragma once
#include <cstddef>
#include <vector>

namespace graindrive::continuum {

/// Coefficients of  sum over the faces of a cell b (p_neighbour - p_cell)/spacing^2 = rhs.
/// All b >= 0; those on the boundary of the box must be 0. Cell (i, j) has number i + nx j.
struct FaceCoefficients {
	int nx = 0, ny = 0;
	double spacing = 1;     // width of a cell [m]
	std::vector<double> x;  // (nx + 1) ny numbers: face (i, j) is left of cell (i, j) [m^2/kg in the plane]
	std::vector<double> y;  // nx (ny + 1) numbers: face (i, j) is below cell (i, j)

	FaceCoefficients() = default;
	/// All faces closed.
	FaceCoefficients(int nx, int ny, double spacing)
		: nx(nx),
		  ny(ny),
		  spacing(spacing),
		  x(std::size_t(nx + 1) * ny),
		  y(std::size_t(nx) * (ny + 1))
	{
	}
	double& left(int i, int j) { return x[i + std::size_t(nx + 1) * j]; }
	double left(int i, int j) const { return x[i + std::size_t(nx + 1) * j]; }
	double& below(int i, int j) { return y[i + std::size_t(nx) * j]; }
	double below(int i, int j) const { return y[i + std::size_t(nx) * j]; }
};

/// Faces with less than this share of the largest coefficient count as closed: rounding in chi opens no cell.
constexpr double closed_below = 1e-12;

/// The largest coefficient.
/// @throws std::invalid_argument if sizes, spacing or a coefficient is not allowed; it names the face
double checked_largest(const FaceCoefficients& b);

}  // namespace graindrive::continuum
