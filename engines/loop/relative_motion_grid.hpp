/// How much nearer two spheres can have come to each other since the last search: by what spheres of one neighbourhood have gone differently.
///
/// A pair that may touch before the next selection lies in two adjacent cells of a grid now, so the displacements since the search
/// need comparing there alone: a bed that flows as a whole, or shears slowly, needs no new search however far it has gone.
#pragma once
#include "engines/loop/pair_geometry.hpp"

namespace graindrive::loop {

class RelativeMotionGrid {
public:
	/// Lays all grains into cells, with where they may be after `horizon` [s] by the drifts of their parties.
	RelativeMotionGrid(const State<3>& state, double horizon);
	/// Bound on the change of distance of any pair that may touch until then [m].
	double largest_approach() const;

private:
	/// Displacements since the search.
	struct Range {
		Vec<3> low = Vec<3>::all(HUGE_VAL), high = Vec<3>::all(-HUGE_VAL);  // [m]
		void include(const Range& other);
	};
	/// What grains of a cell have in common. Drifts are steady, so what two have gone differently is largest now or at the horizon.
	struct Motion {
		Range now, then;
		double allowed = 0;  // largest budget [m]
		void include(const Motion& other);
	};
	const State<3>& state;
	const double horizon;
	Vec<3> corner, width;
	int cells[3];
	std::vector<Motion> motions;

	void lay();
	void enter(std::uint32_t row);
	Motion& at(int x, int y, int z) { return motions[(std::size_t(x) * cells[1] + y) * cells[2] + z]; }
	void join_next_along(int axis);
};

}  // namespace graindrive::loop
