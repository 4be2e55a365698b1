/// The search for neighbours among spheres: every pair nearer than a skin, each once, in the order of (owner, partner).
#pragma once
#include "engines/loop/spheres/sphere_grid.hpp"
#include "engines/loop/spheres/sphere_kernel.hpp"
#include "engines/loop/state.hpp"

namespace graindrive::loop {

/// A pair with a member of a body.
struct MemberPair {
	std::uint32_t owner, member;
	bool wrapped;
};

class SphereSearch {
public:
	/// Free spheres lie first, sorted by `grid`; members of bodies follow. Makes the columns that the kernel looks through, and the
	/// pairs with members. @throws std::invalid_argument where a member would meet a free sphere through two images
	void begin(const State<3>& state, const SphereGrid& grid);

	/// The pairs of members of different bodies, sorted.
	const std::vector<MemberPair>& among_members() const { return members_alone; }

	/// Candidates of the owners in the cells [first, end): `count[owner]` and, one owner behind the other, their partners in order.
	void find(const SphereKernel& kernel, std::uint32_t first_cell, std::uint32_t end_cell, std::uint32_t* count,
		std::vector<Partner>& partners) const;

	/// The first cell whose spheres lie at or behind the row.
	std::uint32_t cell_at(std::uint32_t row) const;

private:
	const State<3>* state = nullptr;
	const SphereGrid* grid = nullptr;
	float rounding = 0;  // by how much the columns may be wrong [m]
	std::vector<float> column[4];
	std::vector<MemberPair> with_members, members_alone;

	void fill_columns();
	void around_member(std::uint32_t member);
	void between_members();
	bool near(std::uint32_t a, std::uint32_t b, bool& wrapped) const;
	void beyond_tile(std::uint32_t a, const CellPlace& at, std::vector<Partner>& partners) const;
};

}  // namespace graindrive::loop
