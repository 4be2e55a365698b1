/// How far the parties (blocks of grains, and bodies) may travel before pairs are selected anew.
#include "engines/loop/budgets.hpp"

#include <algorithm>
#include <cmath>

#include "engines/loop/relative_motion_grid.hpp"

namespace graindrive::loop {

namespace {

constexpr double fewest_steps = 20, most_steps = 200;  // aimed at between two selections of pairs, if grains are fast
constexpr double smallest_part = 0.001;                // smallest budget [d]
constexpr double horizon_in_paces = 1.25;              // longest time between selections, over the pace
constexpr double drifts_share_of_skin = 0.6;           // share of the skin for drifts; two budgets use up to twice 0.15 of it

/// Largest budget, as a fraction of the skin.
template <int D>
constexpr double largest_part = D == 2 ? 0.25 : 0.15;

/// Cost s of testing a candidate over cost p of computing a pair (measured; see choose_pace).
template <int D>
constexpr double selecting_cost = D == 2 ? 6 : 3;

}  // namespace

template <int D>
double Budgets<D>::smallest() const
{
	return smallest_part * state.typical_diameter;
}

template <int D>
double Budgets<D>::body_speed(std::size_t b) const
{
	const RigidBody<D>& body = state.scene.bodies[b];
	return length(body.velocity - drift_of(state.n_blocks() + b)) + length(body.spin) * state.reach[b];
}

/// Sets the longest time until the next selection: somewhat longer than the pace, but so short that two drifts part by one
/// diameter at most, because the cells in which displacements are compared must contain all grains that may touch until then.
template <int D>
void Budgets<D>::choose_horizon()
{
	if (D == 2) return;
	const double steps =
		std::min(horizon_in_paces * state.pace, std::max(state.typical_diameter / gain_per_step(), fewest_steps));
	state.horizon = std::ceil(steps) * state.scene.dt;
}

/// Shortens the horizon so that no two grains approach by more than the skin until then: a search finds only pairs nearer than
/// the skin.
template <int D>
void Budgets<D>::keep_horizon_within_skin()
{
	if (D == 2) return;
	const double steps = std::max(1., std::floor(drifts_share_of_skin * state.skin / gain_per_step()));
	state.horizon = std::min(state.horizon, steps * state.scene.dt);
}

/// Largest approach of two parties in a step by the difference of their drifts [m].
template <int D>
double Budgets<D>::gain_per_step() const
{
	Vec<D> slowest = Vec<D>::all(HUGE_VAL), fastest = Vec<D>::all(-HUGE_VAL);
	for (std::size_t p = 0; p < speed.size(); ++p)
		for (int k = 0; k < D; ++k)
			slowest[k] = std::min(slowest[k], drift_of(p)[k]), fastest[k] = std::max(fastest[k], drift_of(p)[k]);
	return speed.empty() ? 0 : length(fastest - slowest) * state.scene.dt;
}

template <int D>
double Budgets<D>::way(std::size_t p) const
{
	if (D == 2) return state.travelled[p];
	return state.travelled[p] + length(drift_of(p)) * (state.steps - state.selected_at) * state.scene.dt;
}

template <int D>
double Budgets<D>::way_to_come(std::size_t p) const
{
	if (D == 2) return state.allowed[p];
	return state.allowed[p] + length(drift_of(p)) * state.horizon;
}

template <int D>
void Budgets<D>::clear()
{
	speed.assign(state.n_blocks() + state.scene.bodies.size(), 0);
	displaced.assign(speed.size(), 0);
	if (D == 3) state.drifts.assign(speed.size(), {});
}

template <int D>
void Budgets<D>::measure(int rank)
{
	const auto way_of = [&](std::uint32_t i) {
		if (state.searches == 0) return 0.0;
		double square = 0;
		for (int k = 0; k < D; ++k) {
			const double way = state.rows[i].x[k] - state.searched_at[D * i + k];
			square += way * way;
		}
		return square;
	};
	const std::uint32_t blocks = state.n_blocks(), threads = state.scene.threads;
	for (std::uint32_t b = std::uint64_t(blocks) * rank / threads; b < std::uint64_t(blocks) * (rank + 1) / threads; ++b) {
		const std::uint32_t first = b * grains_per_block, end = std::min(first + grains_per_block, state.n_free);
		if constexpr (D == 3) {
			Vec<D> sum;
			for (std::uint32_t i = first; i < end; ++i) sum += state.rows[i].v;
			state.drifts[b] = sum / (end - first);
		}
		double fastest = 0, farthest = 0;
		for (std::uint32_t i = first; i < end; ++i) {
			fastest = std::max(fastest, geometry::squared_norm(state.rows[i].v - drift_of(b)));
			farthest = std::max(farthest, way_of(i));
		}
		speed[b] = std::sqrt(fastest), displaced[b] = std::sqrt(farthest);
	}
	if (rank != 0) return;
	for (std::uint32_t i = state.n_free; i < state.n; ++i) {
		double& farthest = displaced[state.party_of(i)];
		farthest = std::max(farthest, std::sqrt(way_of(i)));
	}
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		if (state.body_fixed[b]) continue;
		if (D == 3) state.drifts[blocks + b] = state.scene.bodies[b].velocity;
		speed[blocks + b] = body_speed(b);
	}
}

