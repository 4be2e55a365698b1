/// Python bindings of the functors and of what a contact carries.
#include "engines/functors/Ip2_FrictMat_FrictMat_ContactPhys.hpp"
#include "engines/functors/contact_law_functors.hpp"
#include "engines/seam/bind.hpp"

namespace graindrive {

void bind_functors()
{
	seam::bind<ContactPhys, yade::FrictPhys>(
		"A contact under one of Graindrive's laws: reduced radius and mass of the pair, its tangential spring.");
	seam::bind<Ip2_FrictMat_FrictMat_ContactPhys, yade::IPhysFunctor>(Ip2_FrictMat_FrictMat_ContactPhys::documentation);
	seam::bind<Law2_ScGeom_ContactPhys_HertzHistory, yade::LawFunctor>(Law2_ScGeom_ContactPhys_HertzHistory::documentation);
	seam::bind<Law2_ScGeom_ContactPhys_HertzRestitution, yade::LawFunctor>(
		Law2_ScGeom_ContactPhys_HertzRestitution::documentation);
	seam::bind<Law2_ScGeom_ContactPhys_SpringDashpot, yade::LawFunctor>(Law2_ScGeom_ContactPhys_SpringDashpot::documentation);
}

}  // namespace graindrive
