/// Turns words into choices; an unknown word is refused with the list of the known ones.
#include "engines/continuum/flow_words.hpp"

#include <cmath>
#include <stdexcept>

namespace graindrive::continuum {

namespace {

int count(const char* name, double value)
{
	if (value >= 2 && value <= 20000 && value == std::floor(value)) return int(value);
	throw std::invalid_argument(std::string(name) + " must be a whole number from 2 to 20000, got " + std::to_string(value));
}

[[noreturn]] void refuse(const char* name, const std::string& choices, const std::string& got)
{
	throw std::invalid_argument(std::string(name) + " must be one of " + choices + ", got '" + got + "'");
}

}  // namespace

Grid FlowWords::grid() const
{
	return { count("cells_x", cells_x), count("cells_y", cells_y), spacing, low_x, low_y, periodic_x != 0 };
}

Fluids FlowWords::all_fluids() const
{
	Fluids all = fluids;
	const double inertia = grain_diameter * std::sqrt(grain_density);
	if (!(inertia > 0)) throw std::invalid_argument("grain_diameter and grain_density must be positive");
	if (!(shear_viscosity > 0)) throw std::invalid_argument("shear_viscosity must be positive");
	if (!(yield_stress >= 0)) throw std::invalid_argument("yield_stress must not be negative");
	if (rheology == "mu_i")
		all.rheology = laws::GranularFluid<laws::MuOfI>{ laws::MuOfI(friction), inertia };
	else if (rheology == "regularised")
		all.rheology = laws::GranularFluid<laws::RegularisedMuOfI>{ laws::RegularisedMuOfI(friction, fast_friction), inertia };
	else if (rheology == "newtonian")
		all.rheology = laws::NewtonianFluid{ shear_viscosity };
	else if (rheology == "bingham")
		all.rheology = laws::BinghamFluid{ yield_stress, shear_viscosity };
	else
		refuse("rheology", "mu_i, regularised, newtonian, bingham", rheology);
	return all;
}

FlowSettings FlowWords::all_settings() const
{
	FlowSettings all = settings;
	if (viscosity != "full" && viscosity != "split") refuse("viscosity", "full, split", viscosity);
	if (edge != "slips" && edge != "sticks") refuse("edge", "slips, sticks", edge);
	all.viscosity = viscosity == "full" ? Viscosity::full : Viscosity::split;
	all.edge = edge == "slips" ? Edge::slips : Edge::sticks;
	return all;
}

}  // namespace graindrive::continuum
