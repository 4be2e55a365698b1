/// Rows to columns and back with AVX2: a group of four doubles is one register, four pairs (eight in single precision) at once.
#pragma once
#include "engines/loop/lanes_avx2.hpp"
#include "engines/loop/simd_pack.hpp"
#include "engines/loop/spheres/sphere_kernel.hpp"

namespace graindrive::loop {
namespace {

constexpr Processor compiled_for = Processor::avx2;

template <class Row>
inline const double* group_of(const Row* rows, std::uint32_t offset, int group)
{
	return reinterpret_cast<const double*>(reinterpret_cast<const char*>(rows) + offset) + 4 * group;
}

/// Sums and differences of two rows, group by group, by the layout's signs.
template <class Row>
struct LayoutDifference {
	using Layout = RowLayout<Row>;
	const Row* rows;
	__m256d signs[Layout::groups], length = _mm256_setzero_pd(), inverse_length = _mm256_setzero_pd();

	LayoutDifference(const Row* first, const double* lengths, const double* inverse_lengths) : rows(first)
	{
		for (int c = 0; c < 4 * Layout::groups; ++c) signs[c / 4][c % 4] = Layout::sign[c];
		for (int axis = 0; axis < Layout::axes; ++axis)
			length[axis] = lengths[axis], inverse_length[axis] = inverse_lengths[axis];
	}

	template <bool Wrapped>
	__m256d operator()(PairLink link, int group) const
	{
		const __m256d d = _mm256_fmadd_pd(
			_mm256_load_pd(group_of(rows, link.first, group)), signs[group], _mm256_load_pd(group_of(rows, link.second, group)));
		if (!Wrapped || group > 0) return d;
		constexpr int to_nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
		return _mm256_fnmadd_pd(length, _mm256_round_pd(_mm256_mul_pd(d, inverse_length), to_nearest), d);
	}
};

template <class Row, class P>
struct LayoutTransposer;

/// The two halves of a line.
struct HalfLines {
	__m256d first, last;
};

/// Columns that nobody uses are not computed: the compiler drops them.
template <class Row>
struct LayoutTransposer<Row, double> {
	using Number = Pack<double, 4>;
	static constexpr int columns_written = 4 * RowLayout<Row>::groups;

	template <bool Wrapped>
	static inline void columns(const LayoutDifference<Row>& difference, const PairLink* links, Number* out)
	{
		for (int group = 0; group < RowLayout<Row>::groups; ++group) {
			__m256d row[4];
			for (int k = 0; k < 4; ++k) row[k] = difference.template operator()<Wrapped>(links[k], group);
			transpose_four(row, [&](int q, __m256d column) { out[4 * group + q].v = (typename Number::Vector)column; });
		}
	}

	/// Calls put(k, line) with the numbers 0, 0, column[0] ... column[5] of pair k, in the order of pairs.
	template <class Put>
	static inline void lines(const Number column[6], const Put& put)
	{
		const __m256d zero = _mm256_setzero_pd();
		const __m256d first[4] = { zero, zero, (__m256d)column[0].v, (__m256d)column[1].v };
		const __m256d last[4] = { (__m256d)column[2].v, (__m256d)column[3].v, (__m256d)column[4].v, (__m256d)column[5].v };
		HalfLines line[4];
		transpose_four(first, [&](int k, __m256d half) { line[k].first = half; });
		transpose_four(last, [&](int k, __m256d half) { line[k].last = half; });
		for (int k = 0; k < 4; ++k) put(k, line[k]);
	}
};

template <class Row>
struct LayoutTransposer<Row, float> {
	using Number = Pack<float, 8>;
	static constexpr int columns_written = 4 * RowLayout<Row>::groups;

	template <bool Wrapped>
	static inline void columns(const LayoutDifference<Row>& difference, const PairLink* links, Number* out)
	{
		for (int group = 0; group < RowLayout<Row>::groups; ++group) {
			const auto d = [&](int k) { return _mm256_cvtpd_ps(difference.template operator()<Wrapped>(links[k], group)); };
			__m256 row[4], column[4];
			for (int k = 0; k < 4; ++k) row[k] = _mm256_set_m128(d(4 + k), d(k));
			transpose_in_lanes(row, column);
			for (int q = 0; q < 4; ++q) out[4 * group + q].v = (typename Number::Vector)column[q];
		}
	}

	template <class Put>
	static inline void lines(const Number column[6], const Put& put)
	{
		const __m256 zero = _mm256_setzero_ps();
		const __m256 first[4] = { zero, zero, (__m256)column[0].v, (__m256)column[1].v };
		const __m256 last[4] = { (__m256)column[2].v, (__m256)column[3].v, (__m256)column[4].v, (__m256)column[5].v };
		__m256 a[4], b[4];
		transpose_in_lanes(first, a);
		transpose_in_lanes(last, b);
		for (int pair = 0; pair < 8; ++pair) {
			const auto half = [&](__m256 both) {
				return _mm256_cvtps_pd(pair < 4 ? _mm256_castps256_ps128(both) : _mm256_extractf128_ps(both, 1));
			};
			put(pair, HalfLines{ half(a[pair % 4]), half(b[pair % 4]) });
		}
	}
};

/// Adds a pair's line to the second lines of both rows; the partner's force has the other sign.
struct LineAdder {
	SphereRow* rows;
	__m256d first_sign = _mm256_setr_pd(1, 1, -1, -1), last_sign = _mm256_setr_pd(-1, 1, 1, 1);

	explicit LineAdder(SphereRow* first) : rows(first) {}

	double* at(std::uint32_t offset) const { return const_cast<double*>(group_of(rows, offset, 2)); }
	void to_owner(std::uint32_t offset, const HalfLines& line) const
	{
		double* to = at(offset);
		_mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), line.first));
		_mm256_store_pd(to + 4, _mm256_add_pd(_mm256_load_pd(to + 4), line.last));
	}
	void to_partner(std::uint32_t offset, const HalfLines& line) const
	{
		double* to = at(offset);
		_mm256_store_pd(to, _mm256_fmadd_pd(line.first, first_sign, _mm256_load_pd(to)));
		_mm256_store_pd(to + 4, _mm256_fmadd_pd(line.last, last_sign, _mm256_load_pd(to + 4)));
	}
	static HalfLines load(const ForceLine& line) { return { _mm256_load_pd(line.number), _mm256_load_pd(line.number + 4) }; }
	static void store(ForceLine& to, const HalfLines& line)
	{
		_mm256_store_pd(to.number, line.first);
		_mm256_store_pd(to.number + 4, line.last);
	}
};

}  // namespace
}  // namespace graindrive::loop
