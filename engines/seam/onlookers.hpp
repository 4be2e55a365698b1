/// The engines of O.engines that may look at any body or change one: what GrainLoop must keep true for them, and when.
#pragma once
#include <string>
#include <vector>

#include "engines/seam/yade.hpp"

namespace graindrive {

/// What an engine has to do with the bodies of a scene.
enum class Reach {
	own_bodies,  ///< it names its bodies, asks GrainLoop for contacts, or adds forces: no other body need be true for it
	all_bodies,  ///< it may read or change any body
	unknown      ///< it may need YADE's interactions, or move bodies by itself
};

/// Graindrive's engines say it themselves (`reads_all_bodies`); YADE's are known by name, and `trusted` names others that
/// do no more than read and change bodies and add forces.
Reach reach_of(const yade::Engine& engine, const std::vector<std::string>& trusted);

/// True if the engine may act at the step `iter`, which begins at `time` [s]. An engine with a period in wall time may act at any.
bool may_act(const yade::Engine& engine, long iter, Real time);

}  // namespace graindrive
