/// Places pairs in memory: first each thread's own, which the sweep computes in order, then those that must be computed before
/// any grain moves.
#include "engines/loop/disks/pair_list.hpp"

#include "engines/loop/pair_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace graindrive::loop {

namespace {

constexpr std::uint32_t row_bytes = sizeof(DiskRow);
constexpr std::uint32_t first_place = pack_alignment;  // place 0 means "no force"

std::uint32_t padded(std::uint32_t places) { return (places + pack_alignment - 1) / pack_alignment * pack_alignment; }

}  // namespace

PairCounts PairList::select(const DiskRow* rows, const Cell<2>& cell, const std::vector<Reach>& reach, double images_may_go)
{
	PairCounts counts;
	for (Candidate& pair : candidates) {
		const DiskRow &a = rows[pair.first], &b = rows[pair.second];
		Vec<2> d = b.x - a.x;
		if (pair.wrapped) d = cell.nearest(d).at;
		const Reach &one = reach[pair.first], &other = reach[pair.second];
		const double square = geometry::squared_norm(d), images = pair.wrapped ? images_may_go : 0;
		const double whole = one.whole + other.whole + images, half = one.half + other.half + images / 2;
		pair.near = square < whole * whole;
		counts.selected += pair.near;
		counts.by_half_budgets += square < half * half;
	}
	return counts;
}

void PairList::lay_out(const DiskRow* rows, std::uint32_t n_free, std::uint32_t n_grains, int threads, Precision kernel_precision,
	std::uint32_t dummy_row)
{
	precision = kernel_precision;
	place_pairs(rows, n_free, threads, dummy_row);
	fill_slots(n_free);
	list_members(n_free, n_grains);
}

void PairList::place_pairs(const DiskRow* rows, std::uint32_t n_free, int threads, std::uint32_t dummy_row)
{
	const std::uint32_t blocks = (n_free + grains_per_block - 1) / grains_per_block;
	const std::uint32_t room = padded(candidates.size()) + (threads + 3) * pack_alignment;
	const PairLink dummy{ dummy_row * row_bytes, (dummy_row + 1) * row_bytes };
	place.assign(candidates.size(), 0);
	links.resize(room);
	for (auto* list : { &slips, &effective_radii, &effective_masses }) list->resize(room);
	block_pair_end.resize(blocks);
	sweeps.assign(threads, {});
	early.clear();
	std::uint32_t next = first_place, c = 0;
	const auto place_at_next = [&](std::uint32_t candidate) {
		const Candidate& pair = candidates[candidate];
		const DiskRow &a = rows[pair.first], &b = rows[pair.second];
		links[next] = { pair.first * row_bytes, pair.second * row_bytes };
		put(effective_radii, next, laws::effective_radius(a.radius, b.radius));
		put(effective_masses, next, laws::effective_mass(a.inverse_mass + b.inverse_mass));
		put(slips, next, pair.slip);
		place[candidate] = next++;
	};
	for (int t = 0; t < threads; ++t) {
		SweepRange& sweep = sweeps[t];
		sweep.block_begin = std::uint64_t(blocks) * t / threads;
		sweep.block_end = std::uint64_t(blocks) * (t + 1) / threads;
		sweep.pair_begin = next;
		const std::uint32_t range_end = std::min(sweep.block_end * grains_per_block, n_free);
		for (std::uint32_t b = sweep.block_begin; b < sweep.block_end; ++b) {
			const std::uint32_t block_end = std::min((b + 1) * grains_per_block, n_free);
			for (; c < candidates.size() && candidates[c].first < block_end; ++c) {
				if (!candidates[c].near) continue;
				const bool leaves_range = candidates[c].second >= range_end;  // partner of another thread, or of a body
				if (candidates[c].wrapped || leaves_range)
					early.push_back(c);
				else
					place_at_next(c);
			}
			block_pair_end[b] = next;
		}
		sweep.pair_end = next = pad(next, dummy);
	}
	for (; c < candidates.size(); ++c)
		if (candidates[c].near) early.push_back(c);
	early_begin = next;
	for (const std::uint32_t candidate : early) place_at_next(candidate);
	early_end = pad(next, dummy);
}

