/// GrainLoop: makes the running loop of YADE's disks and steps it.
#include "engines/loop/GrainLoop.hpp"

#include <algorithm>

#include "engines/seam/without_python.hpp"

namespace graindrive {

const char* const GrainLoop::documentation =
	"Collider, contact law and integrator in one, for disks in the plane z = const: the "
	"same physics as YADE's loop with the Law2_ functor\n"
	"of the same name, many times faster.\n\n"
	"Stands in O.engines where NewtonIntegrator would, after measures and drives: O.engines = "
	"[ContactForceBinner(...), OscillationDrive(...), GrainLoop(...)].\n"
	"Clumps, and disks that are driven, partly blocked, large or `watched`, are written "
	"to YADE at every step; all others where somebody may look: at the end of\n"
	"O.run, before engines that read bodies (PyRunner, recorders, engines of your own), every `syncEvery` steps and by sync(). "
	"What\n"
	"they write into bodies, forces that are added to O.forces, and settings of the loop are heard at once. Orientations of free "
	"disks\n"
	"are not kept. Raises ValueError for shapes other than disks, a time step above the "
	"critical one and numbers out of range; a guard\n"
	"stops the run where grains overlap by more than `largestOverlap` of a radius or leave the box (see `bounds`).";

loop::ContactLaw GrainLoop::contact_law() const
{
	const auto made = [&](const auto& kind) -> loop::ContactLaw {
		using Law = std::decay_t<decltype(kind)>;
		typename Law::Given given;
		Law::Given::quantities([&](const laws::Quantity& q, auto member) { given.*member = number(q.name); });
		return Law::of(given, friction);
	};
	return std::visit(made, laws::law_named(law));
}

/// The attribute of that name.
Real GrainLoop::number(const std::string& name) const
{
	const Real* found = nullptr;
	attributes([&](const char* attribute, auto member, const char*) {
		if constexpr (std::is_same_v<decltype(member), Real GrainLoop::*>)
			if (name == attribute) found = &(this->*member);
	});
	if (!found) throw std::logic_error("GrainLoop has no attribute " + name + ", which a law of the registry takes");
	return *found;
}

loop::Scene GrainLoop::settings() const
{
	loop::Scene s;
	s.law = contact_law();
	s.friction = friction > 0;
	s.gravity_x = gravity[0], s.gravity_y = gravity[1];
	s.damping = damping, s.damps_gravity = dampGravity;
	s.dt = scene->dt;
	s.precision = precision == "single" ? loop::Precision::single : loop::Precision::double_;
	s.threads = threads;
	s.skin = skin;
	s.box = { 0, periods[0], 0, periods[1], periods[0] > 0, periods[1] > 0 };
	return s;
}

void GrainLoop::require_scene()
{
	require_cell();
	require_periods();
	meet_engines();
	loop::Scene read;
	loop::read_yade(*scene, watched, read);
	forces_reset_at_ = scene->forces.syncCount;
}

void GrainLoop::build()
{
	loop::Scene s = settings();
	require_cell();
	require_periods();
	meet_engines();
	s.walls = walls();
	s.target_area_fraction = targetAreaFraction;
	map_ = loop::read_yade(*scene, watched, s);
	stepper_ = std::make_unique<loop::Stepper>(s);
	stepper_->set_springs(kept_springs());
	stepper_->track_energy(trackEnergy);
	bring_walls();
	read_from_ = scene;
	if (forces_reset_at_ < 0) forces_reset_at_ = scene->forces.syncCount;  // YADE's last step may have left its forces there
	stepper_->speak_of(map_.grain_id, scene->iter);
	note_what_was_built();
	require_spread();
}

void GrainLoop::note_what_was_built()
{
	built_watched_ = watched, built_periods_ = periods;
	if (scene->isPeriodic) built_cell_ = scene->cell->hSize;
	settings_changed_ = pushed_ = open_ = false;
	written_.clear();
	counted_.clear();
	for (const int id : map_.body_id) counted_.push_back(id < 0 ? Counted{} : counted(id));
	materials_.clear();
	for (const int id : map_.grain_id) {
		const auto& material = (*scene->bodies)[id]->material;
		const auto* known = dynamic_cast<const yade::FrictMat*>(material.get());
		const auto same = [&](const KnownMaterial& one) { return one.material == material; };
		if (known && std::none_of(materials_.begin(), materials_.end(), same))
			materials_.push_back({ material, known->young, known->poisson, known->frictionAngle });
	}
}

void GrainLoop::bring_guards()
{
	loop::Guards& guards = stepper_->guarding();
	guards.largest_overlap = largestOverlap;
	guards.bounded = !bounds.empty();
	if (guards.bounded) guards.x_low = bounds[0], guards.y_low = bounds[1], guards.x_high = bounds[2], guards.y_high = bounds[3];
}

loop::Stepper& GrainLoop::stepper()
{
	if (!scene) throw std::runtime_error("GrainLoop is in no scene yet; put it into O.engines and run a step first");
	require_cell();
	if (!stepper_ || read_from_ != scene) build();
	if (map_.known_bodies != scene->bodies->size())
		throw std::runtime_error(
			"GrainLoop: bodies were added to or removed from O.bodies; call sync() before and read() after such a change");
	hear_settings();
	hear_bodies();
	bring_guards();
	stepper_->target_area_fraction() = targetAreaFraction;
	if (!stepper_->step_under_way()) stepper_->track_energy(trackEnergy);
	if (stepper_->settings().dt != scene->dt) stepper_->set_time_step(scene->dt);
	return *stepper_;
}

/// Does the work; if a guard trips, everyone can see in O.bodies what went wrong.
template <class Work>
void GrainLoop::guarded(Work work)
{
	try {
		work();
	} catch (...) {
		write_bodies();
		sync();
		throw;
	}
}

void GrainLoop::compute_body_forces()
{
	guarded([&] { stepper_->compute_body_forces(); });
}

GrainLoop::Turn GrainLoop::take_turn() const
{
	Turn turn(busy_, std::try_to_lock);
	if (turn) return turn;
	const seam::WithoutPython released;  // a step that ends may need it
	turn.lock();
	return turn;
}

/// YADE's O.run(..., True) loses the error of a step that fails before it has begun to wait for it; it waits without Python's lock.
void GrainLoop::action()
{
	try {
		make_step();
	} catch (...) {
		seam::wait_for_python();
		throw;
	}
}

void GrainLoop::make_step()
{
	const Turn turn = take_turn();
	meet_engines();
	stepper();
	const bool look_at_all = scene->stopAtIter != run_end_ || scene->iter % 100 == 0;
	run_end_ = scene->stopAtIter;
	require_bodies(look_at_all);
	require_materials();
	if (look_at_all) require_spread();
	read_anew_what_changed();
	compute_body_forces();
	follow_bodies();
	take_outside_forces();
	open_ = false;
	guarded([&] { stepper_->step(1); });
	write_bodies();
	if (someone_may_look()) sync();
}

bool GrainLoop::last_step_of_run() const
{
	return (scene->stopAtIter > 0 && scene->iter + 1 >= scene->stopAtIter) ||
	       (scene->stopAtTime > 0 && scene->time + scene->dt >= scene->stopAtTime) ||
	       !Singleton<yade::Omega>::instance().isRunning();
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_GUID(graindrive::GrainLoop, "GrainLoop")
