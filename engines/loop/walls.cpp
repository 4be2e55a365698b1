/// Checks walls and solids, and computes the size of the box that they bound.
#include <algorithm>
#include <cmath>

#include "engines/loop/guards.hpp"
#include "engines/loop/surfaces.hpp"

namespace graindrive::loop {

namespace {

constexpr const char* side_names[] = { "x_low", "x_high", "y_low", "y_high", "z_low", "z_high" };

template <int D>
void require_of(bool holds, const Wall<D>& wall, const std::string& rule, double got)
{
	if (!holds) throw std::invalid_argument(sentence("wall ", name_of(wall.side), ": ", rule, ", got ", got));
}

template <int D>
const Wall<D>* opposite(const Scene<D>& scene, const Wall<D>& wall)
{
	for (const Wall<D>& other : scene.walls)
		if (other.side != wall.side && other.axis() == wall.axis()) return &other;
	return nullptr;
}

/// Length of the box along an axis, 0 where nothing bounds it.
template <int D>
double extent(const Scene<D>& scene, int axis)
{
	if (scene.cell.periodic[axis]) return scene.cell.length(axis);
	const Wall<D>*low = nullptr, *high = nullptr;
	for (const Wall<D>& wall : scene.walls)
		if (wall.axis() == axis) (wall.outward() < 0 ? low : high) = &wall;
	return low && high ? high->position - low->position : 0;
}

/// Critical step at walls. The contact of a grain with a wall has the effective radius and mass of a pair of two grains with
/// twice the radius and mass, so the bound for pairs of such grains is used.
template <int D>
double critical_step_at_surfaces(Scene<D> scene)
{
	scene.walls.clear();
	for (Grain<D>& g : scene.grains) g.radius *= 2, g.mass *= 2;
	return critical_time_step(scene, 0.05);
}

template <int D>
void check_wall(const Scene<D>& scene, const Wall<D>& wall)
{
	const char* unit = D == 2 ? "[N/m]" : "[N/m^2]";
	const char* what = D == 2 ? "a length" : "an area";
	require_of(wall.axis() < D, wall, "disks have no walls across z", wall.axis());
	require_of(std::isfinite(wall.position), wall, "position must be finite [m]", wall.position);
	require_of(std::isfinite(wall.velocity) && geometry::is_finite(wall.slide), wall, "velocity and slide must be finite [m/s]",
		wall.velocity + geometry::norm(wall.slide));
	require_of(wall.slide[wall.axis()] == 0, wall, "slide must be along the wall; its part across it is `velocity` [m/s]",
		wall.slide[wall.axis()]);
	require_of(!scene.cell.periodic[wall.axis()], wall,
		"the box must not be periodic across it (leave that axis of GrainLoop.periods 0); period [m]",
		extent(scene, wall.axis()));
	const Wall<D>* facing = opposite(scene, wall);
	require_of(!facing || (facing->position - wall.position) * wall.outward() < 0, wall,
		"must lie on its own side of the opposite wall; position [m]", wall.position);
	if (!wall.pressed) return;
	require_of(std::isfinite(wall.pressure), wall, sentence("pressure must be finite ", unit), wall.pressure);
	require_of(wall.mass > 0 && std::isfinite(wall.mass), wall, "a wall under pressure needs a positive mass [kg]", wall.mass);
	require_of(wall.damping >= 0, wall, "damping must not be negative [kg/s]", wall.damping);
	require_of(wall.speed_limit > 0, wall, "speedLimit must be positive [m/s]", wall.speed_limit);
	require_of(wall_extent(scene, wall) > 0, wall,
		sentence("a pressure needs ", what, " to act on: a periodic box or two walls along the wall; ",
			D == 2 ? "length [m]" : "area [m^2]"),
		wall_extent(scene, wall));
}

/// A box that holds the given one in any orientation: its sides have the length of the diagonal, except along endless axes.
template <int D>
geometry::Bounds<D> turned_any_way(geometry::Bounds<D> box)
{
	double square = 0;
	for (int k = 0; k < D; ++k)
		if (std::isfinite(box.high[k] - box.low[k])) square += (box.high[k] - box.low[k]) * (box.high[k] - box.low[k]);
	for (int k = 0; k < D; ++k) {
		if (!std::isfinite(box.high[k] - box.low[k])) continue;
		const double middle = (box.low[k] + box.high[k]) / 2;
		box.low[k] = middle - std::sqrt(square) / 2, box.high[k] = middle + std::sqrt(square) / 2;
	}
	return box;
}

/// Only the image of a solid that is nearest to a grain's centre is computed, so no other image may touch the grain.
template <int D>
void check_solid(const Scene<D>& scene, const Solid<D>& solid)
{
	double largest = 0;
	for (const Grain<D>& g : scene.grains)
		if (g.body != solid.body) largest = std::max(largest, g.radius);
	if (largest > solid.shape->largest_sphere())
		throw std::invalid_argument(sentence("the solid of body ", solid.body, " is sampled only for grains up to a radius of ",
			solid.shape->largest_sphere(), " m, got one of ", largest, "; sample it on a grid that reaches farther out"));
	const RigidBody<D>& body = scene.bodies[solid.body];
	geometry::Bounds<D> box = body.bounds(solid.shape->bounds());
	if (length(body.spin) > 0 || body.turns_somewhere()) box = turned_any_way(box);
	for (int k = 0; k < D; ++k) {
		if (!scene.cell.periodic[k]) continue;
		const double wide = box.high[k] - box.low[k];
		if (std::isinf(wide) || wide + 2 * largest <= scene.cell.length(k)) continue;
		throw std::invalid_argument(sentence("the solid of body ", solid.body, " is ", wide, " m long along ", "xyz"[k],
			"; together with a grain of radius ", largest, " on both sides it must fit into the period of ", scene.cell.length(k),
			" m; lengthen the period, or give a solid that is endless along that axis"));
	}
}

}  // namespace

std::string name_of(Side side) { return side_names[static_cast<int>(side)]; }

template <int D>
Side side_named(const std::string& name)
{
	std::vector<std::string> names;
	for (int s = 0; s < 2 * D; ++s) {
		if (name == side_names[s]) return static_cast<Side>(s);
		names.push_back(side_names[s]);
	}
	throw std::invalid_argument("a wall's side must be " + laws::listed(names, " or ") + ", got " + name);
}

template <int D>
double wall_extent(const Scene<D>& scene, const Wall<D>& wall)
{
	double product = 1;
	for (int k = 0; k < D; ++k)
		if (k != wall.axis()) product *= extent(scene, k);
	return product;
}

template <int D>
void check_surfaces(const Scene<D>& scene)
{
	for (const Wall<D>& wall : scene.walls) check_wall(scene, wall);
	for (const Solid<D>& solid : scene.solids) check_solid(scene, solid);
	if (scene.walls.empty() && scene.solids.empty()) return;
	const auto acts_at_contact_point = [](const auto& law) { return law.acts_at_contact_point; };
	if (std::visit(acts_at_contact_point, scene.law))
		throw std::invalid_argument(sentence(scene.walls.empty() ? "solids" : "walls", ": the laws ",
			laws::listed(laws::names_where(acts_at_contact_point), " and "),
			" are for pairs of disks; take frozen disks, or another law"));
	const double critical = critical_step_at_surfaces(scene);
	if (scene.dt > critical)
		throw std::invalid_argument(sentence("time step must not exceed the critical one of a grain at a ",
			scene.walls.empty() ? "solid" : "wall", ", ", critical, ", got ", scene.dt, "; lower it or take softer grains"));
}

template <int D>
double filled_fraction(const Scene<D>& scene)
{
	double filled = 0, box = 1;
	for (const Grain<D>& g : scene.grains) {
		if (g.body != free_grain && scene.bodies[g.body].frozen) continue;
		filled += D == 2 ? pi * g.radius * g.radius : 4 * pi / 3 * g.radius * g.radius * g.radius;
	}
	for (int k = 0; k < D; ++k) box *= extent(scene, k);
	return filled / box;
}

template Side side_named<2>(const std::string&);
template Side side_named<3>(const std::string&);
template double wall_extent(const Scene<2>&, const Wall<2>&);
template double wall_extent(const Scene<3>&, const Wall<3>&);
template double filled_fraction(const Scene<2>&);
template double filled_fraction(const Scene<3>&);
template void check_surfaces(const Scene<2>&);
template void check_surfaces(const Scene<3>&);

}  // namespace graindrive::loop
