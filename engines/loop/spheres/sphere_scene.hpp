/// What a scene of spheres consists of. Plain data, in the units of the caller.
#pragma once
#include <array>
#include <variant>
#include <vector>

#include "engines/base/real.hpp"
#include "engines/laws/registry.hpp"
#include "engines/loop/kernel.hpp"

namespace graindrive::loop {

using SphereLaw = std::variant<laws::HertzHistory<Real>, laws::HertzRestitution<Real>, laws::SpringDashpot<Real>>;

struct Sphere {
	Vector3r x = Vector3r::Zero();     ///< centre [m]
	Vector3r v = Vector3r::Zero();     ///< velocity, half a step behind the position (leapfrog) [m/s]
	Vector3r spin = Vector3r::Zero();  ///< [rad/s]
	double radius = 0;                 ///< [m]
	double mass = 0;                   ///< [kg]; infinity lets a held sphere count with the partner's mass alone in m_eff
	bool held = false;  ///< keeps the velocity and spin that it is given, whatever touches it; at rest it is frozen
};

struct SphereBox {
	std::array<double, 3> low{}, high{};  ///< [m]; used where periodic
	std::array<bool, 3> periodic{};

	double length(int axis) const { return high[axis] - low[axis]; }
};

struct SphereScene {
	std::vector<Sphere> spheres;
	SphereBox box;
	SphereLaw law;
	bool friction = true;                 ///< off: no tangential force and no history
	bool rotation = true;                 ///< off: spins stay as they are
	Vector3r gravity = Vector3r::Zero();  ///< [m/s^2]
	double dt = 0;                        ///< time step [s]
	Precision precision = Precision::double_;
	int threads = 1;
	double skin = 0;  ///< how far beyond touching neighbours are listed [m]; 0 lets the loop choose
};

}  // namespace graindrive::loop
