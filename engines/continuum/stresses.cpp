/// Computes stresses from differences and means between cells, faces and nodes.
#include "engines/continuum/stresses.hpp"

#include <cmath>

namespace graindrive::continuum {

namespace {

/// Cells with one layer of ghosts around them.
template <class Work>
void for_cells_and_ghosts(const Grid& grid, Work&& work)
{
	for (int j = -1; j <= grid.ny; ++j)
		for (std::size_t c = grid.at(-1, j), end = c + std::size_t(grid.nx) + 2; c < end; ++c) work(c);
}

}  // namespace

void rates_of(const Grid& grid, const FaceValues& velocity, Rates& rates)
{
	const std::size_t up = grid.stride();
	const double scale = 1 / grid.spacing;
	const double *u = velocity.x.data(), *v = velocity.y.data();
	double *xx = rates.along_x.data(), *yy = rates.along_y.data(), *xy = rates.shear.data();
	for_cells_and_ghosts(grid, [&](std::size_t c) {
		xx[c] = scale * (u[c + 1] - u[c]);
		yy[c] = scale * (v[c + up] - v[c]);
	});
	for_nodes(grid, [&](std::size_t n) { xy[n] = scale * (u[n] - u[n - up] + v[n] - v[n - 1]); });
}

void shear_rate(const Grid& grid, const Rates& rates, Values& rate)
{
	const std::size_t up = grid.stride();
	const double *xx = rates.along_x.data(), *yy = rates.along_y.data(), *xy = rates.shear.data();
	double* out = rate.data();
	for (int j = 0; j < grid.ny; ++j) {
		const std::size_t row = grid.at(0, j);
		for (std::size_t c = row; c < row + std::size_t(grid.nx); ++c) {
			const double nodes =
				xy[c] * xy[c] + xy[c + 1] * xy[c + 1] + xy[c + up] * xy[c + up] + xy[c + up + 1] * xy[c + up + 1];
			out[c] = std::sqrt(2 * (xx[c] * xx[c] + yy[c] * yy[c]) + 0.25 * nodes);
		}
	}
}

void shear_rate_at_nodes(const Grid& grid, const Rates& rates, Values& rate)
{
	const std::size_t up = grid.stride();
	const double *xx = rates.along_x.data(), *yy = rates.along_y.data(), *xy = rates.shear.data();
	double* out = rate.data();
	const auto squares = [&](std::size_t c) { return xx[c] * xx[c] + yy[c] * yy[c]; };
	for_nodes(grid, [&](std::size_t n) {
		const double cells = squares(n) + squares(n - 1) + squares(n - up) + squares(n - up - 1);
		out[n] = std::sqrt(0.5 * cells + xy[n] * xy[n]);
	});
}

void viscous_force(const Grid& grid, const Rates& rates, const Viscosities& viscosities, Rates& stresses, FaceValues& force)
{
	const std::size_t up = grid.stride();
	const double scale = 1 / grid.spacing;
	const double *eta = viscosities.cells.data(), *eta_nodes = viscosities.nodes.data();
	double *xx = stresses.along_x.data(), *yy = stresses.along_y.data(), *xy = stresses.shear.data();
	const double *rate_xx = rates.along_x.data(), *rate_yy = rates.along_y.data(), *rate_xy = rates.shear.data();
	for_cells_and_ghosts(grid, [&](std::size_t c) {
		xx[c] = 2 * eta[c] * rate_xx[c];
		yy[c] = 2 * eta[c] * rate_yy[c];
	});
	for_nodes(grid, [&](std::size_t n) { xy[n] = eta_nodes[n] * rate_xy[n]; });
	double *fx = force.x.data(), *fy = force.y.data();
	for (int j = 0; j < grid.ny; ++j)
		for (std::size_t f = grid.at(0, j), end = f + std::size_t(grid.nx); f < end; ++f) {
			fx[f] = scale * (xx[f] - xx[f - 1] + xy[f + up] - xy[f]);
			fy[f] = scale * (yy[f] - yy[f - up] + xy[f + 1] - xy[f]);
		}
}

void advection(const Grid& grid, const FaceValues& velocity, FaceValues& result)
{
	const std::size_t up = grid.stride();
	const double scale = -0.25 / grid.spacing;  // two means of two
	const double *u = velocity.x.data(), *v = velocity.y.data();
	double *ax = result.x.data(), *ay = result.y.data();
	const auto squared = [](double a) { return a * a; };
	for (int j = 0; j < grid.ny; ++j)
		for (std::size_t f = grid.at(0, j), end = f + std::size_t(grid.nx); f < end; ++f) {
			const double node = (u[f] + u[f - up]) * (v[f] + v[f - 1]);
			const double node_above = (u[f + up] + u[f]) * (v[f + up] + v[f + up - 1]);
			const double node_right = (u[f + 1] + u[f + 1 - up]) * (v[f + 1] + v[f]);
			ax[f] = scale * (squared(u[f] + u[f + 1]) - squared(u[f - 1] + u[f]) + node_above - node);
			ay[f] = scale * (squared(v[f] + v[f + up]) - squared(v[f - up] + v[f]) + node_right - node);
		}
}

}  // namespace graindrive::continuum
