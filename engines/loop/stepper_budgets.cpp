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
	return row < n_free ? row / grains_per_block : n_blocks() + members[row - n_free].body;
}

double Stepper::smallest_budget() const { return smallest * typical_diameter; }

void Stepper::measure_speeds()
{
	speed.assign(n_blocks() + scene.bodies.size(), 0);
	for (std::uint32_t i = 0; i < n_free; ++i) {
		double& highest = speed[i / grains_per_block];
		highest = std::max(highest, rows[i].vx * rows[i].vx + rows[i].vy * rows[i].vy);
	}
	for (std::uint32_t b = 0; b < n_blocks(); ++b) speed[b] = std::sqrt(speed[b]);
	for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
		const RigidBody& body = scene.bodies[b];
		if (!body_fixed[b]) speed[n_blocks() + b] = std::hypot(body.vx, body.vy) + std::abs(body.spin) * body_reach[b];
	}
}

void Stepper::find_neighbours()
{
	neighbours.clear();
	std::vector<std::uint32_t> met(n_blocks() + scene.bodies.size(), 0);  // 1 + the last that met this one
	for (const Candidate& pair : pairs.candidates) {
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
	const double least = smallest_budget(), most = largest_budget * skin;
	travelled.resize(speed.size());
	allowed.resize(speed.size());
	for (std::size_t p = 0; p < allowed.size(); ++p) allowed[p] = std::min(std::max(expected[p] * scene.dt * pace, least), most);
	for (std::size_t b = 0; b < scene.bodies.size(); ++b)
		if (body_fixed[b]) allowed[n_blocks() + b] = 0;
}

/// Sets how many steps to aim at between selections. A pair that is selected and does not touch costs at every step, a selection once:
///
///   cost per step = p (N_0 + e n) + s N_candidates / n,  least for n = sqrt(s N_candidates / (p e)),
///
/// where e is how many more are selected for each step that budgets are made for: known from those that half the budgets would
/// select. Only the speed depends on it, no bit of a result.
void Stepper::choose_pace(const PairCounts& counts)
{
	const double more_per_step = 2 * std::max<double>(counts.selected - counts.by_half_budgets, 1) / pace;
	pace = std::clamp(std::sqrt(selecting_cost * pairs.candidates.size() / more_per_step), fewest_steps, most_steps);
}

/// How far from its place at the last search any grain can be before the next selection.
double Stepper::farthest_before_selection() const
{
	double farthest = 0;
	for (std::uint32_t i = 0; i < n_grains; ++i) {
		const double dx = rows[i].x - searched_at[2 * i], dy = rows[i].y - searched_at[2 * i + 1];
		farthest = std::max(farthest, std::sqrt(dx * dx + dy * dy) + allowed[party_of(i)]);
	}
	return farthest;
}

/// After a step: what blocks have travelled the kernels know; here bodies.
void Stepper::spend_budgets()
{
	for (const char beyond : thread_beyond) selection_due |= beyond != 0;
	for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
		if (body_fixed[b]) continue;
		const RigidBody& body = scene.bodies[b];
		double& way = travelled[n_blocks() + b];
		way += (std::hypot(body.vx, body.vy) + std::abs(body.spin) * body_reach[b]) * data.drift;
		selection_due |= way > allowed[n_blocks() + b];
	}
}

void Stepper::point_at_lists()
{
	pairs.point(data);
	data.rows = rows.data();
	data.travelled = travelled.data();
	data.allowed = allowed.data();
}

}  // namespace graindrive::loop
