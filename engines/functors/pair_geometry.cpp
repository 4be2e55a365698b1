/// Solids are recognised by the class index of their shape, as in YADE's dispatchers.
#include "engines/functors/pair_geometry.hpp"

#include "engines/solids/Solid.hpp"

namespace graindrive {

namespace {

/// As in YADE's own laws: velGrad times the distance to the image, or 0 if velocities do not follow the cell (homoDeform = 0).
Vector3r image_velocity(const yade::Scene& scene, const yade::Interaction& contact)
{
	if (!scene.isPeriodic || scene.cell->homoDeform == 0) return Vector3r::Zero();
	return scene.cell->velGrad * (scene.cell->prevHSize * contact.cellDist.cast<Real>());
}

}  // namespace

PairGeometry pair_geometry(const yade::Scene& scene, const yade::ScGeom& geom, const yade::Interaction& contact)
{
	const bool solid = is_solid((*scene.bodies)[contact.getId1()]->shape.get());
	return { geom.normal, geom.penetrationDepth, geom.refR1, geom.refR2, solid, geom.contactPoint,
		image_velocity(scene, contact) };
}

}  // namespace graindrive
