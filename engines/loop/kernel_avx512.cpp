/// The inner functions compiled for processors with AVX-512 (x86-64-v4).
#include "engines/loop/kernel_body.hpp"

namespace graindrive::loop {

Kernel kernel_for_avx512(const KernelChoice& choice) { return kernel_compiled_here(choice); }

}  // namespace graindrive::loop
