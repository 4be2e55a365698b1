/// Shear rates, viscous stresses and momentum carried by the flow, on the faces of a staggered grid, to second order.
#pragma once
#include "engines/continuum/grid.hpp"

namespace graindrive::continuum {

/// Velocity gradients where they are known to second order without interpolation.
struct Rates {
	Values along_x, along_y;  ///< du/dx, dv/dy in cells
	Values shear;             ///< du/dy + dv/dx at nodes

	explicit Rates(const Grid& grid) : along_x(grid.zeros()), along_y(grid.zeros()), shear(grid.zeros()) {}
};

/// `velocity` must have ghosts.
void rates_of(const Grid& grid, const FaceValues& velocity, Rates& rates);

/// (1/2 G:G)^1/2 with G = grad v + grad v^T in cells; the square of the shear is the mean of a cell's four nodes. Oba, Otsuki (2025), (28).
void shear_rate(const Grid& grid, const Rates& rates, Values& rate);

/// The harmonic mean of the four cells around a node: along the surface of two fluids the shear stress is the same in both, so that the
/// thinner one decides. An arithmetic mean would let grains drag the gas a thousand times too strongly, and no time step would be stable.
inline double at_node(const double* viscosity, std::size_t node, std::size_t stride)
{
	const double a = viscosity[node] * viscosity[node - 1], b = viscosity[node - stride] * viscosity[node - stride - 1];
	const double sum_a = viscosity[node] + viscosity[node - 1], sum_b = viscosity[node - stride] + viscosity[node - stride - 1];
	return 4 * a * b / (sum_a * b + sum_b * a);
}

/// div(eta G) on faces, with `at_node`. `viscosity` must be positive and have ghosts; stresses are scratch.
void viscous_force(const Grid& grid, const Rates& rates, const Values& viscosity, Rates& stresses, FaceValues& force);

/// -div(v v) on faces, by means of neighbouring faces: conserves momentum, and energy but for the time step. `velocity` must have ghosts.
void advection(const Grid& grid, const FaceValues& velocity, FaceValues& result);

}  // namespace graindrive::continuum
