/// Makes a contact's reduced radius, reduced mass and friction from its two bodies.
#include "engines/functors/Ip2_FrictMat_FrictMat_ContactPhys.hpp"

namespace graindrive {

const char* const Ip2_FrictMat_FrictMat_ContactPhys::documentation
        = "Makes the ContactPhys of a new contact: reduced radius and mass of the pair, friction coefficient.\n\n"
          "A clump's member counts with the mass of its clump. A body at rest with every degree of freedom blocked (walls, bases) counts\n"
          "as infinitely heavy, so that the pair's reduced mass is the partner's, as LAMMPS takes it for frozen atoms.";

/// 1/m [1/kg]; 0 for a frozen body.
Real Ip2_FrictMat_FrictMat_ContactPhys::inverse_mass(int id) const
{
	const yade::Body* body = (*scene->bodies)[id].get();
	if (body->isClumpMember()) body = (*scene->bodies)[body->clumpId].get();
	const yade::State& state = *body->state;
	const bool frozen = state.blockedDOFs == yade::State::DOF_ALL && state.vel.isZero(0) && state.angVel.isZero(0);
	return frozen || !(state.mass > 0) ? 0 : 1 / state.mass;
}

void Ip2_FrictMat_FrictMat_ContactPhys::go(const yade::shared_ptr<yade::Material>& first, const yade::shared_ptr<yade::Material>& second,
                                           const yade::shared_ptr<yade::Interaction>& interaction)
{
	if (interaction->phys) return;
	const auto* geom = dynamic_cast<const yade::ScGeom*>(interaction->geom.get());
	if (!geom) throw std::invalid_argument(std::string(class_name) + " needs a ScGeom; use Ig2_Sphere_Sphere_ScGeom");
	auto phys = boost::make_shared<ContactPhys>();
	const Real inverse = inverse_mass(interaction->getId1()) + inverse_mass(interaction->getId2());
	phys->effectiveRadius = geom->refR1 * geom->refR2 / (geom->refR1 + geom->refR2);
	phys->effectiveMass = inverse > 0 ? 1 / inverse : 0; // two frozen bodies: no dashpot
	const Real angle = std::min(static_cast<const yade::FrictMat&>(*first).frictionAngle, static_cast<const yade::FrictMat&>(*second).frictionAngle);
	phys->tangensOfFrictionAngle = friction >= 0 ? friction : std::tan(angle);
	interaction->phys = phys;
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_GUID(graindrive::ContactPhys, "ContactPhys")
BOOST_CLASS_EXPORT_GUID(graindrive::Ip2_FrictMat_FrictMat_ContactPhys, "Ip2_FrictMat_FrictMat_ContactPhys")
