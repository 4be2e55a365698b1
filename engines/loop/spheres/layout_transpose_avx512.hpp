/// Rows to columns and back with AVX-512: a line of eight doubles is one register, eight pairs (16 in single precision) at once.
#pragma once
#include "engines/loop/lanes_avx512.hpp"
#include "engines/loop/simd_pack.hpp"
#include "engines/loop/spheres/sphere_kernel.hpp"

namespace graindrive::loop {
namespace {

constexpr Processor compiled_for = Processor::avx512;

template <class Row>
inline const double* line_of(const Row* rows, std::uint32_t offset, int line)
{
	return reinterpret_cast<const double*>(reinterpret_cast<const char*>(rows) + offset) + 8 * line;
}

/// Sums and differences of two rows, line by line, by the layout's signs.
template <class Row>
struct LayoutDifference {
	using Layout = RowLayout<Row>;
	static constexpr int lines = (Layout::groups + 1) / 2;
	const Row* rows;
	__m512d signs[lines], length = _mm512_setzero_pd(), inverse_length = _mm512_setzero_pd();

	LayoutDifference(const Row* first, const double* lengths, const double* inverse_lengths) : rows(first)
	{
		for (int line = 0; line < lines; ++line)
			for (int k = 0; k < 8; ++k) signs[line][k] = 8 * line + k < 4 * Layout::groups ? Layout::sign[8 * line + k] : 1;
		for (int axis = 0; axis < Layout::axes; ++axis)
			length[axis] = lengths[axis], inverse_length[axis] = inverse_lengths[axis];
	}

	template <bool Wrapped>
	__m512d operator()(PairLink link, int line) const
	{
		const __m512d d = _mm512_fmadd_pd(
			_mm512_load_pd(line_of(rows, link.first, line)), signs[line], _mm512_load_pd(line_of(rows, link.second, line)));
		if (!Wrapped || line > 0) return d;
		return _mm512_fnmadd_pd(length, _mm512_roundscale_pd(_mm512_mul_pd(d, inverse_length), 0), d);
	}
};

template <class Row, class P>
struct LayoutTransposer;

/// Columns that nobody uses are not computed: the compiler drops them.
template <class Row>
struct LayoutTransposer<Row, double> {
	using Number = Pack<double, 8>;
	static constexpr int columns_written = 8 * LayoutDifference<Row>::lines;

	template <bool Wrapped>
	static inline void columns(const LayoutDifference<Row>& difference, const PairLink* links, Number* out)
	{
		for (int line = 0; line < LayoutDifference<Row>::lines; ++line) {
			const auto d = [&](int k) { return difference.template operator()<Wrapped>(links[k], line); };
			__m512d even[4], odd[4];
			transpose_lanes(d(0), d(2), d(4), d(6), even);
			transpose_lanes(d(1), d(3), d(5), d(7), odd);
			for (int q = 0; q < 4; ++q) {
				out[8 * line + 2 * q].v = (typename Number::Vector)_mm512_unpacklo_pd(even[q], odd[q]);
				out[8 * line + 2 * q + 1].v = (typename Number::Vector)_mm512_unpackhi_pd(even[q], odd[q]);
			}
		}
	}

	/// Calls put(k, line) with the numbers 0, 0, column[0] ... column[5] of pair k, in the order of pairs.
	template <class Put>
	static inline void lines(const Number column[6], const Put& put)
	{
		__m512d low[4], high[4], even[4], odd[4];
		low[0] = high[0] = _mm512_setzero_pd();
		for (int q = 1; q < 4; ++q) {
			const __m512d a = (__m512d)column[2 * q - 2].v, b = (__m512d)column[2 * q - 1].v;
			low[q] = _mm512_unpacklo_pd(a, b);
			high[q] = _mm512_unpackhi_pd(a, b);
		}
		transpose_lanes(low[0], low[1], low[2], low[3], even);
		transpose_lanes(high[0], high[1], high[2], high[3], odd);
		for (int q = 0; q < 4; ++q) {
			put(2 * q, even[q]);
			put(2 * q + 1, odd[q]);
		}
	}
};

template <class Row>
struct LayoutTransposer<Row, float> {
	using Number = Pack<float, 16>;
	static constexpr int columns_written = 8 * LayoutDifference<Row>::lines;

