/// `clump_of`: beads glued along an outline so that their outer envelope is the outline, with the solid's mass and inertia.
#pragma once
#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// An intruder as the engines want it. Mass and inertia are the uniform solid's, not the sum over overlapping beads.
struct Clump {
	Points beads;      ///< centres, relative to the centroid of the solid [length]
	Real bead_radius;  ///< [length]
	Real mass;         ///< [mass]
	Real inertia;      ///< I_z about the centroid [mass length^2]
};

/// Centres of beads that touch the outline from inside, in the outline's own frame, counter-clockwise.
///
/// They stand at every corner of the inset by a bead radius, and between corners at equal steps of at most `spacing` bead
/// diameters. Convex corners of the envelope are thus rounded by the bead radius. Turns below 0.1 rad count as part of a curve.
/// A curve has at least one bead for each quarter turn.
/// Every bead is within 1e-5 of its radius of touching; steps may pass the asked one by as much, for digits that a file rounds.
/// On a disk the number of beads is a multiple of four, so that its extents along x and y are exact.
/// @throws std::invalid_argument unless bead_diameter > 0 and 0 < spacing <= 1, and if the shape is too thin for the beads
Points beads(const Outline& outline, Real bead_diameter, Real spacing = 1);

/// Beads and inertia are computed near the outline and so are as exact far from the point (0, 0) as about it.
/// @throws std::invalid_argument as `beads`, and unless mass > 0
Clump clump_of(const Outline& outline, Real bead_diameter, Real mass, Real spacing = 1);

}  // namespace graindrive::shapes
