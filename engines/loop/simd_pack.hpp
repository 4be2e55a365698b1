/// `Pack`: a few numbers that the processor treats at once, with the operators and choices that the contact laws ask for.
///
/// Built on the compiler's vector extensions, so the same source serves AVX-512, AVX2 and portable builds; only the square root and the
/// transpositions need the processor's own instructions. A kernel picks its width from the instructions it is compiled for.
#pragma once
#include <cmath>
#include <cstring>
#include <type_traits>

#include "engines/base/branchless.hpp"

#if defined(__AVX2__) || defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace graindrive::loop {

template <class T, int W>
struct VectorOf {
	typedef T type __attribute__((vector_size(W * sizeof(T))));
};

// What has no operator: the processor's own instruction where there is one, else number by number.
template <class T, int W>
typename VectorOf<T, W>::type square_root(typename VectorOf<T, W>::type a)
{
	using Vector [[maybe_unused]] = typename VectorOf<T, W>::type;
#ifdef __AVX512F__
	if constexpr (std::is_same_v<T, double> && W == 8) return (Vector)_mm512_sqrt_pd((__m512d)a);
	if constexpr (std::is_same_v<T, float> && W == 16) return (Vector)_mm512_sqrt_ps((__m512)a);
#endif
#ifdef __AVX2__
	if constexpr (std::is_same_v<T, double> && W == 4) return (Vector)_mm256_sqrt_pd((__m256d)a);
	if constexpr (std::is_same_v<T, float> && W == 8) return (Vector)_mm256_sqrt_ps((__m256)a);
#endif
	for (int lane = 0; lane < W; ++lane) a[lane] = std::sqrt(a[lane]);
	return a;
}

template <class T, int W>
typename VectorOf<T, W>::type greater(typename VectorOf<T, W>::type a, typename VectorOf<T, W>::type b)
{
	using Vector [[maybe_unused]] = typename VectorOf<T, W>::type;
#ifdef __AVX512F__
	if constexpr (std::is_same_v<T, double> && W == 8) return (Vector)_mm512_max_pd((__m512d)a, (__m512d)b);
	if constexpr (std::is_same_v<T, float> && W == 16) return (Vector)_mm512_max_ps((__m512)a, (__m512)b);
#endif
#ifdef __AVX2__
	if constexpr (std::is_same_v<T, double> && W == 4) return (Vector)_mm256_max_pd((__m256d)a, (__m256d)b);
	if constexpr (std::is_same_v<T, float> && W == 8) return (Vector)_mm256_max_ps((__m256)a, (__m256)b);
#endif
	return a > b ? a : b;
}

template <class T, int W>
typename VectorOf<T, W>::type lesser(typename VectorOf<T, W>::type a, typename VectorOf<T, W>::type b)
{
	using Vector [[maybe_unused]] = typename VectorOf<T, W>::type;
#ifdef __AVX512F__
	if constexpr (std::is_same_v<T, double> && W == 8) return (Vector)_mm512_min_pd((__m512d)a, (__m512d)b);
	if constexpr (std::is_same_v<T, float> && W == 16) return (Vector)_mm512_min_ps((__m512)a, (__m512)b);
#endif
#ifdef __AVX2__
	if constexpr (std::is_same_v<T, double> && W == 4) return (Vector)_mm256_min_pd((__m256d)a, (__m256d)b);
	if constexpr (std::is_same_v<T, float> && W == 8) return (Vector)_mm256_min_ps((__m256)a, (__m256)b);
#endif
	return a < b ? a : b;
}

template <class T, int W, int N>
struct PackMask;

/// N vectors of W numbers side by side: N = 2 gives the processor two independent chains of operations to overlap.
template <class T, int W, int N>
struct Pack {
	using Vector = typename VectorOf<T, W>::type;
	using Mask = PackMask<T, W, N>;
	static constexpr int lanes = W, parts = N, width = W * N;

	Vector v[N];

	Pack() = default;
	Pack(T number)
	{
		for (int n = 0; n < N; ++n) v[n] = number - Vector{};
	}

	static Pack load(const T* from)
	{
		Pack loaded;
		for (int n = 0; n < N; ++n) std::memcpy(&loaded.v[n], from + n * W, sizeof(Vector));
		return loaded;
	}
	void store(T* to) const
	{
		for (int n = 0; n < N; ++n) std::memcpy(to + n * W, &v[n], sizeof(Vector));
	}

