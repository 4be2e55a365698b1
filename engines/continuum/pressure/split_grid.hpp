/// Memory for the pressure's grids: in each row first the cells of even x, then those of odd x.
///
/// Neighbours of the cells of one colour, and the cells that a coarser grid keeps, then lie side by side, so that every kernel reads and
/// writes whole packs. Halves of rows begin on a cache line; around them lie zeros that are read and never written.
#pragma once
#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

namespace graindrive::continuum {

constexpr int lanes = 8;  // cells in a pack

template <class Real>
struct PackOf;
template <>
struct PackOf<double> {
	typedef double type __attribute__((vector_size(lanes * sizeof(double)), aligned(sizeof(double)), may_alias));
};
template <>
struct PackOf<float> {
	typedef float type __attribute__((vector_size(lanes * sizeof(float)), aligned(sizeof(float)), may_alias));
};
/// `lanes` numbers, anywhere in memory.
template <class Real>
using Pack = typename PackOf<Real>::type;

template <class Real>
Pack<Real>& pack(Real* p)
{
	return *reinterpret_cast<Pack<Real>*>(p);
}
template <class Real>
const Pack<Real>& pack(const Real* p)
{
	return *reinterpret_cast<const Pack<Real>*>(p);
}

/// The sum over the lanes, always in the same order.
template <class Real>
double sum_of(const Pack<Real>& p)
{
	return (double(p[0]) + p[4] + (double(p[1]) + p[5])) + (double(p[2]) + p[6] + (double(p[3]) + p[7]));
}

/// A multiple of `lanes`.
inline int rounded_down(int k) { return k / lanes * lanes; }
inline int rounded_up(int k) { return rounded_down(k + lanes - 1); }

/// The packs of a row (of both halves) that hold open cells: from `first` to before `last`, multiples of `lanes`.
struct Span {
	int first = 0, last = 0;
	bool operator==(const Span& other) const { return first == other.first && last == other.last; }
};

/// Where the cell (x, y) lies: the half of x's parity, place x/2 (rounded down).
struct SplitGrid {
	int nx = 0, ny = 0;
	static constexpr int margin = 2;  // rows of zeros below and above

	int half() const { return rounded_up((nx + 1) / 2) + lanes; }
	std::size_t size() const { return std::size_t(2) * half() * (ny + 2 * margin) + lanes; }
	/// Where place 0 of a half row lies; `parity` 0 holds even x.
	std::size_t offset(int y, int parity) const { return (std::size_t(2) * (y + margin) + parity) * half() + lanes; }
	std::size_t index(int x, int y) const { return offset(y, x & 1) + x / 2; }
};

/// Memory that begins on a cache line.
template <class T>
struct OnCacheLines {
	using value_type = T;
	OnCacheLines() = default;
	template <class U>
	OnCacheLines(const OnCacheLines<U>&)
	{
	}
	T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
	void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
	template <class U>
	bool operator==(const OnCacheLines<U>&) const
	{
		return true;
	}
	template <class U>
	bool operator!=(const OnCacheLines<U>&) const
	{
		return false;
	}
};

/// One number a cell, in the order of `SplitGrid`.
template <class Real>
class Field {
public:
	Field() = default;
	explicit Field(const SplitGrid& grid) : grid(grid), numbers(grid.size()) {}
	Real* row(int y, int parity) { return numbers.data() + grid.offset(y, parity); }
	const Real* row(int y, int parity) const { return numbers.data() + grid.offset(y, parity); }
	Real& at(int x, int y) { return numbers.data()[grid.index(x, y)]; }
	Real at(int x, int y) const { return numbers.data()[grid.index(x, y)]; }
	Real* data() { return numbers.data(); }
	const Real* data() const { return numbers.data(); }
	void clear() { std::fill(numbers.begin(), numbers.end(), Real(0)); }

private:
	SplitGrid grid;
	std::vector<Real, OnCacheLines<Real>> numbers;
};

/// Takes a row in natural order apart, or puts one together. `row` has n numbers.
template <class Real>
void split_row(const double* row, int n, Real* even, Real* odd)
{
	const int pairs = n / 2;
	for (int k = 0; k < pairs; ++k) {
		even[k] = Real(row[2 * k]);
		odd[k] = Real(row[2 * k + 1]);
	}
	if (n & 1) even[pairs] = Real(row[n - 1]);
}
template <class Real>
void merge_row(const Real* even, const Real* odd, int n, double* row)
{
	const int pairs = n / 2;
	for (int k = 0; k < pairs; ++k) {
		row[2 * k] = even[k];
		row[2 * k + 1] = odd[k];
	}
	if (n & 1) row[n - 1] = even[pairs];
}

/// The same for the packs of a span, whose row in natural order has room for whole packs.
inline void split_span(const double* row, const Span& span, double* even, double* odd)
{
	for (int k = span.first; k < span.last; ++k) {
		even[k] = row[2 * k];
		odd[k] = row[2 * k + 1];
	}
}
inline void merge_span(const double* even, const double* odd, const Span& span, double* row)
{
	for (int k = span.first; k < span.last; ++k) {
		row[2 * k] = even[k];
		row[2 * k + 1] = odd[k];
	}
}

/// Calls `work(offset)` for each pack of open cells in a row.
template <class Work>
void for_row(const SplitGrid& grid, const std::vector<Span>& spans, int y, Work&& work)
{
	for (int parity = 0; parity < 2; ++parity) {
		const std::size_t row = grid.offset(y, parity);
		for (int k = spans[y].first; k < spans[y].last; k += lanes) work(row + k);
	}
}

/// The same for all rows.
template <class Work>
void for_packs(const SplitGrid& grid, const std::vector<Span>& spans, Work&& work)
{
	for (int y = 0; y < grid.ny; ++y) for_row(grid, spans, y, work);
}

inline double dot(const SplitGrid& grid, const std::vector<Span>& spans, const Field<double>& a, const Field<double>& b)
{
	Pack<double> sum = {};
	for_packs(grid, spans, [&](std::size_t i) { sum += pack(a.data() + i) * pack(b.data() + i); });
	return sum_of<double>(sum);
}

}  // namespace graindrive::continuum
