/// Selects and lays out: first the pairs within the thread's blocks, swept in order, then those whose partner another thread moves or
/// nobody does.
#include "engines/loop/spheres/sphere_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "engines/laws/sphere_terms.hpp"

namespace graindrive::loop {

namespace {

constexpr std::uint32_t groups_read_ahead = 24;  // the kernels prefetch rows of links so far behind the last

}  // namespace

void* Buffer::with_room_for(std::size_t bytes)
{
	if (bytes <= size) return memory;
	release();
	size = bytes + bytes / 4;
	return memory = in_big_pages(size);
}

void Buffer::release()
{
	if (memory) free_big_pages(memory, size);
	memory = nullptr;
}

const KeptPair* KeptPairs::of(std::uint32_t owner, std::uint32_t partner) const
{
	for (std::uint32_t e = begin[owner]; e < begin[owner + 1]; ++e)
		if (pairs[e].partner == partner) return &pairs[e];
	return nullptr;
}

/// Writes pairs one behind the other.
template <class P>
struct SpherePairs::Layer {
	static constexpr std::uint32_t group_size = PairGroup<P>::size;
	const Source& source;
	PairGroup<P>* groups;
	const PairGroup<P>* old;
	std::vector<std::uint8_t>& wrapped;
	std::uint32_t next = 0;

	void put(PairLink link, bool is_wrapped, P x, P y, P z, P stiffness, P damping)
	{
		PairGroup<P>& group = groups[next / group_size];
		const std::uint32_t lane = next % group_size;
		if (lane == 0) wrapped.push_back(0);
		wrapped.back() |= is_wrapped;
		group.links[lane] = link;
		group.spring[0][lane] = x, group.spring[1][lane] = y, group.spring[2][lane] = z;
		group.stiffness[lane] = stiffness, group.damping[lane] = damping;
		++next;
	}

	/// The pair of a candidate; `old_place` is 1 + its place before, or 0.
	void put(std::uint32_t a, Partner partner, std::uint32_t old_place)
	{
		const std::uint32_t b = partner.row();
		const PairLink link{ a * std::uint32_t(sizeof(SphereRow)), b * std::uint32_t(sizeof(SphereRow)) };
		if (old_place) {
			const PairGroup<P>& from = old[(old_place - 1) / group_size];
			const std::uint32_t k = (old_place - 1) % group_size;
			put(link, partner.wrapped(), from.spring[0][k], from.spring[1][k], from.spring[2][k], from.stiffness[k],
				from.damping[k]);
		} else if (const KeptPair* kept = source.kept ? source.kept->of(a, b) : nullptr) {
			const laws::PairConstants constants =
				source.as_listed ? constants_of(a, b) : laws::PairConstants{ kept->stiffness, kept->damping };
			put(link, partner.wrapped(), kept->spring[0], kept->spring[1], kept->spring[2], constants.stiffness,
				constants.damping);
		} else {
			const laws::PairConstants constants = constants_of(a, b);
			put(link, partner.wrapped(), 0, 0, 0, constants.stiffness, constants.damping);
		}
	}

	laws::PairConstants constants_of(std::uint32_t a, std::uint32_t b) const
	{
		const SphereState& s = source.state;
		const double r_a = s.rows[a].radius, r_b = s.rows[b].radius, held_mass = source.scene.spheres[s.index_of[b]].mass;
		const double inverse_mass = s.inverse_masses[a] + (b < s.n_free ? s.inverse_masses[b] : 1 / held_mass);
		return std::visit([&](const auto& law) { return laws::pair_constants(law, r_a * r_b / (r_a + r_b), 1 / inverse_mass); },
			source.scene.law);
	}

