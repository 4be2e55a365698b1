/// Chooses the inner functions for the processor that the program finds itself on.
#include "engines/loop/kernel.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace graindrive::loop {

namespace {

Processor best_processor()
{
	__builtin_cpu_init();
	if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
		__builtin_cpu_supports("avx512bw"))
		return Processor::avx512;
	return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? Processor::avx2 : Processor::portable;
}

Processor wanted_processor()
{
	const Processor best = best_processor();
	const char* asked = std::getenv("GRAINDRIVE_PROCESSOR");
	if (!asked || !*asked) return best;
	const std::string name = asked;
	if (name == "portable") return Processor::portable;
	if (name == "avx2" && best != Processor::portable) return Processor::avx2;
	if (name == "avx512" && best == Processor::avx512) return Processor::avx512;
	throw std::invalid_argument("GRAINDRIVE_PROCESSOR must be avx512, avx2 or portable and supported by this processor, got '" +
								name + "'; unset it for the best");
}

}  // namespace

Kernel choose_kernel(const KernelChoice& choice)
{
	switch (wanted_processor()) {
	case Processor::avx512:
		return kernel_for_avx512(choice);
	case Processor::avx2:
		return kernel_for_avx2(choice);
	default:
		return kernel_portable(choice);
	}
}

}  // namespace graindrive::loop
