/// Searches and selects pairs of spheres: places rows in memory, lists pairs, and moves springs to the new places of their pairs.
#include "engines/loop/spheres/sphere_neighbours.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

namespace {

constexpr double work_of_a_sphere = 2;  // work of a sphere in units of one candidate, to share work out evenly

}  // namespace

void SphereNeighbours::set_up()
{
	const Scene<3>& scene = state.scene;
	kernel = choose_sphere_kernel({ scene.law.index(), scene.friction, scene.precision });
	law_in_float = laws::converted<float>(scene.law);
	const auto address = [](const auto& law) -> const void* { return &law; };
	data.law = scene.precision == Precision::single ? std::visit(address, law_in_float) : std::visit(address, scene.law);
	if (int(shares.size()) != threads() + 1) shares = std::vector<SpherePairs>(threads() + 1);
	incoming.resize(threads() + 1), incoming_rows.resize(threads() + 1);
	counts_by_share.assign(threads() + 1, {});
	found.resize(threads()), found_cells.resize(threads() + 1);
	for (int k = 0; k < 3; ++k)
		if (scene.cell.periodic[k]) data.inverse_length[k] = 1 / (data.length[k] = scene.cell.length(k));
	make_dummies();
}

/// Rows for pairs that never touch, two for each thread's share, so that no two threads write into one row.
void SphereNeighbours::make_dummies()
{
	const std::uint32_t dummies = 2 * (threads() + 1);
	state.rows.resize(state.n + dummies), state.inverse_masses.resize(state.n + dummies);
	for (std::uint32_t k = 0; k < dummies; ++k) {
		SphereRow& row = state.rows[state.n + k] = SphereRow{};
		row.radius = state.typical_diameter, row.x[0] = k % 2 ? 10 * state.typical_diameter : 0;
		state.inverse_masses[state.n + k] = 0;
	}
	data.n_free = state.n_free;
}

SpherePairs::Source SphereNeighbours::source(int share, bool as_listed, double smallest_budget, double horizon)
{
	const std::uint32_t dummy = (state.n + 2 * share) * sizeof(SphereRow), size = sizeof(SphereRow);
	const bool members = share == threads();
	const auto row = [&](std::uint32_t block) { return std::min(block * grains_per_block, state.n_free); };
	const std::uint32_t first = members ? state.n_blocks() : share_begin[share], end = members ? first : share_begin[share + 1];
	return { state, first, end, members ? state.n_free : row(first), members ? state.n : row(end), { dummy, dummy + size },
		searched || as_listed ? &kept : nullptr, smallest_budget, horizon, as_listed };
}

void SphereNeighbours::begin_search(const std::vector<Spring<3>>& given)
{
	State<3>& s = state;
	grid.lay(s.rows.data(), s.n_free, s.scene.cell, 2 * s.largest_free_radius + s.skin);
	std::vector<std::uint32_t> order;
	grid.sort(s.rows.data(), s.n_free, order);
	std::vector<std::uint32_t> new_row(s.n);
	for (std::uint32_t at = 0; at < s.n; ++at) new_row[at < s.n_free ? order[at] : at] = at;
	RowVector<3> rows(s.rows);
	StreamedVector<double> inverse_masses(s.inverse_masses);
	std::vector<std::uint32_t> index_of(s.index_of);
	for (std::uint32_t at = 0; at < s.n_free; ++at) {
		rows[at] = s.rows[order[at]];
		inverse_masses[at] = s.inverse_masses[order[at]];
		index_of[at] = s.index_of[order[at]];
	}
	s.rows.swap(rows), s.inverse_masses.swap(inverse_masses), s.index_of.swap(index_of);
	for (std::uint32_t at = 0; at < s.n; ++at) s.row_of[s.index_of[at]] = at;
	keep_pairs(new_row, given);
	finder.begin(s, grid);
	for (int t = 0; t <= threads(); ++t)
		found_cells[t] = t < threads() ? finder.cell_at(std::uint64_t(s.n_free) * t / threads()) : grid.cells();
	s.pairs.candidate_begin.assign(s.n + 1, 0);
	searched = true;
}

