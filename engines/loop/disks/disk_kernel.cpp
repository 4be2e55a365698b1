/// Chooses the inner functions of the loop over disks for the processor on which the program runs.
#include "engines/loop/disks/disk_kernel.hpp"

namespace graindrive::loop {

DiskKernel choose_disk_kernel(const KernelChoice& choice)
{
	switch (wanted_processor()) {
	case Processor::avx512:
		return disk_kernel_for_avx512(choice);
	case Processor::avx2:
		return disk_kernel_for_avx2(choice);
	default:
		return disk_kernel_portable(choice);
	}
}

}  // namespace graindrive::loop
