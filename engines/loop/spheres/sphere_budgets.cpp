/// How far spheres may go before pairs are selected anew: every block of free spheres has a budget of its own, held spheres have one together.
///
/// A pair that is not selected was farther apart than both budgets together, and a sphere's way is never longer than sum v_max dt of its
/// block: until a block has used up its budget no such pair can touch. A few fast spheres so cost pairs around themselves alone.
#include <algorithm>
#include <cmath>

#include "engines/loop/spheres/sphere_loop.hpp"

namespace graindrive::loop {

namespace {

constexpr double fewest_steps = 20, most_steps = 200;  // between two selections, aimed at where spheres are fast
constexpr double selecting_cost = 3;                   // s, of looking at a candidate, over p, of computing a pair
constexpr double smallest = 0.001;                     // budget [d]
constexpr double largest_budget = 0.25;                // of the skin

}  // namespace

double SphereLoop::smallest_budget() const { return smallest * typical_diameter; }

/// By its own speed or that of a faster neighbour, which may push it.
void SphereLoop::allow_travel()
{
	std::vector<double> expected(speed);
	for (const auto& pair : neighbours) {
		expected[pair.first] = std::max(expected[pair.first], speed[pair.second]);
		expected[pair.second] = std::max(expected[pair.second], speed[pair.first]);
	}
	const double least = smallest_budget(), most = largest_budget * state.skin;
	state.travelled.resize(speed.size(), 0), state.allowed.resize(speed.size());
	for (std::size_t p = 0; p < speed.size(); ++p)
		state.allowed[p] = std::min(std::max(expected[p] * scene.dt * state.pace, least), most);
	const std::uint32_t held = state.n_blocks();  // nothing pushes them
	state.allowed[held] = std::min(speed[held] * scene.dt * state.pace, most);
}

/// Sets how many steps to aim at between selections. A pair that is selected and does not touch costs at every step, a selection once:
///
///   cost per step = p (N_0 + e n) + s N_candidates / n,  least for n = sqrt(s N_candidates / (p e)),
///
/// where e is how many more are selected for each step that budgets are made for: known from those that half the budgets would
/// select.
void SphereLoop::choose_pace()
{
	std::size_t by_half_budgets = 0;
	selected = 0;
	for (const PairCounts3& count : counts) selected += count.selected, by_half_budgets += count.by_half_budgets;
	const double more_per_step = 2 * std::max<double>(double(selected) - double(by_half_budgets), 1) / state.pace;
	state.pace = std::clamp(std::sqrt(selecting_cost * state.partners.size() / more_per_step), fewest_steps, most_steps);
}

}  // namespace graindrive::loop
