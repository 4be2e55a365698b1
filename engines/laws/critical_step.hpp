/// The largest stable time step of leapfrog for a contact.
#pragma once
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive::laws {

/// Leapfrog's limit of a damped oscillator: omega dt < 2 (sqrt(1 + zeta^2) - zeta), omega^2 = k/m, zeta = c/(2 sqrt(k m)), with the
/// velocity of the dashpot half a step behind. Stiffness [N/m], dashpot [N s/m], mass [kg] -> [s].
inline Real critical_step(Real stiffness, Real dashpot, Real mass)
{
	const Real omega = std::sqrt(stiffness / mass), zeta = dashpot / (2 * std::sqrt(stiffness * mass));
	return 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
}

}  // namespace graindrive::laws
