/// The inner functions of the loop over spheres, as pointers: one set for each processor generation, law and precision.
#pragma once
#include "engines/loop/spheres/sphere_row.hpp"
#include "engines/loop/step_motion.hpp"

namespace graindrive::loop {

/// What all threads share in a step.
struct SphereStep : StepMotion<3> {
	SphereRow* rows;
	const double* inverse_masses;             ///< by row [1/kg]
	double length[3]{}, inverse_length[3]{};  ///< periods [m] and [1/m], 0 where not periodic
	std::uint32_t n_free = 0;
	const void* law;        ///< the law of `KernelChoice`, in numbers of the precision
	double* travelled;      ///< by block: bound on any sphere's way since pairs were selected [m]
	const Vec<3>* drifts;   ///< by block: the velocity against which that is meant [m/s]
	const double* allowed;  ///< by block: its largest allowed value before pairs must be selected again [m]
};

/// One thread's part of the pairs. Early pairs have a partner beyond the thread's blocks: their forces are computed before anything moves,
/// kept, and added where the order of (owner, partner) wants them.
struct SphereShare {
	std::uint32_t block_begin = 0, block_end = 0;
	void* groups;                         ///< PairGroup<double> or <float>
	const std::uint8_t* wrapped;          ///< by group: some pair is met across a periodic side
	const std::uint32_t* block_pair_end;  ///< by block of the share: pairs owned up to the block end before this
	std::uint32_t early_begin = 0, early_end = 0;
	ForceLine* early_forces;  ///< by early pair
	const PairLink* early_links;
	const std::uint32_t* block_early_end;  ///< by block of the share, counted in early pairs
};

/// What the search reads: positions and radii in sorted order, with room behind the end for a whole pack.
struct SearchColumns {
	const float *x, *y, *z, *radius;
};

struct SphereKernel {
	/// Forces of the early pairs, into `early_forces`.
	void (*early)(const SphereStep&, const SphereShare&);
	/// All other pairs of the share; each block moves as soon as its forces are known. True if a block went beyond its limit.
	bool (*sweep)(const SphereStep&, const SphereShare&);
	/// Writes those of [begin, end) that lie within `reach` plus their radius of sphere `a` to `found`; returns how many. May write a
	/// pack more than it finds.
	int (*near)(const SearchColumns&, std::uint32_t a, std::uint32_t begin, std::uint32_t end, float reach, std::uint32_t* found);
	Processor processor;
	int width;  ///< pairs at once
};

SphereKernel sphere_kernel_for_avx512(const KernelChoice&);
SphereKernel sphere_kernel_for_avx2(const KernelChoice&);
SphereKernel sphere_kernel_portable(const KernelChoice&);

/// The best kernel this processor can run; GRAINDRIVE_PROCESSOR asks for less, see wanted_processor.
/// @throws std::invalid_argument for a law that is for disks only
SphereKernel choose_sphere_kernel(const KernelChoice&);

}  // namespace graindrive::loop
