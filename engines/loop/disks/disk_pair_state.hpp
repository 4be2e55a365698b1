/// The complete state of the pairs of disks.
#pragma once
#include <cstdint>
#include <vector>

namespace graindrive::loop {

/// Two grains that may touch before the next search. `first` owns the pair and is the lower index.
struct Candidate {
	std::uint32_t first, second;
	std::uint32_t wrapped : 1, near : 1;  ///< met across a periodic side; selected for the kernels
	double slip = 0;                      ///< tangential spring, kept here while the pair is not selected [m]
};

struct DiskPairState {
	std::vector<Candidate> candidates;  ///< sorted by (first, second)

	template <class Visitor>
	void visit(Visitor&& visitor)
	{
		visitor(candidates);
	}
	template <class Visitor>
	void visit(Visitor&& visitor) const
	{
		visitor(candidates);
	}
};

}  // namespace graindrive::loop
