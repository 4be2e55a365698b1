/// The contact laws as YADE functors.
#pragma once
#include "engines/functors/ContactLaw.hpp"
#include "engines/laws/registry.hpp"

namespace graindrive {

class Law2_ScGeom_ContactPhys_HertzHistory : public ContactLaw<Law2_ScGeom_ContactPhys_HertzHistory, laws::HertzHistory> {
public:
	static constexpr const char* class_name = "Law2_ScGeom_ContactPhys_HertzHistory";
	static const char* const documentation;
};

class Law2_ScGeom_ContactPhys_HertzRestitution
	: public ContactLaw<Law2_ScGeom_ContactPhys_HertzRestitution, laws::HertzRestitution> {
public:
	static constexpr const char* class_name = "Law2_ScGeom_ContactPhys_HertzRestitution";
	static const char* const documentation;
};

class Law2_ScGeom_ContactPhys_SpringDashpot : public ContactLaw<Law2_ScGeom_ContactPhys_SpringDashpot, laws::SpringDashpot> {
public:
	static constexpr const char* class_name = "Law2_ScGeom_ContactPhys_SpringDashpot";
	static const char* const documentation;
};

/// Calls visit with a null pointer to each class.
template <class Visit>
void for_each_law_functor(Visit&& visit)
{
	visit(static_cast<const Law2_ScGeom_ContactPhys_HertzHistory*>(nullptr));
	visit(static_cast<const Law2_ScGeom_ContactPhys_HertzRestitution*>(nullptr));
	visit(static_cast<const Law2_ScGeom_ContactPhys_SpringDashpot*>(nullptr));
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::Law2_ScGeom_ContactPhys_HertzHistory, "Law2_ScGeom_ContactPhys_HertzHistory")
BOOST_CLASS_EXPORT_KEY2(graindrive::Law2_ScGeom_ContactPhys_HertzRestitution, "Law2_ScGeom_ContactPhys_HertzRestitution")
BOOST_CLASS_EXPORT_KEY2(graindrive::Law2_ScGeom_ContactPhys_SpringDashpot, "Law2_ScGeom_ContactPhys_SpringDashpot")
