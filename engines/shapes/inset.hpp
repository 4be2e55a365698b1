/// The inset of an outline: the line on which the centres of beads lie that touch the outline from inside.
#pragma once
#include "engines/shapes/outline.hpp"
#include "engines/shapes/stretch.hpp"

namespace graindrive::shapes {

/// The points inside a polygon that are `distance` away from its nearest edge, as one closed path, counter-clockwise.
///
/// Every edge is shifted inwards and every reflex corner rounded by an arc; of these stretches all is cut away that another edge
/// is closer to (trimmed offset curves: Tiller, Hanson, IEEE Comput. Graph. Appl. 4(9), 36 (1984)). Lengths are measured against
/// `distance`: what is shorter than 1e-6 of it, or lies that close to the line, is no corner. Places are relative to the
/// outline's origin.
/// @throws std::invalid_argument if the outline is so thin that the inset vanishes or falls apart
std::vector<Stretch> inset(const Outline& polygon, Real distance);

}  // namespace graindrive::shapes
