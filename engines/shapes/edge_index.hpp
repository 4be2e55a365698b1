/// `BoxIndex`: which of many boxes lie near a place, found in a tree; and distances to an outline by means of it.
#pragma once
#include <memory>

#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

using Box = Eigen::AlignedBox<Real, 2>;

/// A box that is larger by `margin` on all sides.
Box grown(const Box& box, Real margin);

class BoxIndex {
public:
	explicit BoxIndex(const std::vector<Box>& boxes);
	~BoxIndex();

	/// Positions in `boxes` of those that meet `place`.
	std::vector<std::size_t> near(const Box& place) const;

private:
	struct Tree;
	std::unique_ptr<Tree> tree_;
};

/// The edges of a closed polygon, edge i from corner i to the next, and which are near a place.
class EdgeIndex {
public:
	explicit EdgeIndex(const Points& corners);

	std::size_t size() const { return corners_.size(); }
	const Vector2r& corner(std::size_t i) const { return corners_[i % corners_.size()]; }
	std::vector<std::size_t> near(const Box& place) const { return index_.near(place); }

	/// Distance from a point to the nearest edge; infinite if that is more than `most`.
	Real distance(const Vector2r& point, Real most) const;

private:
	Points corners_;
	BoxIndex index_;
};

/// Distance from a point to the straight way from a to b.
Real distance_to_segment(const Vector2r& point, const Vector2r& a, const Vector2r& b);

}  // namespace graindrive::shapes
