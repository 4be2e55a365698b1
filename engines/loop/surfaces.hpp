/// Contacts of grains with flat walls and solids, from distance and normal, with the same law and history as all other contacts.
///
/// A surface counts as a plane: R_eff = R, and m_eff = m with a surface that does not respond. Few grains are at a surface, so one
/// thread does it: forces are computed before the grains move, and applied to free grains after the sweep. On a grain a force acts at
/// its own radius, on a solid at the middle of the overlap, like YADE's contact point.
#pragma once
#include "engines/loop/views.hpp"

namespace graindrive::loop {

template <int D>
class Surfaces {
public:
	Surfaces(State<D>& of, const StepMotion<D>& in) : state(of), motion(in) {}

	bool any() const { return !state.scene.walls.empty() || !state.scene.solids.empty(); }
	/// The list of near grains is made again at the next step.
	void forget_list() { largest_way = HUGE_VAL; }
	/// True if a solid was moved since the last step; the list is then made again.
	bool moved_by_hand();
	/// Stores the positions of solids after a step.
	void remember_places();
	/// Called before pairs are selected again; `farthest` is the largest distance that a grain has moved since the last time [m].
	void note_selection(double farthest) { largest_way += farthest; }
	/// Lists grains near surfaces again if a grain outside the list may have reached a surface; until pairs are selected again no grain
	/// moves farther than `to_come` [m].
	void list(double to_come);
	void compute_forces();
	void take_back();
	/// Adds to bodies the forces of surfaces on their members, and the forces of grains on their surfaces.
	void add_to_bodies();
	/// kick(row, force, torque over radius) for each free grain that touches.
	template <class Kick>
	void kick_grains(const Kick& kick) const;
	/// Walls move, by their own rule; solids move with their bodies.
	void move();

	Placement<D> placement_of(const SurfaceTouch<D>& touch) const;
	/// Velocity of the surface where the grain touched it when forces were computed [m/s].
	SurfaceMotion<D> motion_at(const SurfaceTouch<D>& touch) const;
	Vec<D> force_on_grain(const SurfaceTouch<D>& touch) const;
	double effective_mass_at(const SurfaceTouch<D>& touch) const;
	bool is_wall(std::uint32_t surface) const { return surface < state.scene.walls.size(); }
	const Solid<D>& solid(std::uint32_t surface) const { return state.scene.solids[surface - state.scene.walls.size()]; }
	/// The image of a point that is nearest to the solid's middle, with its body where it is, or was.
	Vec<D> seen_from_solid(std::uint32_t surface, const RigidBody<D>& body, const Vec<D>& point) const;
	std::string name_of_surface(std::uint32_t surface) const;

private:
	State<D>& state;
	const StepMotion<D>& motion;
	double reach = 0;                               // of the list [m]
	double largest_way = HUGE_VAL;                  // of any grain since the list was made, up to the last selection [m]
	std::vector<double> surface_way;                // of each surface since then [m]
	std::vector<geometry::RigidMotion<D>> left_at;  // solids, by the last step
	std::vector<double> farthest_grain;             // of each solid: from its place, with a diameter to go [m]

	std::size_t count() const { return state.scene.walls.size() + state.scene.solids.size(); }
	bool may_touch(std::uint32_t surface, std::uint32_t grain) const;
	/// From the solid's place to where the grain touches it, at present [m].
	Vec<D> arm_of(const SurfaceTouch<D>& touch) const;
	double speed_of(std::uint32_t surface) const;
	void measure_spread();
};

template <int D>
template <class Kick>
void Surfaces<D>::kick_grains(const Kick& kick) const
{
	for (const SurfaceTouch<D>& touch : state.touches)
		if (touch.overlap > 0 && state.is_free(touch.grain))
			kick(state.row_of[touch.grain], force_on_grain(touch), turning(touch.normal, touch.friction));
}

/// @throws std::invalid_argument naming the wall or solid and the rule
template <int D>
void check_surfaces(const Scene<D>& scene);

}  // namespace graindrive::loop
