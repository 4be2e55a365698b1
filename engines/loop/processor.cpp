/// Finds out which instructions the processor has.
#include "engines/loop/processor.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace graindrive::loop {

namespace {

bool runs(Processor processor)
{
	__builtin_cpu_init();
	switch (processor) {
	case Processor::avx512:
		return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
		       __builtin_cpu_supports("avx512bw");
	case Processor::avx2:
		return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
	default:
		return true;
	}
}

}  // namespace

std::string name_of(Processor processor)
{
	return processor == Processor::avx512 ? "avx512" : processor == Processor::avx2 ? "avx2" : "portable";
}

std::vector<Processor> processors_supported()
{
	std::vector<Processor> supported;
	for (Processor processor : { Processor::avx512, Processor::avx2, Processor::portable })
		if (runs(processor)) supported.push_back(processor);
	return supported;
}

Processor wanted_processor()
{
	const std::vector<Processor> supported = processors_supported();
	const char* asked = std::getenv("GRAINDRIVE_PROCESSOR");
	if (!asked || !*asked) return supported.front();
	for (Processor processor : supported)
		if (asked == name_of(processor)) return processor;
	throw std::invalid_argument("GRAINDRIVE_PROCESSOR must be avx512, avx2 or portable and supported by this processor, got '" +
								std::string(asked) + "'; unset it for the best");
}

}  // namespace graindrive::loop
