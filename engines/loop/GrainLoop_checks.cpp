/// GrainLoop's checks: numbers out of range, a cell with another period, missing bodies, contacts across a non-periodic axis.
#include <algorithm>
#include <cmath>
#include <set>

#include "engines/loop/GrainLoop.hpp"

namespace graindrive {

void GrainLoop::check() const
{
	const std::vector<std::string> known = laws::law_names();
	require(std::count(known.begin(), known.end(), law) == 1,
		("GrainLoop.law must be " + laws::listed(known, " or ", "'")).c_str(), law);
	check_material();
	require(damping >= 0 && damping < 1, "GrainLoop.damping must lie in [0, 1)", damping);
	require(precision == "double" || precision == "single", "GrainLoop.precision must be 'double' or 'single'", precision);
	const bool plane = dimensions == 2;
	require(dimensions == 2 || dimensions == 3, "GrainLoop.dimensions must be 2 or 3", dimensions);
	require(gravity.allFinite(), "GrainLoop.gravity must be finite", gravity.transpose());
	require(!plane || gravity[2] == 0, "GrainLoop.gravity must lie in the plane, 0 in z, with dimensions=2", gravity.transpose());
	require(std::isfinite(skin) && skin >= 0, "GrainLoop.skin must be finite and not negative", skin);
	require(threads >= 1 && threads <= 256, "GrainLoop.threads must lie in 1..256", threads);
	require(periods.allFinite() && periods.minCoeff() >= 0, "GrainLoop.periods must not be negative", periods.transpose());
	require(!plane || periods[2] == 0, "GrainLoop.periods must be 0 in z with dimensions=2", periods.transpose());
	require(largestOverlap > 0 && largestOverlap <= 1, "GrainLoop.largestOverlap must lie in (0, 1] of the smaller radius",
		largestOverlap);
	require(syncEvery >= 0, "GrainLoop.syncEvery must not be negative", syncEvery);
	require(
		targetAreaFraction >= 0 && targetAreaFraction < 1, "GrainLoop.targetAreaFraction must lie in [0, 1)", targetAreaFraction);
	require(loads.size() % 4 == 0, "GrainLoop.loads must hold four numbers per body; use setLoad", loads.size());
	require(wallSettings.size() % numbers_per_wall == 0, "GrainLoop.wallSettings must hold eleven numbers per wall; use setWall",
		wallSettings.size());
	const std::size_t of_a_spring = plane ? 3 : 5;
	const char* so_many = plane ? "three numbers per contact" : "five numbers per contact";
	require(wallSprings.size() % of_a_spring == 0, (std::string("GrainLoop.wallSprings must hold ") + so_many).c_str(),
		wallSprings.size());
	require(bounds.empty() || bounds.size() == 2u * dimensions,
		plane ? "GrainLoop.bounds must be four numbers, xLow, yLow, xHigh, yHigh, or none"
			  : "GrainLoop.bounds must be six numbers, xLow, yLow, zLow, xHigh, yHigh, zHigh, or none",
		bounds.size());
	require(std::all_of(bounds.begin(), bounds.end(), [](Real b) { return std::isfinite(b); }),
		"GrainLoop.bounds must be finite; equal numbers mean no bound along an axis", "one that is not");
	for (std::size_t k = 0; k < bounds.size() / 2; ++k)
		require(
			bounds[k] <= bounds[dimensions + k], "GrainLoop.bounds must hold the low ones first, low <= high", "the other order");
	require(springs.size() % of_a_spring == 0, (std::string("GrainLoop.springs must hold ") + so_many).c_str(), springs.size());
}

/// Checks the constants of all laws, also of those not in use. Where two laws have different rules for one number, the rule of
/// the law in use holds.
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

/// A period of 0 means that the axis does not repeat, however long YADE's cell is; any other period must equal the length of
/// YADE's cell.
void GrainLoop::require_periods() const
{
	if (!scene->isPeriodic) return;
	if (periods.isZero(0))
		throw std::invalid_argument("GrainLoop: O.periodic is set but GrainLoop.periods are 0; give the period in x (and y), "
									"e.g. periods=(O.cell.size[0], 0, 0)");
	for (int axis = 0; axis < dimensions; ++axis) {
		const Real period = periods[axis], edge = scene->cell->hSize(axis, axis);
		if (period == 0 || std::abs(period - edge) <= 1e-12 * edge) continue;
		throw std::invalid_argument(std::string("GrainLoop: the period in ") + "xyz"[axis] + " is " + std::to_string(period) +
									", but O.cell has the period " + std::to_string(edge) +
									"; make them equal (O.cell.setBox, or periods), or set 0 for an axis that is not periodic");
	}
}

}  // namespace graindrive
