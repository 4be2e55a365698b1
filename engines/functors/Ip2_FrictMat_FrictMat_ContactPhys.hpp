/// Makes a contact's reduced radius, reduced mass and friction from its two bodies.
#pragma once
#include "engines/seam/contact_phys.hpp"

namespace graindrive {

/// What the contact of two bodies carries: the pair's reduced radius [m], which is given, its reduced mass and its friction coefficient.
yade::shared_ptr<ContactPhys> contact_phys_of(const yade::Scene& scene, Real effective_radius, int id1, int id2, Real friction);

class Ip2_FrictMat_FrictMat_ContactPhys : public Registered<Ip2_FrictMat_FrictMat_ContactPhys, yade::IPhysFunctor> {
public:
	static constexpr const char* class_name = "Ip2_FrictMat_FrictMat_ContactPhys";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("friction", &Ip2_FrictMat_FrictMat_ContactPhys::friction,
			"friction coefficient of every contact [-]; negative: tan of the smaller FrictMat.frictionAngle");
	}
	std::string get2DFunctorType1() const override { return "FrictMat"; }
	std::string get2DFunctorType2() const override { return "FrictMat"; }
	void go(const yade::shared_ptr<yade::Material>& first, const yade::shared_ptr<yade::Material>& second,
		const yade::shared_ptr<yade::Interaction>& interaction) override;

	/// The friction coefficient of a contact between bodies of these materials.
	Real friction_between(const yade::Material& first, const yade::Material& second) const;

	Real friction = -1;
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::Ip2_FrictMat_FrictMat_ContactPhys, "Ip2_FrictMat_FrictMat_ContactPhys")
