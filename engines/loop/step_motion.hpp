/// The times and the fields of one step: what every integration of it asks for, of grains and of bodies.
#pragma once
#include "engines/geometry/vec.hpp"

namespace graindrive::loop {

using geometry::Spin;
using geometry::Vec;

template <int D>
struct StepMotion {
	double dt = 0;              ///< time step of the springs [s]
	double kick = 0;            ///< time over which forces act on velocities [s]
	double drift = 0;           ///< time over which velocities move positions [s]
	Vec<D> gravity;             ///< [m/s^2]
	double spin_response = 0;   ///< m R^2 / I of free grains: 2 for disks, 5/2 for spheres, 0 where they may not rotate
	double damping = 0;         ///< Cundall's non-viscous damping [-]; 0: none
	bool damps_gravity = true;  ///< gravity is damped with the other forces
};

}  // namespace graindrive::loop
