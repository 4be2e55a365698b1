/// Pairs of spheres: search, selection, the kernels' memory, and what bodies and views ask of it.
///
/// Forces are added to the rows of both spheres in the order of (owner, partner), on any number of threads. Pairs of members of different
/// bodies are a share of their own, which one thread computes.
#pragma once
#include "engines/loop/spheres/sphere_pairs.hpp"
#include "engines/loop/spheres/sphere_search.hpp"

namespace graindrive::loop {

class SphereNeighbours {
public:
	explicit SphereNeighbours(State<3>& of) : state(of) {}

	/// Kernels, numbers and memory for the settings of the scene.
	/// @throws std::invalid_argument for a law that is for disks only
	void set_up();
	StepMotion<3>& motion() { return data; }
	void see_cell() {}  ///< nothing to do
	Processor processor() const { return kernel.processor; }
	int width() const { return kernel.width; }
	/// Makes the rows after the grains that fill up packs.
	void make_dummies();

	// A search, in this order; each by all threads with a barrier after it. The first and the third by one thread.
	void begin_search(const std::vector<Spring<3>>& given);
	void find(int rank);
	void gather();
	void take(int rank);
	// A selection: by all threads, then by one.
	void select(int rank, double smallest_budget, double horizon);
	void finish_selection();
	PairCounts counts() const;
	std::size_t candidates() const { return state.pairs.partners.size(); }
	/// Lays out the selected pairs again, as listed in the state.
	void lay_out();
	void return_to_state() { lay_out(); }

	// A step: early pairs before anything moves, then the sweep; both by all threads.
	void early(int rank);
	bool sweep(int rank);
	/// Adds up what early pairs do to members of bodies.
	void gather_for_members();
	MemberForce<3> force_on_member(std::uint32_t member) const;

	/// Fills the state's list of selected pairs with their springs.
	void keep_springs();
	void keep_early();
	void put_back_early();
	void forget_springs();

	/// visit(row, row) for every candidate, or visit(row, row, candidate) for those that are selected.
	template <class Visit>
	void each_candidate(const Visit& visit) const
	{
		for (std::uint32_t a = 0; a + 1 < state.pairs.candidate_begin.size(); ++a)
			for (std::uint32_t c = state.pairs.candidate_begin[a]; c < state.pairs.candidate_begin[a + 1]; ++c)
				visit(a, state.pairs.partners[c].row());
	}
	template <class Visit>
	void each_selected(const Visit& visit) const
	{
		for (const SpherePairs& share : shares)
			share.each_place(state, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t) { visit(a, b, c); });
	}
	/// visit(row, row, met across a periodic side) for those that are selected.
	template <class Visit>
	void each_selected_pair(const Visit& visit) const
	{
		each_selected([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { visit(a, b, state.pairs.partners[c].wrapped()); });
	}
	/// visit(owner row, partner row, spring)
	template <class Visit>
	void each_spring(const Visit& visit) const
	{
		for (const SpherePairs& share : shares)
			share.each_place(state, [&](std::uint32_t a, std::uint32_t b, std::uint32_t, std::uint32_t at) {
				const KeptPair pair = share.pair_at(at);
				visit(a, b, Vec<3>{ pair.spring[0], pair.spring[1], pair.spring[2] });
			});
	}
	/// visit(owner row, partner row, force on the owner and turn, spring) for the early pairs that touch.
	template <class Visit>
	void each_early_force(const Visit& visit) const
	{
		for (const SpherePairs& share : shares) each_force(share, share.view.early_begin, share.view.early_forces, visit);
	}
	/// The same for all pairs, computed once more than steps need; springs are put back.
	template <class Visit>
	void each_force_now(const Visit& visit)
	{
		StreamedVector<ForceLine> lines;
		for (SpherePairs& share : shares) {
			lines.resize(share.places());
			SphereShare all = share.view;
			all.early_begin = 0, all.early_forces = lines.data();
			const std::vector<char> before = share.bytes_from(0);
			if (all.early_end > 0) kernel.early(data, all);
			each_force(share, 0, lines.data(), visit);
			share.put_back(0, before);
		}
	}

private:
	State<3>& state;
	SphereKernel kernel{};
	SphereStep data{};
	laws::Laws::Any<float> law_in_float;
	std::vector<SpherePairs> shares;                        // by thread, and last the members'
	std::vector<std::vector<const ForceLine*>> incoming;    // by thread, and last for members: early forces on partners
	std::vector<std::vector<std::uint32_t>> incoming_rows;  // and their rows' offsets
	std::vector<PairCounts> counts_by_share;
	std::vector<std::uint32_t> share_begin;       // by thread: first block, and the end
	std::vector<std::vector<char>> early_before;  // by share: as keep_early found them

	// For the time of a search.
	SphereGrid grid;
	SphereSearch finder;
	KeptPairs kept;
	bool searched = false;
	std::vector<std::vector<Partner>> found;  // by thread
	std::vector<std::uint32_t> found_cells;   // by thread: first cell, and the end

	int threads() const { return state.scene.threads; }
	void keep_pairs(const std::vector<std::uint32_t>& new_row, const std::vector<Spring<3>>& given);
	void share_out();
	SpherePairs::Source source(int share, bool as_listed, double smallest_budget, double horizon);
	void add_incoming(int rank);
	void collect_incoming(int rank);
	void point_at_state();

	template <class Visit>
	void each_force(const SpherePairs& share, std::uint32_t first, const ForceLine* lines, const Visit& visit) const
	{
		share.each_place(state, [&](std::uint32_t a, std::uint32_t b, std::uint32_t, std::uint32_t at) {
			if (at < first) return;
			const double* line = lines[at - first].number;
			const Vec<3> force{ line[2], line[3], line[4] }, turn{ line[5], line[6], line[7] };
			if (geometry::squared_norm(force) == 0) return;
			const KeptPair pair = share.pair_at(at);
			visit(a, b, force, turn, Vec<3>{ pair.spring[0], pair.spring[1], pair.spring[2] });
		});
	}
};

}  // namespace graindrive::loop
