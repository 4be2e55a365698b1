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

template <class T, int W>
struct PackMask {
	using Vector = typename VectorOf<T, W>::type;
	decltype(Vector{} < Vector{}) m;
};

template <class T, int W>
struct Pack {
	using Vector = typename VectorOf<T, W>::type;
	using Mask = PackMask<T, W>;
	static constexpr int width = W;

	Vector v;

	Pack() = default;
	Pack(T number) : v(number - Vector{}) {}

	static Pack of(Vector vector)
	{
		Pack pack;
		pack.v = vector;
		return pack;
	}
	static Pack load(const T* from)
	{
		Pack loaded;
		std::memcpy(&loaded.v, from, sizeof(Vector));
		return loaded;
	}
	void store(T* to) const { std::memcpy(to, &v, sizeof(Vector)); }

	friend Pack operator+(const Pack& a, const Pack& b) { return of(a.v + b.v); }
	friend Pack operator-(const Pack& a, const Pack& b) { return of(a.v - b.v); }
	friend Pack operator*(const Pack& a, const Pack& b) { return of(a.v * b.v); }
	friend Pack operator/(const Pack& a, const Pack& b) { return of(a.v / b.v); }
	friend Pack operator-(const Pack& a) { return of(-a.v); }
	friend Mask operator<(const Pack& a, const Pack& b) { return { a.v < b.v }; }
	friend Mask operator>(const Pack& a, const Pack& b) { return { a.v > b.v }; }
};

/// True if it holds for any number of the pack.
template <class T, int W>
bool any(const PackMask<T, W>& mask)
{
#ifdef __AVX512F__
	if constexpr (W * sizeof(T) == 64) return _mm512_test_epi64_mask((__m512i)mask.m, (__m512i)mask.m) != 0;
#endif
#ifdef __AVX2__
	if constexpr (W * sizeof(T) == 32) return !_mm256_testz_si256((__m256i)mask.m, (__m256i)mask.m);
#endif
	for (int lane = 0; lane < W; ++lane)
		if (mask.m[lane]) return true;
	return false;
}

template <class T, int W>
Pack<T, W> select(const PackMask<T, W>& where, const Pack<T, W>& yes, const Pack<T, W>& no)
{
	return Pack<T, W>::of(where.m ? yes.v : no.v);
}

// min and max as the processor has them: the second operand where either is not a number.
template <class T, int W>
Pack<T, W> max(const Pack<T, W>& a, const Pack<T, W>& b)
{
	return Pack<T, W>::of(greater<T, W>(a.v, b.v));
}

template <class T, int W>
Pack<T, W> min(const Pack<T, W>& a, const Pack<T, W>& b)
{
	return Pack<T, W>::of(lesser<T, W>(a.v, b.v));
}

/// |a|, by clearing the sign bit.
template <class T, int W>
Pack<T, W> abs(const Pack<T, W>& a)
{
	using Bits = typename VectorOf<std::conditional_t<sizeof(T) == 8, long long, int>, W>::type;
	const Bits all_but_sign = (sizeof(T) == 8 ? 0x7fffffffffffffffLL : 0x7fffffffLL) - Bits{};
	return Pack<T, W>::of((typename VectorOf<T, W>::type)((Bits)a.v & all_but_sign));
}

/// The contact laws' cut, as a clamp: two operations instead of five.
template <class T, int W>
Truncated<Pack<T, W>, PackMask<T, W>> truncated(const Pack<T, W>& trial, const Pack<T, W>& limit)
{
	return { max(min(trial, limit), -limit), abs(trial) > limit };
}

template <class T, int W>
Pack<T, W> sqrt(const Pack<T, W>& a)
{
	return Pack<T, W>::of(square_root<T, W>(a.v));
}

}  // namespace graindrive::loop