	template <class Operation>
	static Pack each(const Operation& of_part)
	{
		Pack result;
		for (int n = 0; n < N; ++n) result.v[n] = of_part(n);
		return result;
	}

	friend Pack operator+(const Pack& a, const Pack& b)
	{
		return each([&](int n) { return a.v[n] + b.v[n]; });
	}
	friend Pack operator-(const Pack& a, const Pack& b)
	{
		return each([&](int n) { return a.v[n] - b.v[n]; });
	}
	friend Pack operator*(const Pack& a, const Pack& b)
	{
		return each([&](int n) { return a.v[n] * b.v[n]; });
	}
	friend Pack operator/(const Pack& a, const Pack& b)
	{
		return each([&](int n) { return a.v[n] / b.v[n]; });
	}
	friend Pack operator-(const Pack& a)
	{
		return each([&](int n) { return -a.v[n]; });
	}
	friend Mask operator<(const Pack& a, const Pack& b)
	{
		return Mask::each([&](int n) { return a.v[n] < b.v[n]; });
	}
	friend Mask operator>(const Pack& a, const Pack& b)
	{
		return Mask::each([&](int n) { return a.v[n] > b.v[n]; });
	}
};

template <class T, int W, int N>
struct PackMask {
	using Vector = typename VectorOf<T, W>::type;
	decltype(Vector{} < Vector{}) m[N];

	template <class Comparison>
	static PackMask each(const Comparison& of_part)
	{
		PackMask result;
		for (int n = 0; n < N; ++n) result.m[n] = of_part(n);
		return result;
	}
};

/// True if it holds for any number of the pack.
template <class T, int W, int N>
bool any(const PackMask<T, W, N>& mask)
{
	auto joined = mask.m[0];
	for (int n = 1; n < N; ++n) joined |= mask.m[n];
#ifdef __AVX512F__
	if constexpr (W * sizeof(T) == 64) return _mm512_test_epi64_mask((__m512i)joined, (__m512i)joined) != 0;
#endif
#ifdef __AVX2__
	if constexpr (W * sizeof(T) == 32) return !_mm256_testz_si256((__m256i)joined, (__m256i)joined);
#endif
	for (int lane = 0; lane < W; ++lane)
		if (joined[lane]) return true;
	return false;
}

template <class T, int W, int N>
Pack<T, W, N> select(const PackMask<T, W, N>& where, const Pack<T, W, N>& yes, const Pack<T, W, N>& no)
{
	return Pack<T, W, N>::each([&](int n) { return where.m[n] ? yes.v[n] : no.v[n]; });
}

// min and max as the processor has them: the second operand where either is not a number.
template <class T, int W, int N>
Pack<T, W, N> max(const Pack<T, W, N>& a, const Pack<T, W, N>& b)
{
	return Pack<T, W, N>::each([&](int n) { return greater<T, W>(a.v[n], b.v[n]); });
}

template <class T, int W, int N>
Pack<T, W, N> min(const Pack<T, W, N>& a, const Pack<T, W, N>& b)
{
	return Pack<T, W, N>::each([&](int n) { return lesser<T, W>(a.v[n], b.v[n]); });
}

/// |a|, by clearing the sign bit.
template <class T, int W, int N>
Pack<T, W, N> abs(const Pack<T, W, N>& a)
{
	using Bits = typename VectorOf<std::conditional_t<sizeof(T) == 8, long long, int>, W>::type;
	const Bits all_but_sign = (sizeof(T) == 8 ? 0x7fffffffffffffffLL : 0x7fffffffLL) - Bits{};
	return Pack<T, W, N>::each([&](int n) { return (typename VectorOf<T, W>::type)((Bits)a.v[n] & all_but_sign); });
}

/// The contact laws' cut, as a clamp: two operations instead of five.
template <class T, int W, int N>
Truncated<Pack<T, W, N>, PackMask<T, W, N>> truncated(const Pack<T, W, N>& trial, const Pack<T, W, N>& limit)
{
	return { max(min(trial, limit), -limit), abs(trial) > limit };
}

template <class T, int W, int N>
Pack<T, W, N> sqrt(const Pack<T, W, N>& a)
{
	return Pack<T, W, N>::each([&](int n) { return square_root<T, W>(a.v[n]); });
}

}  // namespace graindrive::loop
