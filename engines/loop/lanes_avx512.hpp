/// Transpositions within and of the 128-bit lanes of 512-bit registers.
#pragma once
#include <immintrin.h>

namespace graindrive::loop {
namespace {

/// out[q] = lane q of a, b, c, d: a 4 x 4 transposition of 128-bit lanes.
inline void transpose_lanes(__m512d a, __m512d b, __m512d c, __m512d d, __m512d out[4])
{
	const __m512d ab_even = _mm512_shuffle_f64x2(a, b, 0x88), ab_odd = _mm512_shuffle_f64x2(a, b, 0xdd);
	const __m512d cd_even = _mm512_shuffle_f64x2(c, d, 0x88), cd_odd = _mm512_shuffle_f64x2(c, d, 0xdd);
	out[0] = _mm512_shuffle_f64x2(ab_even, cd_even, 0x88);
	out[1] = _mm512_shuffle_f64x2(ab_odd, cd_odd, 0x88);
	out[2] = _mm512_shuffle_f64x2(ab_even, cd_even, 0xdd);
	out[3] = _mm512_shuffle_f64x2(ab_odd, cd_odd, 0xdd);
}

/// In each lane of 128 bits: a 4 x 4 transposition of its numbers.
inline void transpose_in_lanes(const __m512 in[4], __m512d out[4])
{
	const __m512d ab_low = _mm512_castps_pd(_mm512_unpacklo_ps(in[0], in[1])),
				  ab_high = _mm512_castps_pd(_mm512_unpackhi_ps(in[0], in[1]));
	const __m512d cd_low = _mm512_castps_pd(_mm512_unpacklo_ps(in[2], in[3])),
				  cd_high = _mm512_castps_pd(_mm512_unpackhi_ps(in[2], in[3]));
	out[0] = _mm512_unpacklo_pd(ab_low, cd_low);
	out[1] = _mm512_unpackhi_pd(ab_low, cd_low);
	out[2] = _mm512_unpacklo_pd(ab_high, cd_high);
	out[3] = _mm512_unpackhi_pd(ab_high, cd_high);
}

}  // namespace
}  // namespace graindrive::loop
