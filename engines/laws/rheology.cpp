/// Constants of friction laws, and the range of inertial numbers in which mu(I) is well-posed.
#include "engines/laws/rheology.hpp"

#include <sstream>

namespace graindrive::laws {

namespace {

FrictionConstants checked(const FrictionConstants& given)
{
	require(static_friction, given.mu_s);
	require(dynamic_friction, given.mu_2);
	require(inertial_scale, given.I_0);
	if (given.mu_2 < given.mu_s) {
		std::ostringstream message;
		message << "dynamicFriction mu_2 must not be below staticFriction mu_s = " << given.mu_s << ", got " << given.mu_2;
		throw std::invalid_argument(message.str());
	}
	return given;
}

/// The zero of f between a and b to round-off; f(a) and f(b) have different signs.
template <class Function>
Real bisected(Function&& f, Real a, Real b)
{
	const bool sign = f(a) > 0;
	for (int k = 0; k < 200; ++k) {
		const Real middle = std::sqrt(a * b);
		if (middle <= a || middle >= b) break;
		((f(middle) > 0) == sign ? a : b) = middle;
	}
	return std::sqrt(a * b);
}

}  // namespace

MuOfI::MuOfI(const FrictionConstants& given) : c(checked(given)) {}

WellPosed well_posed_range(const MuOfI& law)
{
	const auto criterion = [&](Real I) { return ill_posedness(law, I); };
	constexpr Real least = 1e-12, most = 1e6;
	Real best = least;
	for (Real I = least; I < most; I *= 1.05)
		if (criterion(I) < criterion(best)) best = I;
	if (criterion(best) >= 0) return { most, least };
	return { bisected(criterion, least, best), bisected(criterion, best, most) };
}

RegularisedMuOfI::RegularisedMuOfI(const FrictionConstants& given, Real mu_inf_, Real a_)
	: c(checked(given)),
	  mu_inf(mu_inf_),
	  a(a_)
{
	require({ "fastFriction", "mu_inf", "-", "growth of friction in very fast flow", not_negative }, mu_inf);
	require({ "slowRise", "a", "-", "constant of friction in very slow flow", positive }, a);
	const WellPosed range = well_posed_range(MuOfI(given));
	if (range.low > range.high) {
		std::ostringstream message;
		message << "friction must rise enough with the inertial number to be well-posed anywhere, got mu_s = " << c.mu_s
				<< ", mu_2 = " << c.mu_2 << "; take a larger dynamicFriction";
		throw std::invalid_argument(message.str());
	}
	I_1 = range.low;
	const Real mu = (c.mu_s * c.I_0 + c.mu_2 * I_1 + mu_inf * I_1 * I_1) / (c.I_0 + I_1);
	A = I_1 * std::exp(a / (mu * mu));
}

Real RegularisedMuOfI::friction(Real I) const
{
	if (I > I_1) return (c.mu_s * c.I_0 + c.mu_2 * I + mu_inf * I * I) / (c.I_0 + I);
	return I > 0 ? std::sqrt(a / std::log(A / I)) : 0;
}

Real RegularisedMuOfI::slope(Real I) const
{
	if (I > I_1) return (c.mu_2 + 2 * mu_inf * I - friction(I)) / (c.I_0 + I);
	if (I <= 0) return 0;
	const Real mu = friction(I);
	return mu * mu * mu / (2 * a * I);
}

}  // namespace graindrive::laws
