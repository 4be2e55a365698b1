/// The two inner functions of the loop, pair forces and motion, as pointers: one set for each processor generation, law and precision.
#pragma once
#include <string>
#include <vector>

#include "engines/laws/registry.hpp"
#include "engines/loop/grain_row.hpp"

namespace graindrive::loop {

using laws::ContactLaw;

enum class Precision { double_, single };  ///< of the contacts; positions and velocities are always double
enum class Processor { avx512, avx2, portable };

constexpr int pack_alignment = 32;  ///< pair lists begin and end at multiples of this many pairs: the widest pack

/// A fold: one grain's surplus pairs added into one extra force before the grain is moved.
struct Fold {
	std::uint32_t target, begin, end;  ///< index of the extra force; range in `KernelData::fold_sources`
	bool partnered;                    ///< the pairs' forces act on the partner
};

constexpr int grains_per_block = 32;

/// The grains of a block, those with pairs first: the others only drift.
struct BlockOrder {
	std::uint8_t with_pairs;               ///< how many
	std::uint8_t order[grains_per_block];  ///< places within the block
};

/// A force on a free grain that is no pair's. Damping acts on the sum of all forces, so it must know them before the grain moves;
/// without damping they may as well be added afterwards.
struct OutsideForce {
	double x = 0, y = 0;  ///< [N]
	double turning = 0;   ///< torque over radius [N]
};

/// Everything the inner functions touch. Offsets, counts and order are decided by the pair list; the kernels only compute.
struct KernelData {
	GrainRow* rows;
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
	double* travelled;                          ///< by block: bound on any grain's way since pairs were selected [m]
	const double* allowed;                      ///< by block: how long that may grow before they must be selected anew [m]
	double length_x, length_y;                  ///< periods [m], 0 where not periodic
	double inverse_length_x, inverse_length_y;  ///< [1/m], 0 where not periodic
	double dt;                                  ///< time step of the springs [s]
	double kick;                                ///< time over which forces act on velocities [s]
	double drift;                               ///< time over which velocities move positions [s]
	double gravity_x, gravity_y;                ///< [m/s^2]
	double spin_response;                       ///< m R^2 / I: 2 for disks, 0 where grains may not rotate
	const void* law;                            ///< the law of `KernelChoice`, in numbers of the precision
	double damping = 0;                         ///< Cundall's non-viscous damping [-]; 0: none
	bool damps_gravity = true;                  ///< gravity is damped with the other forces
	const OutsideForce* outside = nullptr;      ///< by row, or none; read in damped scenes only
};

struct Kernel {
	/// Forces of the pairs [begin, end), a multiple of `pack_alignment` long; wrapped pairs take the nearest image.
	void (*pairs)(const KernelData&, std::uint32_t begin, std::uint32_t end, bool wrapped);
	/// Pairs owned by the blocks [begin, end) of free grains from pair `first_pair` on, each block moved as soon as its forces are known.
	/// True if a block has travelled farther than it is allowed to.
	bool (*sweep)(const KernelData&, std::uint32_t begin, std::uint32_t end, std::uint32_t n_free, std::uint32_t first_pair);
	Processor processor;
	int width;  ///< pairs at once
};

struct KernelChoice {
	std::size_t law;  ///< index in `laws::Laws`
	bool friction;
	Precision precision;
};

Kernel kernel_for_avx512(const KernelChoice&);
Kernel kernel_for_avx2(const KernelChoice&);
Kernel kernel_portable(const KernelChoice&);

std::string name_of(Processor);                 ///< as in GRAINDRIVE_PROCESSOR
std::vector<Processor> processors_supported();  ///< those whose kernels run here, the best first

/// The best processor whose kernels run here, or the one that GRAINDRIVE_PROCESSOR asks for. @throws as choose_kernel
Processor wanted_processor();

/// The best kernel this processor can run. The environment variable GRAINDRIVE_PROCESSOR (avx512, avx2, portable) asks for less.
/// @throws std::invalid_argument for an unknown name or one that this processor cannot run
Kernel choose_kernel(const KernelChoice&);

}  // namespace graindrive::loop
