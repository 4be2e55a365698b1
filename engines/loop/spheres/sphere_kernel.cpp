/// Chooses the inner functions of the loop over spheres for the processor on which the program runs.
#include "engines/loop/spheres/sphere_kernel.hpp"

#include <stdexcept>

#include "engines/laws/sphere_terms.hpp"

namespace graindrive::loop {

namespace {

SphereKernel kernel_of_processor(const KernelChoice& choice)
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

}  // namespace

SphereKernel choose_sphere_kernel(const KernelChoice& choice)
{
	const SphereKernel kernel = kernel_of_processor(choice);
	if (!kernel.sweep)
		throw std::invalid_argument("the loop over spheres has only the laws " +
									laws::listed(laws::names_where(laws::is_for_spheres), " and ") +
									"; the others are for disks, or for YADE's own loop");
	return kernel;
}

}  // namespace graindrive::loop
