/// Recipes of sampled distances, after checks that the function is a distance.
#pragma once
#include <string>
#include <vector>

#include "engines/geometry/sampled_distance.hpp"

namespace graindrive::solids {

/// The recipe `sampled ...` of distances at a grid's nodes, x fastest.
///
/// Within two spacings of the surface the slope (f(i+1) - f(i-1))/2h along all axes has the length 1 if f is a distance, but for edges.
/// @throws std::invalid_argument as `SampledDistance` does; where the solid reaches the outer layer of nodes, for beyond it nothing
/// would be known; where the lengths of the slopes near the surface have quartiles outside 1 +- 0.1, with their values
std::string sampled_recipe(const geometry::SampleGrid<3>& grid, const std::vector<double>& distances);

}  // namespace graindrive::solids
