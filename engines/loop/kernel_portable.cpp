/// The inner functions compiled for any 64-bit processor.
#include "engines/loop/kernel_body.hpp"

namespace graindrive::loop {

Kernel kernel_portable(const KernelChoice& choice) { return kernel_compiled_here(choice); }

}  // namespace graindrive::loop
