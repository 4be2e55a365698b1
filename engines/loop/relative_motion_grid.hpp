/// A bound for the approach of two spheres since the last search, from differences of displacements between neighbouring spheres.
///
/// A pair that may touch before the next selection lies in two adjacent cells of a grid now, so the displacements since the search
/// have to be compared only there: a bed that flows as a whole, or shears slowly, needs no new search however far it has moved.
#pragma once
#include "engines/loop/pair_geometry.hpp"

namespace graindrive::loop {

class RelativeMotionGrid {
public:
	/// Sorts all grains into cells, with their possible positions after `horizon` [s] from the drifts of their parties.
	RelativeMotionGrid(const State<3>& state, double horizon);
	/// Bound on the change of distance of any pair that may touch until then [m].
	double largest_approach() const;

private:
	/// Displacements since the search.
	struct Range {
		Vec<3> low = Vec<3>::all(HUGE_VAL), high = Vec<3>::all(-HUGE_VAL);  // [m]
		void include(const Range& other);
	};
	/// The motion of the grains of a cell. Drifts are constant, so the difference of two displacements is largest now or at the horizon.
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
