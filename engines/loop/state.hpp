/// The complete state of a run as one value: its copies are used for checkpoints, trial steps, and to return to an earlier state.
#pragma once
#include <limits>
#include <vector>

#include "engines/loop/disks/disk_pair_state.hpp"
#include "engines/loop/grain_rows.hpp"
#include "engines/loop/scene.hpp"
#include "engines/loop/spheres/sphere_pair_state.hpp"

namespace graindrive::loop {

/// A grain that moves with its body.
template <int D>
struct Member {
	Vec<D> at;     ///< from the body's place, in its frame [m]
	Vec<D> shift;  ///< from the body's image to the one in the cell [m]
	int body;      ///< index in `Scene::bodies`
};

/// How a sheared cell deforms in a step, and what that does to grains at once.
template <int D>
struct Flow {
	Vec<D> image_velocity;  ///< of the image one period further across the flow [m/s]
	Spin<D> spin{};         ///< what all grains' spins gain in this step, where the shear rate changes [rad/s]
};

/// A force and a torque from outside on a free grain.
template <int D>
struct Push {
	std::uint32_t grain;  ///< index in `Scene::grains`
	Vec<D> force;         ///< [N]
	Spin<D> torque;       ///< [N m]
};

/// A grain at a surface or near it: a flat wall, or a solid. The spring follows the grain, wherever its row is moved.
template <int D>
struct SurfaceTouch {
	std::uint32_t surface = 0, grain = 0;  ///< place among walls, then solids; index in `Scene::grains`
	Spin<D> slip{};                        ///< tangential spring [m]
	Spin<D> slip_before{};                 ///< the same before the last step [m]
	Vec<D> spring_normal;         ///< into the surface when the spring was last lengthened; of no length before the first touch
	Vec<D> spring_normal_before;  ///< the same before the last step
	Vec<D> normal;                ///< into the surface, at the last step
	Vec<D> arm;                   ///< from a solid's place to where they touch, at the last step [m]
	double overlap = 0;           ///< [m], <= 0 where they do not touch
	double pressing = 0;          ///< F_n > 0 repels [N]
	Spin<D> friction{};           ///< F_t on the grain, in the plane along z x n [N]
};

/// How a step is checked while it runs.
template <int D>
struct Guards {
	long every = 100;              ///< steps between two looks at every pair, at most: every search looks, too; 0: never
	double largest_overlap = 0.1;  ///< of the smaller radius [-]
	bool bounded = false;          ///< the caller says where grains may be, below; else a base says how far they may fall
	Vec<D> low, high;              ///< [m]; no bound along an axis where both are equal
};

template <int D>
using PairState = std::conditional_t<D == 2, DiskPairState, SpherePairState>;

template <int D>
struct State {
	Scene<D> scene;  ///< settings, bodies and walls as they are now; grains as they were given
	long steps = 0, searches = 0, selections = 0;

	RowVector<D> rows;                      ///< free grains by cell, members of bodies, then dummies that fill up packs
	StreamedVector<double> inverse_masses;  ///< by row [1/kg], in space; in the plane they stand in the rows
	std::vector<std::uint32_t> index_of;    ///< row -> index in Scene::grains
	std::vector<Member<D>> members;         ///< in the order of their rows
	std::vector<char> body_fixed;           ///< by body: never moves

	PairState<D> pairs;               ///< candidates and their springs
	std::vector<double> searched_at;  ///< places at the last search [m]
	double skin = 0;                  ///< of the last search [m]

	// Budgets of motion, of blocks of free grains and then of bodies (budgets.hpp).
	std::vector<double> travelled, allowed;  ///< bound on the way since the last selection, its limit [m]
	std::vector<Vec<D>> drifts;              ///< velocity against which these are meant [m/s], in space
	long selected_at = 0;                    ///< step of the last selection
	double horizon = 0;                      ///< how long that may last at most [s], in space
	double pace = 40;                        ///< steps between selections that budgets are made for
	bool selection_due = true;

