/// Exact integrals of averaging kernels along a straight line, as the contact stress needs them: per unit of the line's parameter s.
///
/// x(s) = from + s branch, s in [0, 1]. Seen from a point, a line is its distance h from the point and the stretch [begin, end] that it
/// covers along itself, counted from the foot of the perpendicular; both in two and in three dimensions.
#pragma once
#include <algorithm>
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive {

/// The stretch of a line inside a sphere (a disk) about a point.
struct Stretch {
	Real square_distance;  ///< h^2 [m^2]
	Real begin, end;       ///< along the line from the foot [m]; empty where end <= begin
	Real length;           ///< of the whole line [m]

	bool empty() const { return !(begin < end); }
};

/// @param branch  not zero
template <class Vector>
Stretch stretch_in_sphere(const Vector& from, const Vector& branch, const Vector& point, Real radius)
{
	const Vector to_point = point - from;
	const Real square_length = branch.squaredNorm(), length = std::sqrt(square_length);
	const Real foot = to_point.dot(branch) / length;
	const Real square_distance = (to_point - branch * (foot / length)).squaredNorm();
	const Real half_chord = std::sqrt(std::max(radius * radius - square_distance, Real(0)));
	return { square_distance, std::max(-foot, -half_chord), std::min(length - foot, half_chord), length };
}

/// Fraction of the line inside a sphere about a point: Guillard et al. 2014, W of Eq. (A3).
template <class Vector>
Real fraction_in_sphere(const Vector& from, const Vector& branch, const Vector& point, Real radius)
{
	const Stretch s = stretch_in_sphere(from, branch, point, radius);
	return s.empty() ? 0 : (s.end - s.begin) / s.length;
}

/// int_0^1 exp(-|x(s) - point|^2/w^2) ds, the Gaussian cut off at a radius: Tripura et al., Eqs (3.3), (3.5) without 1/(pi w^2).
///
/// = exp(-h^2/w^2) w sqrt(pi)/(2 L) [erf(end/w) - erf(begin/w)]; the cut only shortens the stretch, so it costs no accuracy.
template <class Vector>
Real gaussian_along_line(const Vector& from, const Vector& branch, const Vector& point, Real width, Real cutoff_radius)
{
	const Stretch s = stretch_in_sphere(from, branch, point, cutoff_radius);
	if (s.empty()) return 0;
	const Real across = std::exp(-s.square_distance / (width * width));
	return across * width * std::sqrt(pi) / (2 * s.length) * (std::erf(s.end / width) - std::erf(s.begin / width));
}

/// Fraction of the line inside the box from `low` to `high` (Liang and Barsky, ACM Trans. Graph. 3, 1 (1984)).
template <class Vector>
Real fraction_in_box(const Vector& from, const Vector& branch, const Vector& low, const Vector& high)
{
	Real begin = 0, end = 1;
	for (int k = 0; k < int(from.size()); ++k) {
		if (branch[k] == 0) {
			if (from[k] < low[k] || from[k] >= high[k]) return 0;  // half open: a line along an edge counts once
			continue;
		}
		const Real one = (low[k] - from[k]) / branch[k], other = (high[k] - from[k]) / branch[k];
		begin = std::max(begin, std::min(one, other));
		end = std::min(end, std::max(one, other));
	}
	return std::max(end - begin, Real(0));
}

}  // namespace graindrive
