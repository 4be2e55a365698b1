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

/// Viscosities where stresses are: of normal stresses in cells, of the shear stress at nodes.
struct Viscosities {
	Values cells, nodes;

	explicit Viscosities(const Grid& grid) : cells(grid.zeros()), nodes(grid.zeros()) {}
};

/// `work(index)` for all nodes of the grid, its edges too.
template <class Work>
void for_nodes(const Grid& grid, Work&& work)
{
	for (int j = 0; j <= grid.ny; ++j)
		for (std::size_t n = grid.at(0, j), end = n + std::size_t(grid.nx) + 1; n < end; ++n) work(n);
}

/// The mean of the four cells around a node. `cells` must have ghosts.
inline double at_node(const Values& cells, std::size_t node, std::size_t stride)
{
	return 0.25 * (cells[node] + cells[node - 1] + cells[node - stride] + cells[node - stride - 1]);
}

/// The same shear rate at nodes; the squares of du/dx and dv/dy are means of a node's four cells.
void shear_rate_at_nodes(const Grid& grid, const Rates& rates, Values& rate);

/// div(eta G) on faces. `viscosities.cells` must have ghosts; `stresses` is scratch.
void viscous_force(const Grid& grid, const Rates& rates, const Viscosities& viscosities, Rates& stresses, FaceValues& force);

/// -div(v v) on faces, by means of neighbouring faces: conserves momentum, and energy except for the error of
/// the time step. `velocity` must have ghosts.
void advection(const Grid& grid, const FaceValues& velocity, FaceValues& result);

}  // namespace graindrive::continuum
