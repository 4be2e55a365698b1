/// Distances from simple solids in closed form, with a defined normal at centres and edges.
#include "engines/geometry/solids.hpp"

#include "engines/geometry/refuse.hpp"

namespace graindrive::geometry {

template <int D>
HalfSpace<D>::HalfSpace(const Vec<D>& point, const Vec<D>& normal)
	: point_(point),
	  normal_(direction("half-space normal", normal))
{
	require_finite("half-space point", point);
}

template <int D>
Bounds<D> HalfSpace<D>::bounds() const
{
	Bounds<D> bounds;
	for (int k = 0; k < D; ++k) {
		if (normal_ == Vec<D>::along(k)) bounds.high[k] = point_[k];
		if (normal_ == -Vec<D>::along(k)) bounds.low[k] = point_[k];
	}
	return bounds;
}

template <int D>
Ball<D>::Ball(const Vec<D>& centre, double radius) : centre_(centre),
													 radius_(radius)
{
	require_finite("ball centre", centre);
	require_positive("ball radius", radius);
}

template <int D>
Nearest<D> Ball<D>::nearest(const Vec<D>& at) const
{
	const Vec<D> from = at - centre_;
	const double length = norm(from);
	if (!(length > 0)) return { -radius_, Vec<D>::along(0) };
	return { length - radius_, from / length };
}

template <int D>
Bounds<D> Ball<D>::bounds() const
{
	return { centre_ - Vec<D>::all(radius_), centre_ + Vec<D>::all(radius_) };
}

template class HalfSpace<2>;
template class HalfSpace<3>;
template class Ball<2>;
template class Ball<3>;

Vec<3> perpendicular_to(const Vec<3>& axis)
{
	int thinnest = 0;
	for (int k = 1; k < 3; ++k)
		if (std::abs(axis[k]) < std::abs(axis[thinnest])) thinnest = k;
	return unit(cross(axis, Vec<3>::along(thinnest)));
}

Nearest<3> perpendicular_intersection(const Nearest<3>& a, const Nearest<3>& b)
{
	if (!(a.distance > 0 && b.distance > 0)) return a.distance > b.distance ? a : b;
	const double distance = std::hypot(a.distance, b.distance);
	return { distance, (a.distance / distance) * a.normal + (b.distance / distance) * b.normal };
}

Cylinder::Cylinder(const Vec<3>& middle, const Vec<3>& axis, double radius, double length)
	: middle_(middle),
	  axis_(direction("cylinder axis", axis)),
	  radius_(radius),
	  half_length_(length / 2)
{
	require_finite("cylinder middle", middle);
	require_positive("cylinder radius", radius);
	require(length > 0, "cylinder length must be positive", length, "give a length > 0, or Cylinder::endless");
}

Nearest<3> Cylinder::nearest(const Vec<3>& at) const
{
	const Vec<3> from = at - middle_;
	const double along = dot(from, axis_);
	const Vec<3> across = from - along * axis_;
	const double length = norm(across);
	const Nearest<3> mantle =
		length > 0 ? Nearest<3>{ length - radius_, across / length } : Nearest<3>{ -radius_, perpendicular_to(axis_) };
	if (half_length_ == endless) return mantle;
	return perpendicular_intersection(mantle, { std::abs(along) - half_length_, along < 0 ? -axis_ : axis_ });
}

Bounds<3> Cylinder::bounds() const
{
	Bounds<3> bounds;
	for (int k = 0; k < 3; ++k) {
		const double along = axis_[k] == 0 ? 0 : half_length_ * std::abs(axis_[k]);
		const double reach = along + radius_ * std::sqrt(std::max(0.0, 1 - axis_[k] * axis_[k]));
		bounds.low[k] = middle_[k] - reach;
		bounds.high[k] = middle_[k] + reach;
	}
	return bounds;
}

}  // namespace graindrive::geometry
