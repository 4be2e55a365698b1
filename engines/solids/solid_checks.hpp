/// Checks of a scene's solids, and errors from places where no exception may be raised.
///
/// YADE calls functors in OpenMP loops, out of which an exception would end the process. A complaint stops the run after the step;
/// graindrive's O.run, O.step and O.wait raise it.
#pragma once
#include <string>

#include "engines/solids/Solid.hpp"

namespace graindrive {

/// @throws std::invalid_argument for a Solid without a surface; for a sampled one and spheres larger than its margin; and, where YADE's collider works in a periodic cell, for a sheared
/// cell and for a Solid that is longer than half of it along an axis but does not go on without end
void check_solids(const yade::Scene& scene);

/// True if a Solid of the scene is endless along an axis of its periodic cell, for which YADE's collider needs
/// allowBiggerThanPeriod: its boxes then take the bodies where they are, not their images, which for such a solid is the same.
bool solids_outgrow_cell(const yade::Scene& scene);

/// As `check_solids` for one body, in a complaint; false if there is one.
bool complain_unless_usable(yade::Scene& scene, const yade::Body& body);

/// Stops the run after this step and keeps the text, unless there is one already.
void complain(yade::Scene& scene, const std::string& text);

/// The complaint since the last call; empty if there is none.
std::string take_complaint();

}  // namespace graindrive
