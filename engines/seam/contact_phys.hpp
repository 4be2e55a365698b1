/// What a contact under one of Graindrive's laws carries: YADE's FrictPhys with the pair's reduced radius and mass, and its spring.
#pragma once
#include "engines/seam/registered.hpp"

namespace graindrive {

/// Dispatched as FrictPhys (it has no class index of its own), so YADE's recorders and exporters read it as one.
class ContactPhys : public Registered<ContactPhys, yade::FrictPhys> {
public:
	static constexpr const char* class_name = "ContactPhys";
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("effectiveRadius", &ContactPhys::effectiveRadius, "R_i R_j / (R_i + R_j) [m]");
		visit("effectiveMass", &ContactPhys::effectiveMass,
			"m_i m_j / (m_i + m_j); a frozen partner counts as infinitely heavy [kg]");
		visit("slip", &ContactPhys::slip, "tangential spring s [m], of body 1 against body 2");
		visit("leverLoss", &ContactPhys::leverLoss,
			"radius less the lever arm of the tangential force in the last step [m]: 0, or half the overlap");
		visit("slipping", &ContactPhys::slipping, "true if the tangential force was at Coulomb's limit in the last step");
	}

	Real effectiveRadius = 0;
	Real effectiveMass = 0;
	Real leverLoss = 0;
	Vector3r slip = Vector3r::Zero();
	bool slipping = false;
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::ContactPhys, "ContactPhys")
