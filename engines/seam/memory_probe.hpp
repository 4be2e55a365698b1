/// Reads this process's memory without ever faulting: a pointer that leads nowhere gives `nullopt`.
#pragma once
#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>

namespace graindrive::seam {

class MemoryProbe {
public:
	MemoryProbe() : file_(::open("/proc/self/mem", O_RDONLY | O_CLOEXEC)) {}
	~MemoryProbe()
	{
		if (file_ >= 0) ::close(file_);
	}
	MemoryProbe(const MemoryProbe&) = delete;
	MemoryProbe& operator=(const MemoryProbe&) = delete;

	bool usable() const { return file_ >= 0; }

	template <class T>
	std::optional<T> read(std::uintptr_t address) const
	{
		T value;
		if (::pread(file_, &value, sizeof value, static_cast<off_t>(address)) != static_cast<ssize_t>(sizeof value))
			return std::nullopt;
		return value;
	}

	std::string bytes(std::uintptr_t address, std::size_t count) const
	{
		std::string out(count, '\0');
		if (::pread(file_, out.data(), count, static_cast<off_t>(address)) != static_cast<ssize_t>(count)) return {};
		return out;
	}

private:
	int file_;
};

}  // namespace graindrive::seam