/// Gives each party a budget by its own speed or by that of a faster neighbour, which may push it.
template <int D>
void Budgets<D>::allow_travel()
{
	std::vector<double> expected(speed);
	for (const auto& pair : neighbours) {
		expected[pair.first] = std::max(expected[pair.first], speed[pair.second]);
		expected[pair.second] = std::max(expected[pair.second], speed[pair.first]);
	}
	const double least = smallest(), most = largest_part<D> * state.skin;
	state.travelled.resize(speed.size());
	state.allowed.resize(speed.size());
	for (std::size_t p = 0; p < state.allowed.size(); ++p)
		state.allowed[p] = std::min(std::max(expected[p] * state.scene.dt * state.pace, least), most);
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b)
		if (state.body_fixed[b]) state.allowed[state.n_blocks() + b] = 0;
	if (state.scene.cell.sheared())
		state.images_may_go =
			std::clamp(length(state.flow.image_velocity) * state.scene.dt * state.pace, least, std::max(least, most));
}

/// Sets how many steps to aim at between selections. A selected pair that does not touch costs time at every step, a selection
/// costs once:
///
///   cost per step = p (N_0 + e n) + s N_candidates / n,  least for n = sqrt(s N_candidates / (p e)),
///
/// where e is the number of additional pairs per step between selections, estimated from the number that half the budgets would
/// select. The pace changes the speed only, no bit of a result.
template <int D>
void Budgets<D>::choose_pace(const PairCounts& counts, std::size_t candidates)
{
	const double more_per_step = 2 * std::max(double(counts.selected) - double(counts.by_half_budgets), 1.0) / state.pace;
	state.pace = std::clamp(std::sqrt(selecting_cost<D> * candidates / more_per_step), fewest_steps, most_steps);
}

/// In the plane it is assumed that each of two grains has moved as far as the one that moved farthest.
template <>
double Budgets<2>::approach_before_selection() const
{
	double farthest = 0;
	for (std::size_t p = 0; p < displaced.size(); ++p) farthest = std::max(farthest, displaced[p] + state.allowed[p]);
	return 2 * farthest + state.images_went_since_search + state.images_may_go;
}

/// In space the differences between the displacements of neighbours are used, which are smaller.
template <>
double Budgets<3>::approach_before_selection() const
{
	for (const double way : displaced)
		if (!std::isfinite(way)) return HUGE_VAL;  // other code has moved grains
	return RelativeMotionGrid(state, state.horizon).largest_approach();
}

template <int D>
double Budgets<D>::fastest_approach() const
{
	if (D == 2 || neighbours.empty()) {
		double fastest = 0;
		for (std::size_t p = 0; p < speed.size(); ++p) fastest = std::max(fastest, length(drift_of(p)) + speed[p]);
		return 2 * fastest + length(state.flow.image_velocity);
	}
	double fastest = 0;
	for (const auto& [a, b] : neighbours) fastest = std::max(fastest, speed[a] + speed[b] + length(drift_of(a) - drift_of(b)));
	for (const double of_party : speed) fastest = std::max(fastest, 2 * of_party);
	return fastest;
}

template <int D>
void Budgets<D>::spend(double drift)
{
	// A step that ends at the horizon may still be made with the selected pairs.
	if (D == 3) state.selection_due |= (state.steps + 1 - state.selected_at) * state.scene.dt >= state.horizon;
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		if (state.body_fixed[b]) continue;
		double& way = state.travelled[state.n_blocks() + b];
		way += body_speed(b) * drift;
		state.selection_due |= way > state.allowed[state.n_blocks() + b];
	}
	if (state.scene.cell.sheared()) spend_on_images(length(state.scene.cell.image_velocity()) * drift);
}

template <int D>
void Budgets<D>::spend_on_images(double way)
{
	state.images_went += way, state.images_went_since_search += way;
	state.selection_due |= state.images_went > state.images_may_go;
}

template <int D>
void Budgets<D>::begin_selection()
{
	std::fill(state.travelled.begin(), state.travelled.end(), 0);
	state.images_went = 0;
	state.selection_due = false;
	state.selected_at = state.steps;
	++state.selections;
}

template class Budgets<2>;
template class Budgets<3>;

}  // namespace graindrive::loop
