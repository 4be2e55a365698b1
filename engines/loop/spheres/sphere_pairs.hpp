/// One thread's pairs: which of the candidates that its blocks own are selected, and where in the kernels' memory they lie.
///
/// A pair's place decides nothing but memory: forces are added to every row in the order of (owner, partner), on any number of threads.
#pragma once
#include <cmath>

#include "engines/loop/spheres/sphere_state.hpp"

namespace graindrive::loop {

/// Memory that only grows and is not initialised.
class Buffer {
public:
	Buffer() = default;
	Buffer(const Buffer&) = delete;
	~Buffer() { release(); }
	void* with_room_for(std::size_t bytes);
	void* data() const { return memory; }
	void swap(Buffer& other) { std::swap(memory, other.memory), std::swap(size, other.size); }

private:
	void* memory = nullptr;
	std::size_t size = 0;

	void release();
};

/// A spring on its way to new rows, with the law's constants of its pair.
struct KeptPair {
	std::uint32_t partner;
	double spring[3], stiffness, damping;
};

/// Springs by owner, for the time when rows change their places.
struct KeptPairs {
	std::vector<std::uint32_t> begin;  ///< by owner
	std::vector<KeptPair> pairs;

	const KeptPair* of(std::uint32_t owner, std::uint32_t partner) const;
};

struct PairCounts3 {
	std::size_t selected = 0, by_half_budgets = 0;  ///< by_half_budgets: if spheres had half the way to go
};

class SpherePairs {
public:
	/// Where the pairs of a selection come from.
	struct Source {
		const SphereState& state;
		const SphereScene& scene;
		std::uint32_t block_begin, block_end;
		PairLink dummy;          ///< a pair that never touches
		const KeptPairs* kept;   ///< after a search; else springs stay with their candidates
		double smallest_budget;  ///< [m]
		bool as_listed;          ///< select what `state.listed` says, not what is near
	};

	PairCounts3 select(const Source& source);
	/// Forgets places of candidates: after a search candidates are others.
	void forget_places() { place.clear(); }
	/// Calls visit(owner row, partner row, KeptPair) for every selected pair.
	template <class Visit>
	void each_pair(const SphereState& state, const Visit& visit) const;

	SphereShare view;                   ///< what the kernels see
	std::vector<PairLink> early_links;  ///< byte offsets of the early pairs' rows

private:
	Precision precision = Precision::double_;
	Buffer memory, old_memory;
	std::vector<std::uint8_t> wrapped;
	std::vector<std::uint32_t> block_pair_end, block_early_end;
	std::vector<std::uint32_t> early;  // candidates
	std::vector<std::uint32_t> early_owner;
	AlignedVector<ForceLine> early_forces;
	std::uint32_t first_candidate = 0;
	std::vector<std::uint32_t> place;  // 1 + the place of each candidate of the share; 0: not selected

	template <class P>
	PairCounts3 select_in(const Source& source);
	template <class P>
	struct Layer;
	KeptPair pair_at(std::uint32_t place) const;
};

template <class Visit>
void SpherePairs::each_pair(const SphereState& state, const Visit& visit) const
{
	const std::uint32_t end = std::min(view.block_end * grains_per_block, state.n_free);
	for (std::uint32_t a = view.block_begin * grains_per_block; a < end; ++a)
		for (std::uint32_t c = state.candidate_begin[a]; c < state.candidate_begin[a + 1]; ++c) {
			if (c - first_candidate >= place.size() || !place[c - first_candidate]) continue;
			KeptPair pair = pair_at(place[c - first_candidate] - 1);
			pair.partner = state.partners[c].row();
			visit(a, c, pair);
		}
}

}  // namespace graindrive::loop
