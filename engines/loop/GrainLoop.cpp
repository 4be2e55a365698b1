/// GrainLoop: builds the running loop from YADE's bodies and steps it.
#include "engines/loop/GrainLoop.hpp"

#include <algorithm>

#include "engines/loop/yade_cell.hpp"
#include "engines/seam/without_python.hpp"

namespace graindrive {

const char* const GrainLoop::documentation =
	"Collider, contact law and integrator in one engine, for disks in the plane z = const or, with dimensions=3, for\n"
	"spheres in space: the same physics as YADE's loop with the Law2_ functor of the same name, many times faster.\n\n"
	"It stands in O.engines in the place of NewtonIntegrator, after measures and drives: O.engines =\n"
	"[ContactForceBinner(...), OscillationDrive(...), GrainLoop(...)]. Clumps, solids, and grains that are driven, partly\n"
	"blocked, large or `watched` are written to YADE at every step. All other grains are written when other code may read\n"
	"them: at the end of O.run, before engines that read bodies (PyRunner, recorders, your own engines), every `syncEvery`\n"
	"steps and by sync(). GrainLoop takes up at once what such engines write into bodies, forces that are added to\n"
	"O.forces, and changed settings of the loop. Orientations of free grains are not kept. Raises ValueError for shapes\n"
	"that it cannot move, a time step above the critical one and numbers out of range; a guard stops the run if grains\n"
	"overlap by more than `largestOverlap` of a radius or leave the box (see `bounds`).";

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

/// The value of the attribute with that name.
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

void GrainLoop::require_scene()
{
	require_cell();
	require_periods();
	meet_engines();
	loop::require_readable(*this);
	forces_reset_at = scene->forces.syncCount;
}

void GrainLoop::build()
{
	require_cell();
	require_periods();
	meet_engines();
	mirror_ = loop::mirror_of(*this);
	read_from_ = scene;
	if (forces_reset_at < 0) forces_reset_at = scene->forces.syncCount;  // YADE's last step may have left forces
	note_what_was_built();
}

void GrainLoop::note_what_was_built()
{
	built_watched_ = watched, built_periods_ = periods, built_dimensions_ = dimensions;
	if (scene->isPeriodic) {
		built_cell_ = followed_ = scene->cell->hSize;
		built_deforming_ = loop::deforms(*scene->cell);
	}
	settings_changed_ = false;
}

loop::Mirror& GrainLoop::running()
{
	if (!scene) throw std::runtime_error("GrainLoop is in no scene yet; put it into O.engines and run a step first");
	require_cell();
	if (!mirror_ || read_from_ != scene) build();
	if (mirror_->map.known_bodies != scene->bodies->size())
		throw std::runtime_error(
			"GrainLoop: bodies were added to or removed from O.bodies; call sync() before and read() after such a change");
	hear_settings();
	follow_cell();
	mirror_->hear_bodies();
	mirror_->bring_settings_of_step();
	return *mirror_;
}

GrainLoop::Turn GrainLoop::take_turn() const
{
	Turn turn(busy_, std::try_to_lock);
	if (turn) return turn;
	const seam::WithoutPython released;  // the step under way may need Python's lock to end
	turn.lock();
	return turn;
}

/// O.run(..., True) of YADE waits for the run without Python's lock, and loses the error of a step that fails before this wait
/// has begun. A failed step therefore waits for Python's lock, which is free once that wait has begun.
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
	running();
	const bool look_at_all = scene->stopAtIter != run_end_ || scene->iter % 100 == 0;
	run_end_ = scene->stopAtIter;
	mirror_->require_bodies(look_at_all);
	mirror_->require_materials();
	if (look_at_all) mirror_->require_spread();
	mirror_->read_anew_what_changed();
	mirror_->compute_body_forces();
	mirror_->follow_bodies();
	mirror_->take_outside_forces();
	mirror_->close();
	mirror_->take_next_flow();
	mirror_->step();
	mirror_->write_bodies();
	if (someone_may_look()) sync();
}

bool GrainLoop::last_step_of_run() const
{
	return (scene->stopAtIter > 0 && scene->iter + 1 >= scene->stopAtIter) ||
	       (scene->stopAtTime > 0 && scene->time + scene->dt >= scene->stopAtTime) ||
	       !Singleton<yade::Omega>::instance().isRunning();
}

void GrainLoop::show_bodies()
{
	const Turn turn = take_turn();
	if (!mirror_ || !mirror_->is_open()) sync();
}

void GrainLoop::sync()
{
	const Turn turn = take_turn();
	if (mirror_ && scene && read_from_ == scene) mirror_->sync();
}

void GrainLoop::read()
{
	const Turn turn = take_turn();
	if (mirror_) mirror_->keep_walls();
	mirror_.reset();
}

void GrainLoop::begin_on_step()
{
	const Turn turn = take_turn();
	running().begin_on_step();
	mirror_->close();
	mirror_->write_bodies();
}

void GrainLoop::contacts_on(int id, std::vector<BodyContact>& contacts)
{
	const Turn turn = take_turn();
	running().contacts_on(id, contacts);
}

Wrench GrainLoop::wrench_on(int id)
{
	const Turn turn = take_turn();
	return running().wrench_on(id);
}

void GrainLoop::look(SceneView& view, bool with_contacts)
{
	const Turn turn = take_turn();
	running().look(view, with_contacts);
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::GrainLoop)
