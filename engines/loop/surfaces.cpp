/// Contacts of grains with walls and solids: list, forces, motion.
#include "engines/loop/surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

namespace {

constexpr double least_reach = 0.2;  // grains are listed at least up to this distance from a surface [d]

using geometry::cross;

}  // namespace

template <int D>
void Surfaces<D>::remember_places()
{
	left_at.clear();
	for (const Solid<D>& solid : state.scene.solids) left_at.push_back(state.scene.bodies[solid.body]);
}

template <int D>
bool Surfaces<D>::moved_by_hand()
{
	bool moved = false;
	for (std::size_t s = 0; s < left_at.size() && s < state.scene.solids.size(); ++s) {
		const RigidBody<D>& body = state.scene.bodies[state.scene.solids[s].body];
		const Vec<D> axis = Vec<D>::along(0), other = Vec<D>::along(1);
		moved |= body.place != left_at[s].place || body.turn.apply(axis) != left_at[s].turn.apply(axis) ||
		         body.turn.apply(other) != left_at[s].turn.apply(other);
	}
	if (moved) forget_list();
	return moved;
}

/// Lists the grains near each surface, in the order in which they were given. The list reaches twice as far as grains may move
/// until the next selection, so that fast grains do not make a new list due at every step; the reach does not change which grains
/// touch.
template <int D>
void Surfaces<D>::list(double to_come)
{
	if (!any()) return;
	surface_way.resize(count(), 0);
	if (largest_way + to_come + *std::max_element(surface_way.begin(), surface_way.end()) <= reach) return;
	reach = std::max(least_reach * state.typical_diameter, 2 * to_come);
	std::vector<SurfaceTouch<D>> listed;
	auto known = state.touches.begin();
	for (std::uint32_t s = 0; s < count(); ++s)
		for (std::uint32_t g = 0; g < state.n; ++g) {
			while (known != state.touches.end() && (known->surface < s || (known->surface == s && known->grain < g))) ++known;
			if (!may_touch(s, g)) continue;
			const bool seen = known != state.touches.end() && known->surface == s && known->grain == g;
			SurfaceTouch<D> touch;
			touch.surface = s, touch.grain = g;
			if (seen) touch = *known;
			if (placement_of(touch).overlap >= -reach) listed.push_back(touch);
		}
	state.touches.swap(listed);
	measure_spread();
	largest_way = 0;
	std::fill(surface_way.begin(), surface_way.end(), 0);
}

/// False if neither the grain nor the surface can move, if the grain belongs to the solid's own body, or if it is outside the
/// solid's box.
template <int D>
bool Surfaces<D>::may_touch(std::uint32_t s, std::uint32_t g) const
{
	const int owner = state.scene.grains[g].body;
	const bool fixed = owner != free_grain && state.body_fixed[owner];
	if (is_wall(s)) return !fixed;
	const Solid<D>& solid = this->solid(s);
	if (owner == solid.body || (fixed && state.body_fixed[solid.body])) return false;
	const RigidBody<D>& body = state.scene.bodies[solid.body];
	const Row<D>& row = state.rows[state.row_of[g]];
	const Vec<D> point = body.to_frame(seen_from_solid(s, body, row.x));
	const geometry::Bounds<D> box = solid.shape->bounds();
	const double beyond = row.radius + reach;
	for (int k = 0; k < D; ++k)
		if (point[k] < box.low[k] - beyond || point[k] > box.high[k] + beyond) return false;
	return true;
}

template <int D>
Vec<D> Surfaces<D>::seen_from_solid(std::uint32_t surface, const RigidBody<D>& body, const Vec<D>& point) const
{
	const Vec<D> middle = body.to_world(state.middles[surface - state.scene.walls.size()]);
	return middle + state.scene.cell.nearest(point - middle).at;
}

template <int D>
Placement<D> Surfaces<D>::placement_of(const SurfaceTouch<D>& touch) const
{
	const Row<D>& row = state.rows[state.row_of[touch.grain]];
	if (is_wall(touch.surface)) return placement<D>(row, state.scene.walls[touch.surface]);
	const Solid<D>& solid = this->solid(touch.surface);
	const RigidBody<D>& body = state.scene.bodies[solid.body];
	const geometry::Nearest<D> found = body.nearest(*solid.shape, seen_from_solid(touch.surface, body, row.x));
	return { -found.normal, row.radius - found.distance };
}

template <int D>
SurfaceMotion<D> Surfaces<D>::motion_at(const SurfaceTouch<D>& touch) const
{
	if (is_wall(touch.surface)) return { state.scene.walls[touch.surface].surface_velocity(), {} };
	const RigidBody<D>& body = state.scene.bodies[solid(touch.surface).body];
	return { body.velocity + cross(body.spin, touch.arm), {} };
}

template <int D>
Vec<D> Surfaces<D>::arm_of(const SurfaceTouch<D>& touch) const
{
	const RigidBody<D>& body = state.scene.bodies[solid(touch.surface).body];
	const Row<D>& row = state.rows[state.row_of[touch.grain]];
	return seen_from_solid(touch.surface, body, row.x) - body.place + (row.radius - touch.overlap / 2) * touch.normal;
}

