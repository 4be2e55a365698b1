/// How far grains may go before pairs are selected anew: every block of free grains and every body has a budget of its own.
///
/// A pair that is not selected was farther apart than both budgets together, and a grain's way is never longer than sum v_max dt of its
/// block: until a block has used up its budget no such pair can touch. A few fast grains so cost pairs around themselves alone.
#include <algorithm>
#include <cmath>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

constexpr double fewest_steps = 20, most_steps = 200;  // between two selections, aimed at where grains are fast
constexpr double selecting_cost = 6;                   // s, of looking at a candidate, over p, of computing a pair (measured)
constexpr double smallest = 0.001;                     // budget [d]
constexpr double largest_budget = 0.25;                // of the skin

}  // namespace

/// Index of a grain's block or body among the budgets.
std::uint32_t Stepper::party_of(std::uint32_t row) const
{
	return row < n_free ? row / grains_per_block : n_blocks() + state.members[row - n_free].body;
}

double Stepper::smallest_budget() const { return smallest * typical_diameter; }

void Stepper::measure_speeds()
{
	speed.assign(n_blocks() + state.scene.bodies.size(), 0);
	for (std::uint32_t i = 0; i < n_free; ++i) {
		double& highest = speed[i / grains_per_block];
		highest = std::max(highest, state.rows[i].vx * state.rows[i].vx + state.rows[i].vy * state.rows[i].vy);
	}
	for (std::uint32_t b = 0; b < n_blocks(); ++b) speed[b] = std::sqrt(speed[b]);
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		const RigidBody& body = state.scene.bodies[b];
		if (!state.body_fixed[b]) speed[n_blocks() + b] = std::hypot(body.vx, body.vy) + std::abs(body.spin) * body_reach[b];
	}
}

void Stepper::find_neighbours()
{
	neighbours.clear();
	std::vector<std::uint32_t> met(n_blocks() + state.scene.bodies.size(), 0);  // 1 + the last that met this one
	for (const Candidate& pair : state.candidates) {
		const std::uint32_t one = party_of(pair.first), other = party_of(pair.second);
		if (one == other || met[other] == one + 1) continue;
		met[other] = one + 1;
		neighbours.push_back({ one, other });
	}
}

/// By its own speed or that of a faster neighbour, which may push it.
void Stepper::allow_travel()
{
	std::vector<double> expected(speed);
	for (const auto& pair : neighbours) {
		expected[pair.first] = std::max(expected[pair.first], speed[pair.second]);
		expected[pair.second] = std::max(expected[pair.second], speed[pair.first]);
	}
	const double least = smallest_budget(), most = largest_budget * state.skin;
	state.travelled.resize(speed.size());
	state.allowed.resize(speed.size());
	for (std::size_t p = 0; p < state.allowed.size(); ++p)
		state.allowed[p] = std::min(std::max(expected[p] * state.scene.dt * state.pace, least), most);
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b)
		if (state.body_fixed[b]) state.allowed[n_blocks() + b] = 0;
}

/// Sets how many steps to aim at between selections. A pair that is selected and does not touch costs at every step, a selection once:
///
///   cost per step = p (N_0 + e n) + s N_candidates / n,  least for n = sqrt(s N_candidates / (p e)),
///
/// where e is how many more are selected for each step that budgets are made for: known from those that half the budgets would
/// select. Only the speed depends on it, no bit of a result.
void Stepper::choose_pace(const PairCounts& counts)
{
	const double more_per_step = 2 * std::max<double>(counts.selected - counts.by_half_budgets, 1) / state.pace;
	state.pace = std::clamp(std::sqrt(selecting_cost * state.candidates.size() / more_per_step), fewest_steps, most_steps);
}

/// How far from its place at the last search any grain can be before the next selection.
double Stepper::farthest_before_selection() const
{
	double farthest = 0;
	for (std::uint32_t i = 0; i < n_grains; ++i) {
		const double dx = state.rows[i].x - state.searched_at[2 * i], dy = state.rows[i].y - state.searched_at[2 * i + 1];
		farthest = std::max(farthest, std::sqrt(dx * dx + dy * dy) + state.allowed[party_of(i)]);
	}
	return farthest;
}

/// After a step: what blocks have travelled the kernels know; here bodies.
void Stepper::spend_budgets()
{
	for (const char beyond : thread_beyond) state.selection_due |= beyond != 0;
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		if (state.body_fixed[b]) continue;
		const RigidBody& body = state.scene.bodies[b];
		double& way = state.travelled[n_blocks() + b];
		way += (std::hypot(body.vx, body.vy) + std::abs(body.spin) * body_reach[b]) * data.drift;
		state.selection_due |= way > state.allowed[n_blocks() + b];
	}
}

void Stepper::point_at_lists()
{
	pairs.point(data);
	data.rows = state.rows.data();
	data.travelled = state.travelled.data();
	data.allowed = state.allowed.data();
}

}  // namespace graindrive::loop