	template <bool Wrapped>
	static inline void columns(const LayoutDifference<Row>& difference, const PairLink* links, Number* out)
	{
		for (int line = 0; line < LayoutDifference<Row>::lines; ++line) {
			const auto d = [&](int k) { return _mm512_cvtpd_ps(difference.template operator()<Wrapped>(links[k], line)); };
			__m512 a[4], b[4];
			for (int k = 0; k < 4; ++k) {
				const auto two = [&](int first, int second) {
					return _mm512_insertf32x8(_mm512_castps256_ps512(d(first)), d(second), 1);
				};
				const __m512 low = two(k, 4 + k), high = two(8 + k, 12 + k);
				a[k] = _mm512_shuffle_f32x4(low, high, 0x88);
				b[k] = _mm512_shuffle_f32x4(low, high, 0xdd);
			}
			__m512d first[4], last[4];
			transpose_in_lanes(a, first);
			transpose_in_lanes(b, last);
			for (int q = 0; q < 4; ++q) {
				out[8 * line + q].v = (typename Number::Vector)first[q];
				out[8 * line + 4 + q].v = (typename Number::Vector)last[q];
			}
		}
	}

	template <class Put>
	static inline void lines(const Number column[6], const Put& put)
	{
		const __m512 zero = _mm512_setzero_ps();
		const __m512 first[4] = { zero, zero, (__m512)column[0].v, (__m512)column[1].v };
		const __m512 last[4] = { (__m512)column[2].v, (__m512)column[3].v, (__m512)column[4].v, (__m512)column[5].v };
		__m512d a[4], b[4];  // lane q of a[k] is the first half of pair 4 q + k
		transpose_in_lanes(first, a);
		transpose_in_lanes(last, b);
		const __m512i lower = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), upper = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
		__m512d two[2][4];
		for (int k = 0; k < 4; ++k) {
			two[0][k] = _mm512_permutex2var_pd(a[k], lower, b[k]);  // pairs k and 4 + k
			two[1][k] = _mm512_permutex2var_pd(a[k], upper, b[k]);  // pairs 8 + k and 12 + k
		}
		for (int pair = 0; pair < 16; ++pair) {
			const __m512 both = _mm512_castpd_ps(two[pair / 8][pair % 4]);
			put(pair, _mm512_cvtps_pd(pair % 8 < 4 ? _mm512_castps512_ps256(both) : _mm512_extractf32x8_ps(both, 1)));
		}
	}
};

/// Adds a pair's line to the second lines of both rows; the partner's force has the other sign.
struct LineAdder {
	SphereRow* rows;
	__m512d partner_sign = _mm512_setr_pd(1, 1, -1, -1, -1, 1, 1, 1);

	explicit LineAdder(SphereRow* first) : rows(first) {}

	double* at(std::uint32_t offset) const { return const_cast<double*>(line_of(rows, offset, 1)); }
	void to_owner(std::uint32_t offset, __m512d line) const
	{
		_mm512_store_pd(at(offset), _mm512_add_pd(_mm512_load_pd(at(offset)), line));
	}
	void to_partner(std::uint32_t offset, __m512d line) const
	{
		_mm512_store_pd(at(offset), _mm512_fmadd_pd(line, partner_sign, _mm512_load_pd(at(offset))));
	}
	static __m512d load(const ForceLine& line) { return _mm512_load_pd(line.number); }
	static void store(ForceLine& to, __m512d line) { _mm512_store_pd(to.number, line); }
};

}  // namespace
}  // namespace graindrive::loop
