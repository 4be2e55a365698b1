/// What GrainLoop hears at every step: forces from outside, settings that were changed, the cell.
#include "engines/loop/GrainLoop.hpp"

namespace graindrive {

namespace {

constexpr const char* kept_by_the_loop[] = { "springs", "wallSprings", "wallSettings" };

}  // namespace

/// Forces that engines and O.forces added since the last step act in this one, as NewtonIntegrator applies them: on disks that are
/// free, on bodies, and on clumps with those on their members. Then the container is emptied, which is ForceResetter's work.
void GrainLoop::take_outside_forces()
{
	yade::ForceContainer& forces = scene->forces;
	forces.sync();
	const bool added = forces.syncCount != forces_reset_at_;  // someone else may have summed them up before
	if (!added && !pushed_) return;
	std::vector<loop::Push> pushes;
	for (loop::RigidBody& body : stepper_->bodies()) body.push_x = body.push_y = body.push_torque = 0;
	if (added) {
		for (std::size_t id = 0; id < map_.grain_of_id.size(); ++id)
			if (scene->bodies->exists(int(id))) push_with(int(id), forces.getForce(int(id)), forces.getTorque(int(id)), pushes);
		forces.reset(scene->iter);
		forces_reset_at_ = forces.syncCount;
	}
	stepper_->set_pushes(std::move(pushes));
	pushed_ = added;
}

void GrainLoop::push_with(int id, const Vector3r& force, const Vector3r& torque, std::vector<loop::Push>& pushes)
{
	if (force.isZero(0) && torque.isZero(0)) return;
	if (!force.allFinite() || !torque.allFinite())
		throw std::runtime_error("GrainLoop: the force from outside on body " + std::to_string(id) +
								 " is not finite; look for the engine or the O.forces call that adds it");
	const auto refuse_off_plane = [&](unsigned free_in, Real part, const char* what) {
		const yade::State& state = *(*scene->bodies)[id]->state;
		if (part == 0 || (state.blockedDOFs & free_in)) return;
		throw std::runtime_error(
			"GrainLoop: the " + std::string(what) + " from outside on body " + std::to_string(id) +
			" would move it out of the plane; block its z, X and Y (blockedDOFs='zXY') or leave that part out");
	};
	const int g = map_.grain_of_id[id];
	const int owner = g >= 0 ? stepper_->settings().grains[g].body : map_.body_of_id[id];
	refuse_off_plane(yade::State::DOF_Z, force[2], "force");
	refuse_off_plane(yade::State::DOF_RX, torque[0], "torque");
	refuse_off_plane(yade::State::DOF_RY, torque[1], "torque");
	if (g >= 0 && owner == loop::free_grain) {
		pushes.push_back({ std::uint32_t(g), force[0], force[1], torque[2] });
		return;
	}
	if (owner < 0 || map_.body_id[owner] < 0) return;  // frozen: it answers to no force
	loop::RigidBody& body = stepper_->bodies()[owner];
	body.push_x += force[0];
	body.push_y += force[1];
	body.push_torque += torque[2];
	if (g < 0 || map_.body_id[owner] == id) return;
	const Vector2r arm = stepper_->arm(g);  // of a clump's member
	body.push_torque += arm[0] * force[1] - arm[1] * force[0];
}

/// Called by the property that was set. What the loop keeps for O.save cannot be set under its feet.
void GrainLoop::assigned(const std::string& name)
{
	for (const char* kept : kept_by_the_loop)
		if (stepper_ && name == kept)
			throw std::invalid_argument(
				"GrainLoop." + name +
				" is kept by the running loop and cannot be set; use setWall, or call sync(), set it after "
				"read() and go on");
	settings_changed_ = true;
}

/// Goes on with settings that Python changed: what the kernels use is changed in the running loop, what decides who is a body by
/// reading the scene anew.
void GrainLoop::hear_settings()
{
	if (!settings_changed_) return;
	settings_changed_ = false;
	if (watched != built_watched_ || periods != built_periods_) {
		stepper_->take_back_body_forces();
		sync();
		build();
		return;
	}
	stepper_->change(settings());
	bring_loads();
	met_engines_.clear();  // `trusted` may be another
}

/// YADE's cell may deform; GrainLoop's box may not.
void GrainLoop::require_cell()
{
	if (!scene->isPeriodic) return;
	const yade::Cell& cell = *scene->cell;
	if (!cell.velGrad.isZero(0) || !cell.nextVelGrad.isZero(0))
		throw std::invalid_argument(
			"GrainLoop: O.cell.velGrad deforms the cell, which GrainLoop does not do; set it to zero, or use YADE's loop");
	Eigen::Matrix<Real, 3, 3> off_diagonal = cell.hSize;
	off_diagonal.diagonal().setZero();
	if (!off_diagonal.isZero(0))
		throw std::invalid_argument("GrainLoop: O.cell is tilted (its hSize has parts off the diagonal); only a box that is not "
									"sheared can be taken over: O.cell.setBox(x, y, z)");
	if (stepper_ && cell.hSize != built_cell_) require_periods();
}

}  // namespace graindrive