/// Fills the last pack up with pairs that never touch.
std::uint32_t PairList::pad(std::uint32_t places, PairLink dummy)
{
	const std::uint32_t end = padded(places);
	for (; places < end; ++places) {
		links[places] = dummy;
		for (auto* list : { &slips, &effective_radii, &effective_masses }) put(*list, places, 0);
	}
	return end;
}

void PairList::order_blocks(std::uint32_t n_free)
{
	block_order.resize(block_pair_end.size());
	for (std::uint32_t b = 0; b < block_order.size(); ++b) {
		const std::uint32_t first = b * grains_per_block, count = std::min<std::uint32_t>(grains_per_block, n_free - first);
		std::uint8_t with = 0, without = 0, alone[grains_per_block];
		for (std::uint32_t k = 0; k < count; ++k) {
			const bool has_pairs = owned[first + k] || partnered[first + k];
			block_order[b].order[with] = alone[without] = std::uint8_t(k);  // no branch: only one counter advances
			with += has_pairs, without += !has_pairs;
		}
		block_order[b].with_pairs = with;
		std::copy(alone, alone + without, block_order[b].order + with);
	}
}

void PairList::fill_slots(std::uint32_t n_free)
{
	owned.assign(n_free, 0);
	partnered.assign(n_free, 0);
	for (std::uint32_t c = 0; c < candidates.size(); ++c) {
		if (!place[c]) continue;
		const std::uint32_t a = candidates[c].first, b = candidates[c].second;
		if (a < n_free) owned[a] += owned[a] < 255;
		if (b < n_free) partnered[b] += partnered[b] < 255;
	}
	order_blocks(n_free);
	const std::uint32_t force_bytes = this->force_bytes();
	used_owned.assign(n_free, 0);
	used_partnered.assign(n_free, 0);
	slots.assign(n_free, ForceSlots{});
	surplus.clear();
	with_members.clear();
	// A grain with more forces than slots keeps its last slot for the sum of the surplus.
	const auto give = [&](std::uint32_t grain, std::uint32_t at, std::uint8_t have, std::uint8_t& used, bool partner) {
		if (have <= ForceSlots::owned || used < ForceSlots::owned - 1)
			slots[grain].at[(partner ? ForceSlots::owned : 0) + used++] = at * force_bytes;
		else
			surplus.push_back({ grain, at, partner });
	};
	for (std::uint32_t c = 0; c < candidates.size(); ++c) {
		if (!place[c]) continue;
		const std::uint32_t a = candidates[c].first, b = candidates[c].second;
		if (a < n_free) give(a, place[c], owned[a], used_owned[a], false);
		if (b < n_free)
			give(b, place[c], partnered[b], used_partnered[b], true);
		else
			with_members.push_back(c);
	}
	fold_surplus(early_end);
}

void PairList::fold_surplus(std::uint32_t next_place)
{
	const auto before = [](const Surplus& a, const Surplus& b) {
		return a.grain != b.grain ? a.grain < b.grain : a.partner < b.partner;
	};
	std::stable_sort(surplus.begin(), surplus.end(), before);
	const std::uint32_t force_bytes = this->force_bytes();
	folds.clear();
	fold_sources.clear();
	block_fold_end.assign(block_pair_end.size(), 0);
	for (std::size_t s = 0; s < surplus.size();) {
		const Surplus lead = surplus[s];
		Fold fold{ next_place++, static_cast<std::uint32_t>(fold_sources.size()), 0, lead.partner };
		for (; s < surplus.size() && surplus[s].grain == lead.grain && surplus[s].partner == lead.partner; ++s)
			fold_sources.push_back(surplus[s].place);
		fold.end = fold_sources.size();
		slots[lead.grain].at[(lead.partner ? ForceSlots::owned : 0) + ForceSlots::owned - 1] = fold.target * force_bytes;
		folds.push_back(fold);
		block_fold_end[lead.grain / grains_per_block] = folds.size();
	}
	for (std::size_t b = 1; b < block_fold_end.size(); ++b)
		block_fold_end[b] = std::max(block_fold_end[b], block_fold_end[b - 1]);
	forces.resize(next_place);
	std::fill_n(forces.begin(), first_place, PairForce<double>{});  // grains without a pair read zeros here
}

