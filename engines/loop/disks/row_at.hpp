/// Where the row of a pair lies: what all transpositions begin with.
#pragma once
#include "engines/loop/disks/disk_kernel.hpp"
#include "engines/loop/simd_pack.hpp"

namespace graindrive::loop {
namespace {

inline const double* row_at(const DiskRow* rows, std::uint32_t offset)
{
	return reinterpret_cast<const double*>(reinterpret_cast<const char*>(rows) + offset);
}

}  // namespace
}  // namespace graindrive::loop
