/// `select`, `clamped` and `truncated`: the choices that the contact laws make, for plain numbers, SIMD packs and vectors.
///
/// A SIMD pack joins in by overloading `select(mask, a, b)`, `sqrt` and `abs` in its own namespace (found by ADL).
#pragma once
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive {

inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
inline float select(bool condition, float yes, float no) { return condition ? yes : no; }
inline Vector3r select(bool condition, const Vector3r& yes, const Vector3r& no) { return condition ? yes : no; }

/// A tangential vector cut to length `limit` >= 0, with the mask that says where it was cut.
template <class T, class Mask>
struct Truncated {
	T value;
	Mask cut;
};

/// In two dimensions the tangential "vector" is a signed number: cutting needs no division and no square root.
template <class S>
auto truncated(const S& trial, const S& limit)
{
	using std::abs;
	const auto cut = abs(trial) > limit;
	const S signed_limit = select(trial < S(0), S(-limit), limit);
	return Truncated<S, std::decay_t<decltype(cut)>>{ select(cut, signed_limit, trial), cut };
}

inline Truncated<Vector3r, bool> truncated(const Vector3r& trial, const Real& limit)
{
	const Real length = trial.norm();
	if (length > limit) return { trial * (limit / length), true };
	return { trial, false };
}

}  // namespace graindrive
