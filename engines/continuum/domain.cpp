/// Openness of faces from a distance, and the solid's velocity there.
#include "engines/continuum/domain.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "engines/base/real.hpp"

namespace graindrive::continuum {

namespace {

const Grid& checked(const Grid& grid)
{
	if (grid.nx < 2 || grid.ny < 2)
		throw std::invalid_argument("a grid must have at least 2 cells a side, got " + std::to_string(grid.nx) + " by " +
									std::to_string(grid.ny) + "; make the spacing smaller");
	if (!(grid.spacing > 0) || !std::isfinite(grid.spacing))
		throw std::invalid_argument("the spacing of a grid must be positive, got " + std::to_string(grid.spacing));
	return grid;
}

bool any_open_face(const Grid& grid, const FaceValues& open, std::size_t cell)
{
	return open.x[cell] > 0 || open.x[cell + 1] > 0 || open.y[cell] > 0 || open.y[cell + grid.stride()] > 0;
}

}  // namespace

double openness(double distance_into_solid, double half_width)
{
	if (distance_into_solid <= -half_width) return 1;
	if (distance_into_solid >= half_width) return 0;
	return 0.5 * (1 - std::sin(pi * distance_into_solid / (2 * half_width)));
}

Domain::Domain(const Grid& grid) : Domain(grid, [](double, double) { return 1.0; }, 0, {}) {}

Domain::Domain(const Grid& grid, const Distance& distance, double half_width, const WallMotion& motion)
	: open(zero_faces(checked(grid))),
	  wall(zero_faces(grid)),
	  cell_open(grid.zeros()),
	  fluid(grid.zeros())
{
	const auto chi = [&](double x, double y) {
		const double d = distance(x, y);
		if (!std::isfinite(d)) throw std::invalid_argument("the distance from a wall must be a finite number everywhere");
		return openness(-d, half_width);
	};
	grid.for_x_faces([&](int i, int j, std::size_t f) {
		open.x[f] = chi(grid.face_x(i), grid.centre_y(j));
		wall.x[f] = motion.velocity_x - motion.spin * (grid.centre_y(j) - motion.y);
	});
	grid.for_y_faces([&](int i, int j, std::size_t f) {
		open.y[f] = chi(grid.centre_x(i), grid.face_y(j));
		wall.y[f] = motion.velocity_y + motion.spin * (grid.centre_x(i) - motion.x);
	});
	if (grid.periodic_x)
		for (int j = 0; j < grid.ny; ++j) {
			open.x[grid.at(grid.nx, j)] = open.x[grid.at(0, j)];
			wall.x[grid.at(grid.nx, j)] = wall.x[grid.at(0, j)];
		}
	grid.for_cells([&](int i, int j, std::size_t c) { cell_open[c] = chi(grid.centre_x(i), grid.centre_y(j)); });
	if (std::none_of(cell_open.begin(), cell_open.end(), [](double part) { return part >= 1; }))
		throw std::invalid_argument("no cell of the grid is wholly in the fluid; make the spacing smaller or the space larger");
	fill_ghosts(grid, cell_open);
	grid.for_cells([&](int, int, std::size_t c) { fluid[c] = any_open_face(grid, open, c); });
	fill_ghosts(grid, fluid);
}

WallLayer::WallLayer(const Grid& grid, const Domain& domain, const Distance& distance, double half_width)
{
	const double h = grid.spacing,
				 inside = half_width + 0.75 * h;  // at this depth the four cells around a point are mostly fluid
	grid.for_cells([&](int i, int j, std::size_t c) {
		if (domain.cell_open[c] >= 1) return;
		const double x = grid.centre_x(i), y = grid.centre_y(j), e = 0.25 * h;
		double nx = distance(x + e, y) - distance(x - e, y), ny = distance(x, y + e) - distance(x, y - e);
		const double length = std::hypot(nx, ny);
		if (!(length > 0)) return;  // on the solid's middle line there is no nearest point
		const double way = (inside - distance(x, y)) / length;
		const double column = (x + way * nx - grid.low_x) / h - 0.5, row = (y + way * ny - grid.low_y) / h - 0.5;
		const int left = int(std::floor(column)), below = int(std::floor(row));
		if (left < 0 || below < 0 || left + 1 >= grid.nx || below + 1 >= grid.ny) return;
		const double a = column - left, b = row - below;
		const double share[4] = { (1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b };
		double most = 1e-3;
		std::size_t from = c;
		for (int k = 0; k < 4; ++k) {
			const std::size_t other = grid.at(left + k % 2, below + k / 2);
			if (domain.cell_open[other] < 1 || share[k] <= most) continue;
			most = share[k];
			from = other;
		}
		if (from != c) layer.push_back({ c, from });
	});
}

void WallLayer::extend(Values& cells) const
{
	for (const Taken& taken : layer) cells[taken.cell] = cells[taken.from];
}

}  // namespace graindrive::continuum
