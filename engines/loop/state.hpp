/// Everything that decides how a run goes on, as one value: its copies are checkpoints, trial steps, and what a run goes back to.
#pragma once
#include <limits>
#include <vector>

#include "engines/loop/pair_search.hpp"

namespace graindrive::loop {

/// A grain that moves with its body.
struct Member {
	double x, y;              ///< from the body's centre at angle 0 [m]
	double shift_x, shift_y;  ///< from the body's image to the one in the box [m]
	int body;                 ///< index in `Scene::bodies`
};

/// A force and a torque from outside on a free grain.
struct Push {
	std::uint32_t grain;  ///< index in `Scene::grains`
	double x, y, torque;  ///< [N], [N m]
};

/// How a step is checked while it runs.
struct Guards {
	long every = 100;              ///< steps between two looks at every pair
	double largest_overlap = 0.1;  ///< of the smaller radius [-]
	bool bounded = false;          ///< the caller says where grains may be, below; else a base says how far they may fall
	double x_low = 0, y_low = 0, x_high = 0, y_high = 0;  ///< [m]; no bound along an axis where both are equal
};

/// What a loop can compute from these it does not keep here: layout of pairs, slots, radii of bodies, bounds on speeds.
struct State {
	Scene scene;  ///< settings, bodies and walls as they are now; grains as they were given
	long steps = 0, searches = 0, selections = 0;

	AlignedVector<GrainRow> rows;         ///< free grains by cell, members of bodies, two dummies
	std::vector<std::uint32_t> index_of;  ///< place in memory -> index in Scene::grains
	std::vector<Member> members;          ///< in the order of their rows
	std::vector<char> body_fixed;         ///< by body: never moves

	std::vector<Candidate> candidates;  ///< pairs and their springs
	std::vector<double> searched_at;    ///< x, y of grains at the last search [m]
	double skin = 0;                    ///< of the last search [m]

	// Budgets of motion, of blocks of free grains and then of bodies (stepper_budgets.cpp).
	std::vector<double> travelled, allowed;  ///< bound on the way since the last selection, its limit [m]
	double pace = 40;                        ///< steps between selections that budgets are made for
	bool selection_due = true;

	std::vector<WallTouch> wall_touches;                                ///< near walls: by wall, then by grain
	double moved_near_walls = std::numeric_limits<double>::infinity();  ///< bound on the way since they were listed [m]
	std::vector<Push> pushes;
	Guards guards;
};

/// Hands every part of a state to `visit`, in one order: what Packer and Unpacker make a file of. How many threads work decides nothing.
template <class Visitor, class AState>
void visit_state(Visitor&& visit, AState& s)
{
	auto& scene = s.scene;
	visit(scene.grains), visit(scene.bodies), visit(scene.walls), visit(scene.box);
	visit_law(visit, scene.law);
	visit(scene.friction), visit(scene.rotation), visit(scene.gravity_x), visit(scene.gravity_y), visit(scene.damping),
		visit(scene.damps_gravity), visit(scene.dt), visit(scene.precision), visit(scene.spin_response), visit(scene.skin),
		visit(scene.target_area_fraction);
	visit(s.steps), visit(s.searches), visit(s.selections);
	visit(s.rows), visit(s.index_of), visit(s.members), visit(s.body_fixed);
	visit(s.candidates), visit(s.searched_at), visit(s.skin);
	visit(s.travelled), visit(s.allowed), visit(s.pace), visit(s.selection_due);
	visit(s.wall_touches), visit(s.moved_near_walls), visit(s.pushes), visit(s.guards);
}

}  // namespace graindrive::loop
