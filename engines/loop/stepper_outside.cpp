/// What comes from outside while a run goes on: forces on grains and bodies, other settings, grains that were moved.
///
/// Leapfrog is linear in the force, so a kick that comes after the sweep's own moves a grain as if all forces had been added first.
#include <cmath>
#include <stdexcept>

#include "engines/loop/guards.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

/// One free grain after the sweep; `surface_force` is torque over radius [N].
void Stepper::kick_grain(std::uint32_t at, double force_x, double force_y, double surface_force)
{
	GrainRow& row = state.rows[at];
	const double response = row.inverse_mass * data.kick, kick_x = force_x * response, kick_y = force_y * response;
	row.vx += kick_x;
	row.vy += kick_y;
	row.x += kick_x * data.drift;
	row.y += kick_y * data.drift;
	row.surface_speed += surface_force * response * data.spin_response;
	const std::uint32_t block = party_of(at);
	state.travelled[block] += std::hypot(kick_x, kick_y) * data.drift;  // on top of what the sweep has counted
	state.selection_due |= state.travelled[block] > state.allowed[block];
}

/// Damping acts on the sum of all forces, so the sweep must know those of walls and pushes; without damping they come after it.
void Stepper::hand_outside_forces_over()
{
	data.outside = nullptr;
	if (data.damping == 0 || (state.wall_touches.empty() && state.pushes.empty())) return;
	outside.assign(n_free, {});
	for (const WallTouch& touch : state.wall_touches) {
		if (!(touch.overlap > 0) || state.scene.grains[touch.grain].body != free_grain) continue;
		const laws::Planar<double> by_wall = force_of_wall(touch);
		OutsideForce& force = outside[row_of[touch.grain]];
		force.x += by_wall.x;
		force.y += by_wall.y;
		force.turning += touch.friction;
	}
	for (const Push& push : state.pushes) {
		OutsideForce& force = outside[row_of[push.grain]];
		force.x += push.x;
		force.y += push.y;
		force.turning += push.torque / state.rows[row_of[push.grain]].radius;
	}
	data.outside = outside.data();
}

void Stepper::push_grains()
{
	if (data.outside) return;  // the sweep has done it
	for (const Push& push : state.pushes) {
		const std::uint32_t at = row_of[push.grain];
		kick_grain(at, push.x, push.y, push.torque / state.rows[at].radius);
	}
}

void Stepper::set_pushes(std::vector<Push> on_grains)
{
	for (const Push& push : on_grains)
		if (push.grain >= n_grains || state.scene.grains[push.grain].body != free_grain)
			throw std::invalid_argument(sentence("a push acts on a free grain; got grain ", push.grain));
	state.pushes = std::move(on_grains);
	if (body_forces_known) hand_outside_forces_over();
}

/// Springs and forces of the pairs that were computed early go back to where they were, so that those can be computed again.
void Stepper::take_back_body_forces()
{
	if (!body_forces_known) return;
	pairs.put_back_early_pairs();
	for (WallTouch& touch : state.wall_touches) touch.slip = touch.slip_before;
	body_forces_known = false;
}

void Stepper::put(std::size_t index, const Grain& grain)
{
	GrainRow& row = state.rows[row_of[index]];
	const bool elsewhere = row.x != grain.x || row.y != grain.y;
	row.x = grain.x, row.y = grain.y, row.vx = grain.vx, row.vy = grain.vy;
	row.surface_speed = grain.spin * grain.radius;
	if (!elsewhere) return;
	state.searched_at.assign(state.searched_at.size(), HUGE_VAL);  // whoever was near is no guide any more
	state.moved_near_walls = HUGE_VAL;
	state.selection_due = true;
}

void Stepper::change(const Scene& wanted)
{
	Scene changed = state.scene;
	changed.law = wanted.law, changed.friction = wanted.friction, changed.precision = wanted.precision;
	changed.gravity_x = wanted.gravity_x, changed.gravity_y = wanted.gravity_y;
	changed.threads = wanted.threads, changed.skin = wanted.skin;
	changed.damping = wanted.damping, changed.damps_gravity = wanted.damps_gravity;
	const bool other_physics = !same(changed.law, state.scene.law) || changed.friction != state.scene.friction ||
	                           changed.gravity_x != state.scene.gravity_x || changed.gravity_y != state.scene.gravity_y ||
	                           changed.damping != state.scene.damping;
	if (books && other_physics)
		throw std::invalid_argument(
			"law, friction, gravity and damping must stay while energy is tracked; switch trackEnergy off and on again");
	check_scene(changed);
	check_walls(changed);
	take_back_body_forces();
	if (state.selections > 0) pairs.keep_slips();
	const bool other_springs = !changed.friction || changed.law.index() != state.scene.law.index();
	state.scene = std::move(changed);
	if (other_springs) forget_springs();
	set_up_kernels();
	if (state.selections > 0) lay_out_pairs();
}

}  // namespace graindrive::loop
