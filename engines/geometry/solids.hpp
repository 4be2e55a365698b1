/// Half-spaces, balls and cylinders: solids whose distance is a closed form.
#pragma once
#include "engines/geometry/surface.hpp"

namespace graindrive::geometry {

/// Everything behind a plane (in 2D: a line): d = (x - p) n.
template <int D>
class HalfSpace : public Surface<D> {
public:
	/// @param point on the plane [m]; @param normal out of the solid, of any length
	/// @throws std::invalid_argument unless both are finite and the normal is not zero
	HalfSpace(const Vec<D>& point, const Vec<D>& normal);
	Nearest<D> nearest(const Vec<D>& at) const override { return { dot(at - point_, normal_), normal_ }; }
	Bounds<D> bounds() const override;

private:
	Vec<D> point_, normal_;
};

/// A sphere, or a disk in 2D: d = |x - c| - R.
template <int D>
class Ball : public Surface<D> {
public:
	/// @throws std::invalid_argument unless the centre is finite and the radius positive
	Ball(const Vec<D>& centre, double radius);
	Nearest<D> nearest(const Vec<D>& at) const override;
	Bounds<D> bounds() const override;

private:
	Vec<D> centre_;
	double radius_;
};

/// A round cylinder along any axis, infinite or with flat ends. In 2D a disk serves.
///
/// With q = distance from the axis - R and z = distance from the middle - h/2: d = q without ends; with them d = max(q, z)
/// inside and beside, and |(q, z)| off the edge, where both are positive.
class Cylinder : public Surface<3> {
public:
	static constexpr double endless = std::numeric_limits<double>::infinity();

	/// @param middle a point of the axis, half-way between the ends; @param axis of any length; @param length between the ends
	/// @throws std::invalid_argument unless middle and axis are finite, the axis not zero, radius and length positive
	Cylinder(const Vec<3>& middle, const Vec<3>& axis, double radius, double length = endless);
	Nearest<3> nearest(const Vec<3>& at) const override;
	Bounds<3> bounds() const override;

private:
	Vec<3> middle_, axis_;
	double radius_, half_length_;
};

/// The intersection of two solids whose surfaces are perpendicular everywhere: the edge where both end is |(a, b)| away.
Nearest<3> perpendicular_intersection(const Nearest<3>& a, const Nearest<3>& b);

/// A vector of unit length perpendicular to a vector of unit length.
Vec<3> perpendicular_to(const Vec<3>& axis);

}  // namespace graindrive::geometry
