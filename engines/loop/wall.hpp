/// Flat walls: their data, and their motion under a velocity or a pressure.
///
/// A wall is normal to one axis and bounds the grains on one side. In contacts it counts as a frozen grain of infinite radius and
/// mass: R_eff = R, m_eff = m, with the same law and history as all other contacts.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

#include "engines/loop/step_motion.hpp"

namespace graindrive::loop {

enum class Side : int { x_low, x_high, y_low, y_high, z_low, z_high };

constexpr int axis_of(Side side) { return int(side) / 2; }
constexpr double outward_of(Side side) { return int(side) % 2 ? 1 : -1; }

/// A wall keeps its velocity, or is pushed inwards by a pressure p and moves, as a body of mass M with a dashpot c, along its axis:
///
///   M dv/dt = F - p A - c v,  |v| <= v_max,  F by the grains, p A over the wall's extent A (a length in the plane)
///
/// A mass rather than a servo that sets v from p - F/A: it is stable for any M not far below a grain's, at every dt that the grains
/// allow, and comes to rest where F = p A to round-off. The dashpot is taken at the new velocity, so that any c is stable.
template <int D>
struct Wall {
	Side side = Side::y_low;
	double position = 0;  ///< of its surface, along its axis [m]
	double velocity = 0;  ///< along its axis [m/s], half a step behind the position
	Vec<D> slide;         ///< velocity of its surface along the other axes [m/s]
	bool pressed = false;
	double pressure = 0;                                           ///< p, inwards [N/m], [N/m^2] in space
	double mass = 0;                                               ///< M [kg], > 0 where pressed
	double damping = 0;                                            ///< c [kg/s]
	double speed_limit = std::numeric_limits<double>::infinity();  ///< v_max [m/s]
	Vec<D> force;                                                  ///< by the grains, in the last step [N]

	int axis() const { return axis_of(side); }
	double outward() const { return outward_of(side); }
	Vec<D> surface_velocity() const
	{
		Vec<D> v = slide;
		v[axis()] = velocity;
		return v;
	}

	void move(double extent, double kick, double drift)
	{
		if (pressed) {
			const double pushed = velocity + (force[axis()] - outward() * pressure * extent) / mass * kick;
			velocity = std::clamp(pushed / (1 + damping / mass * kick), -speed_limit, speed_limit);
		}
		position += velocity * drift;
	}
};

}  // namespace graindrive::loop
