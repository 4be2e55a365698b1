/// Makes a contact's reduced radius, reduced mass and friction from its two bodies.
#include "engines/functors/Ip2_FrictMat_FrictMat_ContactPhys.hpp"

#include "engines/functors/pair_geometry.hpp"
#include "engines/solids/Solid.hpp"

namespace graindrive {

const char* const Ip2_FrictMat_FrictMat_ContactPhys::documentation =
	"Makes the ContactPhys of a new contact: reduced radius and mass of the pair, friction coefficient.\n\n"
	"A member of a clump has the mass of its clump. A body at rest with all degrees of freedom blocked (walls, bases)\n"
	"counts as infinitely heavy, so the pair's reduced mass is the mass of its partner, as in LAMMPS for frozen atoms. The\n"
	"same holds for a Solid whose three translations are blocked, whether it moves or not, and for a Solid without a mass.\n"
	"The reduced radius of a sphere and a Solid is the radius of the sphere.";

/// A driven solid has no mass that could recoil, however it moves.
static bool is_held(const yade::Body& body)
{
	const yade::State& state = *body.state;
	constexpr unsigned translations = yade::State::DOF_X | yade::State::DOF_Y | yade::State::DOF_Z;
	if (is_solid(body.shape.get())) return (state.blockedDOFs & translations) == translations;
	return state.blockedDOFs == yade::State::DOF_ALL && state.vel.isZero(0) && state.angVel.isZero(0);
}

/// 1/m [1/kg]; 0 for a held body.
static Real inverse_mass(const yade::Scene& scene, int id)
{
	const yade::Body* body = (*scene.bodies)[id].get();
	if (body->isClumpMember()) body = (*scene.bodies)[body->clumpId].get();
	const Real mass = body->state->mass;
	return is_held(*body) || !(mass > 0) ? 0 : 1 / mass;
}

yade::shared_ptr<ContactPhys> contact_phys_of(const yade::Scene& scene, Real effective_radius, int id1, int id2, Real friction)
{
	auto phys = boost::make_shared<ContactPhys>();
	const Real inverse = inverse_mass(scene, id1) + inverse_mass(scene, id2);
	phys->effectiveRadius = effective_radius;
	phys->effectiveMass = laws::effective_mass(inverse);
	phys->tangensOfFrictionAngle = friction;
	return phys;
}

Real Ip2_FrictMat_FrictMat_ContactPhys::friction_between(const yade::Material& first, const yade::Material& second) const
{
	if (friction >= 0) return friction;
	const Real angle = std::min(
		static_cast<const yade::FrictMat&>(first).frictionAngle, static_cast<const yade::FrictMat&>(second).frictionAngle);
	return std::tan(angle);
}

void Ip2_FrictMat_FrictMat_ContactPhys::go(const yade::shared_ptr<yade::Material>& first,
	const yade::shared_ptr<yade::Material>& second, const yade::shared_ptr<yade::Interaction>& interaction)
{
	if (interaction->phys) return;
	const auto* geom = dynamic_cast<const yade::ScGeom*>(interaction->geom.get());
	if (!geom)
		throw std::invalid_argument(
			std::string(class_name) + " needs a ScGeom; use Ig2_Sphere_Sphere_ScGeom and Ig2_Solid_Sphere_ScGeom");
	const int id1 = interaction->getId1(), id2 = interaction->getId2();
	const Real radius = pair_geometry(*scene, *geom, *interaction).effective_radius();
	interaction->phys = contact_phys_of(*scene, radius, id1, id2, friction_between(*first, *second));
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::ContactPhys)
BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::Ip2_FrictMat_FrictMat_ContactPhys)
