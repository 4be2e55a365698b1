/// Everything that decides how a run of spheres goes on; all else is made from it and from the scene's settings.
#pragma once
#include <cstdint>
#include <vector>

#include "engines/loop/spheres/big_pages.hpp"
#include "engines/loop/spheres/sphere_row.hpp"
#include "engines/loop/spheres/sphere_search.hpp"

namespace graindrive::loop {

/// A pair that is selected, with its tangential spring of the owner's surface against the partner's.
struct ListedPair {
	std::uint32_t candidate;
	double spring[3];  ///< [m]
};

struct SphereState {
	StreamedVector<SphereRow> rows;         ///< free spheres by cell, then held ones, then dummies that fill up packs
	StreamedVector<double> inverse_masses;  ///< by row [1/kg]; 0 for held spheres and dummies
	std::vector<std::uint32_t> index_of;    ///< row -> index in SphereScene::spheres
	std::uint32_t n_free = 0, n = 0;
	std::vector<double> searched_at;             ///< places at the last search [m]
	double skin = 0;                             ///< of the last search [m]
	std::vector<std::uint32_t> candidate_begin;  ///< by owner, and the end
	std::vector<Partner> partners;               ///< of the candidates, by owner, then by row
	std::vector<double> travelled, allowed;  ///< by block, then of all held spheres: way since the last selection, its limit [m]
	double pace = 40;                        ///< steps between selections that budgets are made for
	bool selection_due = true;
	long steps = 0, searches = 0, selections = 0;
	std::vector<ListedPair> listed;  ///< filled for a checkpoint; while a run goes on springs lie in the kernels' memory

	std::uint32_t n_blocks() const { return (n_free + grains_per_block - 1) / grains_per_block; }
	/// Index of a row's block, or of the held spheres, among the budgets.
	std::uint32_t party_of(std::uint32_t row) const { return row < n_free ? row / grains_per_block : n_blocks(); }

	/// Calls visit(field) for each, in the order in which a checkpoint holds them.
	template <class Visitor, class Self>
	static void visit(Visitor&& visit, Self& s)
	{
		visit(s.rows), visit(s.inverse_masses), visit(s.index_of), visit(s.n_free), visit(s.n);
		visit(s.searched_at), visit(s.skin), visit(s.candidate_begin), visit(s.partners);
		visit(s.travelled), visit(s.allowed), visit(s.pace), visit(s.selection_due);
		visit(s.steps), visit(s.searches), visit(s.selections), visit(s.listed);
	}
};

}  // namespace graindrive::loop
