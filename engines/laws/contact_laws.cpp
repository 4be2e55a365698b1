/// The coefficients of the contact laws from material properties, as the papers tabulate them.
#include "engines/laws/contact_laws.hpp"

#include "engines/laws/require.hpp"

namespace graindrive::laws {

Real damping_fraction(Real restitution)
{
	require(restitution > 0 && restitution <= 1, "restitution must lie in (0, 1]", restitution);
	const Real log_e = std::log(restitution);
	return -log_e / std::sqrt(log_e * log_e + pi * pi);
}

HertzRestitution<Real> hertz_restitution(Real young, Real poisson, Real restitution, Real mu)
{
	require(young > 0, "Young's modulus must be positive [Pa]", young);
	require(poisson > -1 && poisson <= 0.5, "Poisson's ratio must lie in (-1, 0.5]", poisson);
	require(mu >= 0, "friction coefficient must not be negative", mu);
	return { young / (2 * (1 - poisson * poisson)), 3 * (1 - poisson) / (2 - poisson), damping_fraction(restitution), mu };
}

SpringDashpot<Real> spring_dashpot(Real k_n, Real k_t, Real restitution, Real mu)
{
	require(k_n > 0, "normal stiffness must be positive [N/m]", k_n);
	require(k_t >= 0, "tangential stiffness must not be negative [N/m]", k_t);
	require(mu >= 0, "friction coefficient must not be negative", mu);
	return { k_n, k_t, 2 * damping_fraction(restitution) * std::sqrt(k_n), mu };
}

}  // namespace graindrive::laws
