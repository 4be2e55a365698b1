/// From an operator to the interpolation from the next coarser grid, and to the operator there.
#pragma once
#include "engines/continuum/pressure/multigrid_links.hpp"

namespace graindrive::continuum {

/// Fills p with weights that follow the links of `a`, and `coarse` with P^T A P.
/// @param rows room for five rows of the coarse grid
/// @param largest the largest link of the finest grid
void coarsen(const Links& a, Interpolation& p, NinePoint& coarse, PlainField& rows, double largest);

}  // namespace graindrive::continuum
