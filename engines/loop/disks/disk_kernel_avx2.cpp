/// The inner functions of the loop over disks, compiled for processors with AVX2 and FMA (x86-64-v3).
#include "engines/loop/disks/disk_kernel_body.hpp"

namespace graindrive::loop {

DiskKernel disk_kernel_for_avx2(const KernelChoice& choice) { return disk_kernel_compiled_here(choice); }

}  // namespace graindrive::loop
