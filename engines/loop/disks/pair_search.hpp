/// The search for neighbours: every pair of grains nearer than a skin, each once, in an order that depends on positions alone.
#pragma once
#include "engines/loop/disks/cell_grid.hpp"
#include "engines/loop/state.hpp"

namespace graindrive::loop {

/// All candidates of a state whose free rows lie sorted by `grid`, in the order of (first, second).
void find_candidates(const State<2>& state, const CellGrid& grid, std::vector<Candidate>& candidates);

}  // namespace graindrive::loop
