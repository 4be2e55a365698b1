/// A flow's grid, wall, fluids and settings as named numbers and words, for bindings.
#pragma once
#include "engines/continuum/two_phase_flow.hpp"

namespace graindrive::continuum {

/// What a flow is made of, less the shape of its vessel and where the fluid stands.
struct FlowWords {
	double cells_x = 0, cells_y = 0, spacing = 0, low_x = 0, low_y = 0, periodic_x = 0;
	double transition = 2;  ///< half width of the wall's transition, in cells
	WallMotion wall;
	std::string rheology = "mu_i", viscosity = "full", edge = "slips";
	laws::FrictionConstants friction;
	double fast_friction = 0.05, grain_diameter = 1, grain_density = 4 / 3.14159265358979323846;
	double shear_viscosity = 1, yield_stress = 0;
	Fluids fluids;
	FlowSettings settings;

	/// `visit(name, number or word, meaning)`
	template <class Visit>
	void list(Visit&& visit)
	{
		visit("cells_x", cells_x, "cells along x");
		visit("cells_y", cells_y, "cells along y");
		visit("spacing", spacing, "side of a cell");
		visit("low_x", low_x, "left edge of the grid");
		visit("low_y", low_y, "lower edge of the grid");
		visit("periodic_x", periodic_x, "1: periodic along x; 0: left and right edges are closed");
		visit("edge", edge, "slips or sticks: boundary condition along closed edges");
		visit("transition", transition, "half width of the transition between fluid and solid, in cells");
		visit("wall_velocity_x", wall.velocity_x, "velocity of the solid along x");
		visit("wall_velocity_y", wall.velocity_y, "velocity of the solid along y");
		visit("wall_spin", wall.spin, "spin of the solid, counter-clockwise");
		visit("wall_x", wall.x, "x of the point about which the solid turns");
		visit("wall_y", wall.y, "y of the point about which the solid turns");
		visit("rheology", rheology, "mu_i, regularised, newtonian or bingham");
		visit("static_friction", friction.mu_s, "mu_s");
		visit("dynamic_friction", friction.mu_2, "mu_2");
		visit("inertial_scale", friction.I_0, "I_0");
		visit("fast_friction", fast_friction, "mu_inf of the regularised rheology");
		visit("grain_diameter", grain_diameter, "d, for the inertial number");
		visit("grain_density", grain_density, "density of the grains' material, for the inertial number");
		visit("shear_viscosity", shear_viscosity, "viscosity of a newtonian or a bingham fluid");
		visit("yield_stress", yield_stress, "yield stress of a bingham fluid");
		visit("density", fluids.density, "density of the dense fluid");
		visit("largest_viscosity", fluids.largest_viscosity, "eta_max of the dense fluid");
		visit("least_pressure", fluids.least_pressure, "p_min of the rheology");
		visit("gas_density", fluids.gas_density, "density of the gas");
		visit("gas_viscosity", fluids.gas_viscosity, "viscosity of the gas");
		visit("time_step", settings.time_step, "dt");
		visit("gravity_x", settings.gravity_x, "acceleration");
		visit("gravity_y", settings.gravity_y, "acceleration");
		visit("viscosity", viscosity, "split (only SMAC's constant part is implicit) or full (all of it)");
		visit("implicit_share", settings.implicit_share, "nu_0 over eta_gas/rho_gas + eta_max/rho; only for split");
		visit("tolerance", settings.tolerance, "relative tolerance of the pressures");
		visit("viscous_tolerance", settings.viscous_tolerance, "relative tolerance of the viscous part");
		visit("sharpness", settings.sharpness, "sharpness of the free surface, which is 4/sharpness cells thick");
		visit("pressure_solver", settings.pressure_solver, "name of a pressure solver; empty for the fastest");
	}

	/// @throws std::invalid_argument for words that are not known and numbers of cells that are none
	Grid grid() const;
	Fluids all_fluids() const;
	FlowSettings all_settings() const;
};

}  // namespace graindrive::continuum
