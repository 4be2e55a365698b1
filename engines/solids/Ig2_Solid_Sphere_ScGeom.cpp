/// Evaluates the surface once, and makes the ScGeom from the result.
#include "engines/solids/Ig2_Solid_Sphere_ScGeom.hpp"

#include "engines/solids/conversions.hpp"
#include "engines/solids/solid_checks.hpp"

namespace graindrive {

using namespace geometry;

const char* const Ig2_Solid_Sphere_ScGeom::documentation =
	"The contact of a Solid, body 1, and a Sphere, body 2: normal n out of the solid, penetrationDepth delta = R - d,\n"
	"contactPoint c = x - (R - delta/2) n, with the distance d and normal n at the sphere's centre x. shearInc is computed\n"
	"from the velocities of the bodies' material at c.\n\n"
	"Graindrive's laws use its radius R and the solid's material velocity v + omega x (c - state.pos). YADE's own laws use\n"
	"these velocities too, with Law2_ScGeom_FrictPhys_CundallStrack(sphericalBodies=False) and\n"
	"Law2_ScGeom_MindlinPhys_Mindlin(preventGranularRatcheting=False) in scenes that are not periodic. With other settings\n"
	"they treat the solid as a sphere of radius refR1: the force on the sphere is then right if the solid is at rest, but\n"
	"the torque on the solid is always wrong. YADE's Ip2_ compute the pair's radius from refR1 and refR2: with\n"
	"solidRadius=1 it is R/2, as for YADE's walls and facets; with solidRadius=1e12 it is R. If the surface refuses to\n"
	"compute a distance, the run stops after the step, and O.run(n, True), O.wait() or O.step() raise RuntimeError.";

void Ig2_Solid_Sphere_ScGeom::check() const
{
	require(
		solidRadius >= 1 && std::isfinite(solidRadius), "Ig2_Solid_Sphere_ScGeom.solidRadius must be a number >= 1", solidRadius);
}

bool Ig2_Solid_Sphere_ScGeom::go(const yade::shared_ptr<yade::Shape>& first, const yade::shared_ptr<yade::Shape>& second,
	const yade::State& state1, const yade::State& state2, const Vector3r& shift2, const bool& force,
	const yade::shared_ptr<yade::Interaction>& interaction)
{
	const auto& solid = static_cast<const Solid&>(*first);
	const Real radius = static_cast<const yade::Sphere&>(*second).radius;
	const Vector3r centre = state2.pos + shift2;
	Nearest<3> nearest{};
	try {
		if (!solid.surface()) return false;  // Bo1_Solid_Aabb has reported the error
		nearest = motion_of(state1.pos, state1.ori).nearest(*solid.surface(), vec(centre));
	} catch (const std::exception& error) {
		complain(*scene, "the Solid of body " + std::to_string(interaction->getId1()) +
							 " cannot give its distance at the centre of body " + std::to_string(interaction->getId2()) + ": " +
							 error.what());
		return false;
	}
	if (!(nearest.distance <= radius) && !interaction->isReal() && !force) return false;

	const bool is_new = !interaction->geom;
	if (is_new)
		interaction->geom =
			boost::static_pointer_cast<yade::IGeom>(Singleton<yade::ClassFactory>::instance().createShared("ScGeom"));
	auto& geom = static_cast<yade::ScGeom&>(*interaction->geom);
	const Vector3r normal = vector(nearest.normal);
	geom.penetrationDepth = radius - nearest.distance;
	geom.contactPoint = centre - (radius - geom.penetrationDepth / 2) * normal;
	geom.refR1 = solidRadius * radius;
	geom.refR2 = radius;
	geom.precompute(state1, state2, scene, interaction, normal, is_new, shift2, false);
	return true;
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::Ig2_Solid_Sphere_ScGeom)
