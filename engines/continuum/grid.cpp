/// Ghosts of cells and faces, and the divergence of a flow through faces.
#include "engines/continuum/grid.hpp"

namespace graindrive::continuum {

void fill_ghosts(const Grid& grid, Values& cells)
{
	const int nx = grid.nx, ny = grid.ny;
	for (int j = 0; j < ny; ++j)
		for (int k = 1; k <= Grid::ghosts; ++k) {
			const int left = grid.periodic_x ? (nx - k % nx) % nx : 0, right = grid.periodic_x ? (k - 1) % nx : nx - 1;
			cells[grid.at(-k, j)] = cells[grid.at(left, j)];
			cells[grid.at(nx - 1 + k, j)] = cells[grid.at(right, j)];
		}
	for (int k = 1; k <= Grid::ghosts; ++k)
		for (int i = -Grid::ghosts; i < nx + Grid::ghosts; ++i) {
			cells[grid.at(i, -k)] = cells[grid.at(i, 0)];
			cells[grid.at(i, ny - 1 + k)] = cells[grid.at(i, ny - 1)];
		}
}

void extrapolate_ghosts(const Grid& grid, Values& cells)
{
	fill_ghosts(grid, cells);
	const int nx = grid.nx, ny = grid.ny;
	const auto line = [&](std::size_t ghost, std::size_t last, std::size_t before, int distance) {
		cells[ghost] = cells[last] + distance * (cells[last] - cells[before]);
	};
	for (int k = 1; k <= Grid::ghosts; ++k)
		for (int j = 0; j < ny && !grid.periodic_x; ++j) {
			line(grid.at(-k, j), grid.at(0, j), grid.at(1, j), k);
			line(grid.at(nx - 1 + k, j), grid.at(nx - 1, j), grid.at(nx - 2, j), k);
		}
	for (int k = 1; k <= Grid::ghosts; ++k)
		for (int i = -Grid::ghosts; i < nx + Grid::ghosts; ++i) {
			line(grid.at(i, -k), grid.at(i, 0), grid.at(i, 1), k);
			line(grid.at(i, ny - 1 + k), grid.at(i, ny - 1), grid.at(i, ny - 2), k);
		}
}

void fill_ghosts(const Grid& grid, FaceValues& velocity, Edge edge)
{
	const int nx = grid.nx, ny = grid.ny;
	Values &u = velocity.x, &v = velocity.y;
	const double along = edge == Edge::slips ? 1 : -1;
	for (int j = 0; j < ny; ++j) {
		if (grid.periodic_x) {
			u[grid.at(nx, j)] = u[grid.at(0, j)];
			u[grid.at(nx + 1, j)] = u[grid.at(1 % nx, j)];
			u[grid.at(-1, j)] = u[grid.at(nx - 1, j)];
			v[grid.at(-1, j)] = v[grid.at(nx - 1, j)];
			v[grid.at(nx, j)] = v[grid.at(0, j)];
			continue;
		}
		u[grid.at(0, j)] = u[grid.at(nx, j)] = 0;
		u[grid.at(-1, j)] = -u[grid.at(1, j)];
		u[grid.at(nx + 1, j)] = -u[grid.at(nx - 1, j)];
		v[grid.at(-1, j)] = along * v[grid.at(0, j)];
		v[grid.at(nx, j)] = along * v[grid.at(nx - 1, j)];
	}
	for (int i = -Grid::ghosts; i < nx + Grid::ghosts; ++i) {
		v[grid.at(i, 0)] = v[grid.at(i, ny)] = 0;
		v[grid.at(i, -1)] = -v[grid.at(i, 1)];
		v[grid.at(i, ny + 1)] = -v[grid.at(i, ny - 1)];
		u[grid.at(i, -1)] = along * u[grid.at(i, 0)];
		u[grid.at(i, ny)] = along * u[grid.at(i, ny - 1)];
	}
}

void divergence(const Grid& grid, const FaceValues& flow, Values& cells)
{
	const std::size_t up = grid.stride();
	const double scale = 1 / grid.spacing;
	const double *u = flow.x.data(), *v = flow.y.data();
	double* out = cells.data();
	for (int j = 0; j < grid.ny; ++j) {
		const std::size_t row = grid.at(0, j);
		for (std::size_t c = row; c < row + std::size_t(grid.nx); ++c) out[c] = scale * (u[c + 1] - u[c] + v[c + up] - v[c]);
	}
}

}  // namespace graindrive::continuum
