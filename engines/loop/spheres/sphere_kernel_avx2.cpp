/// The inner functions of the loop over spheres, compiled for processors with AVX2 and FMA (x86-64-v3).
#include "engines/loop/spheres/sphere_kernel_body.hpp"

namespace graindrive::loop {

SphereKernel sphere_kernel_for_avx2(const KernelChoice& choice) { return sphere_kernel_compiled_here(choice); }

}  // namespace graindrive::loop
