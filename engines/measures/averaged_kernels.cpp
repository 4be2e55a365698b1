/// Kernels of spheres integrated over a whole axis, in closed form.
#include "engines/measures/averaged_kernels.hpp"

#include <boost/math/special_functions/owens_t.hpp>

#include "engines/measures/ball_overlap.hpp"
#include "engines/measures/line_integrals.hpp"

namespace graindrive {

namespace {

/// int dy of t^3, t, 1 and 1/t from `y_0` to `y_1`, t = sqrt(rho^2 + y^2).
struct Powers {
	Real cube, one, none, inverse;
};

Powers powers_between(Real y_0, Real y_1, Real square_rho)
{
	const Real t_0 = std::sqrt(square_rho + y_0 * y_0), t_1 = std::sqrt(square_rho + y_1 * y_1);
	// From t = 0 on the logarithm is infinite, but every factor that it has is zero.
	const Real logarithm = t_0 > 0 ? std::log((y_1 + t_1) / (y_0 + t_0)) : 0;
	const Real one = (y_1 * t_1 - y_0 * t_0 + square_rho * logarithm) / 2;
	const Real cube = (y_1 * t_1 * t_1 * t_1 - y_0 * t_0 * t_0 * t_0 + 3 * square_rho * one) / 4;
	return { cube, one, y_1 - y_0, logarithm };
}

/// int_0^u du int_0^sqrt(a^2 - u^2) dv exp(-u^2 - v^2), odd in u, |u| <= a: a triangle of angle alpha and a sector.
Real gaussian_in_half_strip(Real u, Real a)
{
	if (u == 0) return 0;
	using boost::math::policies::policy;
	using boost::math::policies::promote_double;
	const Real side = std::abs(u), height = std::sqrt(std::max((a - side) * (a + side), Real(0))),
			   alpha = std::atan2(height, side);
	const Real owen = boost::math::owens_t(side * std::sqrt(Real(2)), height / side, policy<promote_double<false>>());
	const Real sector = (pi / 2 - alpha) / 2 * -std::expm1(-a * a);
	return std::copysign(alpha / 2 - pi * owen + sector, u);
}

/// The projection of a line almost along the axis is very short, and a difference of integrals over it would be round-off.
bool is_a_point(const Vector3r& shadow, Real scale) { return shadow.squaredNorm() < 1e-14 * scale * scale; }

Real square_distance(const Vector3r& from, const Vector3r& branch, const Vector3r& point)
{
	return (from + branch / 2 - point).squaredNorm();
}

/// 2 sqrt(R^2 - rho^2), 0 outside.
Real chord_along_axis(Real square_rho, Real radius) { return 2 * std::sqrt(std::max(radius * radius - square_rho, Real(0))); }

}  // namespace

Real sphere_overlap_along_axis(Real r, Real big_r, Real rho)
{
	const Real sum = r + big_r, difference = std::abs(big_r - r);
	if (rho >= sum) return 0;
	const Real ss = sum * sum, dd = difference * difference, square_rho = rho * rho;
	const Real inside = std::sqrt(std::max((difference - rho) * (difference + rho), Real(0)));
	const Powers p = powers_between(inside, std::sqrt((sum - rho) * (sum + rho)), square_rho);
	const Real lens = p.cube - 3 * (dd + ss) * p.one + 2 * sum * (3 * dd + ss) * p.none - 3 * dd * ss * p.inverse;
	return std::max(2 * (ball_volume<3>(std::min(r, big_r)) * inside + pi / 12 * lens), Real(0));
}

Real gaussian_along_axis(Real square_rho, Real width, Real cutoff)
{
	const Real q = square_rho / (width * width), rest = cutoff * cutoff - q;
	return rest > 0 ? std::sqrt(pi) * width * std::exp(-q) * std::erf(std::sqrt(rest)) : 0;
}

Real mean_chord_along_axis(const Vector3r& from, const Vector3r& branch, const Vector3r& point, Real radius)
{
	if (is_a_point(branch, radius)) return chord_along_axis(square_distance(from, branch, point), radius);
	const Stretch s = stretch_in_sphere(from, branch, point, radius);
	if (s.empty()) return 0;
	const Real square = radius * radius - s.square_distance;
	const auto area = [&](Real u) {
		const Real half_chord = std::sqrt(std::max(square - u * u, Real(0)));
		return u * half_chord + square * std::atan2(u, half_chord);
	};
	return (area(s.end) - area(s.begin)) / s.length;
}

Real mean_gaussian_along_axis(const Vector3r& from, const Vector3r& branch, const Vector3r& point, Real width, Real cutoff)
{
	if (is_a_point(branch, width)) return gaussian_along_axis(square_distance(from, branch, point), width, cutoff);
	const Stretch s = stretch_in_sphere(from, branch, point, cutoff * width);
	if (s.empty()) return 0;
	const Real q = s.square_distance / (width * width), a = std::sqrt(std::max(cutoff * cutoff - q, Real(0)));
	const auto half_strip = [&](Real u) { return gaussian_in_half_strip(std::clamp(u / width, -a, a), a); };
	return 2 * width * width * std::exp(-q) * (half_strip(s.end) - half_strip(s.begin)) / s.length;
}

}  // namespace graindrive
