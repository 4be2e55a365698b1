/// Reads tilt and velocity gradient of O.cell.
#include "engines/loop/yade_cell.hpp"

#include <sstream>

namespace graindrive::loop {

namespace {

using Matrix = Eigen::Matrix<Real, 3, 3>;

/// True if the velocity gradient has no entries but (0, 1), (1, 1) and, if `with_diagonal`, the rest of the diagonal.
bool is_flow(Matrix m, bool with_diagonal)
{
	m(0, 1) = m(1, 1) = 0;
	if (with_diagonal) m.diagonal().setZero();
	return m.isZero(0);
}

std::string words(const Matrix& m)
{
	std::ostringstream text;
	for (int row = 0; row < 3; ++row) text << (row ? "; " : "(") << m(row, 0) << ", " << m(row, 1) << ", " << m(row, 2);
	return text.str() + ")";
}

}  // namespace

bool deforms(const yade::Cell& cell) { return cell.hSize(0, 1) != 0 || !cell.velGrad.isZero(0) || !cell.nextVelGrad.isZero(0); }

void require_flow(const yade::Cell& cell, int dimensions)
{
	if (!is_flow(cell.hSize, true))
		throw std::invalid_argument(
			"GrainLoop: O.cell is tilted; of its hSize only the diagonal and, with disks, hSize[0][1] may "
			"differ from 0, got " +
			words(cell.hSize) + ": O.cell.setBox(x, y, z), or use YADE's loop");
	for (const Matrix* gradient : { &cell.velGrad, &cell.nextVelGrad })
		if (!is_flow(*gradient, false))
			throw std::invalid_argument(
				"GrainLoop: O.cell.velGrad deforms the cell in a way that GrainLoop does not support; only "
				"velGrad[0][1] (shear) and velGrad[1][1] (height) may differ from 0, got " +
				words(*gradient) + "; set the others to zero, or use YADE's loop");
	if (!deforms(cell)) return;
	if (dimensions == 3)
		throw std::invalid_argument(
			cell.velGrad.isZero(0) && cell.nextVelGrad.isZero(0)
				? "GrainLoop: O.cell is tilted (its hSize has parts off the diagonal), which spheres in space "
				  "cannot have here: O.cell.setBox(x, y, z), or use YADE's loop"
				: "GrainLoop: O.cell.velGrad deforms the cell, which GrainLoop supports only for disks; set it "
				  "to zero, or use YADE's loop");
	if (cell.homoDeform != 1)
		throw std::invalid_argument("GrainLoop: O.cell.homoDeform must be 1 in a cell that deforms, got " +
									std::to_string(cell.homoDeform) +
									"; 0 gives images no velocity, and 2 adds velGrad v dt to velocities without a force");
}

void read_flow(const yade::Cell& yade_cell, Cell<2>& cell)
{
	cell.across = 1, cell.along = 0;
	cell.high[1] = cell.low[1] + yade_cell.hSize(1, 1);
	cell.set_offset(yade_cell.hSize(0, 1));
	cell.rate = yade_cell.velGrad(0, 1) * yade_cell.prevHSize(1, 1);
	cell.growth = yade_cell.velGrad(1, 1) * yade_cell.prevHSize(1, 1);
}

Flow<2> take_next_flow(yade::Cell& cell)
{
	const Matrix before = cell.velGrad;
	if (cell.velGradChanged || !cell.nextVelGrad.isZero(0)) {
		cell.velGrad = cell.nextVelGrad;
		cell.nextVelGrad.setZero();
		cell.velGradChanged = false;
	}
	cell.prevVelGrad = cell.velGrad;
	const Real height = cell.hSize(1, 1);
	return { { cell.velGrad(0, 1) * height, cell.velGrad(1, 1) * height }, -(cell.velGrad(0, 1) - before(0, 1)) / 2 };
}

}  // namespace graindrive::loop
