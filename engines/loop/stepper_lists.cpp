/// Search and selection of pairs: when they are due, and the parts common to all dimensions.
#include <algorithm>
#include <cmath>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

/// Steps aimed at between two searches if grains are fast. In space displacements are compared over some diameters, and over
/// these a shear flow gives three times the difference that it gives between two neighbours.
template <int D>
constexpr double steps_between_searches = D == 2 ? 300 : 900;
constexpr double smallest_skin = 0.1;  // [d]
template <int D>
constexpr double largest_skin = D == 2 ? 0.35 : 0.6;  // [d], by measurement: makes searches rarer in flowing grains

}  // namespace

/// Makes new lists, with all threads together; false if a guard has raised an error.
template <int D>
bool Stepper<D>::update_lists(int rank)
{
	team->barrier();  // all threads have read selection_due
	if (rank == 0) {
		if (D == 2 && state.selections > 0) pairs.keep_springs();
		double farthest = 0;
		for (std::size_t p = 0; p < state.travelled.size(); ++p) farthest = std::max(farthest, budgets.way(p));
		surfaces.note_selection(farthest);
		budgets.clear();
	}
	team->barrier();
	budgets.measure(rank);
	team->barrier();
	if (rank == 0) plan_lists();
	team->barrier();
	if (failure) return false;
	if (searching) {
		pairs.find(rank);
		team->barrier();
		if (rank == 0) pairs.gather(), budgets.clear();
		team->barrier();
		pairs.take(rank);
		budgets.measure(rank);
		team->barrier();
		if (rank == 0) budgets.find_neighbours(pairs), budgets.allow_travel();
		team->barrier();
	}
	pairs.select(rank, budgets.smallest(), state.horizon);
	team->barrier();
	if (rank == 0) finish_lists();
	team->barrier();
	return true;
}

/// Decides whether a search is due, and begins it.
template <int D>
void Stepper<D>::plan_lists()
{
	try {
		budgets.choose_horizon();
		if (state.searches > 0) budgets.allow_travel();
		searching = state.searches == 0 || !(budgets.approach_before_selection() <= state.skin);
		if (searching) begin_search(), budgets.keep_horizon_within_skin();
		// In space the guards also check after selections without a search: two grains that pass through each other need not
		// cause a search.
		moved_since_look |= searching || D == 3;
	} catch (...) {
		failure = std::current_exception();
	}
}

template <int D>
void Stepper<D>::begin_search()
{
	const double d = state.typical_diameter, wanted = budgets.fastest_approach() * state.scene.dt * steps_between_searches<D>;
	double largest = largest_skin<D> * d;
	for (int k = 0; D == 3 && k < D; ++k)  // the search needs three cells along a period
		if (state.scene.cell.periodic[k])
			largest = std::min(largest, 0.999 * state.scene.cell.length(k) / 3 - 2 * state.largest_free_radius);
	const double least = smallest_skin * d;
	state.skin = state.scene.skin > 0 ? state.scene.skin : std::clamp(wanted, least, std::max(least, largest));
	wrap_into_cell();
	pairs.begin_search(given_springs);
	given_springs.clear();
	state.searched_at.resize(D * state.n);
	for (std::uint32_t i = 0; i < state.n; ++i)
		for (int k = 0; k < D; ++k) state.searched_at[D * i + k] = state.rows[i].x[k];
	state.images_went_since_search = 0;
	++state.searches;
}

template <int D>
void Stepper<D>::wrap_into_cell()
{
	for (std::uint32_t i = 0; i < state.n; ++i) {
		Row<D>& row = state.rows[i];
		const geometry::Image<D> image = state.scene.cell.wrap(row.x);
		if (i >= state.n_free) state.members[i - state.n_free].shift += image.at - row.x;
		row.x = image.at;
		if (!state.scene.cell.sheared() || !image.wrapped) continue;
		const Vec<D> before = row.v;
		row.v += state.scene.cell.velocity_change(image);
		if (books) books->ledger.see_from_image(state.inverse_mass(i), before, row.v);
	}
}

template <int D>
void Stepper<D>::finish_lists()
{
	pairs.finish_selection();
	budgets.choose_pace(pairs.counts(), pairs.candidates());
	budgets.begin_selection();
	laid_out_since_forces = state.steps > 0;
	searching = false;
}

template class Stepper<2>;
template class Stepper<3>;

}  // namespace graindrive::loop
