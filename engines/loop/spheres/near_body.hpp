/// The search's inner function: which spheres of a run of memory lie near one sphere.
#pragma once
#include "engines/loop/simd_pack.hpp"
#include "engines/loop/spheres/sphere_kernel.hpp"

namespace graindrive::loop {
namespace {

int near_in_columns(
	const SearchColumns& all, std::uint32_t a, std::uint32_t begin, std::uint32_t end, float reach, std::uint32_t* found)
{
	int n = 0;
	const float x = all.x[a], y = all.y[a], z = all.z[a];
#if defined(__AVX512F__) && defined(__AVX512VL__)
	const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
	for (; begin < end; begin += 16) {
		const __m512 dx = _mm512_sub_ps(_mm512_loadu_ps(all.x + begin), _mm512_set1_ps(x));
		const __m512 dy = _mm512_sub_ps(_mm512_loadu_ps(all.y + begin), _mm512_set1_ps(y));
		const __m512 dz = _mm512_sub_ps(_mm512_loadu_ps(all.z + begin), _mm512_set1_ps(z));
		const __m512 limit = _mm512_add_ps(_mm512_loadu_ps(all.radius + begin), _mm512_set1_ps(reach));
		const __m512 square = _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
		const __mmask16 inside = end - begin >= 16 ? 0xffff : (1u << (end - begin)) - 1;
		const __mmask16 near = _mm512_mask_cmp_ps_mask(inside, square, _mm512_mul_ps(limit, limit), _CMP_LT_OQ);
		_mm512_storeu_si512(found + n, _mm512_maskz_compress_epi32(near, _mm512_add_epi32(lanes, _mm512_set1_epi32(begin))));
		n += __builtin_popcount(near);
	}
#elif defined(__AVX2__)
	for (; begin < end; begin += 8) {
		const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(all.x + begin), _mm256_set1_ps(x));
		const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(all.y + begin), _mm256_set1_ps(y));
		const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(all.z + begin), _mm256_set1_ps(z));
		const __m256 limit = _mm256_add_ps(_mm256_loadu_ps(all.radius + begin), _mm256_set1_ps(reach));
		const __m256 square = _mm256_fmadd_ps(dz, dz, _mm256_fmadd_ps(dy, dy, _mm256_mul_ps(dx, dx)));
		unsigned near = _mm256_movemask_ps(_mm256_cmp_ps(square, _mm256_mul_ps(limit, limit), _CMP_LT_OQ));
		if (end - begin < 8) near &= (1u << (end - begin)) - 1;
		for (; near; near &= near - 1) found[n++] = begin + __builtin_ctz(near);
	}
#else
	for (std::uint32_t b = begin; b < end; ++b) {
		const float dx = all.x[b] - x, dy = all.y[b] - y, dz = all.z[b] - z, limit = all.radius[b] + reach;
		found[n] = b;
		n += dx * dx + dy * dy + dz * dz < limit * limit;
	}
#endif
	return n;
}

}  // namespace
}  // namespace graindrive::loop
