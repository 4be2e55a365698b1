/// Sets up the grid, enters grains, and joins cells to cubes axis by axis.
#include "engines/loop/relative_motion_grid.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

namespace {

constexpr double cells_per_grain = 2;  // at most: a box that is mostly empty gets wider cells

}  // namespace

void RelativeMotionGrid::Range::include(const Range& other)
{
	for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], other.low[k]), high[k] = std::max(high[k], other.high[k]);
}

void RelativeMotionGrid::Motion::include(const Motion& other)
{
	now.include(other.now), then.include(other.then);
	allowed = std::max(allowed, other.allowed);
}

RelativeMotionGrid::RelativeMotionGrid(const State<3>& of, double until) : state(of), horizon(until)
{
	lay();
	for (std::uint32_t row = 0; row < state.n; ++row) enter(row);
	for (int axis = 0; axis < 3; ++axis) join_next_along(axis);
}

/// Cells are as narrow as possible, because in a shear flow displacements differ more within a wider cell; but free grains that
/// may touch must lie in the same or in adjacent cells. A larger member is entered in all cells that its box overlaps.
void RelativeMotionGrid::lay()
{
	double most_allowed = 0;
	for (const double budget : state.allowed) most_allowed = std::max(most_allowed, budget);
	Vec<3> slowest = Vec<3>::all(HUGE_VAL), fastest = Vec<3>::all(-HUGE_VAL);
	for (const Vec<3>& drift : state.drifts)
		for (int k = 0; k < 3; ++k) slowest[k] = std::min(slowest[k], drift[k]), fastest[k] = std::max(fastest[k], drift[k]);
	double wanted = 2 * state.largest_free_radius + 2 * most_allowed;
	if (!state.drifts.empty()) wanted += length(fastest - slowest) * horizon;
	const Cell<3>& cell = state.scene.cell;
	Vec<3> low = Vec<3>::all(HUGE_VAL), high = Vec<3>::all(-HUGE_VAL);
	for (std::uint32_t i = 0; i < state.n; ++i)
		for (int k = 0; k < 3; ++k)
			low[k] = std::min(low[k], state.rows[i].x[k]), high[k] = std::max(high[k], state.rows[i].x[k]);
	for (int k = 0; k < 3; ++k) {
		if (cell.periodic[k]) low[k] = cell.low[k], high[k] = cell.high[k];
		corner[k] = low[k];
	}
	const double enough = cells_per_grain * state.n + 8;
	double count = HUGE_VAL;
	for (; count > enough; wanted *= 1.3) {
		count = 1;
		for (int k = 0; k < 3; ++k) {
			cells[k] = int(std::clamp((high[k] - low[k]) / wanted, 1.0, enough));
			width[k] = std::max((high[k] - low[k]) / cells[k], wanted * 1e-3);
			count *= cells[k];
		}
	}
	motions.resize(std::size_t(cells[0]) * cells[1] * cells[2]);
}

void RelativeMotionGrid::enter(std::uint32_t row)
{
	const SphereRow& grain = state.rows[row];
	const std::uint32_t party = state.party_of(row);
	Motion motion;
	motion.allowed = state.allowed[party];
	for (int k = 0; k < 3; ++k) {
		motion.now.low[k] = motion.now.high[k] = grain.x[k] - state.searched_at[3 * row + k];
		motion.then.low[k] = motion.then.high[k] = motion.now.low[k] + state.drifts[party][k] * horizon;
	}
	const double beyond = std::max(0.0, grain.radius - state.largest_free_radius);
	int first[3], last[3];
	for (int k = 0; k < 3; ++k) {
		first[k] = int(std::floor((grain.x[k] - beyond - corner[k]) / width[k]));
		last[k] = int(std::floor((grain.x[k] + beyond - corner[k]) / width[k]));
		if (!state.scene.cell.periodic[k])
			first[k] = std::clamp(first[k], 0, cells[k] - 1), last[k] = std::clamp(last[k], 0, cells[k] - 1);
		last[k] = std::min(last[k], first[k] + cells[k] - 1);
	}
	const auto within = [&](int k, int c) { return (c % cells[k] + cells[k]) % cells[k]; };
	for (int x = first[0]; x <= last[0]; ++x)
		for (int y = first[1]; y <= last[1]; ++y)
			for (int z = first[2]; z <= last[2]; ++z) at(within(0, x), within(1, y), within(2, z)).include(motion);
}

/// Each cell includes the motions of the next cell along an axis; after the three axes it includes a cube of eight cells. Two
/// grains in adjacent cells lie in one such cube.
void RelativeMotionGrid::join_next_along(int axis)
{
	const std::vector<Motion> before = motions;
	const std::size_t stride = axis == 0 ? std::size_t(cells[1]) * cells[2] : axis == 1 ? cells[2] : 1;
	for (std::size_t c = 0; c < motions.size(); ++c) {
		const int place = int(c / stride % cells[axis]);
		if (place + 1 < cells[axis])
			motions[c].include(before[c + stride]);
		else if (state.scene.cell.periodic[axis])
			motions[c].include(before[c - place * stride]);
	}
}

double RelativeMotionGrid::largest_approach() const
{
	double largest = 0;
	for (const Motion& motion : motions) {
		if (!(motion.now.low[0] <= motion.now.high[0])) continue;  // no grain here
		for (const Range& range : { motion.now, motion.then })
			largest = std::max(largest, length(range.high - range.low) + 2 * motion.allowed);
	}
	return largest;
}

}  // namespace graindrive::loop
