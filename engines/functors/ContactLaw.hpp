/// A pure contact law as a `Law2_` functor of YADE's InteractionLoop.
#pragma once
#include "engines/functors/Ip2_FrictMat_FrictMat_ContactPhys.hpp"
#include "engines/functors/pair_geometry.hpp"

namespace graindrive {

/// Base of the functors, one for each law: reads the pair from YADE, asks the law, and gives YADE the forces. Its attributes are what
/// the law is given of the grains' material.
///
/// Velocities are YADE's leapfrog ones at n-1/2, positions at n, as in LAMMPS. In a cell that deforms (velGrad) the image of body 2 has its velocity.
template <class Self, template <class> class Law_>
class ContactLaw : public Registered<Self, yade::LawFunctor>, public Law_<Real>::Given {
public:
	using Law = Law_<Real>;
	using Given = typename Law::Given;

	template <class Visit>
	static void attributes(Visit&& visit)
	{
		Given::quantities([&](const laws::Quantity& quantity, Real Given::*member) {
			const std::string words = std::string(quantity.meaning) + ", " + quantity.symbol + " [" + quantity.unit + "]";
			visit(quantity.name, static_cast<Real Self::*>(member), words.c_str());
		});
		visit("leverArm", &ContactLaw::leverArm,
			"where the tangential force acts: 'radius' (LAMMPS, the papers) or 'contactPoint'");
	}
	std::string get2DFunctorType1() const override { return "ScGeom"; }
	std::string get2DFunctorType2() const override { return "FrictPhys"; }
	void check() const
	{
		require(leverArm == "radius" || leverArm == "contactPoint", "leverArm must be 'radius' or 'contactPoint'", leverArm);
		Given::quantities(
			[&](const laws::Quantity& quantity, Real Given::*member) { laws::require(quantity, this->*member, quantity.name); });
	}

	bool go(yade::shared_ptr<yade::IGeom>& igeom, yade::shared_ptr<yade::IPhys>& iphys, yade::Interaction* interaction) override
	{
		const auto& geom = static_cast<const yade::ScGeom&>(*igeom);
		if (geom.penetrationDepth < 0) return false;
		const int id1 = interaction->getId1(), id2 = interaction->getId2();
		auto* phys = dynamic_cast<ContactPhys*>(iphys.get());
		if (!phys) {  // from another Ip2. Raising would end the process: YADE calls this in an OpenMP loop
			const Real friction = static_cast<const yade::FrictPhys&>(*iphys).tangensOfFrictionAngle;
			const Real radius = pair_geometry(*this->scene, geom, *interaction).effective_radius();
			const auto made = contact_phys_of(*this->scene, radius, id1, id2, friction);
			iphys = made;
			phys = made.get();
		}
		apply(geom, *phys, *interaction);
		return true;
	}

	std::string leverArm = "radius";

	/// What the law says of a pair of bodies at the present positions and velocities; changes nothing.
	laws::PairResponse answer(const yade::Scene& scene, const PairGeometry& pair, const ContactPhys& phys, int id1, int id2) const
	{
		const yade::State& s1 = *(*scene.bodies)[id1]->state;
		const yade::State& s2 = *(*scene.bodies)[id2]->state;
		const auto respond = [&](const auto& contact) {
			return laws::respond(Law::of(*this, phys.tangensOfFrictionAngle), contact, phys.slip, scene.dt, arm());
		};
		if (pair.solid)
			return respond(laws::SolidAndSphere{ pair.normal, pair.overlap, pair.radius2, pair.contact_point - s1.pos, s1.vel,
				s2.vel + pair.image_velocity, s1.angVel, s2.angVel, phys.effectiveMass });
		return respond(laws::SpherePair{ pair.normal, pair.overlap, pair.radius1, pair.radius2, s1.vel,
			s2.vel + pair.image_velocity, s1.angVel, s2.angVel, phys.effectiveRadius, phys.effectiveMass });
	}

private:
	laws::LeverArm arm() const { return leverArm == "radius" ? laws::LeverArm::radius : laws::LeverArm::contact_point; }

	void apply(const yade::ScGeom& geom, ContactPhys& phys, const yade::Interaction& contact) const
	{
		yade::Scene& scene = *this->scene;
		const int id1 = contact.getId1(), id2 = contact.getId2();
		const auto answer = this->answer(scene, pair_geometry(scene, geom, contact), phys, id1, id2);
		phys.normalForce = answer.normal_force2;
		phys.shearForce = answer.tangential_force2;
		phys.slip = answer.slip;
		phys.slipping = answer.slipping;
		phys.leverLoss = laws::lever_loss(arm(), geom.penetrationDepth);
		const Vector3r force2 = answer.normal_force2 + answer.tangential_force2;
		scene.forces.addForce(id1, -force2);
		scene.forces.addForce(id2, force2);
		scene.forces.addTorque(id1, answer.torque1);
		scene.forces.addTorque(id2, answer.torque2);
	}
};

}  // namespace graindrive
