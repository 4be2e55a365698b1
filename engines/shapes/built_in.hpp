/// The five intruders of the wiggle paper (Tripura, Kumar, Anyam, Reddy), by name, with their sizes as parameters.
#pragma once
#include <string>
#include <vector>

#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// A built-in shape about its centroid, turned counter-clockwise by `orientation` [rad]. Sizes are outer ones, beads included.
///
///   disk     OS1  {diameter}       7          tall  OS3  {width, height}  4.5 x 9.5
///   square   OS2  {side}           6.5        wide  OS4  {width, height}  9.5 x 4.5
///   triangle OS5  {side}           9.5 (equilateral, apex up)
///
/// No `sizes` means the paper's, in grain diameters d.
/// @throws std::invalid_argument for an unknown name, a wrong number of sizes, or one that is not positive
Outline outline_of(const std::string& name, const std::vector<Real>& sizes = {}, Real orientation = 0);

/// The names that `outline_of` knows, without the aliases OS1 to OS5.
std::vector<std::string> shape_names();

}  // namespace graindrive::shapes