template <int D>
double Surfaces<D>::effective_mass_at(const SurfaceTouch<D>& touch) const
{
	double inverse = state.inverse_mass(state.row_of[touch.grain]);
	if (!is_wall(touch.surface)) {
		const RigidBody<D>& body = state.scene.bodies[solid(touch.surface).body];
		if (body.responds_somewhere()) inverse += 1 / body.mass;
	}
	return laws::effective_mass(inverse);
}

template <int D>
Vec<D> Surfaces<D>::force_on_grain(const SurfaceTouch<D>& touch) const
{
	return force_on_first(touch.normal, touch.pressing, touch.friction);
}

template <int D>
void Surfaces<D>::compute_forces()
{
	for (Wall<D>& wall : state.scene.walls) wall.force = {};
	for (SurfaceTouch<D>& touch : state.touches) {
		const Row<D>& row = state.rows[state.row_of[touch.grain]];
		const Placement<D> at = placement_of(touch);
		touch.spring_normal_before = touch.spring_normal;
		touch.spring_normal = touch.normal = at.normal, touch.overlap = at.overlap;
		touch.pressing = 0, touch.friction = {};
		touch.slip_before = touch.slip;
		if (!is_wall(touch.surface)) touch.arm = arm_of(touch);
		if (!(touch.overlap > 0)) {
			touch.slip = {};
			continue;
		}
		const auto contact = kinematics<D>(
			at, relative_motion(at.normal, motion_of(row), motion_at(touch)), row.radius, effective_mass_at(touch), motion.dt);
		const auto slip = for_law(turned_along(touch.slip, touch.spring_normal_before, at.normal));
		const auto response = std::visit([&](const auto& law) { return answer_of(law(contact, slip)); }, state.scene.law);
		touch.pressing = response.normal;
		if (state.scene.friction) touch.friction = response.tangential, touch.slip = response.slip;
		if (is_wall(touch.surface)) state.scene.walls[touch.surface].force -= force_on_grain(touch);
	}
}

template <int D>
void Surfaces<D>::take_back()
{
	for (SurfaceTouch<D>& touch : state.touches) touch.slip = touch.slip_before, touch.spring_normal = touch.spring_normal_before;
}

/// Adds forces to bodies. Free grains have already moved, so the values stored by `compute_forces` are used.
template <int D>
void Surfaces<D>::add_to_bodies()
{
	for (const SurfaceTouch<D>& touch : state.touches) {
		if (!(touch.overlap > 0)) continue;
		const Vec<D> force = force_on_grain(touch);
		const std::uint32_t at = state.row_of[touch.grain];
		const Row<D>& row = state.rows[at];
		if (const int owner = state.scene.grains[touch.grain].body; owner != free_grain && !state.body_fixed[owner]) {
			RigidBody<D>& body = state.scene.bodies[owner];
			const Vec<D> arm = row.x - state.members[at - state.n_free].shift - body.place;
			body.force += force;
			body.torque += cross(arm, force) + row.radius * turning(touch.normal, touch.friction);
		}
		if (is_wall(touch.surface)) continue;
		const int owner = solid(touch.surface).body;
		if (state.body_fixed[owner]) continue;
		RigidBody<D>& body = state.scene.bodies[owner];
		body.force -= force;
		body.torque -= cross(touch.arm, force);
	}
}

/// An upper bound for the speed at which a surface approaches grains; that of a turning solid is taken at the farthest grain.
template <int D>
double Surfaces<D>::speed_of(std::uint32_t s) const
{
	if (is_wall(s)) return std::abs(state.scene.walls[s].velocity);
	const RigidBody<D>& body = state.scene.bodies[solid(s).body];
	return length(body.velocity) + length(body.spin) * farthest_grain[s - state.scene.walls.size()];
}

template <int D>
void Surfaces<D>::measure_spread()
{
	farthest_grain.clear();
	for (std::uint32_t s = state.scene.walls.size(); s < count(); ++s) {
		double farthest = 0;  // squared distance
		const RigidBody<D>& body = state.scene.bodies[solid(s).body];
		for (std::uint32_t i = 0; i < state.n && length(body.spin) > 0; ++i)
			farthest = std::max(farthest, geometry::squared_norm(seen_from_solid(s, body, state.rows[i].x) - body.place));
		farthest_grain.push_back(std::sqrt(farthest) + state.typical_diameter);
	}
}

template <int D>
void Surfaces<D>::move()
{
	for (Wall<D>& wall : state.scene.walls) wall.move(wall_extent(state.scene, wall), motion.kick, motion.drift);
	for (std::uint32_t s = 0; s < surface_way.size(); ++s) surface_way[s] += speed_of(s) * motion.drift;
	if (state.scene.target_fraction > 0 && filled_fraction(state.scene) >= state.scene.target_fraction)
		for (Wall<D>& wall : state.scene.walls) wall.velocity = 0, wall.pressed = false;
}

template <int D>
std::string Surfaces<D>::name_of_surface(std::uint32_t surface) const
{
	if (is_wall(surface)) return "wall " + name_of(state.scene.walls[surface].side);
	return "the solid of body " + std::to_string(solid(surface).body);
}

template class Surfaces<2>;
template class Surfaces<3>;

}  // namespace graindrive::loop
