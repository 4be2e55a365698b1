/// Checks during the run: the bounds that grains must not pass, and the messages of all guards.
#include "engines/loop/running_guards.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

namespace {

constexpr double free_fall = 3;  // a grain this far below the base counts as lost [largest free diameter]

/// The text of a vector, "(1, 2)".
template <int D>
std::string listed(const Vec<D>& v)
{
	std::string text = "(";
	for (int k = 0; k < D; ++k) text += (k ? ", " : "") + sentence(v[k]);
	return text + ")";
}

}  // namespace

template <int D>
std::string RunningGuards<D>::time_of_step() const
{
	return sentence("step ", speech.first_step + state.steps, ": ");
}

template <int D>
std::string RunningGuards<D>::introduce(std::uint32_t row) const
{
	const std::uint32_t index = state.index_of[row];
	const long name = index < speech.names.size() ? speech.names[index] : long(index);
	return sentence("grain ", name, " at ", listed(state.rows[row].x), ", velocity ", listed(state.rows[row].v));
}

/// The bound of each side: the caller's if there is one, else some diameters behind the last grain or solid that is held against
/// gravity. A wall is a bound in any case.
template <int D>
std::array<typename RunningGuards<D>::Limit, 2 * D> RunningGuards<D>::limits() const
{
	std::array<Limit, 2 * D> all{};
	for (int s = 0; s < 2 * D; ++s)
		if (!state.scene.cell.periodic[axis_of(Side(s))])
			all[s] = state.guards.bounded ? given_bound(Side(s)) : behind_held_grains(Side(s));
	for (const Wall<D>& wall : state.scene.walls)
		all[int(wall.side)] = { wall.position, true, "wall " + name_of(wall.side), "a slower or heavier wall" };
	return all;
}

/// The caller's bound of a side; there is none along an axis whose two bounds are equal.
template <int D>
typename RunningGuards<D>::Limit RunningGuards<D>::given_bound(Side side) const
{
	const double low = state.guards.low[axis_of(side)], high = state.guards.high[axis_of(side)];
	return { outward_of(side) < 0 ? low : high, low < high, "the bounds that were set", "wider bounds, if grains may be there" };
}

/// The bound behind held grains and solids; none on sides to which gravity does not pull, and none if nothing is held.
template <int D>
typename RunningGuards<D>::Limit RunningGuards<D>::behind_held_grains(Side side) const
{
	const Vec<D>& gravity = state.scene.gravity;
	const int axis = axis_of(side);
	int down = D - 1;  // the axis along which gravity is largest
	for (int k = D - 2; k >= 0; --k)
		if (std::abs(gravity[k]) > std::abs(gravity[down])) down = k;
	if (axis != down || !(gravity[axis] * outward_of(side) > 0)) return {};
	double last = -HUGE_VAL;  // coordinate of the last held grain, positive outwards
	for (std::uint32_t row = state.n_free; row < state.n; ++row) {
		if (state.scene.bodies[state.members[row - state.n_free].body].responds[axis]) continue;
		last = std::max(last, outward_of(side) * state.rows[row].x[axis] + state.rows[row].radius);
	}
	for (const Solid<D>& solid : state.scene.solids) {
		const RigidBody<D>& body = state.scene.bodies[solid.body];
		if (body.responds[axis]) continue;
		const geometry::Bounds<D> box = body.bounds(solid.shape->bounds());
		last = std::max(last, outward_of(side) < 0 ? -box.low[axis] : box.high[axis]);
	}
	if (last == HUGE_VAL) return {};  // an endless solid
	return { outward_of(side) * (last + free_fall * 2 * state.largest_free_radius), last > -HUGE_VAL,
		"three diameters beyond the last grain that is held against gravity",
		"a base without gaps, or bounds if grains may fall there" };
}

template <int D>
void RunningGuards<D>::check_box() const
{
	const auto limits = this->limits();
	for (int s = 0; s < 2 * D; ++s) {
		const Limit& limit = limits[s];
		const double outward = outward_of(Side(s));
		if (!limit.is_set) continue;
		for (std::uint32_t row = 0; row < state.n; ++row) {
			if (!(outward * (state.rows[row].x[axis_of(Side(s))] - limit.at) > 0) || state.is_led(row)) continue;
			throw std::runtime_error(sentence(time_of_step(), introduce(row), " has left the box: its ", "xyz"[axis_of(Side(s))],
				outward < 0 ? " is below " : " is above ", limit.at, ", ", limit.by,
				"; likely it passed through other grains or a wall: use stiffer grains, a shorter time step, ", limit.cause));
		}
	}
}

template <int D>
void RunningGuards<D>::check_finite() const
{
	for (std::uint32_t i = 0; i < state.n_free; ++i) {
		const Row<D>& row = state.rows[i];
		double sum = 0;
		for (int k = 0; k < D; ++k) sum += row.x[k] + row.v[k];
		if (!std::isfinite(sum + inner(row.surface, row.surface)))
			throw std::runtime_error(sentence(time_of_step(), introduce(i),
				" is not finite; likely the time step is too long, or two grains began in one place"));
	}
}

template <int D>
void RunningGuards<D>::check_pair(std::uint32_t i, std::uint32_t j, bool wrapped) const
{
	const Row<D>&a = state.rows[i], &b = state.rows[j];
	const double smaller = std::min(a.radius, b.radius), nearest = a.radius + b.radius - state.guards.largest_overlap * smaller;
	Vec<D> d = b.x - a.x;
	if (wrapped) d = state.scene.cell.nearest(d).at;
	if (geometry::squared_norm(d) >= nearest * nearest || (state.is_led(i) && state.is_led(j))) return;
	throw std::runtime_error(sentence(time_of_step(), introduce(i), " and ", introduce(j), " overlap by ",
		placement<D>(a, b, state.scene.cell).overlap / smaller, " of a radius, more than ", state.guards.largest_overlap,
		"; likely causes: grains too soft for their speed or load, too long a time step, or an overlap at the start"));
}

template <int D>
void RunningGuards<D>::check_surfaces(const Surfaces<D>& surfaces) const
{
	for (const SurfaceTouch<D>& touch : state.touches) {
		const std::uint32_t at = state.row_of[touch.grain];
		const double radius = state.rows[at].radius, overlap = surfaces.placement_of(touch).overlap;
		if (state.is_led(at) || !(overlap > state.guards.largest_overlap * radius)) continue;
		throw std::runtime_error(sentence(time_of_step(), introduce(at), " overlaps ", surfaces.name_of_surface(touch.surface),
			" by ", overlap / radius, " of its radius, more than ", state.guards.largest_overlap,
			"; likely causes: grains too soft for their speed or load, too fast or light a wall, or grains beyond it at the "
			"start"));
	}
}

template class RunningGuards<2>;
template class RunningGuards<3>;

}  // namespace graindrive::loop
