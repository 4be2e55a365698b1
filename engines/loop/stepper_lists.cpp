/// Search and sorting: where rows lie in memory, and how springs follow their pairs to new places.
#include <algorithm>
#include <cmath>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

constexpr double steps_between_searches = 300;              // aimed at, where grains are fast
constexpr double smallest_skin = 0.1, largest_skin = 0.35;  // [d]

double into_box(double at, double low, double high) { return at - (high - low) * std::floor((at - low) / (high - low)); }

/// Springs by owner, for the time when pairs change their numbers.
struct SpringBook {
	std::vector<std::uint32_t> begin;
	std::vector<std::pair<std::uint32_t, double>> entries;  // partner, slip

	SpringBook(const std::vector<Candidate>& pairs, const std::vector<std::uint32_t>& new_row, const std::vector<Spring>& given,
		const std::vector<std::uint32_t>& row_of, std::uint32_t n_grains)
		: begin(n_grains + 2, 0)
	{
		const auto each = [&](auto&& visit) {
			for (const Spring& s : given)
				visit(std::min(row_of[s.first], row_of[s.second]), std::max(row_of[s.first], row_of[s.second]), s.slip);
			for (const Candidate& pair : pairs) {
				if (pair.slip == 0) continue;
				const std::uint32_t a = new_row[pair.first], b = new_row[pair.second];
				visit(std::min(a, b), std::max(a, b),
					pair.slip);  // a spring has no side: its sign survives a swap of the two grains
			}
		};
		each([&](std::uint32_t owner, std::uint32_t, double) { ++begin[owner + 2]; });
		for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
		entries.resize(begin.back());
		each([&](std::uint32_t owner, std::uint32_t partner, double slip) { entries[begin[owner + 1]++] = { partner, slip }; });
	}

	double of(std::uint32_t owner, std::uint32_t partner) const
	{
		for (std::uint32_t e = begin[owner]; e < begin[owner + 1]; ++e)
			if (entries[e].first == partner) return entries[e].second;
		return 0;
	}
};

}  // namespace

void Stepper::search()
{
	const double wanted = 2 * *std::max_element(speed.begin(), speed.end()) * state.scene.dt * steps_between_searches;
	state.skin = state.scene.skin > 0 ? state.scene.skin
	                                  : std::clamp(wanted, smallest_skin * typical_diameter, largest_skin * typical_diameter);
	for (std::uint32_t i = 0; i < n_free; ++i) {
		if (state.scene.box.periodic_x)
			state.rows[i].x = into_box(state.rows[i].x, state.scene.box.x_low, state.scene.box.x_high);
		if (state.scene.box.periodic_y)
			state.rows[i].y = into_box(state.rows[i].y, state.scene.box.y_low, state.scene.box.y_high);
	}
	for (std::size_t m = 0; m < state.members.size(); ++m) {
		GrainRow& row = state.rows[n_free + m];
		const double x = row.x, y = row.y;
		if (state.scene.box.periodic_x) row.x = into_box(x, state.scene.box.x_low, state.scene.box.x_high);
		if (state.scene.box.periodic_y) row.y = into_box(y, state.scene.box.y_low, state.scene.box.y_high);
		state.members[m].shift_x += row.x - x;
		state.members[m].shift_y += row.y - y;
	}
	sort_rows();
	state.searched_at.resize(2 * n_grains);
	for (std::uint32_t i = 0; i < n_grains; ++i) {
		state.searched_at[2 * i] = state.rows[i].x;
		state.searched_at[2 * i + 1] = state.rows[i].y;
	}
	++state.searches;
}

void Stepper::sort_rows()
{
	grid.lay(state.rows.data(), n_free, state.scene.box, 2 * largest_free_radius + state.skin);
	std::vector<std::uint32_t> order;
	grid.sort(state.rows.data(), n_free, order);
	std::vector<std::uint32_t> new_row(n_grains);
	AlignedVector<GrainRow> sorted(state.rows);
	std::vector<std::uint32_t> sorted_index(state.index_of);
	for (std::uint32_t at = 0; at < n_grains; ++at) {
		const std::uint32_t from = at < n_free ? order[at] : at;
		new_row[from] = at;
		sorted[at] = state.rows[from];
		sorted_index[at] = state.index_of[from];
	}
	state.rows.swap(sorted);
	state.index_of.swap(sorted_index);
	for (std::uint32_t at = 0; at < n_grains; ++at) row_of[state.index_of[at]] = at;
	const SpringBook springs(state.candidates, new_row, given_springs, row_of, n_grains);
	given_springs.clear();
	std::vector<int> body_of(n_grains, free_grain);
	for (std::size_t m = 0; m < state.members.size(); ++m) body_of[n_free + m] = state.members[m].body;
	find_candidates({ state.rows.data(), n_free, n_grains, body_of.data(), &state.scene.bodies, &state.body_fixed,
						&state.scene.box, state.skin, largest_free_radius },
		grid, state.candidates);
	for (Candidate& pair : state.candidates) pair.slip = springs.of(pair.first, pair.second);
}

}  // namespace graindrive::loop
