/// Memory for what a step streams through: on cache lines, and in pages of 2 MB where it is large, so that the processor's table of pages
/// holds all of it.
#pragma once
#include <cstddef>
#include <new>
#include <sys/mman.h>
#include <vector>

namespace graindrive::loop {

constexpr std::size_t big_page = std::size_t(2) << 20;

inline std::align_val_t page_alignment(std::size_t bytes) { return std::align_val_t(bytes >= big_page / 2 ? big_page : 64); }

inline void* in_big_pages(std::size_t bytes)
{
	void* memory = ::operator new(bytes, page_alignment(bytes));
	if (bytes >= big_page / 2)
		madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: where it is not granted all works as well, more slowly
	return memory;
}

inline void free_big_pages(void* memory, std::size_t bytes) { ::operator delete(memory, page_alignment(bytes)); }

template <class T>
struct BigPages {
	using value_type = T;
	BigPages() = default;
	template <class U>
	BigPages(const BigPages<U>&)
	{
	}
	T* allocate(std::size_t n) { return static_cast<T*>(in_big_pages(n * sizeof(T))); }
	void deallocate(T* p, std::size_t n) { free_big_pages(p, n * sizeof(T)); }
	template <class U>
	bool operator==(const BigPages<U>&) const
	{
		return true;
	}
	template <class U>
	bool operator!=(const BigPages<U>&) const
	{
		return false;
	}
};

template <class T>
using StreamedVector = std::vector<T, BigPages<T>>;

}  // namespace graindrive::loop
