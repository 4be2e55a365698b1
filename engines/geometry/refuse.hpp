/// How the room refuses bad input: the rule, the value that was given, the way out.
#pragma once
#include <sstream>
#include <stdexcept>
#include <string>

#include "engines/geometry/vec.hpp"

namespace graindrive::geometry {

/// "(1, 2.5, 3)".
template <int D>
std::ostream& operator<<(std::ostream& out, const Vec<D>& v)
{
	for (int k = 0; k < D; ++k) out << (k == 0 ? "(" : ", ") << v[k];
	return out << ")";
}

/// @throws std::invalid_argument "RULE, got VALUE; WAY OUT" unless the rule holds
template <class Value>
void require(bool holds, const std::string& rule, const Value& value, const std::string& way_out)
{
	if (holds) return;
	std::ostringstream message;
	message.precision(10);
	message << rule << ", got " << value << "; " << way_out;
	throw std::invalid_argument(message.str());
}

template <int D>
void require_finite(const std::string& what, const Vec<D>& value)
{
	require(is_finite(value), what + " must be finite numbers", value, "correct it");
}

inline void require_positive(const std::string& what, double value)
{
	require(value > 0 && std::isfinite(value), what + " must be positive and finite", value, "give a length > 0");
}

/// The direction as a unit vector.
template <int D>
Vec<D> direction(const std::string& what, const Vec<D>& given)
{
	require_finite(what, given);
	require(largest(given) > 0, what + " must not be zero", given, "give a direction of any length");
	return unit(given);
}

}  // namespace graindrive::geometry
