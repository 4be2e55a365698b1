/// The inner functions of the loop over spheres, compiled for any 64-bit processor (x86-64).
#include "engines/loop/spheres/sphere_kernel_body.hpp"

namespace graindrive::loop {

SphereKernel sphere_kernel_portable(const KernelChoice& choice) { return sphere_kernel_compiled_here(choice); }

}  // namespace graindrive::loop
