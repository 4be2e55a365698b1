/// The two inner functions of the loop over disks, pair forces and motion, as pointers: one set for each processor generation, law and precision.
#pragma once
#include "engines/loop/disks/disk_row.hpp"
#include "engines/loop/processor.hpp"
#include "engines/loop/step_motion.hpp"

namespace graindrive::loop {

constexpr int pack_alignment = 32;  ///< pair lists begin and end at multiples of this many pairs: the widest pack

/// A fold: one grain's surplus pairs added into one extra force before the grain is moved.
struct Fold {
	std::uint32_t target, begin, end;  ///< index of the extra force; range in `DiskStep::fold_sources`
	bool partnered;                    ///< the pairs' forces act on the partner
};

/// The grains of a block, those with pairs first: the others only drift.
struct BlockOrder {
	std::uint8_t with_pairs;               ///< how many
	std::uint8_t order[grains_per_block];  ///< places within the block
};

/// A force on a free grain that is no pair's. Damping acts on the sum of all forces, so it must know them before the grain moves;
/// without damping they may as well be added afterwards.
struct OutsideForce {
	Vec<2> force;        ///< [N]
	double turning = 0;  ///< torque over radius [N]
};

/// Everything the inner functions touch. Offsets, counts and order are decided by the pair list; the kernels only compute.
struct DiskStep : StepMotion<2> {
	DiskRow* rows;
	const PairLink* links;
	const void *effective_radii, *effective_masses;  ///< of each pair [m], [kg]; double or float
	void* slips;              ///< tangential springs [m], or what else the law remembers; not read without friction
	void* forces;             ///< PairForce<double> or <float>; forces[0] stays zero
	const ForceSlots* slots;  ///< of free grains
	const BlockOrder* block_order;
	const Fold* folds;
	const std::uint32_t* fold_sources;
	const std::uint32_t* block_pair_end;  ///< by block of free grains: all pairs owned up to the block end before this
	const std::uint32_t* block_fold_end;
	double* travelled;                    ///< by block: bound on any grain's way since pairs were selected [m]
	const double* allowed;                ///< by block: its largest allowed value before pairs must be selected again [m]
	double length[2], inverse_length[2];  ///< periods [m] and [1/m], 0 where not periodic
	double image[4];  ///< displacement [m] along x and velocity [m/s] of the image one period further in y; 0 without shear
	const void* law;  ///< the law of `KernelChoice`, in numbers of the precision
	const OutsideForce* outside = nullptr;  ///< by row, or none; read in damped scenes only
};

struct DiskKernel {
	/// Forces of the pairs [begin, end), a multiple of `pack_alignment` long; wrapped pairs take the nearest image.
	void (*pairs)(const DiskStep&, std::uint32_t begin, std::uint32_t end, bool wrapped);
	/// Pairs owned by the blocks [begin, end) of free grains from pair `first_pair` on, each block moved as soon as its forces are known.
	/// True if a block has travelled farther than it is allowed to.
	bool (*sweep)(const DiskStep&, std::uint32_t begin, std::uint32_t end, std::uint32_t n_free, std::uint32_t first_pair);
	Processor processor;
	int width;  ///< pairs at once
};

DiskKernel disk_kernel_for_avx512(const KernelChoice&);
DiskKernel disk_kernel_for_avx2(const KernelChoice&);
DiskKernel disk_kernel_portable(const KernelChoice&);

/// The best kernel this processor can run; GRAINDRIVE_PROCESSOR asks for less, see wanted_processor.
DiskKernel choose_disk_kernel(const KernelChoice&);

}  // namespace graindrive::loop
