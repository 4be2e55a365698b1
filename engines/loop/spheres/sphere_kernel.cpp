/// Chooses the inner functions of the loop over spheres for the processor that the program finds itself on.
#include "engines/loop/spheres/sphere_kernel.hpp"

namespace graindrive::loop {

SphereKernel choose_sphere_kernel(const KernelChoice& choice)
{
	switch (wanted_processor()) {
	case Processor::avx512:
		return sphere_kernel_for_avx512(choice);
	case Processor::avx2:
		return sphere_kernel_for_avx2(choice);
	default:
		return sphere_kernel_portable(choice);
	}
}

}  // namespace graindrive::loop
