/// Collects the energy ledger's data of a step: stored before the grains move, booked after they have moved.
#pragma once
#include "engines/loop/energy_ledger.hpp"
#include "engines/loop/surfaces.hpp"

namespace graindrive::loop {

/// @throws std::invalid_argument for a scene in which some force has no exact entry
template <int D>
void require_explicable(const Scene<D>& scene);

template <int D>
class Books {
public:
	Books(const State<D>& of, const Surfaces<D>& with)
		: ledger(of.scene.law, of.scene.friction, of.scene.dt),
		  state(of),
		  surfaces(with)
	{
	}

	EnergyLedger<D> ledger;

	/// Before anything moves.
	template <class Neighbours>
	void remember(const Neighbours& pairs);
	/// When all has moved; the cell and its images are still as they were.
	void book();

private:
	const State<D>& state;
	const Surfaces<D>& surfaces;
	RowVector<D> rows;  // as they were when the forces of the step were computed
	std::vector<RigidBody<D>> bodies;
	std::vector<Wall<D>> walls;
	struct Pair {
		std::uint32_t first, second;
		Tangent<D> slip;
	};
	std::vector<Pair> selected;
	std::vector<MetContact<D>> met;

	SurfaceMotion<D> motion_after(std::uint32_t row) const;
	void meet(std::uint64_t key, const Placement<D>& at, double radius, double mass, const RelativeMotion<D>& before,
		const RelativeMotion<D>& after, const Tangent<D>& slip, const Vec<D>& image_before = {}, const Vec<D>& image_after = {});
	void meet_pairs();
	void meet_surfaces(LedgerMotion& motion);
	void meet_surface(const SurfaceTouch<D>& touch);
	void move_grains(LedgerMotion& motion) const;
	void move_bodies(LedgerMotion& motion) const;
	void deform_cell(LedgerMotion& motion) const;
	void weigh(LedgerMotion& motion, double mass, const Vec<D>& place, const Vec<D>& v, const Vec<D>& v_after,
		const std::array<bool, D>& along) const;
};

template <int D>
template <class Neighbours>
void Books<D>::remember(const Neighbours& pairs)
{
	rows = state.rows, bodies = state.scene.bodies, walls = state.scene.walls;
	selected.clear();
	if constexpr (D == 2)
		pairs.each_selected([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
			selected.push_back({ a, b, pairs.spring(c) });
		});
	else
		pairs.each_spring([&](std::uint32_t a, std::uint32_t b, const Vec<3>& slip) { selected.push_back({ a, b, slip }); });
}

}  // namespace graindrive::loop
