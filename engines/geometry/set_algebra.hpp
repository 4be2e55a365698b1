/// Solids made of solids: complement, intersection, union.
///
/// If the parts' distances d_i are exact, the result is exact
///
///   inside an intersection:  d = max d_i  (what is outside is a union, whose distance is the smallest)
///   outside of it:           d = max d_i, if that part's nearest point lies in all others
///   off an edge or corner:   the nearest point x of all parts minimises |x - p|^2 with d_i(x) <= 0 (see `set_algebra.cpp`)
///
/// and for unions the same of the complements. Off an edge the iteration finds a local minimum: the nearest point of all wherever p
/// is nearer to the edge than a tenth of the parts' radii of curvature and of the way to other edges. Farther away it may be another
/// minimum, so the distance a bound from above; where the iteration finds none, as for parts that do not meet, the distance is
/// max d_i, a bound from below, whose foot x - d n is not in all parts. Where surfaces meet at less than 1e-7 rad it is that bound
/// too. Parts that give bounds give bounds.
#pragma once
#include <vector>

#include "engines/geometry/surface.hpp"

namespace graindrive::geometry {

/// The largest radius of spheres for which every part is right. What is outside a complement is inside its solid, where samples are known.
template <int D>
double least_of_parts(const std::vector<SharedSurface<D>>& parts)
{
	double least = Bounds<D>::infinity;
	for (const auto& part : parts) least = std::min(least, part->largest_sphere());
	return least;
}

/// Everything but a solid: a drum is what a cylinder leaves.
template <int D>
class Complement : public Surface<D> {
public:
	/// @throws std::invalid_argument without a shape
	explicit Complement(SharedSurface<D> solid);
	Nearest<D> nearest(const Vec<D>& at) const override
	{
		const Nearest<D> of_solid = solid_->nearest(at);
		return { -of_solid.distance, -of_solid.normal };
	}

private:
	SharedSurface<D> solid_;
};

/// What lies in all parts. A half-space and another make a wedge, six a block.
template <int D>
class Intersection : public Surface<D> {
public:
	/// @throws std::invalid_argument without parts
	explicit Intersection(std::vector<SharedSurface<D>> parts);
	Nearest<D> nearest(const Vec<D>& at) const override;
	Bounds<D> bounds() const override;
	double largest_sphere() const override { return least_of_parts(parts_); }

private:
	std::vector<SharedSurface<D>> parts_;
};

/// What lies in any part.
template <int D>
class Union : public Surface<D> {
public:
	/// @throws std::invalid_argument without parts
	explicit Union(std::vector<SharedSurface<D>> parts);
	Nearest<D> nearest(const Vec<D>& at) const override;
	Bounds<D> bounds() const override;
	double largest_sphere() const override { return least_of_parts(parts_); }

private:
	std::vector<SharedSurface<D>> parts_;
};

}  // namespace graindrive::geometry
