/// Selects pairs and places them in memory: first those within the thread's blocks, which the sweep computes in order, then those
/// whose partner another thread moves, or which is a member of a body.
#include "engines/loop/spheres/sphere_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engines/laws/sphere_terms.hpp"

namespace graindrive::loop {

namespace {

constexpr std::uint32_t groups_read_ahead = 24;  // the kernels prefetch rows for links up to this far behind the last

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

/// Writes pairs into groups, one after the other.
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

	/// Writes the pair of a candidate; `old_place` is 1 + its earlier place, or 0 if it had none.
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
			const laws::PairConstants constants = source.as_listed || std::isnan(kept->stiffness)
			                                          ? constants_of(a, b)
			                                          : laws::PairConstants{ kept->stiffness, kept->damping };
			put(link, partner.wrapped(), kept->spring[0], kept->spring[1], kept->spring[2], constants.stiffness,
				constants.damping);
		} else {
			const laws::PairConstants constants = constants_of(a, b);
			put(link, partner.wrapped(), 0, 0, 0, constants.stiffness, constants.damping);
		}
	}

	laws::PairConstants constants_of(std::uint32_t a, std::uint32_t b) const
	{
		const State<3>& s = source.state;
		const double radius = laws::effective_radius(s.rows[a].radius, s.rows[b].radius);
		const double mass = laws::effective_mass(s.inverse_masses[a] + s.inverse_masses[b]);
		return std::visit(
			[&](const auto& law) {
				if constexpr (laws::is_for_spheres(std::decay_t<decltype(law)>{}))
					return laws::pair_constants(law, radius, mass);
				else
					return laws::PairConstants{};  // never reached: no kernel of spheres has this law
			},
			s.scene.law);
	}

	/// Fills the last group up with pairs that never touch.
	void pad()
	{
		while (next % group_size) put(source.dummy, false, 0, 0, 0, 0, 0);
	}
};

PairCounts SpherePairs::select(const Source& source)
{
	precision = source.state.scene.precision;
	return precision == Precision::double_ ? select_in<double>(source) : select_in<float>(source);
}

/// Puts the candidates of the owners [first, end) that may touch before the next selection into `chosen`. There is no branch,
/// because about half of the candidates are near enough, in an order that a processor cannot predict.
void SpherePairs::choose(const Source& source, std::uint32_t first, std::uint32_t end, PairCounts& counts)
{
	const State<3>& s = source.state;
	const std::vector<std::uint32_t>& begin = s.pairs.candidate_begin;
	chosen.resize(begin[end] - begin[first] + 1);
	std::uint32_t n = 0;
	for (std::uint32_t a = first; a < end; ++a) {
		const SphereRow& one = s.rows[a];
		const std::uint32_t party = s.party_of(a);
		const double own = s.allowed[party];
		for (std::uint32_t c = begin[a]; c < begin[a + 1]; ++c) {
			const Partner partner = s.pairs.partners[c];
			const SphereRow& other = s.rows[partner.row()];
			Vec<3> d = other.x - one.x;
			if (partner.wrapped()) d = s.scene.cell.nearest(d).at;
			const double square = geometry::squared_norm(d), touch = one.radius + other.radius;
			const std::uint32_t other_party = s.party_of(partner.row());
			const double approach = length(s.drifts[other_party] - s.drifts[party]) * source.horizon;
			const double budget = own + s.allowed[other_party] + approach;
			const double half = touch + std::max(budget / 2, std::min(budget, 2 * source.smallest_budget));
			counts.by_half_budgets += square < half * half;
			chosen[n] = { a, c };
			n += square < (touch + budget) * (touch + budget);
		}
	}
	chosen.resize(n);
}

/// Puts the candidates of the owners [first, end) that the state lists into `chosen`.
void SpherePairs::choose_listed(const Source& source, std::uint32_t first, std::uint32_t end)
{
	const SpherePairState& pairs = source.state.pairs;
	const auto before = [](const ListedPair& pair, std::uint32_t candidate) { return pair.candidate < candidate; };
	auto listed = std::lower_bound(pairs.listed.begin(), pairs.listed.end(), pairs.candidate_begin[first], before);
	chosen.clear();
	for (std::uint32_t a = first; a < end; ++a)
		for (; listed != pairs.listed.end() && listed->candidate < pairs.candidate_begin[a + 1]; ++listed)
			chosen.push_back({ a, listed->candidate });
}

