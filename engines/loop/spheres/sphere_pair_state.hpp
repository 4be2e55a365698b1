/// The complete state of the pairs of spheres.
#pragma once
#include <cstdint>
#include <vector>

namespace graindrive::loop {

/// A partner of a candidate pair: the row, and whether the pair is met across a periodic side.
struct Partner {
	std::uint32_t bits;

	static constexpr std::uint32_t across = 0x80000000u;
	std::uint32_t row() const { return bits & ~across; }
	bool wrapped() const { return bits & across; }
};

/// A pair that is selected, with its tangential spring of the owner's surface against the partner's.
struct ListedPair {
	std::uint32_t candidate;
	double spring[3];  ///< [m]
};

struct SpherePairState {
	std::vector<std::uint32_t> candidate_begin;  ///< by owner row, and the end
	std::vector<Partner> partners;               ///< of the candidates, by owner, then by row
	std::vector<ListedPair> listed;              ///< filled for a checkpoint; during a run springs are in the kernels' memory

	template <class Visitor>
	void visit(Visitor&& visitor)
	{
		visitor(candidate_begin), visitor(partners), visitor(listed);
	}
	template <class Visitor>
	void visit(Visitor&& visitor) const
	{
		visitor(candidate_begin), visitor(partners), visitor(listed);
	}
};

}  // namespace graindrive::loop