	// Images across a sheared side move by themselves; in the plane.
	Flow<D> flow;                               ///< of the cell in the step that comes
	double images_went = 0, images_may_go = 0;  ///< since the last selection, and until the next one [m]
	double images_went_since_search = 0;        ///< [m]

	std::vector<SurfaceTouch<D>> touches;  ///< near surfaces: by surface, then by grain
	std::vector<Push<D>> pushes;
	Guards<D> guards;

	// Derived from the above, and not part of a checkpoint.
	std::uint32_t n_free = 0, n = 0;          ///< free grains; all grains
	std::vector<std::uint32_t> row_of;        ///< index in Scene::grains -> row
	std::vector<std::uint32_t> first_member;  ///< of each body, and the end
	std::vector<double> reach;                ///< of each body: farthest point of a member from its place [m]
	std::vector<Vec<D>> middles;              ///< of solids, in their frames [m]
	double typical_diameter = 0, largest_free_radius = 0;

	/// Computes what follows from the rest.
	void derive();

	std::uint32_t n_blocks() const { return (n_free + grains_per_block - 1) / grains_per_block; }
	/// Index of a grain's block or body among the budgets.
	std::uint32_t party_of(std::uint32_t row) const
	{
		return row < n_free ? row / grains_per_block : n_blocks() + members[row - n_free].body;
	}
	double inverse_mass(std::uint32_t row) const
	{
		if constexpr (D == 2)
			return rows[row].inverse_mass;
		else
			return inverse_masses[row];
	}
	bool is_free(std::uint32_t grain) const { return scene.grains[grain].body == free_grain; }
	/// True if no force decides where the grain goes.
	bool is_led(std::uint32_t row) const
	{
		return row >= n_free && !scene.bodies[members[row - n_free].body].responds_somewhere();
	}
};

/// True if a sheared cell flows otherwise in the step that comes than in the last one.
template <int D>
bool changes_flow(const State<D>& state)
{
	return state.scene.cell.sheared() &&
	       (state.flow.image_velocity != state.scene.cell.image_velocity() || state.flow.spin != Spin<D>{});
}

/// What the velocity of a grain gains where the flow changes [m/s]: its height over the period times what the image gains there, so
/// that a grain and its images gain the same against the mean flow.
template <int D>
Vec<D> flow_kick(const State<D>& state, const Vec<D>& at)
{
	const Cell<D>& cell = state.scene.cell;
	const double height = (at[cell.across] - cell.low[cell.across]) / cell.length(cell.across);
	return height * (state.flow.image_velocity - cell.image_velocity());
}

/// Hands every part of a state to `visit`, in one order: what Packer and Unpacker make a file of. How many threads work decides nothing.
template <class Visitor, class AState>
void visit_state(Visitor&& visit, AState& s)
{
	auto& scene = s.scene;
	visit(scene.grains), visit(scene.bodies), visit(scene.walls), visit(scene.cell);
	visit_law(visit, scene.law);
	visit_solids(visit, scene.solids);
	visit(scene.friction), visit(scene.rotation), visit(scene.gravity), visit(scene.damping), visit(scene.damps_gravity),
		visit(scene.dt), visit(scene.precision), visit(scene.spin_response), visit(scene.skin), visit(scene.target_fraction);
	visit(s.steps), visit(s.searches), visit(s.selections);
	visit(s.rows), visit(s.inverse_masses), visit(s.index_of), visit(s.members), visit(s.body_fixed);
	s.pairs.visit(visit);
	visit(s.searched_at), visit(s.skin);
	visit(s.travelled), visit(s.allowed), visit(s.drifts), visit(s.selected_at), visit(s.horizon), visit(s.pace),
		visit(s.selection_due);
	visit(s.flow), visit(s.images_went), visit(s.images_may_go), visit(s.images_went_since_search);
	visit(s.touches), visit(s.pushes), visit(s.guards);
}

}  // namespace graindrive::loop
