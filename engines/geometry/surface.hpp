/// A surface: gives at any point the distance to a solid, and the direction out of it.
#pragma once
#include <array>
#include <limits>
#include <memory>

#include "engines/geometry/vec.hpp"

namespace graindrive::geometry {

/// The result at a point x. The nearest point of the surface is x - distance normal.
template <int D>
struct Nearest {
	double distance;  ///< > 0 outside the solid, < 0 inside [m]
	Vec<D> normal;    ///< out of the solid, of unit length
};

/// A box parallel to the axes; its sides may be infinite.
template <int D>
struct Bounds {
	static constexpr double infinity = std::numeric_limits<double>::infinity();

	Vec<D> low = Vec<D>::all(-infinity), high = Vec<D>::all(infinity);  ///< [m]
};

/// The box parallel to the world's axes around the box of a frame, whose axes and origin are seen from the world.
template <int D>
Bounds<D> moved_bounds(const Bounds<D>& in_frame, const std::array<Vec<D>, D>& axes, const Vec<D>& origin)
{
	Bounds<D> box{ origin, origin };
	for (int j = 0; j < D; ++j)
		for (int k = 0; k < D; ++k) {
			const double part = axes[j][k];
			if (std::abs(part) < 1e-15) continue;  // a round-off must not turn an infinite side into this direction
			box.low[k] += std::min(part * in_frame.low[j], part * in_frame.high[j]);
			box.high[k] += std::max(part * in_frame.low[j], part * in_frame.high[j]);
		}
	return box;
}

/// A solid body by distance and normal. A new shape derives from this and implements two functions; see `surface_test.cpp`.
///
/// Where several points of the surface are equally near, as for the centre of a ball, any of them may be taken.
template <int D>
class Surface {
public:
	Surface() = default;
	Surface(const Surface&) = default;
	Surface& operator=(const Surface&) = default;
	virtual ~Surface() = default;

	virtual Nearest<D> nearest(const Vec<D>& at) const = 0;

	/// A box that contains the whole solid, for search and packing. The default is infinite.
	virtual Bounds<D> bounds() const { return {}; }

	/// The radius [m] up to which spheres outside meet the surface at the right place. Where only bounds of distances are known, as beyond
	/// the grid of a sampled one, a larger sphere would meet it too soon.
	virtual double largest_sphere() const { return Bounds<D>::infinity; }
};

/// Surfaces do not change, so many bodies and compositions may share one.
template <int D>
using SharedSurface = std::shared_ptr<const Surface<D>>;

/// `shared(Ball<3>({ 0, 0, 0 }, 2))`: the shape where a shared one is wanted.
template <class Shape>
std::shared_ptr<const Shape> shared(Shape shape)
{
	return std::make_shared<const Shape>(std::move(shape));
}

static_assert(std::is_trivially_copyable_v<Nearest<2>> && std::is_trivially_copyable_v<Bounds<3>>);

}  // namespace graindrive::geometry
