/// Search and selection: where rows lie in memory, which pairs are listed, and how springs follow their pairs to new places.
#include <algorithm>
#include <cmath>

#include "engines/loop/spheres/sphere_loop.hpp"

namespace graindrive::loop {

namespace {

constexpr double steps_between_searches = 300;              // aimed at, where spheres are fast
constexpr double smallest_skin = 0.1, largest_skin = 0.35;  // [d]
constexpr double work_of_a_sphere = 2;                      // in candidates, for even shares

}  // namespace

/// All threads together; false if the lists could not be made.
bool SphereLoop::update_lists(int rank)
{
	measure_motion(rank);
	team->barrier();
	if (rank == 0) plan_lists();
	team->barrier();
	if (failure) return false;
	if (searching) {
		std::uint32_t* count = state.candidate_begin.data() + 1;
		finder.find(kernel, found_cells[rank], found_cells[rank + 1], count, found[rank]);
		team->barrier();
		if (rank == 0) lay_candidates_out();
		team->barrier();
		take_candidates(rank);
		measure_motion(rank);
		team->barrier();
		if (rank == 0) find_neighbours(), allow_travel();
		team->barrier();
	}
	counts[rank] = shares[rank].select(source(rank, false));
	team->barrier();
	collect_incoming(rank);
	if (rank == 0) finish_lists();
	team->barrier();
	return true;
}

SpherePairs::Source SphereLoop::source(int rank, bool as_listed)
{
	const std::uint32_t dummy = (state.n + 2 * rank) * sizeof(SphereRow);
	return { state, scene, share_begin[rank], share_begin[rank + 1], { dummy, dummy + std::uint32_t(sizeof(SphereRow)) },
		searching || as_listed ? &kept : nullptr, smallest_budget(), as_listed };
}

/// Speeds of the blocks, and how far they are from where they were at the last search.
void SphereLoop::measure_motion(int rank)
{
	const std::uint32_t blocks = state.n_blocks();
	const auto bounds = [&](std::uint32_t first, std::uint32_t end, std::uint32_t party) {
		double fastest = 0, farthest = 0;
		for (std::uint32_t i = first; i < end; ++i) {
			double speed2 = 0, way2 = 0;
			for (int k = 0; k < 3; ++k) {
				const SphereRow& row = state.rows[i];
				speed2 += row.v[k] * row.v[k];
				if (state.searches == 0) continue;
				const double way = row.x[k] - state.searched_at[3 * i + k];
				way2 += way * way;
			}
			fastest = std::max(fastest, speed2), farthest = std::max(farthest, way2);
		}
		speed[party] = std::sqrt(fastest), displaced[party] = std::sqrt(farthest);
	};
	const std::uint32_t first = std::uint64_t(blocks) * rank / scene.threads,
						end = std::uint64_t(blocks) * (rank + 1) / scene.threads;
	for (std::uint32_t b = first; b < end; ++b)
		bounds(b * grains_per_block, std::min((b + 1) * grains_per_block, state.n_free), b);
	if (rank == 0) bounds(state.n_free, state.n, blocks);
}

/// Decides on a search, and prepares it.
void SphereLoop::plan_lists()
{
	try {
		if (state.searches > 0) allow_travel();
		double farthest = 0;
		for (std::size_t p = 0; p < displaced.size() && state.searches > 0; ++p)
			farthest = std::max(farthest, displaced[p] + state.allowed[p]);
		searching = state.searches == 0 || !(2 * farthest <= state.skin);
		if (searching) begin_search();
	} catch (...) {
		failure = std::current_exception();
	}
}

void SphereLoop::begin_search()
{
	SphereState& s = state;
	const double wanted = 2 * *std::max_element(speed.begin(), speed.end()) * scene.dt * steps_between_searches;
	s.skin = scene.skin > 0 ? scene.skin : std::clamp(wanted, smallest_skin * typical_diameter, largest_skin * typical_diameter);
	wrap_into_box();
	grid.lay(s.rows.data(), s.n_free, scene.box, 2 * largest_free_radius + s.skin);
	std::vector<std::uint32_t> order;
	grid.sort(s.rows.data(), s.n_free, order);
	std::vector<std::uint32_t> new_row(s.n);
	for (std::uint32_t at = 0; at < s.n; ++at) new_row[at < s.n_free ? order[at] : at] = at;
	keep_pairs(new_row);
	StreamedVector<SphereRow> rows(s.rows);
	StreamedVector<double> inverse_masses(s.inverse_masses);
	std::vector<std::uint32_t> index_of(s.index_of);
	for (std::uint32_t at = 0; at < s.n_free; ++at) {
		rows[at] = s.rows[order[at]];
		inverse_masses[at] = s.inverse_masses[order[at]];
		index_of[at] = s.index_of[order[at]];
	}
	s.rows.swap(rows), s.inverse_masses.swap(inverse_masses), s.index_of.swap(index_of);
	s.searched_at.resize(3 * s.n);
	for (std::uint32_t at = 0; at < s.n; ++at) {
		row_of[s.index_of[at]] = at;
		for (int k = 0; k < 3; ++k) s.searched_at[3 * at + k] = s.rows[at].x[k];
	}
	finder.begin(s.rows.data(), s.n_free, s.n, grid, scene.box, s.skin);
	for (int t = 0; t <= scene.threads; ++t)
		found_cells[t] = t < scene.threads ? finder.cell_at(std::uint64_t(s.n_free) * t / scene.threads) : grid.cells();
	s.candidate_begin.assign(s.n_free + 1, 0);
	++s.searches;
}

void SphereLoop::wrap_into_box()
{
	for (std::uint32_t i = 0; i < state.n; ++i)
		for (int k = 0; k < 3; ++k) {
			if (!scene.box.periodic[k]) continue;
			double& x = state.rows[i].x[k];
			x -= scene.box.length(k) * std::floor((x - scene.box.low[k]) / scene.box.length(k));
		}
}

/// Springs under the numbers that their rows are about to get. A pair whose spheres change places keeps its spring with the other sign.
void SphereLoop::keep_pairs(const std::vector<std::uint32_t>& new_row)
{
	kept.begin.assign(state.n_free + 2, 0);
	const auto each = [&](auto&& visit) {
		for (const SpherePairs& share : shares)
			share.each_pair(state, [&](std::uint32_t owner, std::uint32_t, const KeptPair& pair) {
				const std::uint32_t a = new_row[owner], b = new_row[pair.partner];
				KeptPair moved = pair;
				moved.partner = std::max(a, b);
				if (a > b)
					for (double& x : moved.spring) x = -x;
				visit(std::min(a, b), moved);
			});
	};
	each([&](std::uint32_t owner, const KeptPair&) { ++kept.begin[owner + 2]; });
	for (std::size_t i = 2; i < kept.begin.size(); ++i) kept.begin[i] += kept.begin[i - 1];
	kept.pairs.resize(kept.begin.back());
	each([&](std::uint32_t owner, const KeptPair& pair) { kept.pairs[kept.begin[owner + 1]++] = pair; });
}

/// From counts to places.
void SphereLoop::lay_candidates_out()
{
	std::vector<std::uint32_t>& begin = state.candidate_begin;
	for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
	state.partners.resize(begin.back());
	share_out();
}

/// Even shares of the work.
void SphereLoop::share_out()
{
	const std::vector<std::uint32_t>& begin = state.candidate_begin;
	share_begin.assign(scene.threads + 1, state.n_blocks());
	share_begin[0] = 0;
	const double whole = begin.back() + work_of_a_sphere * state.n_free;
	int t = 1;
	for (std::uint32_t b = 0; b < state.n_blocks() && t < scene.threads; ++b) {
		const std::uint32_t row = b * grains_per_block;
		if (begin[row] + work_of_a_sphere * row >= whole * t / scene.threads) share_begin[t++] = b;
	}
}

void SphereLoop::take_candidates(int rank)
{
	const std::uint32_t first_row = grid.start[found_cells[rank]];
	std::copy(found[rank].begin(), found[rank].end(), state.partners.begin() + state.candidate_begin[first_row]);
	shares[rank].forget_places();
}

void SphereLoop::find_neighbours()
{
	neighbours.clear();
	std::vector<std::uint32_t> met(state.n_blocks() + 1, 0);  // 1 + the last that met this one
	for (std::uint32_t a = 0; a < state.n_free; ++a)
		for (std::uint32_t c = state.candidate_begin[a]; c < state.candidate_begin[a + 1]; ++c) {
			const std::uint32_t one = state.party_of(a), other = state.party_of(state.partners[c].row());
			if (one == other || met[other] == one + 1) continue;
			met[other] = one + 1;
			neighbours.push_back({ one, other });
		}
}

void SphereLoop::finish_lists()
{
	collect_incoming(scene.threads);
	choose_pace();
	std::fill(state.travelled.begin(), state.travelled.end(), 0);
	state.selection_due = false;
	++state.selections;
	searching = false;
	point_at_state();
}

void SphereLoop::point_at_state()
{
	data.rows = state.rows.data();
	data.inverse_masses = state.inverse_masses.data();
	data.travelled = state.travelled.data();
	data.allowed = state.allowed.data();
}

/// The pairs of a state that was kept, as they were selected then.
void SphereLoop::lay_listed_pairs_out()
{
	kept.begin.assign(state.n_free + 2, 0);
	kept.pairs.clear();
	std::size_t next = 0;
	for (std::uint32_t a = 0; a < state.n_free; ++a) {
		for (; next < state.listed.size() && state.listed[next].candidate < state.candidate_begin[a + 1]; ++next) {
			const ListedPair& pair = state.listed[next];
			kept.pairs.push_back(
				{ state.partners[pair.candidate].row(), { pair.spring[0], pair.spring[1], pair.spring[2] }, 0, 0 });
		}
		kept.begin[a + 1] = next;
	}
	share_out();
	find_neighbours();
	for (int t = 0; t < scene.threads; ++t) {
		shares[t].forget_places();
		counts[t] = shares[t].select(source(t, true));
	}
	for (int t = 0; t <= scene.threads; ++t) collect_incoming(t);
	point_at_state();
}

}  // namespace graindrive::loop
