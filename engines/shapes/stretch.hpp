/// `Stretch`: a piece of the line that beads' centres lie on, straight or round, and what part of it an edge forbids.
#pragma once
#include <optional>

#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// A straight edge, or the arc on which a bead rolls round a reflex corner of the outline.
struct Stretch {
	Vector2r from, to;
	Vector2r centre = Vector2r::Zero();  ///< of the arc: the reflex corner
	Real radius = 0;                     ///< of the arc, run clockwise; 0 for a straight edge
	Real length = 0;

	Vector2r at(Real distance) const;          ///< the point `distance` along the stretch
	Vector2r heading(Real distance) const;     ///< unit tangent there
	Stretch part(Real begin, Real end) const;  ///< from `begin` to `end` along the stretch
	Eigen::AlignedBox<Real, 2> box() const;    ///< a box around it
};

Stretch straight(const Vector2r& from, const Vector2r& to);
Stretch arc(const Vector2r& from, const Vector2r& to, const Vector2r& centre);

Vector2r left_of(const Vector2r& edge);  ///< unit normal on its left

/// Distances along a stretch, or along the line or circle that it is part of.
struct Interval {
	Real begin, end;
};

/// Where the line or circle of `stretch` is closer to the edge from a to b than `reach`, which must not be less than the radius.
std::optional<Interval> closer_than(Real reach, const Stretch& stretch, const Vector2r& a, const Vector2r& b);

/// What is left of `parts` without `hole`.
std::vector<Interval> without(const std::vector<Interval>& parts, const Interval& hole);

}  // namespace graindrive::shapes
