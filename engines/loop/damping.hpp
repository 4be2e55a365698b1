/// Cundall's non-viscous damping, as YADE's NewtonIntegrator.damping has it: each component of an acceleration is made less where it
/// speeds up and more where it slows down.
///
///   a' = a (1 - d sign(a (v + a dt/2))),  v half a step behind
///
/// Cundall, "Distinct element models of rock and soil structure" (1987). It acts on the sum of all forces on a grain or body, and in the
/// same way on the angular acceleration; gravity belongs to the sum unless `damps_gravity` says otherwise (YADE's dampGravity).
#pragma once

namespace graindrive::loop {
namespace {  // the kernels are compiled for several processors; each has its own copy

/// `velocity` and `acceleration` may both be multiplied by the same positive number.
inline double damped(double acceleration, double velocity, double damping, double half_step)
{
	const double product = acceleration * (velocity + half_step * acceleration);
	return acceleration * (1 - damping * ((product > 0) - (product < 0)));
}

/// Velocity after a kick by a force per mass and gravity.
template <class Data>
double kicked(double velocity, double force_per_mass, double gravity, const Data& data)
{
	const double half_step = data.dt / 2;
	if (data.damps_gravity) return velocity + damped(force_per_mass + gravity, velocity, data.damping, half_step) * data.kick;
	return velocity + (damped(force_per_mass, velocity, data.damping, half_step) + gravity) * data.kick;
}

}  // namespace
}  // namespace graindrive::loop
