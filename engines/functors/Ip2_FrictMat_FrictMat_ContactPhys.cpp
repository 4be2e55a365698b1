/// Makes a contact's reduced radius, reduced mass and friction from its two bodies.
#include "engines/functors/Ip2_FrictMat_FrictMat_ContactPhys.hpp"

#include "engines/laws/pair_geometry.hpp"

namespace graindrive {

const char* const Ip2_FrictMat_FrictMat_ContactPhys::documentation =
	"Makes the ContactPhys of a new contact: reduced radius and mass of the pair, friction coefficient.\n\n"
	"A clump's member counts with the mass of its clump. A body at rest with every degree of freedom blocked (walls, bases) "
	"counts\n"
	"as infinitely heavy, so that the pair's reduced mass is the partner's, as LAMMPS takes it for frozen atoms.";

/// 1/m [1/kg]; 0 for a frozen body.
static Real inverse_mass(const yade::Scene& scene, int id)
{
	const yade::Body* body = (*scene.bodies)[id].get();
	if (body->isClumpMember()) body = (*scene.bodies)[body->clumpId].get();
	const yade::State& state = *body->state;
	const bool frozen = state.blockedDOFs == yade::State::DOF_ALL && state.vel.isZero(0) && state.angVel.isZero(0);
	return frozen || !(state.mass > 0) ? 0 : 1 / state.mass;
}

yade::shared_ptr<ContactPhys> contact_phys_of(
	const yade::Scene& scene, Real radius1, Real radius2, int id1, int id2, Real friction)
{
	auto phys = boost::make_shared<ContactPhys>();
	const Real inverse = inverse_mass(scene, id1) + inverse_mass(scene, id2);
	phys->effectiveRadius = laws::effective_radius(radius1, radius2);
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
	if (!geom) throw std::invalid_argument(std::string(class_name) + " needs a ScGeom; use Ig2_Sphere_Sphere_ScGeom");
	interaction->phys = contact_phys_of(
		*scene, geom->refR1, geom->refR2, interaction->getId1(), interaction->getId2(), friction_between(*first, *second));
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_GUID(graindrive::ContactPhys, "ContactPhys")
BOOST_CLASS_EXPORT_GUID(graindrive::Ip2_FrictMat_FrictMat_ContactPhys, "Ip2_FrictMat_FrictMat_ContactPhys")
