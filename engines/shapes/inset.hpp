/// The inset of an outline: the line on which the centres of beads lie that touch the outline from inside.
#pragma once
#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// One stretch of an inset: a straight edge, or the arc on which a bead rolls round a reflex corner of the outline.
struct Stretch {
	Vector2r from, to;
	Vector2r centre = Vector2r::Zero();  ///< of the arc: the reflex corner
	Real radius = 0;                     ///< of the arc, run clockwise; 0 for a straight edge
	Real length = 0;

	Vector2r at(Real distance) const;       ///< the point `distance` along the stretch
	Vector2r heading(Real distance) const;  ///< unit tangent there
};

Stretch straight(const Vector2r& from, const Vector2r& to);
Stretch arc(const Vector2r& from, const Vector2r& to, const Vector2r& centre);

/// The inset of a polygon by `distance`, counter-clockwise: CGAL's straight-skeleton offset, whose mitres at the outline's reflex
/// corners give way to arcs wherever the neighbouring edges are long enough.
/// @throws std::invalid_argument if the outline is so thin that the inset vanishes or falls apart
std::vector<Stretch> inset(const Outline& polygon, Real distance);

/// Distance from a point to the nearest edge of the outline.
Real distance_to(const Outline& outline, const Vector2r& point);

}  // namespace graindrive::shapes
