/// The three contact laws as YADE functors.
#pragma once
#include "engines/functors/ContactLaw.hpp"

namespace graindrive {

class Law2_ScGeom_ContactPhys_HertzHistory : public ContactLaw<Law2_ScGeom_ContactPhys_HertzHistory> {
public:
	using Self = Law2_ScGeom_ContactPhys_HertzHistory;
	static constexpr const char* class_name = "Law2_ScGeom_ContactPhys_HertzHistory";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("normalStiffness", &Self::normalStiffness, "K_n [Pa]");
		visit("tangentialStiffness", &Self::tangentialStiffness, "K_t [Pa]");
		visit("normalDamping", &Self::normalDamping, "gamma_n [1/(m s)]");
		visit("tangentialDamping", &Self::tangentialDamping, "gamma_t [1/(m s)]");
		common_attributes(visit);
	}
	laws::HertzHistory<Real> law(Real friction) const;

	Real normalStiffness = 2e6, tangentialStiffness = 2.46e6, normalDamping = 2500, tangentialDamping = 2500;
};

class Law2_ScGeom_ContactPhys_HertzRestitution : public ContactLaw<Law2_ScGeom_ContactPhys_HertzRestitution> {
public:
	using Self = Law2_ScGeom_ContactPhys_HertzRestitution;
	static constexpr const char* class_name = "Law2_ScGeom_ContactPhys_HertzRestitution";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("young", &Self::young, "Young's modulus of the grains [Pa]");
		visit("poisson", &Self::poisson, "Poisson's ratio [-]");
		visit("restitution", &Self::restitution, "coefficient of restitution e in (0, 1] [-]");
		common_attributes(visit);
	}
	laws::HertzRestitution<Real> law(Real friction) const;

	Real young = 5e6, poisson = 0.45, restitution = 0.6;
};

class Law2_ScGeom_ContactPhys_SpringDashpot : public ContactLaw<Law2_ScGeom_ContactPhys_SpringDashpot> {
public:
	using Self = Law2_ScGeom_ContactPhys_SpringDashpot;
	static constexpr const char* class_name = "Law2_ScGeom_ContactPhys_SpringDashpot";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("normalStiffness", &Self::normalStiffness, "k_n [N/m]");
		visit("tangentialStiffness", &Self::tangentialStiffness, "k_t [N/m]");
		visit("restitution", &Self::restitution, "coefficient of restitution e in (0, 1] [-]");
		common_attributes(visit);
	}
	laws::SpringDashpot<Real> law(Real friction) const;

	Real normalStiffness = 2e5, tangentialStiffness = 2e5 * 2 / 7, restitution = 0.92;
};

}  // namespace graindrive
