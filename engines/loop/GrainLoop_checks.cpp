/// What GrainLoop refuses: numbers out of range, a cell with another period, bodies that are gone, disks that meet across an axis left free.
#include <algorithm>
#include <cmath>
#include <set>

#include "engines/loop/GrainLoop.hpp"

namespace graindrive {

namespace {

constexpr std::size_t numbers_per_wall = 9;

}  // namespace

void GrainLoop::check() const
{
	const std::vector<std::string> known = laws::law_names();
	require(std::count(known.begin(), known.end(), law) == 1,
		("GrainLoop.law must be " + laws::listed(known, " or ", "'")).c_str(), law);
	check_material();
	require(damping >= 0 && damping < 1, "GrainLoop.damping must lie in [0, 1)", damping);
	require(precision == "double" || precision == "single", "GrainLoop.precision must be 'double' or 'single'", precision);
	require(
		gravity.allFinite() && gravity[2] == 0, "GrainLoop.gravity must be finite and in the plane, 0 in z", gravity.transpose());
	require(std::isfinite(skin) && skin >= 0, "GrainLoop.skin must be finite and not negative", skin);
	require(threads >= 1 && threads <= 256, "GrainLoop.threads must lie in 1..256", threads);
	require(periods.allFinite() && periods[0] >= 0 && periods[1] >= 0 && periods[2] == 0,
		"GrainLoop.periods must not be negative, and 0 in z", periods.transpose());
	require(largestOverlap > 0 && largestOverlap <= 1, "GrainLoop.largestOverlap must lie in (0, 1] of the smaller radius",
		largestOverlap);
	require(syncEvery >= 0, "GrainLoop.syncEvery must not be negative", syncEvery);
	require(
		targetAreaFraction >= 0 && targetAreaFraction < 1, "GrainLoop.targetAreaFraction must lie in [0, 1)", targetAreaFraction);
	require(loads.size() % 3 == 0, "GrainLoop.loads must hold three numbers a body", loads.size());
	require(wallSettings.size() % numbers_per_wall == 0, "GrainLoop.wallSettings must hold nine numbers a wall; use setWall",
		wallSettings.size());
	require(wallSprings.size() % 3 == 0, "GrainLoop.wallSprings must hold three numbers a contact", wallSprings.size());
	require(bounds.empty() || bounds.size() == 4, "GrainLoop.bounds must be four numbers, xLow, yLow, xHigh, yHigh, or none",
		bounds.size());
	require(std::all_of(bounds.begin(), bounds.end(), [](Real b) { return std::isfinite(b); }),
		"GrainLoop.bounds must be finite; equal numbers leave an axis without bound", "one that is not");
	require(bounds.empty() || (bounds[0] <= bounds[2] && bounds[1] <= bounds[3]),
		"GrainLoop.bounds must be xLow, yLow, xHigh, yHigh with low <= high", "the other order");
	require(springs.size() % 3 == 0, "GrainLoop.springs must hold three numbers a contact", springs.size());
}

/// What laws are given, whatever the law in use; of several rules for one number that of the law in use holds.
void GrainLoop::check_material() const
{
	std::set<std::string> checked;
	const auto check_numbers_of = [&](const auto& kind) {
		std::decay_t<decltype(kind)>::Given::quantities([&](const laws::Quantity& q, auto) {
			if (checked.insert(q.name).second) laws::require(q, number(q.name), std::string("GrainLoop.") + q.name);
		});
	};
	std::visit(check_numbers_of, laws::law_named(law));
	laws::Laws::for_each(check_numbers_of);
	laws::require(laws::friction_coefficient, friction, "GrainLoop.friction");
}

/// A cell that is long on purpose leaves an axis free; one that repeats must do so with YADE's own length.
void GrainLoop::require_periods() const
{
	if (!scene->isPeriodic) return;
	if (periods.isZero(0))
		throw std::invalid_argument("GrainLoop: O.periodic is set but GrainLoop.periods are 0; give the period in x (and y), "
									"e.g. periods=(O.cell.size[0], 0, 0)");
	for (int axis = 0; axis < 2; ++axis) {
		const Real period = periods[axis], edge = scene->cell->hSize(axis, axis);
		if (period == 0 || std::abs(period - edge) <= 1e-12 * edge) continue;
		throw std::invalid_argument(std::string("GrainLoop: the period in ") + "xy"[axis] + " is " + std::to_string(period) +
									", O.cell repeats after " + std::to_string(edge) +
									"; make them equal (O.cell.setBox, or periods), or 0 for an axis that does not repeat");
	}
}

/// Bodies may be erased while the loop does not look; the few that it writes at every step are checked at every step.
void GrainLoop::require_bodies(bool all) const
{
	const auto require_all = [&](const std::vector<int>& ids) {
		for (const int id : ids)
			if (id >= 0 && !scene->bodies->exists(id))
				throw std::runtime_error("GrainLoop: body " + std::to_string(id) +
										 " was erased from O.bodies; call sync() before such a change and read() after it");
	};
	require_all(map_.body_id);
	if (all) require_all(map_.grain_id);
}

/// An axis of the cell that is left free must be longer than the scene: YADE lets grains meet across it.
void GrainLoop::require_spread() const
{
	if (!scene->isPeriodic) return;
	for (int axis = 0; axis < 2; ++axis) {
		if (periods[axis] != 0) continue;
		Real low = HUGE_VAL, high = -HUGE_VAL;
		for (std::size_t g = 0; g < stepper_->size(); ++g) {
			const loop::Grain grain = stepper_->grain(g);
			const Real at = axis == 0 ? grain.x : grain.y;
			low = std::min(low, at - grain.radius), high = std::max(high, at + grain.radius);
		}
		const Real edge = scene->cell->hSize(axis, axis);
		if (high - low <= edge) continue;
		throw std::invalid_argument(std::string("GrainLoop: disks reach over ") + std::to_string(high - low) + " m along " +
									"xy"[axis] + ", where O.cell repeats after " + std::to_string(edge) +
									" m and GrainLoop.periods is 0; give that period, or make the cell longer");
	}
}

}  // namespace graindrive
