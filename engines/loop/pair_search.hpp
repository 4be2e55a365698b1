/// The search for neighbours: every pair of grains nearer than a skin, each once, in an order that depends on positions alone.
#pragma once
#include <cstdint>
#include <vector>

#include "engines/loop/cell_grid.hpp"

namespace graindrive::loop {

/// Two grains that may touch before the next search. `first` owns the pair and is the lower index.
struct Candidate {
	std::uint32_t first, second;
	std::uint32_t wrapped : 1, near : 1;  ///< met across a periodic side; selected for the kernels
	double slip = 0;                      ///< tangential spring, kept here while the pair is not selected [m]
};

/// What the search sees: free grains lie first, sorted by cell; members of bodies follow.
struct SearchInput {
	const GrainRow* rows;
	std::uint32_t n_free, n_grains;
	const int* body_of;  ///< by grain; `free_grain` for free ones
	const std::vector<RigidBody>* bodies;
	const std::vector<char>* fixed;  ///< by body: never moves, so two of them need no pair
	const Box* box;
	double skin;                 ///< [m]
	double largest_free_radius;  ///< [m]
};

/// All candidates, sorted by (first, second). `grid` must be sorted for the rows as they lie.
void find_candidates(const SearchInput&, const CellGrid& grid, std::vector<Candidate>& candidates);

/// b - a by the nearest image.
struct Separation {
	double x, y;
	bool wrapped;
};
Separation separation(const GrainRow& a, const GrainRow& b, const Box& box);

}  // namespace graindrive::loop
