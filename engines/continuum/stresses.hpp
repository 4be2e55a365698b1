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

/// div(eta G) on faces, the viscosity at a node the mean of its four cells. `viscosity` must have ghosts, stresses are scratch.
void viscous_force(const Grid& grid, const Rates& rates, const Values& viscosity, Rates& stresses, FaceValues& force);

/// -div(v v) on faces, by means of neighbouring faces: conserves momentum, and energy but for the time step. `velocity` must have ghosts.
void advection(const Grid& grid, const FaceValues& velocity, FaceValues& result);

}  // namespace graindrive::continuum
