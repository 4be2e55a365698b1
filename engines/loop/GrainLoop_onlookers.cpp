/// Who else may read or change bodies: GrainLoop writes all of them for those who may, and hears what they wrote.
#include <algorithm>
#include <cstring>
#include <map>

#include "engines/loop/GrainLoop.hpp"
#include "engines/seam/onlookers.hpp"

namespace graindrive {

namespace {

bool is_rival(const std::string& name)
{
	return name == GrainLoop::class_name || name == "NewtonIntegrator" || name == "InteractionLoop";
}

}  // namespace

/// Looks at O.engines where it has changed: two integrators would move everything twice, and what an unknown engine needs is unknown.
void GrainLoop::meet_engines()
{
	std::vector<const yade::Engine*> here;
	for (const auto& engine : scene->engines) here.push_back(engine.get());
	std::vector<bool> dead;
	for (const auto& engine : scene->engines) dead.push_back(engine->dead);
	if (here == met_engines_ && dead == met_dead_) return;
	onlookers_.clear();
	bool behind = false;
	for (const auto& engine : scene->engines) {
		if (engine.get() == this) {
			behind = true;
			continue;
		}
		const std::string name = engine->getClassName();
		if (engine->dead && is_rival(name)) continue;
		if (is_rival(name))
			throw std::runtime_error(
				"GrainLoop takes the place of collider, InteractionLoop and NewtonIntegrator; O.engines also holds " + name +
				": remove it");
		const Reach reach = reach_of(*engine, trusted);
		if (reach == Reach::unknown && !engine->dead)
			throw std::runtime_error("GrainLoop does not know what " + name +
									 " needs: it may read interactions, which YADE does not keep here; remove it "
									 "from O.engines, use YADE's loop, or add its name to GrainLoop.trusted if it only reads and "
									 "changes bodies and adds "
									 "forces");
		if (reach == Reach::all_bodies) onlookers_.push_back({ engine.get(), behind });
	}
	met_engines_ = here, met_dead_ = dead;
}

/// After a step: will somebody look at bodies before the next one? Then they must be true.
bool GrainLoop::someone_may_look() const
{
	if (last_step_of_run() || (syncEvery > 0 && (scene->iter + 1) % syncEvery == 0)) return true;
	for (const Onlooker& one : onlookers_)
		if (one.behind ? may_act(*one.engine, scene->iter, scene->time)
					   : may_act(*one.engine, scene->iter + 1, scene->time + scene->dt))
			return true;
	return false;
}

bool GrainLoop::Written::operator==(const Written& other) const { return std::memcmp(this, &other, sizeof *this) == 0; }

GrainLoop::Written GrainLoop::written_in(const yade::Body& body)
{
	if (!body.state || !body.shape)
		throw std::runtime_error(
			"GrainLoop: body " + std::to_string(body.id) + " has lost its shape or its state; put it back, or erase the body");
	const yade::State& s = *body.state;
	Written w{};
	w.x = s.pos[0], w.y = s.pos[1], w.vx = s.vel[0], w.vy = s.vel[1], w.spin = s.angVel[2];
	w.z = s.pos[2], w.vz = s.vel[2], w.spin_x = s.angVel[0], w.spin_y = s.angVel[1];
	w.mass = s.mass, w.inertia = s.inertia[2];
	w.radius = static_cast<const yade::Sphere&>(*body.shape).radius;
	w.blocked = s.blockedDOFs, w.mask = body.groupMask, w.clump = body.clumpId, w.flags = body.flags;
	w.material = body.material.get(), w.damped = s.isDamped;
	return w;
}

bool GrainLoop::is_member_or_body(std::size_t g) const
{
	const int owner = stepper_->settings().grains[g].body;
	return owner != loop::free_grain && map_.body_id[owner] >= 0;
}

/// What stands in O.bodies now is what everyone was shown.
void GrainLoop::remember_what_is_written()
{
	written_.clear();
	for (const int id : map_.grain_id)
		written_.push_back(scene->bodies->exists(id) ? written_in(*(*scene->bodies)[id]) : Written{});
	open_ = true;
}

/// Hears what others wrote into grains since all were last shown: a motion at once, anything else by reading the scene anew.
void GrainLoop::hear_bodies()
{
	if (!open_) return;
	bool anew = false;
	std::vector<std::size_t> moved;
	for (std::size_t g = 0; g < written_.size(); ++g) {
		const int id = map_.grain_id[g];
		if (!scene->bodies->exists(id)) continue;  // require_bodies will say so
		Written now = written_in(*(*scene->bodies)[id]);
		const Written& then = written_[g];
		if (now == then) continue;
		if (now.material != then.material)
			throw std::runtime_error(
				"GrainLoop: body " + std::to_string(id) +
				" was given another material, which its contacts do not follow; assign GrainLoop.friction, young, "
				"... if they shall change, and then call read(), or use YADE's loop");
		const bool free = stepper_->settings().grains[g].body == loop::free_grain;
		if (is_member_or_body(g)) now.x = then.x, now.y = then.y;
		if (!free) {  // followed at every step, or looked at in read_anew_what_changed
			now.vx = then.vx, now.vy = then.vy, now.spin = then.spin;
			now.blocked = then.blocked;
		}
		const loop::Grain motion{ now.x, now.y, now.vx, now.vy, now.spin };
		if (free) now.x = then.x, now.y = then.y, now.vx = then.vx, now.vy = then.vy, now.spin = then.spin;
		if (!(now == then))
			anew = true;
		else if (free)
			moved.push_back(g), heard_motions_.push_back(motion);
	}
	if (anew) {
		heard_motions_.clear();
		build();
		remember_what_is_written();
		return;
	}
	if (moved.empty()) return;
	stepper_->take_back_body_forces();
	for (std::size_t k = 0; k < moved.size(); ++k) {
		loop::Grain grain = stepper_->grain(moved[k]);
		const loop::Grain& now = heard_motions_[k];
		const Written& then = written_[moved[k]];
		if (now.x != then.x || now.y != then.y) grain.x = now.x, grain.y = now.y;
		grain.vx = now.vx, grain.vy = now.vy, grain.spin = now.spin;
		stepper_->put(moved[k], grain);
		written_[moved[k]] = written_in(*(*scene->bodies)[map_.grain_id[moved[k]]]);
	}
	heard_motions_.clear();
}

/// A frozen disk that someone has set in motion becomes a body of its own. A body with another mass or inertia, or one that is held
/// or freed, counts otherwise in its pairs; one that was frozen and is driven counts as infinitely heavy as before. Either is heard
/// in the same step, whose contacts still see the velocities of the step before, as on YADE's loop.
void GrainLoop::read_anew_what_changed()
{
	if (!set_in_motion() && !counts_otherwise()) return;
	stepper_->take_back_body_forces();
	sync();
	std::map<int, loop::RigidBody> before;
	for (std::size_t b = 0; b < map_.body_id.size(); ++b) before[map_.body_id[b]] = stepper_->bodies()[b];
	build();
	for (std::size_t b = 0; b < map_.body_id.size(); ++b) {
		const loop::RigidBody was = before[map_.body_id[b]];  // at rest where it was among the frozen
		if (map_.body_id[b] >= 0) stepper_->set_velocity(b, was.vx, was.vy, was.spin);
	}
}

bool GrainLoop::set_in_motion() const
{
	const auto moves = [&](int id) { return scene->bodies->exists(id) && !loop::is_frozen(*(*scene->bodies)[id]->state); };
	return std::any_of(map_.frozen_id.begin(), map_.frozen_id.end(), moves);
}

GrainLoop::Counted GrainLoop::counted(int id) const
{
	const yade::State& state = *(*scene->bodies)[id]->state;
	return { state.mass, state.inertia[2], state.blockedDOFs == yade::State::DOF_ALL, state.isDamped };
}

bool GrainLoop::counts_otherwise() const
{
	for (std::size_t b = 0; b < counted_.size(); ++b) {
		if (map_.body_id[b] < 0) continue;
		const Counted now = counted(map_.body_id[b]), then = counted_[b];
		if (now.mass != then.mass || now.inertia != then.inertia || now.held != then.held || now.damped != then.damped)
			return true;
	}
	return false;
}

/// Contacts follow the loop's own constants: a material that is changed would change nothing.
void GrainLoop::require_materials() const
{
	for (const KnownMaterial& known : materials_) {
		const auto& now = static_cast<const yade::FrictMat&>(*known.material);
		if (now.young == known.young && now.poisson == known.poisson && now.frictionAngle == known.friction_angle) continue;
		throw std::runtime_error(
			"GrainLoop: the constants of material " + std::to_string(now.id) + " ('" + now.label +
			"') were changed, which its contacts do not follow; assign GrainLoop.friction, young, ... and then "
			"call read(), or use YADE's loop");
	}
}

}  // namespace graindrive
