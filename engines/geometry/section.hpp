/// The section of a solid in space by a plane, for contacts with disks in that plane.
#pragma once
#include "engines/geometry/refuse.hpp"
#include "engines/geometry/surface.hpp"

namespace graindrive::geometry {

/// The section by the plane z = 0 of a solid that is uniform along z where disks come near it, so that distances in the plane equal
/// those in space. Elsewhere `nearest` refuses.
class Section : public Surface<2> {
public:
	/// @throws std::invalid_argument without a surface
	explicit Section(SharedSurface<3> whole) : whole_(std::move(whole))
	{
		require(whole_ != nullptr, "a section needs a surface", "none", "give one");
	}

	/// @throws std::invalid_argument where the way to the surface leads out of the plane
	Nearest<2> nearest(const Vec<2>& at) const override
	{
		const Nearest<3> found = whole_->nearest({ at[0], at[1], 0 });
		require(std::abs(found.normal[2]) < steepest, "a solid in contact with disks must be uniform along z", found.normal,
			"that is its normal at the disk; sweep an outline along z, or turn the solid");
		return { found.distance, unit(Vec<2>{ found.normal[0], found.normal[1] }) };
	}

	Bounds<2> bounds() const override
	{
		const Bounds<3> box = whole_->bounds();
		return { { box.low[0], box.low[1] }, { box.high[0], box.high[1] } };
	}

	double largest_sphere() const override { return whole_->largest_sphere(); }

private:
	static constexpr double steepest = 1e-9;  // the round-off of a solid that was turned
	SharedSurface<3> whole_;
};

}  // namespace graindrive::geometry
