/// The coefficients of YADE's own laws from the properties of one material.
#include "engines/laws/yade_laws.hpp"

#include "engines/laws/require.hpp"

namespace graindrive::laws {

CundallStrack<Real> cundall_strack(Real young, Real poisson, Real mu)
{
	require(young > 0, "Young's modulus must be positive [Pa]", young);
	require(poisson >= 0 && std::isfinite(poisson), "Poisson's ratio, here k_t/k_n, must not be negative", poisson);
	require(mu >= 0, "friction coefficient must not be negative", mu);
	return { young, poisson, mu };
}

HertzMindlin<Real> hertz_mindlin(Real young, Real poisson, Real beta_n, Real beta_t, Real mu)
{
	require(young > 0, "Young's modulus must be positive [Pa]", young);
	require(poisson > -1 && poisson <= 0.5, "Poisson's ratio must lie in (-1, 0.5]", poisson);
	require(beta_n >= 0 && std::isfinite(beta_n), "normal damping ratio must not be negative", beta_n);
	require(beta_t >= 0 && std::isfinite(beta_t), "tangential damping ratio must not be negative", beta_t);
	require(mu >= 0, "friction coefficient must not be negative", mu);
	const Real effective_young = young / (2 * (1 - poisson * poisson)),
			   effective_shear = young / (4 * (1 + poisson) * (2 - poisson));
	return { effective_young, effective_shear, 2 * beta_n * std::sqrt(2 * effective_young),
		2 * beta_t * std::sqrt(8 * effective_shear), mu };
}

}  // namespace graindrive::laws
