/// Closed forms of the prescribed motions: displacement from the start as a function of time.
#pragma once
#include "engines/base/real.hpp"

namespace graindrive {

/// Harmonic motion that starts from rest of displacement: u(0) = 0.
///
/// Displacement form:  u = A [sin(2 pi t/T + phi) - sin phi],              A a length
/// Velocity form:      du/dt = A sin(2 pi t/T + phi),                       A a velocity
///                     u = A T/(2 pi) [cos phi - cos(2 pi t/T + phi)]
/// Both readings of Tripura et al. (the wiggle paper), whose text writes the second and uses the first.
struct Oscillation {
	enum class Form { displacement, velocity };

	Real amplitude;  ///< A [m] or [m/s]
	Real period;     ///< T [s]
	Real phase;      ///< phi [rad]
	Form form;

	/// Largest displacement from the centre of the motion [m].
	Real reach() const { return std::abs(form == Form::displacement ? amplitude : amplitude * period / (2 * pi)); }

	Real displacement(Real t) const
	{
		const Real angle = 2 * pi * t / period + phase;
		if (form == Form::displacement) return amplitude * (std::sin(angle) - std::sin(phase));
		return amplitude * period / (2 * pi) * (std::cos(phase) - std::cos(angle));
	}
};

/// Rotation by a fixed spin omega [rad/s] about its own direction for a time t.
inline Quaternionr rotation(const Vector3r& omega, Real t)
{
	const Real speed = omega.norm();
	if (speed == 0) return Quaternionr::Identity();
	return Quaternionr(Eigen::AngleAxis<Real>(speed * t, omega / speed));
}

}  // namespace graindrive
