/// The inner functions of the loop over disks, compiled for any 64-bit processor (x86-64).
#include "engines/loop/disks/disk_kernel_body.hpp"

namespace graindrive::loop {

DiskKernel disk_kernel_portable(const KernelChoice& choice) { return disk_kernel_compiled_here(choice); }

}  // namespace graindrive::loop