/// Keeps springs under the new numbers of their rows. The sign of a spring changes where the two spheres of a pair change their
/// order.
void SphereNeighbours::keep_pairs(const std::vector<std::uint32_t>& new_row, const std::vector<Spring<3>>& given)
{
	kept.begin.assign(state.n + 2, 0);
	const auto put = [&](std::uint32_t a, std::uint32_t b, KeptPair pair, auto&& visit) {
		pair.partner = std::max(a, b);
		if (a > b)
			for (double& x : pair.spring) x = -x;
		visit(std::min(a, b), pair);
	};
	const auto each = [&](auto&& visit) {
		for (const Spring<3>& s : given)
			put(state.row_of[s.first], state.row_of[s.second], { 0, { s.slip[0], s.slip[1], s.slip[2] }, NAN, NAN }, visit);
		for (const SpherePairs& share : shares)
			share.each_pair(state, [&](std::uint32_t owner, std::uint32_t, const KeptPair& pair) {
				put(new_row[owner], new_row[pair.partner], pair, visit);
			});
	};
	each([&](std::uint32_t owner, const KeptPair&) { ++kept.begin[owner + 2]; });
	for (std::size_t i = 2; i < kept.begin.size(); ++i) kept.begin[i] += kept.begin[i - 1];
	kept.pairs.resize(kept.begin.back());
	each([&](std::uint32_t owner, const KeptPair& pair) { kept.pairs[kept.begin[owner + 1]++] = pair; });
}

void SphereNeighbours::find(int rank)
{
	if (state.n_free == 0) return found[rank].clear();
	finder.find(kernel, found_cells[rank], found_cells[rank + 1], state.pairs.candidate_begin.data() + 1, found[rank]);
}

/// Sums the number of candidates of each owner to the place of its first one. Pairs between members of bodies come last.
void SphereNeighbours::gather()
{
	std::vector<std::uint32_t>& begin = state.pairs.candidate_begin;
	for (const MemberPair& pair : finder.among_members()) ++begin[pair.owner + 1];
	for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
	state.pairs.partners.resize(begin.back());
	std::uint32_t next = begin[state.n_free];
	for (const MemberPair& pair : finder.among_members())
		state.pairs.partners[next++] = { pair.wrapped ? pair.member | Partner::across : pair.member };
	share_out();
}

/// Divides the blocks among the threads so that each has about the same work.
void SphereNeighbours::share_out()
{
	const std::vector<std::uint32_t>& begin = state.pairs.candidate_begin;
	share_begin.assign(threads() + 1, state.n_blocks());
	share_begin[0] = 0;
	const double whole = begin[state.n_free] + work_of_a_sphere * state.n_free;
	int t = 1;
	for (std::uint32_t b = 0; b < state.n_blocks() && t < threads(); ++b) {
		const std::uint32_t row = b * grains_per_block;
		if (begin[row] + work_of_a_sphere * row >= whole * t / threads()) share_begin[t++] = b;
	}
}

void SphereNeighbours::take(int rank)
{
	if (state.n_free > 0) {
		const std::uint32_t first_row = grid.start[found_cells[rank]];
		std::copy(found[rank].begin(), found[rank].end(), state.pairs.partners.begin() + state.pairs.candidate_begin[first_row]);
	}
	shares[rank].forget_places();
	if (rank == 0) shares[threads()].forget_places();
}

void SphereNeighbours::select(int rank, double smallest_budget, double horizon)
{
	counts_by_share[rank] = shares[rank].select(source(rank, false, smallest_budget, horizon));
	if (rank == 0) counts_by_share[threads()] = shares[threads()].select(source(threads(), false, smallest_budget, horizon));
}

void SphereNeighbours::finish_selection()
{
	for (int t = 0; t <= threads(); ++t) collect_incoming(t);
	searched = false;
	point_at_state();
}

PairCounts SphereNeighbours::counts() const
{
	PairCounts sum;
	for (const PairCounts& count : counts_by_share) sum.selected += count.selected, sum.by_half_budgets += count.by_half_budgets;
	return sum;
}

void SphereNeighbours::point_at_state()
{
	data.rows = state.rows.data();
	data.inverse_masses = state.inverse_masses.data();
	data.travelled = state.travelled.data();
	data.allowed = state.allowed.data();
	data.drifts = state.drifts.data();
}

void SphereNeighbours::keep_springs()
{
	state.pairs.listed.clear();
	for (const SpherePairs& share : shares)
		share.each_pair(state, [&](std::uint32_t, std::uint32_t candidate, const KeptPair& pair) {
			state.pairs.listed.push_back({ candidate, { pair.spring[0], pair.spring[1], pair.spring[2] } });
		});
}

