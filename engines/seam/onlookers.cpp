/// Which engines may look at any body, and when they will act.
#include "engines/seam/onlookers.hpp"

#include <algorithm>

#include "engines/seam/registered.hpp"

namespace graindrive {

namespace {

bool is_one_of(const std::vector<std::string>& names, const std::string& name)
{
	return std::find(names.begin(), names.end(), name) != names.end();
}

const std::vector<std::string> that_add_forces{ "ForceResetter", "ForceEngine", "TorqueEngine", "GravityEngine",
	"HarmonicForceEngine", "HdapsGravityEngine", "InterpolatingDirectedForceEngine" };

const std::vector<std::string> that_read_or_move_bodies{ "AxialGravityEngine", "BicyclePedalEngine",
	"CentralConstantAccelerationEngine", "CombinedKinematicEngine", "DragEngine", "HarmonicMotionEngine",
	"HarmonicRotationEngine", "HelixEngine", "InterpolatingHelixEngine", "LinearDragEngine", "PyRunner", "RadialForceEngine",
	"RotationEngine", "SnapshotEngine", "StepDisplacer", "TranslationEngine", "VTKRecorder" };

}  // namespace

Reach reach_of(const yade::Engine& engine, const std::vector<std::string>& trusted)
{
	if (const auto* ours = dynamic_cast<const seam::Stateful*>(&engine))
		return ours->reads_all_bodies() ? Reach::all_bodies : Reach::own_bodies;
	const std::string name = engine.getClassName();
	if (is_one_of(that_add_forces, name)) return Reach::own_bodies;
	return is_one_of(that_read_or_move_bodies, name) || is_one_of(trusted, name) ? Reach::all_bodies : Reach::unknown;
}

/// The rule of YADE's PeriodicEngine::isActivated, which cannot be asked itself: asking counts as acting.
bool may_act(const yade::Engine& engine, long iter, Real time)
{
	if (engine.dead) return false;
	const auto* periodic = dynamic_cast<const yade::PeriodicEngine*>(&engine);
	if (!periodic) return true;
	const yade::PeriodicEngine& p = *periodic;
	if (p.firstIterRun > 0 && p.nDone == 0) return p.firstIterRun == iter;
	if (p.nDone == 0) return true;  // the first time: initRun, or a clock that starts
	const bool restarted = iter < p.iterLast;
	if (!restarted && p.nDo >= 0 && p.nDone >= p.nDo) return false;
	return restarted || p.realPeriod > 0 || (p.virtPeriod > 0 && time - p.virtLast >= p.virtPeriod * (1 - 1e-9)) ||
	       (p.iterPeriod > 0 && iter - p.iterLast >= p.iterPeriod);
}

}  // namespace graindrive
