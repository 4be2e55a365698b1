/// YADE's periodic cell as GrainLoop follows it: a box, or a cell of disks that is sheared across y along x and may grow in y.
///
/// YADE deforms O.cell itself, at the start of each step: hSize' = hSize + dt velGrad hSize. So at the forces of step n its edges are those of
/// the positions x_n, and velGrad is that of the motion since x_{n-1}. NewtonIntegrator then takes nextVelGrad, which Python's
/// O.cell.velGrad sets, and gives bodies velGrad's change; GrainLoop does the same (Cell::homoDeform = 1).
#pragma once
#include "engines/loop/state.hpp"
#include "engines/seam/yade.hpp"

namespace graindrive::loop {

/// True if it is tilted, or deforms, or is about to.
bool deforms(const yade::Cell& cell);

/// @throws std::invalid_argument for a tilt or a gradient that GrainLoop does not follow, saying which
void require_flow(const yade::Cell& cell, int dimensions);

/// Offset, height and velocity of the images at the present positions, for a cell that deforms.
void read_flow(const yade::Cell& yade_cell, Cell<2>& cell);

/// The flow of the next step, after the values set for it have been applied, as in NewtonIntegrator.
Flow<2> take_next_flow(yade::Cell& cell);

}  // namespace graindrive::loop
