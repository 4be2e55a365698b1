/// The contact laws as YADE functors.
#include "engines/functors/contact_law_functors.hpp"

namespace graindrive {

const char* const Law2_ScGeom_ContactPhys_HertzHistory::documentation =
	"Brilliantov-Silbert law (LAMMPS gran/hertz/history), Magnus and wiggle studies.\n\n"
	"F_n = sqrt(R_eff delta) (K_n delta - m_eff gamma_n v_n)\n"
	"F_t = -min(mu |F_n|, sqrt(R_eff delta) |K_t s + m_eff gamma_t v_t|) t\n\n"
	"Default constants: the wiggle paper's, in units of d, rho, g. Stands with Ip2_FrictMat_FrictMat_ContactPhys. Raises "
	"ValueError for\n"
	"stiffnesses <= 0 or negative damping.";

const char* const Law2_ScGeom_ContactPhys_HertzRestitution::documentation =
	"Hertz-Mindlin law damped for a given restitution, lift study (Guillard, Forterre, Pouliquen 2014, Table I).\n\n"
	"F_n = k* delta^(3/2) - g_n delta^(1/4) v_n, F_t likewise in the tangential spring, cut at mu |F_n|.\n"
	"Default constants: the paper's, in SI units. Stands with Ip2_FrictMat_FrictMat_ContactPhys. Raises ValueError for values "
	"out of range.";

const char* const Law2_ScGeom_ContactPhys_SpringDashpot::documentation =
	"Linear spring-dashpot, drum study (Oba, Otsuki 2025); the tangential spring grows only while the contact sticks.\n\n"
	"F_n = k_n delta - eta v_n, F_t = -(k_t s + eta v_t) cut at mu F_n, eta = -2 ln e sqrt(m_eff k_n/(pi^2 + ln^2 e)).\n"
	"Default constants: the paper's, in units of m, g, d. Stands with Ip2_FrictMat_FrictMat_ContactPhys. Raises ValueError for "
	"values out of range.";

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::Law2_ScGeom_ContactPhys_HertzHistory)
BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::Law2_ScGeom_ContactPhys_HertzRestitution)
BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::Law2_ScGeom_ContactPhys_SpringDashpot)