void SphereNeighbours::lay_out()
{
	const SpherePairState& pairs = state.pairs;
	make_dummies();
	kept.begin.assign(state.n + 2, 0);
	kept.pairs.clear();
	std::size_t next = 0;
	for (std::uint32_t a = 0; a < state.n; ++a) {
		for (; next < pairs.listed.size() && pairs.listed[next].candidate < pairs.candidate_begin[a + 1]; ++next) {
			const ListedPair& pair = pairs.listed[next];
			kept.pairs.push_back(
				{ pairs.partners[pair.candidate].row(), { pair.spring[0], pair.spring[1], pair.spring[2] }, NAN, NAN });
		}
		kept.begin[a + 1] = next;
	}
	kept.begin[state.n + 1] = next;
	share_out();
	for (int t = 0; t <= threads(); ++t) {
		shares[t].forget_places();
		counts_by_share[t] = shares[t].select(source(t, true, 0, 0));
	}
	for (int t = 0; t <= threads(); ++t) collect_incoming(t);
	point_at_state();
}

void SphereNeighbours::early(int rank)
{
	kernel.early(data, shares[rank].view);
	if (rank == 0 && shares[threads()].places() > 0) kernel.early(data, shares[threads()].view);
}

bool SphereNeighbours::sweep(int rank)
{
	add_incoming(rank);
	return kernel.sweep(data, shares[rank].view);
}

/// Adds the forces that other threads computed on this thread's rows. They come first, because their owners lie before its
/// blocks.
void SphereNeighbours::add_incoming(int rank)
{
	for (std::size_t e = 0; e < incoming[rank].size(); ++e) {
		SphereRow& row = state.rows[incoming_rows[rank][e]];
		const double* line = incoming[rank][e]->number;
		for (int k = 0; k < 3; ++k) row.force[k] -= line[2 + k], row.turn[k] += line[5 + k];
	}
}

void SphereNeighbours::gather_for_members()
{
	for (std::uint32_t at = state.n_free; at < state.n; ++at) state.rows[at].force = state.rows[at].turn = {};
	add_incoming(threads());
	const SpherePairs& among = shares[threads()];
	for (std::size_t e = 0; e < among.early_links.size(); ++e) {
		SphereRow& owner = state.rows[among.early_links[e].first / sizeof(SphereRow)];
		const double* line = among.view.early_forces[e].number;
		for (int k = 0; k < 3; ++k) owner.force[k] += line[2 + k], owner.turn[k] += line[5 + k];
	}
}

void SphereNeighbours::collect_incoming(int rank)
{
	const bool for_members = rank == threads();
	const std::uint32_t first = for_members ? state.n_free : share_begin[rank] * grains_per_block;
	const std::uint32_t end = for_members ? state.n : std::min(share_begin[rank + 1] * grains_per_block, state.n_free);
	incoming[rank].clear(), incoming_rows[rank].clear();
	for (int from = 0; from < (for_members ? threads() + 1 : rank); ++from)
		for (std::size_t e = 0; e < shares[from].early_links.size(); ++e) {
			const std::uint32_t row = shares[from].early_links[e].second / sizeof(SphereRow);
			if (row < first || row >= end) continue;
			incoming[rank].push_back(shares[from].view.early_forces + e);
			incoming_rows[rank].push_back(row);
		}
}

MemberForce<3> SphereNeighbours::force_on_member(std::uint32_t m) const
{
	const SphereRow& row = state.rows[state.n_free + m];
	return { row.force, row.turn, 0 };
}

void SphereNeighbours::keep_early()
{
	early_before.clear();
	for (const SpherePairs& share : shares) early_before.push_back(share.bytes_from(share.view.early_begin));
}

void SphereNeighbours::put_back_early()
{
	for (std::size_t s = 0; s < shares.size(); ++s) shares[s].put_back(shares[s].view.early_begin, early_before[s]);
}

void SphereNeighbours::forget_springs()
{
	for (SpherePairs& share : shares) share.forget_springs();
	for (ListedPair& pair : state.pairs.listed)
		for (double& x : pair.spring) x = 0;
}

}  // namespace graindrive::loop
