/// One thread's pairs: which of the candidates that its blocks own are selected, and where in the kernels' memory they lie.
///
/// A pair's place decides nothing but memory: forces are added to every row in the order of (owner, partner), on any number of threads.
#pragma once
#include <cmath>

#include "engines/loop/spheres/sphere_kernel.hpp"
#include "engines/loop/views.hpp"

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

class SpherePairs {
public:
	/// Where the pairs of a selection come from.
	struct Source {
		const State<3>& state;
		std::uint32_t block_begin, block_end;  ///< blocks of free spheres that the thread moves; none for members of bodies
		std::uint32_t owner_begin, owner_end;  ///< rows whose pairs these are
		PairLink dummy;                        ///< a pair that never touches
		const KeptPairs* kept;                 ///< after a search; else springs stay with their candidates
		double smallest_budget;                ///< [m]
		double horizon;                        ///< for how long the selection may last [s]
		bool as_listed;                        ///< select the pairs in `state.pairs.listed`, not the near ones
	};

	PairCounts select(const Source& source);
	/// Forgets places of candidates: after a search candidates are others.
	void forget_places() { place.clear(); }
	/// Calls visit(owner row, partner row, KeptPair) for every selected pair.
	template <class Visit>
	void each_pair(const State<3>& state, const Visit& visit) const;
	/// The number of places for pairs, including dummies.
	std::uint32_t places() const { return view.early_end; }
	/// Calls visit(owner row, partner row, candidate, place).
	template <class Visit>
	void each_place(const State<3>& state, const Visit& visit) const;
	/// The spring at a place.
	KeptPair pair_at(std::uint32_t place) const;
	void forget_springs();
	/// What stands at the places from `first` on, and back.
	std::vector<char> bytes_from(std::uint32_t first) const;
	void put_back(std::uint32_t first, const std::vector<char>& bytes);

	SphereShare view;                   ///< what the kernels see
	std::vector<PairLink> early_links;  ///< byte offsets of the early pairs' rows

private:
	Precision precision = Precision::double_;
	Buffer memory, old_memory;
	std::vector<std::uint8_t> wrapped;
	std::vector<std::uint32_t> block_pair_end, block_early_end;
	struct Chosen {
		std::uint32_t owner, candidate;
	};
	struct EarlyPair : Chosen {
		std::uint32_t old_place;
	};
	std::vector<Chosen> chosen;  // of the owners under way
	std::vector<EarlyPair> early;
	StreamedVector<ForceLine> early_forces;
	std::uint32_t first_candidate = 0, owner_begin = 0, owner_end = 0;
	std::vector<std::uint32_t> place, old_places;  // 1 + the place of each candidate of the share; 0: not selected

	template <class P>
	PairCounts select_in(const Source& source);
	template <class P>
	struct Layer;
	void choose(const Source& source, std::uint32_t first, std::uint32_t end, PairCounts& counts);
	void choose_listed(const Source& source, std::uint32_t first, std::uint32_t end);
	template <class P>
	void take_pairs_of(const Source& source, std::uint32_t first, std::uint32_t end, Layer<P>& layer, PairCounts& counts);
	template <class P>
	void lay_early_pairs(const Source& source, Layer<P>& layer);
	std::size_t group_bytes() const;
	std::uint32_t group_size() const
	{
		return precision == Precision::double_ ? PairGroup<double>::size : PairGroup<float>::size;
	}
};

template <class Visit>
void SpherePairs::each_place(const State<3>& state, const Visit& visit) const
{
	const SpherePairState& pairs = state.pairs;
	for (std::uint32_t a = owner_begin; a < owner_end; ++a)
		for (std::uint32_t c = pairs.candidate_begin[a]; c < pairs.candidate_begin[a + 1]; ++c)
			if (c - first_candidate < place.size() && place[c - first_candidate])
				visit(a, pairs.partners[c].row(), c, place[c - first_candidate] - 1);
}

template <class Visit>
void SpherePairs::each_pair(const State<3>& state, const Visit& visit) const
{
	each_place(state, [&](std::uint32_t owner, std::uint32_t partner, std::uint32_t candidate, std::uint32_t at) {
		KeptPair pair = pair_at(at);
		pair.partner = partner;
		visit(owner, candidate, pair);
	});
}

}  // namespace graindrive::loop
