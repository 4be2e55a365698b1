/// Random numbers that are the same on every machine: the standard fixes mt19937_64, but not what its distributions make of it.
#pragma once
#include <cstdint>
#include <random>

#include "engines/base/real.hpp"

namespace graindrive::packing {

class Uniform {
public:
	/// One stream a purpose, so that one seed for diameters and places does not tie the two together.
	Uniform(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(seed + stream * 0x9E3779B97F4A7C15u)) {}

	/// A number in [0, 1): the 53 upper bits of a draw.
	Real operator()() { return static_cast<Real>(engine_() >> 11) * 0x1p-53; }

	/// A number in [low, high).
	Real operator()(Real low, Real high) { return low + (high - low) * (*this)(); }

private:
	/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): neighbouring seeds give unrelated streams.
	static std::uint64_t mixed(std::uint64_t z)
	{
		z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
		z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
		return z ^ (z >> 31);
	}

	std::mt19937_64 engine_;
};

}  // namespace graindrive::packing
