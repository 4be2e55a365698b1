/// The inner functions compiled for processors with AVX2 and FMA (x86-64-v3).
#include "engines/loop/kernel_body.hpp"

namespace graindrive::loop {

Kernel kernel_for_avx2(const KernelChoice& choice) { return kernel_compiled_here(choice); }

}  // namespace graindrive::loop
