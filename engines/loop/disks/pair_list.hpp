/// Which pairs the kernels compute now, where in memory, and where each grain finds its forces.
///
/// Candidates (within the skin) change at a search; the selected ones (about to touch) change more often and cheaply. A pair's place decides
/// nothing but memory: every grain adds its forces in the order of its candidates, so results do not depend on places or on threads.
#pragma once
#include "engines/loop/disks/disk_kernel.hpp"
#include "engines/loop/views.hpp"

namespace graindrive::loop {

/// What one thread sweeps: blocks of free grains and the places of the pairs they own.
struct SweepRange {
	std::uint32_t block_begin, block_end, pair_begin, pair_end;
};

/// Radius and the way a grain may go until the next selection, or half of that way [m].
struct Reach {
	double whole, half;
};

class PairList {
public:
	/// For pairs that someone else keeps, with their springs.
	explicit PairList(std::vector<Candidate>& pairs) : candidates(pairs) {}

	/// Selects the candidates nearer than the sum of their reaches; those across a side also by the way that its images may go [m].
	PairCounts select(const DiskRow* rows, const Cell<2>& cell, const std::vector<Reach>& reach, double images_may_go);
	/// Lays the selected ones out for `threads` and points the grains' slots at them.
	void lay_out(const DiskRow* rows, std::uint32_t n_free, std::uint32_t n_grains, int threads, Precision precision,
		std::uint32_t dummy_row);
	/// Brings the tangential springs of the selected pairs back into the candidates.
	void keep_slips();
	void put_back_slips();  ///< and into the kernels' memory again
	/// Springs and forces of the early pairs alone, which cost little.
	void keep_early_pairs();
	void put_back_early_pairs();
	bool is_early(std::uint32_t candidate) const { return place[candidate] >= early_begin; }
	/// Forces as they stand in memory, and back.
	using Bytes = std::vector<char>;
	Bytes forces_in_memory() const { return bytes_of_forces(0, forces.size()); }
	void put_back_forces(const Bytes& bytes) { put_back_forces(0, bytes); }
	void point(DiskStep& data);

	std::vector<SweepRange> sweeps;  ///< one per thread
	std::uint32_t early_begin = 0,
				  early_end = 0;  ///< pairs to be computed before anything moves: across threads or periodic sides, with bodies
	std::vector<std::uint32_t> place;  ///< by candidate; 0 = not selected

	/// Forces on grains that do not move freely: by member, the places and which side of the pair it is.
	struct Share {
		std::uint32_t candidate;
		bool partner;
	};
	std::vector<std::uint32_t> member_begin;
	std::vector<Share> member_shares;

	PairForce<double> force(std::uint32_t candidate) const;
	double slip(std::uint32_t candidate) const;

private:
	std::vector<Candidate>& candidates;

	void put(StreamedVector<double>& list, std::uint32_t at, double number);

	Precision precision = Precision::double_;
	StreamedVector<PairLink> links;
	StreamedVector<double> slips, effective_radii, effective_masses;  // room for doubles; floats use half of it
	StreamedVector<PairForce<double>> forces;
	StreamedVector<ForceSlots> slots;
	std::vector<BlockOrder> block_order;
	std::vector<Fold> folds;
	std::vector<std::uint32_t> fold_sources, block_pair_end, block_fold_end;

	struct Surplus {
		std::uint32_t grain, place;
		bool partner;
	};
	std::vector<Surplus> surplus;
	std::vector<double> early_slips;  // as keep_early_pairs found them
	Bytes early_forces;
	std::vector<std::uint32_t> early, with_members;                          // candidates
	std::vector<std::uint8_t> owned, partnered, used_owned, used_partnered;  // by grain: pairs selected, slots filled

	std::size_t force_bytes() const;
	Bytes bytes_of_forces(std::size_t begin, std::size_t end) const;
	void put_back_forces(std::size_t begin, const Bytes& bytes);
	void place_pairs(const DiskRow* rows, std::uint32_t n_free, int threads, std::uint32_t dummy_row);
	std::uint32_t pad(std::uint32_t places, PairLink dummy);
	void order_blocks(std::uint32_t n_free);
	void fill_slots(std::uint32_t n_free);
	void fold_surplus(std::uint32_t next_place);
	void list_members(std::uint32_t n_free, std::uint32_t n_grains);
};

}  // namespace graindrive::loop