void PairList::list_members(std::uint32_t n_free, std::uint32_t n_grains)
{
	member_begin.assign(n_grains - n_free + 1, 0);
	const auto each = [&](auto&& visit) {
		for (const std::uint32_t c : with_members) {
			if (candidates[c].first >= n_free) visit(candidates[c].first - n_free, Share{ c, false });
			visit(candidates[c].second - n_free, Share{ c, true });
		}
	};
	each([&](std::uint32_t member, Share) { ++member_begin[member + 1]; });
	for (std::size_t m = 1; m < member_begin.size(); ++m) member_begin[m] += member_begin[m - 1];
	member_shares.resize(member_begin.back());
	std::vector<std::uint32_t> next(member_begin.begin(), member_begin.end() - 1);
	each([&](std::uint32_t member, Share share) { member_shares[next[member]++] = share; });
}

void PairList::keep_slips()
{
	for (std::uint32_t c = 0; c < place.size(); ++c)
		if (place[c]) candidates[c].slip = slip(c);
}

void PairList::put_back_slips()
{
	for (std::uint32_t c = 0; c < place.size(); ++c)
		if (place[c]) put(slips, place[c], candidates[c].slip);
}

void PairList::keep_early_pairs()
{
	early_slips.clear();
	for (const std::uint32_t c : early) early_slips.push_back(slip(c));
	early_forces = bytes_of_forces(early_begin, early_end);
}

void PairList::put_back_early_pairs()
{
	for (std::size_t k = 0; k < early.size(); ++k) put(slips, place[early[k]], early_slips[k]);
	put_back_forces(early_begin, early_forces);
}

std::size_t PairList::force_bytes() const
{
	return precision == Precision::double_ ? sizeof(PairForce<double>) : sizeof(PairForce<float>);
}

PairList::Bytes PairList::bytes_of_forces(std::size_t begin, std::size_t end) const
{
	const char* first = reinterpret_cast<const char*>(forces.data());
	return { first + begin * force_bytes(), first + end * force_bytes() };
}

void PairList::put_back_forces(std::size_t begin, const Bytes& bytes)
{
	std::memcpy(reinterpret_cast<char*>(forces.data()) + begin * force_bytes(), bytes.data(), bytes.size());
}

void PairList::put(StreamedVector<double>& list, std::uint32_t at, double number)
{
	if (precision == Precision::double_)
		list[at] = number;
	else
		reinterpret_cast<float*>(list.data())[at] = static_cast<float>(number);
}

double PairList::slip(std::uint32_t candidate) const
{
	if (!place[candidate]) return candidates[candidate].slip;
	return precision == Precision::double_ ? slips[place[candidate]]
	                                       : reinterpret_cast<const float*>(slips.data())[place[candidate]];
}

PairForce<double> PairList::force(std::uint32_t candidate) const
{
	if (!place[candidate]) return {};
	if (precision == Precision::double_) return forces[place[candidate]];
	const PairForce<float>& f = reinterpret_cast<const PairForce<float>*>(forces.data())[place[candidate]];
	return { f.x, f.y, f.friction, f.normal };
}

void PairList::point(DiskStep& data)
{
	data.links = links.data();
	data.slips = slips.data();
	data.effective_radii = effective_radii.data();
	data.effective_masses = effective_masses.data();
	data.forces = forces.data();
	data.slots = slots.data();
	data.block_order = block_order.data();
	data.folds = folds.data();
	data.fold_sources = fold_sources.data();
	data.block_pair_end = block_pair_end.data();
	data.block_fold_end = block_fold_end.data();
}

}  // namespace graindrive::loop