	/// Fills up to a whole group with pairs that never touch.
	void pad()
	{
		while (next % group_size) put(source.dummy, false, 0, 0, 0, 0, 0);
	}
};

PairCounts3 SpherePairs::select(const Source& source)
{
	precision = source.scene.precision;
	return precision == Precision::double_ ? select_in<double>(source) : select_in<float>(source);
}

template <class P>
PairCounts3 SpherePairs::select_in(const Source& source)
{
	constexpr std::uint32_t group_size = PairGroup<P>::size;
	const SphereState& s = source.state;
	const std::uint32_t first_row = source.block_begin * grains_per_block,
						range_end = std::min(source.block_end * grains_per_block, s.n_free);
	const std::uint32_t candidates_end = s.candidate_begin[range_end];
	first_candidate = s.candidate_begin[first_row];
	place.resize(candidates_end - first_candidate, 0);
	memory.swap(old_memory);
	const std::size_t most = (candidates_end - first_candidate + 4 * group_size) / group_size + groups_read_ahead;
	wrapped.clear(), block_pair_end.clear(), block_early_end.clear(), early.clear(), early_owner.clear(), early_links.clear();
	Layer<P> layer{ source, static_cast<PairGroup<P>*>(memory.with_room_for(most * sizeof(PairGroup<P>))),
		static_cast<const PairGroup<P>*>(old_memory.data()), wrapped };
	PairCounts3 counts;
	std::vector<std::uint32_t> old_early;
	auto listed = std::lower_bound(s.listed.begin(), s.listed.end(), first_candidate,
		[](const ListedPair& pair, std::uint32_t candidate) { return pair.candidate < candidate; });
	for (std::uint32_t block = source.block_begin; block < source.block_end; ++block) {
		const std::uint32_t end = std::min((block + 1) * grains_per_block, s.n_free);
		const double own = s.allowed[block];
		for (std::uint32_t a = block * grains_per_block; a < end; ++a) {
			const SphereRow& one = s.rows[a];
			for (std::uint32_t c = s.candidate_begin[a]; c < s.candidate_begin[a + 1]; ++c) {
				const Partner partner = s.partners[c];
				const std::uint32_t b = partner.row();
				const SphereRow& other = s.rows[b];
				double d[3] = { other.x[0] - one.x[0], other.x[1] - one.x[1], other.x[2] - one.x[2] };
				if (partner.wrapped()) separation(one, other, source.scene.box, d);
				const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], touch = one.radius + other.radius;
				const double budget = own + s.allowed[s.party_of(b)];
				const double half = touch + std::max(budget / 2, std::min(budget, 2 * source.smallest_budget));
				bool near = square < (touch + budget) * (touch + budget);
				counts.by_half_budgets += square < half * half;
				std::uint32_t& at = place[c - first_candidate];
				if (source.as_listed) {
					near = listed != s.listed.end() && listed->candidate == c;
					listed += near;
				}
				counts.selected += near;
				const std::uint32_t old_place = at;
				at = 0;
				if (!near) continue;
				if (b >= range_end) {
					early.push_back(c), early_owner.push_back(a), old_early.push_back(old_place);
					continue;
				}
				layer.put(a, partner, old_place);
				at = layer.next;  // 1 + the place
			}
		}
		block_pair_end.push_back(layer.next);
		block_early_end.push_back(early.size());
	}
	layer.pad();
	view.early_begin = layer.next;
	for (std::size_t e = 0; e < early.size(); ++e) {
		layer.put(early_owner[e], s.partners[early[e]], old_early[e]);
		place[early[e] - first_candidate] = layer.next;
		early_links.push_back(layer.groups[(layer.next - 1) / group_size].links[(layer.next - 1) % group_size]);
	}
	layer.pad();
	view.early_end = layer.next;
	for (std::uint32_t k = 0; k < groups_read_ahead; ++k)
		std::fill_n(layer.groups[layer.next / group_size + k].links, group_size, source.dummy);
	early_forces.resize(view.early_end - view.early_begin);
	view.block_begin = source.block_begin, view.block_end = source.block_end;
	view.groups = layer.groups;
	view.wrapped = wrapped.data();
	view.block_pair_end = block_pair_end.data();
	view.block_early_end = block_early_end.data();
	view.early_forces = early_forces.data();
	view.early_links = early_links.data();
	return counts;
}

KeptPair SpherePairs::pair_at(std::uint32_t at) const
{
	const auto read = [&](const auto* groups) {
		constexpr std::uint32_t group_size = std::decay_t<decltype(*groups)>::size;
		const auto& g = groups[at / group_size];
		const std::uint32_t k = at % group_size;
		return KeptPair{ 0, { g.spring[0][k], g.spring[1][k], g.spring[2][k] }, g.stiffness[k], g.damping[k] };
	};
	return precision == Precision::double_ ? read(static_cast<const PairGroup<double>*>(memory.data()))
	                                       : read(static_cast<const PairGroup<float>*>(memory.data()));
}

}  // namespace graindrive::loop
