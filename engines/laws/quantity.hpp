/// The numbers that laws are made of: name, symbol, unit, meaning, and what values they may have.
#pragma once
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

#include "engines/base/real.hpp"

namespace graindrive::laws {

constexpr Real unbounded = std::numeric_limits<Real>::infinity();

/// Finite numbers between two bounds, of which each belongs to them or not.
struct Range {
	const char* words;  ///< "must be positive"
	Real low, high;
	bool with_low, with_high;

	/// False for what is not a number.
	bool holds(Real value) const
	{
		return std::isfinite(value) && (with_low ? value >= low : value > low) && (with_high ? value <= high : value < high);
	}
};

constexpr Range positive{ "must be positive", 0, unbounded, false, false };
constexpr Range not_negative{ "must not be negative", 0, unbounded, true, false };

struct Quantity {
	const char* name;     ///< in interfaces, as YADE's attributes are written
	const char* symbol;   ///< in formulas
	const char* unit;     ///< "-" for pure numbers
	const char* meaning;  ///< in words
	Range range;
	const char* way_out = "";  ///< what to do in place of a value that is refused, in brackets
};

constexpr Quantity friction_coefficient{ "friction", "mu", "-", "friction coefficient", not_negative };
constexpr Quantity young_modulus{ "young", "E", "Pa", "Young's modulus", positive };
constexpr Quantity poisson_ratio{ "poisson", "nu", "-", "Poisson's ratio", { "must lie in (-1, 0.5]", -1, 0.5, false, true } };
constexpr Quantity coefficient_of_restitution{ "restitution", "e", "-", "restitution",
	{ "must lie in (0, 1]", 0, 1, false, true } };

/// @throws std::invalid_argument with the rule, the value received and the way out, unless it is in range. An interface has its own
/// name for the quantity.
inline void require(const Quantity& quantity, Real value, const std::string& interface_name = "")
{
	if (quantity.range.holds(value)) return;
	std::ostringstream message;
	message << (interface_name.empty() ? quantity.meaning : interface_name) << ' ' << quantity.range.words;
	if (std::isinf(value) && quantity.range.high == unbounded) message << " and finite";
	if (interface_name.empty() && quantity.unit[0] != '-') message << " [" << quantity.unit << ']';
	message << quantity.way_out << ", got " << value;
	throw std::invalid_argument(message.str());
}

/// The same for all numbers of a law's material.
template <class Given>
void require_in_range(const Given& given)
{
	Given::quantities([&](const Quantity& quantity, auto member) { require(quantity, given.*member); });
}

/// b = -ln e / sqrt(ln^2 e + pi^2): fraction of critical damping of a linear contact with restitution e in (0, 1].
/// @throws std::invalid_argument for a value out of range
inline Real damping_fraction(Real restitution)
{
	require(coefficient_of_restitution, restitution);
	const Real log_e = std::log(restitution);
	return -log_e / std::sqrt(log_e * log_e + pi * pi);
}

}  // namespace graindrive::laws
