/// Guards that look at every grain and pair from time to time: not finite, out of the box, overlapping too far.
#include "engines/loop/guards.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

constexpr double free_fall = 3;  // how far below a base a grain counts as lost [largest free diameter]
constexpr Side sides[] = { Side::x_low, Side::x_high, Side::y_low, Side::y_high };

bool is_across_x(Side side) { return side == Side::x_low || side == Side::x_high; }
double outward(Side side) { return side == Side::x_low || side == Side::y_low ? -1 : 1; }

}  // namespace

std::string Stepper::now() const { return sentence("step ", spoken_first_step + state.steps, ": "); }

std::string Stepper::introduce(std::uint32_t row) const
{
	const std::uint32_t index = state.index_of[row];
	const long name = index < grain_names.size() ? grain_names[index] : long(index);
	return sentence("grain ", name, " at (", state.rows[row].x, ", ", state.rows[row].y, "), velocity (", state.rows[row].vx,
		", ", state.rows[row].vy, ")");
}

/// Where it goes is nobody's force's doing.
bool Stepper::is_led(std::uint32_t row) const
{
	if (row < n_free) return false;
	const RigidBody& body = state.scene.bodies[state.members[row - n_free].body];
	return !body.responds_x && !body.responds_y;
}

/// Where the caller sets bounds, these; where gravity presses grains onto held ones, some diameters behind the last of those. A wall in any case.
std::array<Stepper::Limit, 4> Stepper::limits() const
{
	std::array<Limit, 4> all{};
	for (const Side side : sides)
		if (!(is_across_x(side) ? state.scene.box.periodic_x : state.scene.box.periodic_y))
			all[int(side)] = state.guards.bounded ? given_bound(side) : behind_held_grains(side);
	for (const Wall& wall : state.scene.walls)
		all[int(wall.side)] = { wall.position, true, std::string("wall ") + name_of(wall.side), "a slower or heavier wall" };
	return all;
}

/// Two equal bounds are none.
Stepper::Limit Stepper::given_bound(Side side) const
{
	const bool x = is_across_x(side);
	const double low = x ? state.guards.x_low : state.guards.y_low, high = x ? state.guards.x_high : state.guards.y_high;
	return { outward(side) < 0 ? low : high, low < high, "the bounds that were set", "wider bounds, if grains may be there" };
}

/// None where gravity does not pull, or no grain is held against it.
Stepper::Limit Stepper::behind_held_grains(Side side) const
{
	const bool x = is_across_x(side);
	const bool is_down = (std::abs(state.scene.gravity_x) > std::abs(state.scene.gravity_y)) == x;  // the axis of the larger part
	const double pull = (x ? state.scene.gravity_x : state.scene.gravity_y) * outward(side);
	if (!is_down || !(pull > 0)) return {};
	double last = -HUGE_VAL;  // outwards
	for (std::uint32_t row = n_free; row < n_grains; ++row) {
		const RigidBody& body = state.scene.bodies[state.members[row - n_free].body];
		if (x ? body.responds_x : body.responds_y) continue;
		last = std::max(last, outward(side) * (x ? state.rows[row].x : state.rows[row].y) + state.rows[row].radius);
	}
	return { outward(side) * (last + free_fall * 2 * largest_free_radius), last > -HUGE_VAL,
		"three diameters behind the last grain that is held against gravity",
		"a base without gaps, or bounds if grains may fall there" };
}

void Stepper::check_box() const
{
	const auto limits = this->limits();
	for (const Side side : sides) {
		const Limit& limit = limits[int(side)];
		if (!limit.is_set) continue;
		for (std::uint32_t row = 0; row < n_grains; ++row) {
			const double at = is_across_x(side) ? state.rows[row].x : state.rows[row].y;
			if (!(outward(side) * (at - limit.at) > 0) || is_led(row)) continue;
			throw std::runtime_error(sentence(now(), introduce(row), " has left the box: its ", is_across_x(side) ? "x" : "y",
				outward(side) < 0 ? " is below " : " is above ", limit.at, ", ", limit.by,
				"; likely it was pressed or thrown through: take stiffer grains, a shorter time step, ", limit.cause));
		}
	}
}

void Stepper::check_pairs() const
{
	for (std::uint32_t i = 0; i < n_free; ++i) {
		const double sum = state.rows[i].x + state.rows[i].y + state.rows[i].vx + state.rows[i].vy + state.rows[i].surface_speed;
		if (!std::isfinite(sum))
			throw std::runtime_error(sentence(
				now(), introduce(i), " is not finite; likely the time step is too long or two grains were put into one place"));
	}
	for (std::uint32_t c = 0; c < pairs.place.size(); ++c) {
		const Candidate& pair = state.candidates[c];
		if (!pairs.place[c] || (is_led(pair.first) && is_led(pair.second))) continue;
		const GrainRow &a = state.rows[pair.first], &b = state.rows[pair.second];
		const Separation d = separation(a, b, state.scene.box);
		const double allowed = state.guards.largest_overlap * std::min(a.radius, b.radius),
					 nearest = a.radius + b.radius - allowed;
		if (d.x * d.x + d.y * d.y >= nearest * nearest) continue;
		const double overlap = placement(a, b, state.scene.box).overlap;
		throw std::runtime_error(sentence(now(), introduce(pair.first), " and ", introduce(pair.second), " overlap by ",
			overlap / std::min(a.radius, b.radius), " of a radius, more than ", state.guards.largest_overlap,
			"; likely grains too soft for their speed or load, a time step too long, or an overlapping start"));
	}
}

}  // namespace graindrive::loop
