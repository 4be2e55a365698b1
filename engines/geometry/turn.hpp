/// Orientations in two and three dimensions.
#pragma once
#include "engines/geometry/vec.hpp"

namespace graindrive::geometry {

/// How a body is turned against its own frame. `Turn<D>{}` is not turned.
///
///   by(r)            turned by a rotation vector r [rad]: an angle in the plane, axis times angle in space
///   apply, undo      a vector of the body's frame seen from the world, and back
///   fixed()          the same orientation for many vectors: its apply gives the same bits and takes the sines but once
///   advanced(w, dt)  after a time dt at constant spin w, seen from the world: exact, R(t + dt) = exp(w dt) R(t)
///   a.then(b)        first a, then b about the world's axes
template <int D>
struct Turn;

/// The angle is not reduced to one turn, so that revolutions can be counted.
template <>
struct Turn<2> {
	double angle = 0;  ///< counter-clockwise [rad]

	static Turn by(double rotation) { return { rotation }; }
	Turn then(const Turn& next) const { return { angle + next.angle }; }
	Turn inverse() const { return { -angle }; }
	Turn advanced(double spin, double dt) const { return { angle + spin * dt }; }
	Turn normalised() const { return *this; }
	bool is_finite() const { return std::isfinite(angle); }

	struct Fixed {
		double c, s;
		Vec<2> apply(const Vec<2>& v) const { return { c * v[0] - s * v[1], s * v[0] + c * v[1] }; }
	};
	Fixed fixed() const { return { std::cos(angle), std::sin(angle) }; }
	Vec<2> apply(const Vec<2>& v) const { return fixed().apply(v); }
	Vec<2> undo(const Vec<2>& v) const { return inverse().apply(v); }
};

/// A unit quaternion w + u, w = cos(angle/2), u = axis sin(angle/2).
template <>
struct Turn<3> {
	double w = 1;
	Vec<3> u;

	/// exp(r/2) = cos(|r|/2) + r sin(|r|/2)/|r|.
	static Turn by(const Vec<3>& rotation)
	{
		const double half = norm(rotation) / 2;
		// Below 1e-8 the ratio differs from its limit by less than a round-off, and |r|^2 may be too small for a number.
		const double ratio = half < 1e-8 ? 0.5 : std::sin(half) / (2 * half);
		return { std::cos(half), ratio * rotation };
	}

	static Turn about(const Vec<3>& axis, double angle) { return by(angle * unit(axis)); }

	/// Hamilton's product next * this.
	Turn then(const Turn& next) const { return { next.w * w - dot(next.u, u), next.w * u + w * next.u + cross(next.u, u) }; }
	Turn inverse() const { return { w, -u }; }

	/// Normalised, so that the length stays 1 over any number of steps.
	Turn advanced(const Vec<3>& spin, double dt) const { return then(by(dt * spin)).normalised(); }

	Turn normalised() const
	{
		const double length = std::sqrt(w * w + squared_norm(u));
		return { w / length, u / length };
	}
	bool is_finite() const { return std::isfinite(w) && geometry::is_finite(u); }
	const Turn& fixed() const { return *this; }

	/// v + 2 w (u x v) + 2 u x (u x v).
	Vec<3> apply(const Vec<3>& v) const
	{
		const Vec<3> twice = 2 * cross(u, v);
		return v + w * twice + cross(u, twice);
	}
	Vec<3> undo(const Vec<3>& v) const { return inverse().apply(v); }
};

static_assert(std::is_trivially_copyable_v<Turn<2>> && std::is_trivially_copyable_v<Turn<3>>);

}  // namespace graindrive::geometry
