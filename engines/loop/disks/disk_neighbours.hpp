/// Pairs of disks: search, selection, the kernels' memory, and what bodies and views ask of it.
#pragma once
#include "engines/loop/disks/pair_list.hpp"
#include "engines/loop/disks/pair_search.hpp"

namespace graindrive::loop {

class DiskNeighbours {
public:
	static constexpr int row_alignment = 2;  ///< dummy rows behind the grains
	explicit DiskNeighbours(State<2>& of) : state(of), pairs(of.pairs.candidates) {}

	/// Kernels, numbers and memory for the settings of the scene.
	void set_up();
	StepMotion<2>& motion() { return data; }
	/// Periods and images as the cell has them now.
	void see_cell();
	Processor processor() const { return kernel.processor; }
	int width() const { return kernel.width; }
	/// Makes the rows after the grains that fill up packs.
	void make_dummies();

	// A search, in this order; each by all threads with a barrier after it. The first and the third by one thread.
	void begin_search(const std::vector<Spring<2>>& given);
	void find(int rank);
	void gather() {}
	void take(int) {}
	// A selection: by all threads, then by one.
	void select(int rank, double smallest_budget, double horizon);
	void finish_selection();
	const PairCounts& counts() const { return selected; }
	std::size_t candidates() const { return state.pairs.candidates.size(); }
	/// Lays out the selected pairs again, as stored in the state.
	void lay_out();
	/// Returns to a state of the same selection, in which pairs have the same places.
	void return_to_state();

	// A step: early pairs before anything moves, then the sweep; both by all threads.
	void early(int rank);
	bool sweep(int rank);
	/// Forces on free grains that the sweep must know, in damped scenes.
	std::vector<OutsideForce>* outside_of_sweep();
	bool sweep_knows_outside() const { return data.outside != nullptr; }
	void gather_for_members() {}
	MemberForce<2> force_on_member(std::uint32_t member) const;

	void keep_springs() { pairs.keep_slips(); }
	void keep_early() { pairs.keep_early_pairs(); }
	void put_back_early() { pairs.put_back_early_pairs(); }
	void forget_springs();

	/// visit(row, row) for every candidate, or visit(row, row, candidate) for those that are selected.
	template <class Visit>
	void each_candidate(const Visit& visit) const
	{
		for (const Candidate& pair : state.pairs.candidates) visit(pair.first, pair.second);
	}
	template <class Visit>
	void each_selected(const Visit& visit) const
	{
		for (std::uint32_t c = 0; c < pairs.place.size(); ++c)
			if (pairs.place[c]) visit(state.pairs.candidates[c].first, state.pairs.candidates[c].second, c);
	}
	/// visit(row, row, met across a periodic side) for those that are selected.
	template <class Visit>
	void each_selected_pair(const Visit& visit) const
	{
		each_selected([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { visit(a, b, state.pairs.candidates[c].wrapped); });
	}
	double spring(std::uint32_t candidate) const { return pairs.slip(candidate); }
	bool is_early(std::uint32_t candidate) const { return pairs.is_early(candidate); }
	ForceParts<2> parts(std::uint32_t candidate) const;
	/// True where forces act half an overlap below the surface; without friction it makes no difference.
	bool at_contact_point() const;
	/// visit(candidate, is the partner) for every selected pair of a member.
	template <class Visit>
	void each_pair_of_member(std::uint32_t member, const Visit& visit) const
	{
		for (std::uint32_t k = pairs.member_begin[member]; k < pairs.member_begin[member + 1]; ++k)
			visit(pairs.member_shares[k].candidate, pairs.member_shares[k].partner);
	}
	/// Computes all pairs once more than steps need, calls look(), and puts back forces and springs that stood in memory.
	template <class Look>
	void with_all_forces(const Look& look)
	{
		pairs.keep_slips();
		const PairList::Bytes forces = pairs.forces_in_memory();
		for (const SweepRange& sweep : pairs.sweeps) kernel.pairs(data, sweep.pair_begin, sweep.pair_end, false);
		look();
		pairs.put_back_forces(forces);
		pairs.put_back_slips();
	}

private:
	State<2>& state;
	DiskKernel kernel{};
	DiskStep data{};
	laws::Laws::Any<float> law_in_float;
	PairList pairs;
	CellGrid grid;
	PairCounts selected;
	std::vector<OutsideForce> outside;

	void point_at_state();
};

}  // namespace graindrive::loop
