/// Where the fluid is: how much of every face is open to it, and how the solid moves (boundary data immersion).
#pragma once
#include <functional>

#include "engines/continuum/grid.hpp"

namespace graindrive::continuum {

/// A solid that moves with `velocity` and turns with `spin` about (x, y).
struct WallMotion {
	double velocity_x = 0, velocity_y = 0, spin = 0, x = 0, y = 0;
};

/// Signed distance from the solid at a point, > 0 in the fluid.
using Distance = std::function<double(double x, double y)>;

/// chi: 1 in the fluid, 0 in the solid, (1 - sin(pi d/(2 eps)))/2 between, d > 0 into the solid. Weymouth, Yue (2011); Oba, Otsuki
/// (2025), (41).
double openness(double distance_into_solid, double half_width);

/// Openness and wall velocity on all faces, openness in all cells.
struct Domain {
	FaceValues open;   ///< chi [-]; 0 on closed edges of the grid
	FaceValues wall;   ///< velocity of the solid
	Values cell_open;  ///< chi at centres
	Values fluid;      ///< 1 in cells of which some face is open, else 0: there nothing moves but the solid

	/// A grid full of fluid. @throws std::invalid_argument for fewer than two cells a side or a spacing that is not positive
	explicit Domain(const Grid& grid);
	/// The fluid where `distance` > 0, with a transition of `half_width` to each side.
	/// Where fluid reaches a closed edge of the grid, the edge is a wall at rest.
	/// @throws std::invalid_argument as above, for a distance that is not finite, and where no cell is wholly in the fluid
	Domain(const Grid& grid, const Distance& distance, double half_width, const WallMotion& motion);
};

/// What the cells within a wall's transition and behind it take over from the fluid beside them: the value of the cell that is found along
/// the normal, where the transition begins; of one, for means would smear a surface. So a moving wall carries no film of either fluid through the other.
class WallLayer {
public:
	/// None where nothing is solid.
	WallLayer() = default;
	/// `distance` as of the domain, smooth near the wall; `half_width` that of its transition.
	WallLayer(const Grid& grid, const Domain& domain, const Distance& distance, double half_width);

	/// Fills those cells; `cells` within the fluid must have their ghosts.
	void extend(Values& cells) const;

private:
	struct Taken {
		std::size_t cell, from;
	};
	std::vector<Taken> layer;
};

}  // namespace graindrive::continuum
