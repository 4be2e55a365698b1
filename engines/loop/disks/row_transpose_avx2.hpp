/// Rows to columns and back with AVX2: half a row is one register, four pairs (eight in single precision) are transposed at once.
#pragma once
#include "engines/loop/lanes_avx2.hpp"
#include "engines/loop/disks/row_at.hpp"

namespace graindrive::loop {
namespace {

constexpr Processor compiled_for = Processor::avx2;

/// Positions and velocities of the second row minus the first, and sums of radius and surface speed.
struct RowDifference {
	const DiskRow* rows;
	__m256d length, inverse_length, image;

	explicit RowDifference(const DiskStep& data)
		: rows(data.rows),
		  length(_mm256_setr_pd(data.length[0], data.length[1], 0, 0)),
		  inverse_length(_mm256_setr_pd(data.inverse_length[0], data.inverse_length[1], 0, 0)),
		  image(_mm256_loadu_pd(data.image))
	{
	}

	/// x, y, v_x, v_y
	template <bool Wrapped>
	__m256d operator()(PairLink link) const
	{
		__m256d d = _mm256_sub_pd(_mm256_load_pd(row_at(rows, link.second)), _mm256_load_pd(row_at(rows, link.first)));
		if constexpr (!Wrapped) return d;
		d = _mm256_fnmadd_pd(_mm256_permute4x64_pd(periods_of(d), 0x55), image, d);  // those in y displace along x
		return _mm256_fnmadd_pd(length, periods_of(d), d);
	}

	/// Radius and surface speed of one pair, then of another.
	__m256d sums(PairLink one, PairLink other) const
	{
		return _mm256_add_pd(second_halves(one.second, other.second), second_halves(one.first, other.first));
	}

private:
	__m256d periods_of(__m256d d) const
	{
		constexpr int to_nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
		return _mm256_round_pd(_mm256_mul_pd(d, inverse_length), to_nearest);
	}
	__m256d second_halves(std::uint32_t one, std::uint32_t other) const
	{
		return _mm256_insertf128_pd(
			_mm256_castpd128_pd256(_mm_load_pd(row_at(rows, one) + 4)), _mm_load_pd(row_at(rows, other) + 4), 1);
	}
};

template <class P>
struct Transposer;

template <>
struct Transposer<double> {
	using Number = Pack<double, 4>;

	template <bool Wrapped>
	static void columns(const RowDifference& difference, const PairLink* links, Number out[6])
	{
		__m256d row[4];
		for (int k = 0; k < 4; ++k) row[k] = difference.operator()<Wrapped>(links[k]);
		transpose_four(row, [&](int q, __m256d column) { out[q].v = (Number::Vector)column; });
		const __m256d even = difference.sums(links[0], links[2]), odd = difference.sums(links[1], links[3]);
		out[4].v = (Number::Vector)_mm256_unpacklo_pd(even, odd);
		out[5].v = (Number::Vector)_mm256_unpackhi_pd(even, odd);
	}

	static void store(const Number& x, const Number& y, const Number& friction, const Number& normal, PairForce<double>* to)
	{
		const __m256d columns[4] = { (__m256d)x.v, (__m256d)y.v, (__m256d)friction.v, (__m256d)normal.v };
		transpose_four(columns, [&](int pair, __m256d row) { _mm256_store_pd(reinterpret_cast<double*>(to + pair), row); });
	}
};

template <>
struct Transposer<float> {
	using Number = Pack<float, 8>;

	template <bool Wrapped>
	static void columns(const RowDifference& difference, const PairLink* links, Number out[6])
	{
		const auto joined = [](__m256d low, __m256d high) {
			return _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
		};
		__m256 row[4], column[4];
		for (int k = 0; k < 4; ++k)
			row[k] = joined(difference.operator()<Wrapped>(links[k]), difference.operator()<Wrapped>(links[4 + k]));
		transpose_in_lanes(row, column);
		for (int q = 0; q < 4; ++q) out[q].v = (Number::Vector)column[q];
		const __m256 low = joined(difference.sums(links[0], links[1]), difference.sums(links[4], links[5]));
		const __m256 high = joined(difference.sums(links[2], links[3]), difference.sums(links[6], links[7]));
		out[4].v = (Number::Vector)_mm256_shuffle_ps(low, high, 0x88);
		out[5].v = (Number::Vector)_mm256_shuffle_ps(low, high, 0xdd);
	}

	static void store(const Number& x, const Number& y, const Number& friction, const Number& normal, PairForce<float>* to)
	{
		const __m256 columns[4] = { (__m256)x.v, (__m256)y.v, (__m256)friction.v, (__m256)normal.v };
		__m256 row[4];
		transpose_in_lanes(columns, row);
		for (int k = 0; k < 4; k += 2) {  // two neighbours make one register
			_mm256_store_ps(reinterpret_cast<float*>(to + k), _mm256_permute2f128_ps(row[k], row[k + 1], 0x20));
			_mm256_store_ps(reinterpret_cast<float*>(to + 4 + k), _mm256_permute2f128_ps(row[k], row[k + 1], 0x31));
		}
	}
};

}  // namespace
}  // namespace graindrive::loop
