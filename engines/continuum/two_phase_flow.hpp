/// Grains and gas as two incompressible fluids in a moving vessel: SMAC on a staggered grid, after Oba, Otsuki (2025), section II.3.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engines/continuum/momentum_solve.hpp"
#include "engines/continuum/pressure.hpp"
#include "engines/continuum/volume_of_fluid.hpp"
#include "engines/laws/rheology.hpp"

namespace graindrive::continuum {

/// The two fluids; units of the caller, consistent ones.
struct Fluids {
	laws::Rheology rheology = laws::NewtonianFluid{ 1 };  ///< of the dense fluid, whose fraction is alpha
	double density = 1;
	double largest_viscosity = 1e300;  ///< eta_max: where the dense fluid is at rest it flows that little
	double least_pressure = 1e-5;      ///< p_min, below which the rheology is that of p_min
	double gas_density = 1e-3;
	double gas_viscosity = 1e-6;
};

/// How viscosity acts within a step: SMAC's constant part nu_0 implicit and the rest explicit, or all of it implicit.
enum class Viscosity { split, full };

struct FlowSettings {
	double time_step = 1e-4;
	double gravity_x = 0, gravity_y = 0;
	Viscosity viscosity = Viscosity::split;
	double implicit_share = 0.5;  ///< nu_0 over eta_gas/rho_gas + eta_max/rho (split only); the paper's is 1/2
	double tolerance = 1e-5;      ///< of both pressures' residuals, against the right side of p's equation
	double viscous_tolerance = 1e-6;
	double sharpness = 3.5;  ///< see VolumeOfFluid
	Edge edge = Edge::slips;
	std::string pressure_solver;  ///< "" for the default
};

/// The complete state of a flow.
struct FlowState {
	double time = 0;
	long steps = 0;
	Values fraction;  ///< alpha [-]
	FaceValues velocity;
	FaceValues advection_before;                       ///< A of the last step
	Values potential;                                  ///< S, by which the last step projected
	Values potential_change, potential_change_before;  ///< sigma of the last steps: first guesses
	Values pressure, pressure_before;                  ///< p, which the rheology sees

	template <class Visit>
	void arrays(Visit&& visit)
	{
		visit("fraction", fraction);
		visit("velocity_x", velocity.x);
		visit("velocity_y", velocity.y);
		visit("advection_x", advection_before.x);
		visit("advection_y", advection_before.y);
		visit("potential", potential);
		visit("potential_change", potential_change);
		visit("potential_change_before", potential_change_before);
		visit("pressure", pressure);
		visit("pressure_before", pressure_before);
	}
};

/// What the last step took.
struct StepReport {
	int potential_iterations = 0, pressure_iterations = 0, viscous_iterations = 0;
	double courant = 0;     ///< largest velocity dt/spacing [-]
	double divergence = 0;  ///< largest |div v| [1/time]
};

/// Wall time [s] of each part of the step, summed over all steps so far, for profiling.
struct PartTimes {
	double material = 0;   ///< rates, viscosity, density, coefficients and preconditioner of the pressure
	double forces = 0;     ///< advection and viscous forces
	double pressure = 0;   ///< both pressures and the correction of the velocity
	double viscosity = 0;  ///< the implicit part of the momentum equation
	double surface = 0;    ///< transport of the fraction
};

class TwoPhaseFlow {
public:
	/// At rest, with the pressure of rest. `fraction(x, y)` is alpha at the start, averaged over 8 x 8 points a cell.
	/// @throws std::invalid_argument for densities, viscosities, steps and tolerances that are not positive, for a gas denser than the
	/// fluid, and for a time step above `stable_step`
	TwoPhaseFlow(const Grid& grid, const Domain& domain, const Fluids& fluids, const FlowSettings& settings,
		const std::function<double(double x, double y)>& fraction, const WallLayer& wall_layer = {});

	/// @throws std::runtime_error with the reason and the way out if the scheme cannot follow the flow
	void step();
	void advance(long steps);

	/// The largest time step that the explicit part of the viscosity allows; infinite with `Viscosity::full`.
	double stable_step() const;
	/// Applies from the next step on. @throws std::invalid_argument as the constructor
	void set_time_step(double dt);

	const Grid& grid() const { return g; }
	const Domain& domain() const { return d; }
	const Fluids& fluids() const { return material; }
	const FlowSettings& settings() const { return how; }
	const FlowState& state() const { return now; }
	/// Takes a state whole. @throws std::invalid_argument for arrays of another size, or a number that is not finite
	void restore(const FlowState& state);
	const StepReport& report() const { return last; }
	const PartTimes& part_times() const { return times; }

	/// Shear rate and viscosity in cells, of the present velocity and pressure.
	const Values& present_shear_rate();
	const Values& present_viscosity();
	/// 1 in cells of the dense fluid where its equations are ill-posed, else 0.
	Values ill_posed();
	/// Area of the dense fluid in the cells that are wholly open: nothing changes it.
	double area() const { return area_of(g, now.fraction, &wholly_open); }

private:
	Grid g;
	Domain d;
	Fluids material;
	FlowSettings how;
	FlowState now;
	StepReport last;
	PartTimes times;

	WallLayer layer;
	Values wholly_open;
	VolumeOfFluid transport;
	SplitViscosity split;
	FullViscosity full;
	Pressure pressures;
	Rates rates, stresses;
	Values rate, node_rate, density, scratch;
	Viscosities viscosity;
	double right_side_size = 0;  ///< of the pressure's equation: what residuals are small against
	FaceValues over_density, advected, viscous, given, predicted, change, inertia;

	void check() const;
	double nu_0() const;
	void find_material();
	void find_viscosity();
	void find_forces();
	void predict();
	void predict_split();
	void predict_full();
	void project();
	void find_pressure();
	void set_pressure_level();
	void move_surface();
	void give_back(double area);
	void require_followed();
	/// `along(f, neighbour)` for every free face: the work of both directions in one place
	template <class Work>
	void for_faces(Work&& work);
};

}  // namespace graindrive::continuum
