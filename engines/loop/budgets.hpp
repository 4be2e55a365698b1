/// The distances that grains may travel before pairs are selected again: every block of free grains and every body has its own budget.
///
/// A pair that is not selected was farther apart than both budgets together, and a grain's way is never longer than sum v_max dt of its
/// block: until a block has used up its budget no such pair can touch. A few fast grains so cost pairs around themselves alone.
///
/// In space a block has a drift besides, its mean velocity when pairs were selected, and v_max is that of its grains against it: neighbours that
/// flow together come no nearer to each other. Two blocks whose drifts differ may approach by |U_a - U_b| dt a step for so many steps as the
/// selection may last, its horizon.
#pragma once
#include <utility>

#include "engines/loop/views.hpp"

namespace graindrive::loop {

template <int D>
class Budgets {
public:
	explicit Budgets(State<D>& of) : state(of) {}

	/// Speeds of the parties, and how far they are from where they were at the last search; all threads together, then barrier.
	void measure(int rank);
	void clear();  ///< before `measure`, by one thread
	/// Which parties have candidates in common.
	template <class Neighbours>
	void find_neighbours(const Neighbours& pairs);
	void allow_travel();
	/// For how long a selection may last, in space [s]; without end in the plane.
	void choose_horizon();
	void keep_horizon_within_skin();  ///< right after a search
	void choose_pace(const PairCounts& counts, std::size_t candidates);
	/// A bound on how much nearer two grains can have come to each other since the last search when the next selection is made [m].
	double approach_before_selection() const;
	/// Of two neighbours towards each other [m/s].
	double fastest_approach() const;
	double smallest() const;
	/// The largest speed of a point of a body relative to the body's drift [m/s].
	double body_speed(std::size_t body) const;
	/// The largest distance that a party may have moved since the last selection, or may move until the next one [m].
	double way(std::size_t party) const;
	double way_to_come(std::size_t party) const;
	/// After a step: adds the travel of bodies and images; the kernels add that of blocks.
	void spend(double drift);
	/// Adds the travel of the images across the side [m].
	void spend_on_images(double way);
	void begin_selection();

private:
	double gain_per_step() const;

	State<D>& state;
	std::vector<double> speed, displaced;                             // by party; speed against the drift
	std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours;  // those with candidates in common

	Vec<D> drift_of(std::size_t party) const { return D == 3 ? state.drifts[party] : Vec<D>{}; }
};

template <int D>
template <class Neighbours>
void Budgets<D>::find_neighbours(const Neighbours& pairs)
{
	neighbours.clear();
	std::vector<std::uint32_t> met(state.n_blocks() + state.scene.bodies.size(), 0);  // 1 + the last that met this one
	pairs.each_candidate([&](std::uint32_t a, std::uint32_t b) {
		const std::uint32_t one = state.party_of(a), other = state.party_of(b);
		if (one == other || met[other] == one + 1) return;
		met[other] = one + 1;
		neighbours.push_back({ one, other });
	});
}

}  // namespace graindrive::loop
