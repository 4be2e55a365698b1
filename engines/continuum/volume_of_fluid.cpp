/// Fluxes of THINC and WLIC, and the two sweeps of a step.
#include "engines/continuum/volume_of_fluid.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace graindrive::continuum {

namespace {

constexpr double pure = 1e-6;  // a cell closer than this to empty or full has no surface

/// Integral of (1 + s tanh(beta (x - x_0)))/2 over the part of a cell of unit length that leaves it, with mean a. With
/// B = exp(2 beta x_0), cosh(beta (1 - x_0))/cosh(beta (1 - c - x_0)) = exp(beta c) (1 + B q)/(1 + B q exp(2 beta c)),
/// q = exp(-2 beta), and likewise at the cell's other end.
double thinc(double a, double sign, double courant, double beta)
{
	const double full = sign > 0 ? 2 - 2 * a : 2 * a, rest = 2 - full, c = std::abs(courant);
	const double B = std::expm1(beta * full) / -std::expm1(-beta * rest);
	const double q = std::exp(-2 * beta), turned = std::exp((courant > 0 ? 2 : -2) * beta * c);
	const double ratio = courant > 0 ? (1 + B * q) / (1 + B * q * turned) : (1 + B * turned) / (1 + B);
	return 0.5 * (c + sign * (c + std::log(ratio) / beta));
}

}  // namespace

VolumeOfFluid::VolumeOfFluid(const Grid& g, const Domain& domain, double sharpness)
	: grid(g),
	  moves_x(g.zeros()),
	  moves_y(g.zeros()),
	  whole(g.zeros()),
	  beta(sharpness),
	  flux(g.zeros()),
	  above_half(g.zeros()),
	  first_dilation(g.zeros())
{
	if (!(beta > 0) || !std::isfinite(beta))
		throw std::invalid_argument("the sharpness of a surface must be positive, got " + std::to_string(beta));
	const std::size_t up = grid.stride();
	const Values& fluid = domain.fluid;
	grid.for_x_faces([&](int, int, std::size_t f) { moves_x[f] = fluid[f] * fluid[f - 1]; });
	grid.for_y_faces([&](int, int, std::size_t f) { moves_y[f] = fluid[f] * fluid[f - up]; });
	if (grid.periodic_x)
		for (int j = 0; j < grid.ny; ++j) moves_x[grid.at(grid.nx, j)] = moves_x[grid.at(0, j)];
	// On closed edges of the grid the velocity itself is zero, so their cells count as whole.
	grid.for_cells([&](int i, int j, std::size_t c) {
		const bool left = moves_x[c] > 0 || (i == 0 && !grid.periodic_x);
		const bool right = moves_x[c + 1] > 0 || (i == grid.nx - 1 && !grid.periodic_x);
		const bool below = moves_y[c] > 0 || j == 0, above = moves_y[c + up] > 0 || j == grid.ny - 1;
		whole[c] = left && right && below && above && fluid[c] > 0;
	});
}

void VolumeOfFluid::advect(Values& fraction, const FaceValues& velocity, double dt, bool x_first)
{
	std::transform(fraction.begin(), fraction.end(), above_half.begin(), [](double a) { return a > 0.5 ? 1.0 : 0.0; });
	fill_ghosts(grid, fraction);
	const Sweep along_x{ &velocity.x, &moves_x, 1 }, along_y{ &velocity.y, &moves_y, grid.stride() };
	const double scale = dt / grid.spacing;
	sweep(fraction, x_first ? along_x : along_y, scale, false);
	fill_ghosts(grid, fraction);
	sweep(fraction, x_first ? along_y : along_x, scale, true);
	fill_ghosts(grid, fraction);
}

/// What leaves `donor` through a face across direction `step` with Courant number `courant`, > 0 along it, in cells, >= 0.
double VolumeOfFluid::flux_of(
	const Values& fraction, std::size_t donor, std::size_t step, std::size_t across, double courant) const
{
	const double* a = fraction.data() + donor;
	if (a[0] < pure || a[0] > 1 - pure) return a[0] * std::abs(courant);
	const auto at = [&](int along, int side) { return a[std::ptrdiff_t(step) * along + std::ptrdiff_t(across) * side]; };
	const double along = (at(1, -1) - at(-1, -1)) + 2 * (at(1, 0) - at(-1, 0)) + (at(1, 1) - at(-1, 1));
	const double sideways = (at(-1, 1) - at(-1, -1)) + 2 * (at(0, 1) - at(0, -1)) + (at(1, 1) - at(1, -1));
	const double total = std::abs(along) + std::abs(sideways);
	if (total == 0 || at(1, 0) == at(-1, 0)) return a[0] * std::abs(courant);
	const double weight = std::abs(along) / total, sign = at(1, 0) > at(-1, 0) ? 1 : -1;
	return weight * thinc(a[0], sign, courant, beta) + (1 - weight) * a[0] * std::abs(courant);
}

/// Fluxes along one direction, whose neighbours are `along` apart in memory, then the change of every cell.
void VolumeOfFluid::sweep(Values& fraction, const Sweep& s, double scale, bool second)
{
	const std::size_t across = s.along == 1 ? grid.stride() : 1;
	const Values &velocity = *s.velocity, &moves = *s.moves;
	const int last_i = grid.nx + (s.along == 1), last_j = grid.ny + (s.along != 1);
	for (int j = 0; j < last_j; ++j)
		for (std::size_t f = grid.at(0, j); f < grid.at(last_i, j); ++f) {
			const double courant = scale * velocity[f] * moves[f];
			flux[f] = courant > 0   ? flux_of(fraction, f - s.along, s.along, across, courant)
			          : courant < 0 ? -flux_of(fraction, f, s.along, across, courant)
			                        : 0;
		}
	grid.for_cells([&](int, int, std::size_t c) {
		const double own = scale * (velocity[c + s.along] * moves[c + s.along] - velocity[c] * moves[c]);
		// The divergence that the projection leaves must not change the area: the dilatations of both directions cancel.
		const double dilation = second && whole[c] > 0 ? -first_dilation[c] : own;
		if (!second) first_dilation[c] = own;
		fraction[c] += flux[c] - flux[c + s.along] + above_half[c] * dilation;
	});
}

double area_of(const Grid& grid, const Values& fraction, const Values* weight)
{
	double sum = 0;
	grid.for_cells([&](int, int, std::size_t c) { sum += weight ? fraction[c] * (*weight)[c] : fraction[c]; });
	return sum * grid.spacing * grid.spacing;
}

}  // namespace graindrive::continuum
