/// Finds the engines that may read or change YADE's bodies; GrainLoop writes all bodies before such an engine acts.
#include <algorithm>

#include "engines/loop/GrainLoop.hpp"
#include "engines/seam/onlookers.hpp"

namespace graindrive {

namespace {

bool is_rival(const std::string& name)
{
	return name == GrainLoop::class_name || name == "NewtonIntegrator" || name == "InteractionLoop";
}

}  // namespace

/// Checks O.engines if it has changed. A second integrator is refused because it would move everything twice; an engine of an
/// unknown class is refused because it may read interactions, which GrainLoop does not keep.
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
				"GrainLoop replaces collider, InteractionLoop and NewtonIntegrator, but O.engines also holds " + name +
				": remove it");
		const Reach reach = reach_of(*engine, trusted);
		if (reach == Reach::unknown && !engine->dead)
			throw std::runtime_error("GrainLoop does not know what " + name +
									 " needs: it may read interactions, which GrainLoop does not keep; remove it "
									 "from O.engines, use YADE's loop, or add its name to GrainLoop.trusted if it only reads and "
									 "changes bodies and adds "
									 "forces");
		if (reach == Reach::all_bodies) onlookers_.push_back({ engine.get(), behind });
	}
	met_engines_ = here, met_dead_ = dead;
}

/// True if other code may read bodies before the next step, so that they must be up to date at the end of this one.
bool GrainLoop::someone_may_look() const
{
	if (last_step_of_run() || (syncEvery > 0 && (scene->iter + 1) % syncEvery == 0)) return true;
	for (const Onlooker& one : onlookers_)
		if (one.behind ? may_act(*one.engine, scene->iter, scene->time)
					   : may_act(*one.engine, scene->iter + 1, scene->time + scene->dt))
			return true;
	return false;
}

}  // namespace graindrive
