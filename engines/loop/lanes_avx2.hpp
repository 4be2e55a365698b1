/// Transpositions of rows of four numbers in 256-bit registers.
#pragma once
#include <immintrin.h>

namespace graindrive::loop {
namespace {

/// Four columns from four rows, or back: put(k, column k).
template <class Put>
inline void transpose_four(const __m256d in[4], const Put& put)
{
	const __m256d low_01 = _mm256_unpacklo_pd(in[0], in[1]), high_01 = _mm256_unpackhi_pd(in[0], in[1]);
	const __m256d low_23 = _mm256_unpacklo_pd(in[2], in[3]), high_23 = _mm256_unpackhi_pd(in[2], in[3]);
	put(0, _mm256_permute2f128_pd(low_01, low_23, 0x20));
	put(1, _mm256_permute2f128_pd(high_01, high_23, 0x20));
	put(2, _mm256_permute2f128_pd(low_01, low_23, 0x31));
	put(3, _mm256_permute2f128_pd(high_01, high_23, 0x31));
}

/// In each lane of 128 bits: a 4 x 4 transposition of its numbers.
inline void transpose_in_lanes(const __m256 in[4], __m256 out[4])
{
	const __m256 low_01 = _mm256_unpacklo_ps(in[0], in[1]), high_01 = _mm256_unpackhi_ps(in[0], in[1]);
	const __m256 low_23 = _mm256_unpacklo_ps(in[2], in[3]), high_23 = _mm256_unpackhi_ps(in[2], in[3]);
	out[0] = _mm256_shuffle_ps(low_01, low_23, 0x44);
	out[1] = _mm256_shuffle_ps(low_01, low_23, 0xee);
	out[2] = _mm256_shuffle_ps(high_01, high_23, 0x44);
	out[3] = _mm256_shuffle_ps(high_01, high_23, 0xee);
}

}  // namespace
}  // namespace graindrive::loop