/// Writes the pairs of the owners [first, end). Those with partners beyond the share are put aside: they are computed early.
template <class P>
void SpherePairs::take_pairs_of(const Source& source, std::uint32_t first, std::uint32_t end, Layer<P>& layer, PairCounts& counts)
{
	const SpherePairState& pairs = source.state.pairs;
	const std::uint32_t share_end = source.owner_begin >= source.state.n_free ? source.owner_begin : source.owner_end;
	source.as_listed ? choose_listed(source, first, end) : choose(source, first, end, counts);
	counts.selected += chosen.size();
	for (const Chosen& pair : chosen) {
		const std::uint32_t old_place = old_places[pair.candidate - first_candidate];
		const Partner partner = pairs.partners[pair.candidate];
		if (partner.row() >= share_end) {
			early.push_back({ pair, old_place });
			continue;
		}
		layer.put(pair.owner, partner, old_place);
		place[pair.candidate - first_candidate] = layer.next;  // 1 + the place
	}
}

template <class P>
void SpherePairs::lay_early_pairs(const Source& source, Layer<P>& layer)
{
	constexpr std::uint32_t group_size = PairGroup<P>::size;
	layer.pad();
	view.early_begin = layer.next;
	early_links.clear();
	for (const EarlyPair& pair : early) {
		layer.put(pair.owner, source.state.pairs.partners[pair.candidate], pair.old_place);
		place[pair.candidate - first_candidate] = layer.next;
		early_links.push_back(layer.groups[(layer.next - 1) / group_size].links[(layer.next - 1) % group_size]);
	}
	layer.pad();
	view.early_end = layer.next;
	early_forces.resize(view.early_end - view.early_begin);
}

template <class P>
PairCounts SpherePairs::select_in(const Source& source)
{
	constexpr std::uint32_t group_size = PairGroup<P>::size;
	const State<3>& s = source.state;
	owner_begin = source.owner_begin, owner_end = source.owner_end;
	first_candidate = s.pairs.candidate_begin[owner_begin];
	const std::uint32_t candidates = s.pairs.candidate_begin[owner_end] - first_candidate;
	place.swap(old_places);
	old_places.resize(candidates, 0);
	place.assign(candidates, 0);
	memory.swap(old_memory);
	const std::size_t most = (candidates + 4 * group_size) / group_size + groups_read_ahead;
	wrapped.clear(), block_pair_end.clear(), block_early_end.clear(), early.clear();
	Layer<P> layer{ source, static_cast<PairGroup<P>*>(memory.with_room_for(most * sizeof(PairGroup<P>))),
		static_cast<const PairGroup<P>*>(old_memory.data()), wrapped };
	PairCounts counts;
	for (std::uint32_t block = source.block_begin; block < source.block_end; ++block) {
		const std::uint32_t first = block * grains_per_block;
		take_pairs_of(source, first, std::min(first + grains_per_block, s.n_free), layer, counts);
		block_pair_end.push_back(layer.next);
		block_early_end.push_back(early.size());
	}
	if (owner_begin >= s.n_free) take_pairs_of(source, owner_begin, owner_end, layer, counts);
	lay_early_pairs(source, layer);
	for (std::uint32_t k = 0; k < groups_read_ahead; ++k)
		std::fill_n(layer.groups[layer.next / group_size + k].links, group_size, source.dummy);
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

std::size_t SpherePairs::group_bytes() const
{
	return precision == Precision::double_ ? sizeof(PairGroup<double>) : sizeof(PairGroup<float>);
}

void SpherePairs::forget_springs()
{
	const auto forget = [&](auto* groups) {
		for (std::uint32_t g = 0; g < places() / group_size(); ++g)
			for (auto& component : groups[g].spring) std::fill(std::begin(component), std::end(component), 0);
	};
	precision == Precision::double_ ? forget(static_cast<PairGroup<double>*>(memory.data()))
									: forget(static_cast<PairGroup<float>*>(memory.data()));
}

std::vector<char> SpherePairs::bytes_from(std::uint32_t first) const
{
	const char* groups = static_cast<const char*>(memory.data());
	return { groups + first / group_size() * group_bytes(), groups + places() / group_size() * group_bytes() };
}

void SpherePairs::put_back(std::uint32_t first, const std::vector<char>& bytes)
{
	if (!bytes.empty())
		std::memcpy(static_cast<char*>(memory.data()) + first / group_size() * group_bytes(), bytes.data(), bytes.size());
}

}  // namespace graindrive::loop
