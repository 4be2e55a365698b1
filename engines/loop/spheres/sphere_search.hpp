/// The search for neighbours among spheres: every pair nearer than a skin, each once, in the order of (owner, partner).
#pragma once
#include "engines/loop/spheres/sphere_grid.hpp"
#include "engines/loop/spheres/sphere_kernel.hpp"

namespace graindrive::loop {

/// A partner of a candidate pair: the row, and whether the pair is met across a periodic side.
struct Partner {
	std::uint32_t bits;

	static constexpr std::uint32_t across = 0x80000000u;
	std::uint32_t row() const { return bits & ~across; }
	bool wrapped() const { return bits & across; }
};

/// b - a by the nearest image [m].
inline void separation(const SphereRow& a, const SphereRow& b, const SphereBox& box, double d[3])
{
	for (int k = 0; k < 3; ++k) {
		d[k] = b.x[k] - a.x[k];
		if (box.periodic[k]) d[k] -= box.length(k) * std::nearbyint(d[k] / box.length(k));
	}
}

/// A free sphere and a held one.
struct HeldPair {
	std::uint32_t free, held;
	bool wrapped;
};

class SphereSearch {
public:
	/// Free spheres lie first, sorted by `grid`; held ones follow. Makes the columns that the kernel looks through, and the pairs with
	/// held spheres. @throws std::invalid_argument where a held sphere would meet a free one through two images
	void begin(
		const SphereRow* rows, std::uint32_t n_free, std::uint32_t n, const SphereGrid& grid, const SphereBox& box, double skin);

	/// Candidates of the owners in the cells [first, end): `count[owner]` and, one owner behind the other, their partners in order.
	void find(const SphereKernel& kernel, std::uint32_t first_cell, std::uint32_t end_cell, std::uint32_t* count,
		std::vector<Partner>& partners) const;

	/// The first cell whose spheres lie at or behind the row.
	std::uint32_t cell_at(std::uint32_t row) const;

private:
	const SphereRow* rows = nullptr;
	const SphereGrid* grid = nullptr;
	const SphereBox* box = nullptr;
	double skin = 0;
	float rounding = 0;  // by how much the columns may be wrong [m]
	std::vector<float> column[4];
	std::vector<HeldPair> held_pairs;

	void fill_columns(std::uint32_t n_free);
	void around_held(std::uint32_t held, double largest_radius);
	void beyond_tile(std::uint32_t a, const CellPlace& at, std::vector<Partner>& partners) const;
};

}  // namespace graindrive::loop
