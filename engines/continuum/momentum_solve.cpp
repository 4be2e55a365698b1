/// Viscosity within a step: a constant part by components, or the whole of it.
#include "engines/continuum/momentum_solve.hpp"

#include <algorithm>

#include "engines/continuum/plain_conjugate_gradients.hpp"

namespace graindrive::continuum {

namespace {

/// 1 on the faces that are open to the fluid, 0 elsewhere, ghosts too.
FaceValues free_faces(const Grid& grid, const Domain& domain)
{
	FaceValues free = zero_faces(grid);
	grid.for_x_faces([&](int, int, std::size_t f) { free.x[f] = domain.open.x[f] > 0; });
	grid.for_y_faces([&](int, int, std::size_t f) { free.y[f] = domain.open.y[f] > 0; });
	return free;
}

template <class Work>
void for_rows(const Grid& grid, Work&& work)
{
	for (int j = 0; j < grid.ny; ++j) work(grid.at(0, j), grid.at(grid.nx, j));
}

}  // namespace

SplitViscosity::SplitViscosity(const Grid& g, const Domain& domain, Edge e)
	: grid(g),
	  edge(e),
	  free(free_faces(g, domain)),
	  direction(zero_faces(g)),
	  image(zero_faces(g)),
	  rest(zero_faces(g))
{
}

void SplitViscosity::apply(double a, FaceValues& of, FaceValues& result) const
{
	fill_ghosts(grid, of, edge);
	const double neighbour = a / (grid.spacing * grid.spacing), own = 1 + 4 * neighbour;
	const std::size_t up = grid.stride();
	const auto component = [&](const Values& from, const Values& open, Values& to) {
		const double *v = from.data(), *mask = open.data();
		double* out = to.data();
		for_rows(grid, [&](std::size_t first, std::size_t end) {
			for (std::size_t f = first; f < end; ++f)
				out[f] = mask[f] * (own * v[f] - neighbour * (v[f - 1] + v[f + 1] + v[f - up] + v[f + up]));
		});
	};
	component(of.x, free.x, result.x);
	component(of.y, free.y, result.y);
}

MomentumReport SplitViscosity::solve(double a, const FaceValues& given, FaceValues& delta, double tolerance)
{
	apply(a, delta, image);
	const double scale = std::sqrt(dot(given, given));
	for_rows(grid, [&](std::size_t first, std::size_t end) {
		for (std::size_t f = first; f < end; ++f) {
			rest.x[f] = free.x[f] * given.x[f] - image.x[f];
			rest.y[f] = free.y[f] * given.y[f] - image.y[f];
		}
	});
	FaceValues& preconditioned = rest;  // the diagonal is constant
	const GradientReport report = conjugate_gradients(
		"the constant part of the viscosity", [&](FaceValues& p, FaceValues& Ap) { apply(a, p, Ap); },
		[](const FaceValues&, const FaceValues&) {}, delta, rest, direction, image, preconditioned, scale, tolerance);
	return { report.iterations, report.residual };
}

FullViscosity::FullViscosity(const Grid& g, const Domain& domain, Edge e)
	: grid(g),
	  edge(e),
	  free(free_faces(g, domain)),
	  direction(zero_faces(g)),
	  image(zero_faces(g)),
	  rest(zero_faces(g)),
	  preconditioned(zero_faces(g)),
	  over_diagonal(zero_faces(g)),
	  rates(g),
	  stresses(g)
{
}

void FullViscosity::apply(const FaceValues& inertia, const Viscosities& viscosity, FaceValues& of, FaceValues& result)
{
	fill_ghosts(grid, of, edge);
	rates_of(grid, of, rates);
	viscous_force(grid, rates, viscosity, stresses, result);
	const auto component = [&](const Values& weight, const Values& v, const Values& open, Values& out) {
		for_rows(grid, [&](std::size_t first, std::size_t end) {
			for (std::size_t f = first; f < end; ++f) out[f] = open[f] * (weight[f] * v[f] - out[f]);
		});
	};
	component(inertia.x, of.x, free.x, result.x);
	component(inertia.y, of.y, free.y, result.y);
}

void FullViscosity::find_diagonal(const FaceValues& inertia, const Viscosities& viscosity)
{
	const std::size_t up = grid.stride();
	const double scale = 1 / (grid.spacing * grid.spacing);
	const Values &eta = viscosity.cells, &nodes = viscosity.nodes;
	for_rows(grid, [&](std::size_t first, std::size_t end) {
		for (std::size_t f = first; f < end; ++f) {
			const double here = nodes[f];
			const double x = inertia.x[f] + scale * (2 * (eta[f] + eta[f - 1]) + here + nodes[f + up]);
			const double y = inertia.y[f] + scale * (2 * (eta[f] + eta[f - up]) + here + nodes[f + 1]);
			over_diagonal.x[f] = free.x[f] / (free.x[f] > 0 ? x : 1);
			over_diagonal.y[f] = free.y[f] / (free.y[f] > 0 ? y : 1);
		}
	});
}

MomentumReport FullViscosity::solve(
	const FaceValues& inertia, const Viscosities& viscosity, const FaceValues& given, FaceValues& velocity, double tolerance)
{
	find_diagonal(inertia, viscosity);
	apply(inertia, viscosity, velocity, image);
	for_rows(grid, [&](std::size_t first, std::size_t end) {
		for (std::size_t f = first; f < end; ++f) {
			rest.x[f] = free.x[f] * given.x[f];
			rest.y[f] = free.y[f] * given.y[f];
		}
	});
	const auto precondition = [&](const FaceValues& r, FaceValues& z) {
		for (std::size_t k = 0; k < z.x.size(); ++k) {
			z.x[k] = over_diagonal.x[k] * r.x[k];
			z.y[k] = over_diagonal.y[k] * r.y[k];
		}
	};
	precondition(rest, preconditioned);
	const double scale = std::sqrt(dot(rest, preconditioned));
	add(-1, image, rest);
	const GradientReport report = conjugate_gradients(
		"the viscosity", [&](FaceValues& p, FaceValues& Ap) { apply(inertia, viscosity, p, Ap); }, precondition, velocity, rest,
		direction, image, preconditioned, scale, tolerance);
	fill_ghosts(grid, velocity, edge);
	return { report.iterations, report.residual };
}

}  // namespace graindrive::continuum
