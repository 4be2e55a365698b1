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
	const double wanted = 2 * *std::max_element(speed.begin(), speed.end()) * scene.dt * steps_between_searches;
	skin = scene.skin > 0 ? scene.skin : std::clamp(wanted, smallest_skin * typical_diameter, largest_skin * typical_diameter);
	for (std::uint32_t i = 0; i < n_free; ++i) {
		if (scene.box.periodic_x) rows[i].x = into_box(rows[i].x, scene.box.x_low, scene.box.x_high);
		if (scene.box.periodic_y) rows[i].y = into_box(rows[i].y, scene.box.y_low, scene.box.y_high);
	}
	for (std::size_t m = 0; m < members.size(); ++m) {
		GrainRow& row = rows[n_free + m];
		const double x = row.x, y = row.y;
		if (scene.box.periodic_x) row.x = into_box(x, scene.box.x_low, scene.box.x_high);
		if (scene.box.periodic_y) row.y = into_box(y, scene.box.y_low, scene.box.y_high);
		members[m].shift_x += row.x - x;
		members[m].shift_y += row.y - y;
	}
	sort_rows();
	searched_at.resize(2 * n_grains);
	for (std::uint32_t i = 0; i < n_grains; ++i) {
		searched_at[2 * i] = rows[i].x;
		searched_at[2 * i + 1] = rows[i].y;
	}
	++searches;
}

void Stepper::sort_rows()
{
	grid.lay(rows.data(), n_free, scene.box, 2 * largest_free_radius + skin);
	std::vector<std::uint32_t> order;
	grid.sort(rows.data(), n_free, order);
	std::vector<std::uint32_t> new_row(n_grains);
	AlignedVector<GrainRow> sorted(rows);
	std::vector<std::uint32_t> sorted_index(index_of);
	for (std::uint32_t at = 0; at < n_grains; ++at) {
		const std::uint32_t from = at < n_free ? order[at] : at;
		new_row[from] = at;
		sorted[at] = rows[from];
		sorted_index[at] = index_of[from];
	}
	rows.swap(sorted);
	index_of.swap(sorted_index);
	for (std::uint32_t at = 0; at < n_grains; ++at) row_of[index_of[at]] = at;
	const SpringBook springs(pairs.candidates, new_row, given_springs, row_of, n_grains);
	given_springs.clear();
	std::vector<int> body_of(n_grains, free_grain);
	for (std::size_t m = 0; m < members.size(); ++m) body_of[n_free + m] = members[m].body;
	find_candidates(
		{ rows.data(), n_free, n_grains, body_of.data(), &scene.bodies, &body_fixed, &scene.box, skin, largest_free_radius },
		grid, pairs.candidates);
	for (Candidate& pair : pairs.candidates) pair.slip = springs.of(pair.first, pair.second);
}

}  // namespace graindrive::loop
