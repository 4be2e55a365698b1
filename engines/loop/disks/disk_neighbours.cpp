/// Searches and sorts disks: places rows in memory, moves springs to the new places of their pairs, and prepares the kernels'
/// input.
#include "engines/loop/disks/disk_neighbours.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

namespace {

/// Springs by the owner of the pair, kept while a search gives pairs new numbers.
struct SpringBook {
	std::vector<std::uint32_t> begin;
	std::vector<std::pair<std::uint32_t, double>> entries;  // partner, slip

	SpringBook(const State<2>& state, const std::vector<std::uint32_t>& new_row, const std::vector<Spring<2>>& given)
		: begin(state.n + 2, 0)
	{
		const auto each = [&](auto&& visit) {
			const auto by_row = [&](std::uint32_t a, std::uint32_t b, double slip) {
				visit(std::min(a, b), std::max(a, b), slip);  // in the plane a swap of the two grains keeps the sign
			};
			for (const Spring<2>& s : given) by_row(state.row_of[s.first], state.row_of[s.second], s.slip);
			for (const Candidate& pair : state.pairs.candidates)
				if (pair.slip != 0) by_row(new_row[pair.first], new_row[pair.second], pair.slip);
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

void DiskNeighbours::set_up()
{
	const Scene<2>& scene = state.scene;
	kernel = choose_disk_kernel({ scene.law.index(), scene.friction, scene.precision });
	law_in_float = laws::converted<float>(scene.law);
	const auto address = [](const auto& law) -> const void* { return &law; };
	data.law = scene.precision == Precision::single ? std::visit(address, law_in_float) : std::visit(address, scene.law);
	see_cell();
}

void DiskNeighbours::see_cell()
{
	const Cell<2>& cell = state.scene.cell;
	for (int k = 0; k < 2; ++k)
		if (cell.periodic[k]) data.inverse_length[k] = 1 / (data.length[k] = cell.length(k));
	if (!cell.sheared()) return;
	data.image[0] = cell.offset, data.image[1] = 0;  // the image's offset along y is the period
	data.image[2] = cell.rate, data.image[3] = cell.growth;
}

void DiskNeighbours::make_dummies()
{
	state.rows.resize(state.n + row_alignment);
	state.rows[state.n] = { {}, {}, state.typical_diameter, 0, 1, 0 };  // two grains that never touch
	state.rows[state.n + 1] = { { 10 * state.typical_diameter, 0 }, {}, state.typical_diameter, 0, 1, 0 };
}

void DiskNeighbours::begin_search(const std::vector<Spring<2>>& given)
{
	grid.lay(state.rows.data(), state.n_free, state.scene.cell, 2 * state.largest_free_radius + state.skin);
	std::vector<std::uint32_t> order;
	grid.sort(state.rows.data(), state.n_free, order);
	std::vector<std::uint32_t> new_row(state.n);
	RowVector<2> sorted(state.rows);
	std::vector<std::uint32_t> sorted_index(state.index_of);
	for (std::uint32_t at = 0; at < state.n; ++at) {
		const std::uint32_t from = at < state.n_free ? order[at] : at;
		new_row[from] = at;
		sorted[at] = state.rows[from];
		sorted_index[at] = state.index_of[from];
	}
	state.rows.swap(sorted);
	state.index_of.swap(sorted_index);
	for (std::uint32_t at = 0; at < state.n; ++at) state.row_of[state.index_of[at]] = at;
	const SpringBook springs(state, new_row, given);
	find_candidates(state, grid, state.pairs.candidates);
	for (Candidate& pair : state.pairs.candidates) pair.slip = springs.of(pair.first, pair.second);
}

void DiskNeighbours::find(int) {}

void DiskNeighbours::select(int rank, double smallest_budget, double)
{
	if (rank != 0) return;
	std::vector<Reach> reach(state.n);
	for (std::uint32_t i = 0; i < state.n; ++i) {
		const double budget = state.allowed[state.party_of(i)];
		reach[i] = { state.rows[i].radius + budget,
			state.rows[i].radius + std::max(budget / 2, std::min(budget, smallest_budget)) };
	}
	selected = pairs.select(state.rows.data(), state.scene.cell, reach, state.images_may_go);
}

void DiskNeighbours::finish_selection() { lay_out(); }

void DiskNeighbours::lay_out()
{
	pairs.lay_out(state.rows.data(), state.n_free, state.n, state.scene.threads, state.scene.precision, state.n);
	point_at_state();
}

void DiskNeighbours::point_at_state()
{
	pairs.point(data);
	data.rows = state.rows.data();
	data.travelled = state.travelled.data();
	data.allowed = state.allowed.data();
}

void DiskNeighbours::return_to_state()
{
	point_at_state();
	pairs.put_back_slips();
}

void DiskNeighbours::early(int rank)
{
	const std::uint32_t packs = (pairs.early_end - pairs.early_begin) / pack_alignment;
	const auto share = [&](int r) {
		return pairs.early_begin + std::uint32_t(std::uint64_t(packs) * r / state.scene.threads) * pack_alignment;
	};
	kernel.pairs(data, share(rank), share(rank + 1), true);
}

bool DiskNeighbours::sweep(int rank)
{
	const SweepRange& mine = pairs.sweeps[rank];
	return kernel.sweep(data, mine.block_begin, mine.block_end, state.n_free, mine.pair_begin);
}

/// Forces of surfaces and pushes for the sweep, which needs them with damping, because damping acts on the sum of all forces.
/// Without damping they are applied after the sweep.
std::vector<OutsideForce>* DiskNeighbours::outside_of_sweep()
{
	data.outside = nullptr;
	if (data.damping == 0 || (state.touches.empty() && state.pushes.empty())) return nullptr;
	outside.assign(state.n_free, {});
	data.outside = outside.data();
	return &outside;
}

MemberForce<2> DiskNeighbours::force_on_member(std::uint32_t m) const
{
	MemberForce<2> sum;
	for (std::uint32_t s = pairs.member_begin[m]; s < pairs.member_begin[m + 1]; ++s) {
		const PairForce<double> force = pairs.force(pairs.member_shares[s].candidate);
		const double side = pairs.member_shares[s].partner ? -1 : 1;
		sum.force += side * Vec<2>{ force.x, force.y };
		sum.turning += force.friction;
		sum.shorter += force.normal;
	}
	if (!at_contact_point()) sum.shorter = 0;
	return sum;
}

void DiskNeighbours::forget_springs()
{
	for (Candidate& pair : state.pairs.candidates) pair.slip = 0;
	pairs.put_back_slips();
}

bool DiskNeighbours::at_contact_point() const
{
	return state.scene.friction && std::visit([](const auto& law) { return law.acts_at_contact_point; }, state.scene.law);
}

/// Laws whose force acts at the contact point store a torque in the place of F_n. Their F_n is never negative, so it follows from
/// the magnitude of the whole force and F_t.
ForceParts<2> DiskNeighbours::parts(std::uint32_t candidate) const
{
	const PairForce<double> f = pairs.force(candidate);
	const double friction = f.friction;
	const double normal = at_contact_point() ? std::sqrt(std::max(f.x * f.x + f.y * f.y - friction * friction, 0.0)) : f.normal;
	const double square = normal * normal + friction * friction;
	if (square == 0) return { 0, 0, {} };
	return { normal, friction, { (friction * f.y - normal * f.x) / square, (-friction * f.x - normal * f.y) / square } };
}

}  // namespace graindrive::loop
