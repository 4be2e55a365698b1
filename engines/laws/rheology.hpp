/// What a continuum of grains resists shear with: friction as a function of the inertial number, and the viscosity that it makes.
#pragma once
#include <algorithm>
#include <cmath>
#include <variant>

#include "engines/laws/quantity.hpp"

namespace graindrive::laws {

constexpr Quantity static_friction{ "staticFriction", "mu_s", "-", "friction of slow flow", positive };
constexpr Quantity dynamic_friction{ "dynamicFriction", "mu_2", "-", "friction of fast flow", positive };
constexpr Quantity inertial_scale{ "inertialScale", "I_0", "-", "inertial number of the transition", positive };

/// The three constants of friction between slow and fast flow; by default those that Oba, Otsuki (2025) found for their disks.
struct FrictionConstants {
	Real mu_s = 0.246;  ///< at I = 0 [-]
	Real mu_2 = 0.401;  ///< at I = infinity [-]
	Real I_0 = 0.133;   ///< where friction is half-way [-]
};

/// mu(I) = mu_s + (mu_2 - mu_s)/(I_0/I + 1): Jop, Forterre, Pouliquen (2006).
class MuOfI {
public:
	MuOfI() : MuOfI(FrictionConstants{}) {}
	/// @throws std::invalid_argument for constants that are not positive, or a mu_2 below mu_s
	explicit MuOfI(const FrictionConstants& given);

	/// of the inertial number I >= 0
	Real friction(Real I) const { return c.mu_s + (c.mu_2 - c.mu_s) * I / (c.I_0 + I); }
	/// d mu/d I
	Real slope(Real I) const { return (c.mu_2 - c.mu_s) * c.I_0 / ((c.I_0 + I) * (c.I_0 + I)); }

private:
	FrictionConstants c;
};

/// mu(I) made well-posed at small and at large inertial numbers: Barker, Gray (2017), equations of section 6.
///
///   mu = sqrt(a/ln(A/I))                                 for I <= I_1
///   mu = (mu_s I_0 + mu_2 I + mu_inf I^2)/(I_0 + I)      beyond
///
/// I_1 is where MuOfI with the same constants becomes ill-posed towards slow flow; A makes mu continuous there.
class RegularisedMuOfI {
public:
	RegularisedMuOfI() : RegularisedMuOfI(FrictionConstants{}) {}
	/// @throws std::invalid_argument as MuOfI; for constants with which no inertial number is well-posed; for a negative mu_inf
	explicit RegularisedMuOfI(const FrictionConstants& given, Real mu_inf = 0.05, Real a = 1.9);

	Real friction(Real I) const;
	Real slope(Real I) const;
	/// I_1, below which the law differs from MuOfI's rise from mu_s
	Real neutral() const { return I_1; }

private:
	FrictionConstants c;
	Real mu_inf, a, I_1, A;
};

/// 4 r^2 - 4 r + mu^2 (1 - r/2)^2 with r = I mu'/mu: where it is positive, short waves in an incompressible flow with that friction grow
/// without bound, so that no grid resolves it. Barker, Schaeffer, Bohorquez, Gray (2015), (3.8) in the form of Barker, Gray (2017).
template <class Friction>
Real ill_posedness(const Friction& law, Real I)
{
	const Real mu = law.friction(I), r = I * law.slope(I) / mu;
	return 4 * r * r - 4 * r + mu * mu * (1 - r / 2) * (1 - r / 2);
}

/// The inertial numbers between which MuOfI with these constants is well-posed; `low > high` if there are none.
struct WellPosed {
	Real low, high;
};
WellPosed well_posed_range(const MuOfI& law);

/// Grains as a fluid, eta = mu(I) p/rate, with I = rate d sqrt(rho_s/p).
template <class Friction>
struct GranularFluid {
	Friction friction_law;
	Real inertia = 1;  ///< d sqrt(rho_s), grain diameter and density of grains

	Real inertial_number(Real rate, Real pressure) const { return rate * inertia / std::sqrt(pressure); }

	/// Shear stress over shear rate; both arguments > 0.
	Real viscosity(Real rate, Real pressure) const
	{
		return friction_law.friction(inertial_number(rate, pressure)) * pressure / rate;
	}
	bool ill_posed(Real rate, Real pressure) const { return ill_posedness(friction_law, inertial_number(rate, pressure)) > 0; }
};

/// tau = eta rate: for checks against closed forms, and for liquids.
struct NewtonianFluid {
	Real constant;  ///< eta

	Real viscosity(Real, Real) const { return constant; }
	bool ill_posed(Real, Real) const { return false; }
};

/// tau = tau_y + eta rate: Bingham (1922). A granular fluid at constant pressure and large I_0 is one.
struct BinghamFluid {
	Real yield_stress, plastic_viscosity;

	Real viscosity(Real rate, Real) const { return yield_stress / rate + plastic_viscosity; }
	bool ill_posed(Real, Real) const { return false; }
};

/// Any of them; a sweep over cells asks which one once.
using Rheology = std::variant<GranularFluid<MuOfI>, GranularFluid<RegularisedMuOfI>, NewtonianFluid, BinghamFluid>;

}  // namespace graindrive::laws
