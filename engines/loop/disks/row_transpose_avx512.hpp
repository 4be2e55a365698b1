/// Rows to columns and back with AVX-512: a row is one register, eight pairs (16 in single precision) are transposed at once.
#pragma once
#include "engines/loop/lanes_avx512.hpp"
#include "engines/loop/disks/row_at.hpp"

namespace graindrive::loop {
namespace {

constexpr Processor compiled_for = Processor::avx512;
/// Positions and velocities of the second row minus the first; the other columns are sums. One row, one register.
struct RowDifference {
	const DiskRow* rows;
	__m512d signs = _mm512_setr_pd(-1, -1, -1, -1, 1, 1, 1, 1), length, inverse_length, image;

	explicit RowDifference(const DiskStep& data)
		: rows(data.rows),
		  length(_mm512_setr_pd(data.length[0], data.length[1], 0, 0, 0, 0, 0, 0)),
		  inverse_length(_mm512_setr_pd(data.inverse_length[0], data.inverse_length[1], 0, 0, 0, 0, 0, 0)),
		  image(_mm512_setr_pd(data.image[0], data.image[1], data.image[2], data.image[3], 0, 0, 0, 0))
	{
	}

	template <bool Wrapped>
	__m512d operator()(PairLink link) const
	{
		__m512d d = _mm512_fmadd_pd(_mm512_load_pd(row_at(rows, link.first)), signs, _mm512_load_pd(row_at(rows, link.second)));
		if constexpr (!Wrapped) return d;
		d = _mm512_fnmadd_pd(_mm512_permutex_pd(periods_of(d), 0x55), image, d);  // those in y displace along x
		return _mm512_fnmadd_pd(length, periods_of(d), d);
	}

private:
	__m512d periods_of(__m512d d) const { return _mm512_roundscale_pd(_mm512_mul_pd(d, inverse_length), 0); }
};

template <class P>
struct Transposer;

template <>
struct Transposer<double> {
	using Number = Pack<double, 8>;

	template <bool Wrapped>
	static void columns(const RowDifference& difference, const PairLink* links, Number out[6])
	{
		__m512d even[4], odd[4];  // the fourth is not used, and not computed
		transpose_lanes(difference.operator()<Wrapped>(links[0]), difference.operator()<Wrapped>(links[2]),
			difference.operator()<Wrapped>(links[4]), difference.operator()<Wrapped>(links[6]), even);
		transpose_lanes(difference.operator()<Wrapped>(links[1]), difference.operator()<Wrapped>(links[3]),
			difference.operator()<Wrapped>(links[5]), difference.operator()<Wrapped>(links[7]), odd);
		for (int q = 0; q < 3; ++q) {
			out[2 * q].v = (Number::Vector)_mm512_unpacklo_pd(even[q], odd[q]);
			out[2 * q + 1].v = (Number::Vector)_mm512_unpackhi_pd(even[q], odd[q]);
		}
	}

	static void store(const Number& x, const Number& y, const Number& friction, const Number& normal, PairForce<double>* to)
	{
		const __m512d a = (__m512d)x.v, b = (__m512d)y.v, c = (__m512d)friction.v, d = (__m512d)normal.v;
		__m512d rows[4];
		transpose_lanes(
			_mm512_unpacklo_pd(a, b), _mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d), rows);
		for (int q = 0; q < 4; ++q) _mm512_store_pd(reinterpret_cast<double*>(to + 2 * q), rows[q]);
	}
};

template <>
struct Transposer<float> {
	using Number = Pack<float, 16>;

	template <bool Wrapped>
	static void columns(const RowDifference& difference, const PairLink* links, Number out[6])
	{
		__m512 a[4], b[4];
		for (int k = 0; k < 4; ++k) {
			const auto two = [&](int first, int second) {
				return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(difference.operator()<Wrapped>(links[first]))),
					_mm512_cvtpd_ps(difference.operator()<Wrapped>(links[second])), 1);
			};
			const __m512 low = two(k, 4 + k), high = two(8 + k, 12 + k);
			a[k] = _mm512_shuffle_f32x4(low, high, 0x88);
			b[k] = _mm512_shuffle_f32x4(low, high, 0xdd);
		}
		__m512d first[4], last[4];
		transpose_in_lanes(a, first);
		transpose_in_lanes(b, last);
		for (int q = 0; q < 4; ++q) out[q].v = (typename Number::Vector)first[q];
		for (int q = 0; q < 2; ++q) out[4 + q].v = (typename Number::Vector)last[q];
	}

	static void store(const Number& x, const Number& y, const Number& friction, const Number& normal, PairForce<float>* to)
	{
		const __m512 columns[4] = { (__m512)x.v, (__m512)y.v, (__m512)friction.v, (__m512)normal.v };
		__m512d rows[4], whole[4];
		transpose_in_lanes(columns, rows);
		transpose_lanes(rows[0], rows[1], rows[2], rows[3], whole);
		for (int q = 0; q < 4; ++q) _mm512_store_pd(reinterpret_cast<double*>(to + 4 * q), whole[q]);
	}
};

}  // namespace
}  // namespace graindrive::loop
