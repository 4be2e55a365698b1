/// Transport of the volume fraction of one fluid with a sharp surface: WLIC with THINC, direction by direction, conserving area.
#pragma once
#include "engines/continuum/domain.hpp"

namespace graindrive::continuum {

/// d alpha/dt + div(alpha v) - alpha div v = 0.
///
/// Along each direction alpha is taken for (1 + s tanh(beta (x - x_0)))/2 within a cell (THINC: Xiao, Honma, Kono 2005), weighed with a
/// plain upwind flux by how much the surface's normal points along it (WLIC: Yokoi 2007). The term alpha div v is c div v with
/// c = 1 where alpha > 1/2 before the step, else 0, in both directions: then the area is conserved to rounding, and alpha stays within
/// [0, 1] for Courant numbers below 1/2 (Weymouth, Yue 2010). Nothing flows through closed edges or into the solid's own cells.
class VolumeOfFluid {
public:
	/// `sharpness` is beta: the surface is about 4/beta cells thick. @throws std::invalid_argument unless it is positive
	VolumeOfFluid(const Grid& grid, const Domain& domain, double sharpness = 3.5);

	/// Moves `fraction` by one step of `dt`, x first if `x_first`; alternate it. `velocity` must have ghosts.
	void advect(Values& fraction, const FaceValues& velocity, double dt, bool x_first);

private:
	Grid grid;
	Values moves_x, moves_y;  ///< 1 on faces through which alpha flows
	Values whole;             ///< 1 in cells all of whose faces do
	double beta;
	Values flux, above_half, first_dilation;

	/// One direction: velocity and open faces across it, and how far its neighbours lie apart in memory.
	struct Sweep {
		const Values *velocity, *moves;
		std::size_t along;
	};
	void sweep(Values& fraction, const Sweep& s, double scale, bool second);
	double flux_of(const Values& fraction, std::size_t donor, std::size_t step, std::size_t across, double courant) const;
};

/// Area of the fluid in the cells, weighed with how open they are if `weight` is given.
double area_of(const Grid& grid, const Values& fraction, const Values* weight = nullptr);

}  // namespace graindrive::continuum
