/// Flat walls: what one is, how it answers to what it is told, and the contact of a grain with it.
///
/// A wall is parallel to x or y and bounds the grains on one side. Grains meet it as they meet a frozen grain of infinite radius and
/// mass: R_eff = R, m_eff = m, with the law and the history of every other contact.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

namespace graindrive::loop {

enum class Side : int { x_low, x_high, y_low, y_high };

/// A wall keeps its velocity, or is pushed inwards by a pressure p and moves, as a body of mass M with a dashpot c, along its axis:
///
///   M dv/dt = F - p L - c v,  |v| <= v_max,  F by the grains, p L over the wall's length L
///
/// A mass rather than a servo that sets v from p - F/L: it is stable for any M not far below a grain's, at every dt that the grains
/// allow, and comes to rest where F = p L to round-off. The dashpot is taken at the new velocity, so that any c is stable.
struct Wall {
	Side side = Side::y_low;
	double position = 0;  ///< of its surface, along its axis [m]
	double velocity = 0;  ///< along its axis [m/s], half a step behind the position
	double slide = 0;     ///< velocity of its surface along the other axis [m/s]
	bool pressed = false;
	double pressure = 0;                                           ///< p, inwards [N/m]
	double mass = 0;                                               ///< M [kg], > 0 where pressed
	double damping = 0;                                            ///< c [kg/s]
	double speed_limit = std::numeric_limits<double>::infinity();  ///< v_max [m/s]
	double force_x = 0, force_y = 0;                               ///< by the grains, in the last step [N]

	bool across_x() const { return side == Side::x_low || side == Side::x_high; }  ///< its axis is x
	double outward() const { return side == Side::x_low || side == Side::y_low ? -1 : 1; }
	double velocity_x() const { return across_x() ? velocity : slide; }
	double velocity_y() const { return across_x() ? slide : velocity; }
	double force() const { return across_x() ? force_x : force_y; }  ///< along its axis [N]

	void move(double length, double kick, double drift)
	{
		if (pressed) {
			const double pushed = velocity + (force() - outward() * pressure * length) / mass * kick;
			velocity = std::clamp(pushed / (1 + damping / mass * kick), -speed_limit, speed_limit);
		}
		position += velocity * drift;
	}
};

/// A grain at a wall or near it; the tangential spring follows the grain, wherever its row is moved.
struct WallTouch {
	std::uint32_t wall, grain;        ///< in `Scene::walls` and `Scene::grains`
	double slip = 0;                  ///< tangential spring [m]
	double slip_before = 0;           ///< the same before the last step [m]
	double overlap = 0;               ///< [m], <= 0 where they do not touch
	double normal = 0, friction = 0;  ///< F_n > 0 repels, F_t along z x n on the grain [N]; n is outward
};

}  // namespace graindrive::loop
