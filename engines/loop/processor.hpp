/// What kernels of all dimensions share: the processor that they are compiled for, the choice among them, blocks and links.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engines/laws/registry.hpp"

namespace graindrive::loop {

using laws::ContactLaw;

enum class Precision { double_, single };  ///< of the contacts; positions and velocities are always double
enum class Processor { avx512, avx2, portable };

constexpr std::uint32_t grains_per_block = 32;  ///< free grains that are moved together and share a budget of motion

/// Byte offsets of the two rows of a pair from the first row: `first` is the owner, on which the stored force acts.
struct PairLink {
	std::uint32_t first, second;
};

struct KernelChoice {
	std::size_t law;  ///< index in `laws::Laws`
	bool friction;
	Precision precision;
};

std::string name_of(Processor);                 ///< as in GRAINDRIVE_PROCESSOR
std::vector<Processor> processors_supported();  ///< those whose kernels run here, the best first

/// The best processor whose kernels run here. The environment variable GRAINDRIVE_PROCESSOR (avx512, avx2, portable) asks for less.
/// @throws std::invalid_argument for an unknown name or one that this processor cannot run
Processor wanted_processor();

}  // namespace graindrive::loop
