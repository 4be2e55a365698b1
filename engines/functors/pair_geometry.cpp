/// Solids are told by the class index of their shape, as YADE's dispatchers tell them.
#include "engines/functors/pair_geometry.hpp"

#include "engines/solids/Solid.hpp"

namespace graindrive {

PairGeometry pair_geometry(const yade::Scene& scene, const yade::ScGeom& geom, int id1)
{
	const bool solid = is_solid((*scene.bodies)[id1]->shape.get());
	return { geom.normal, geom.penetrationDepth, geom.refR1, geom.refR2, solid, geom.contactPoint };
}

}  // namespace graindrive
