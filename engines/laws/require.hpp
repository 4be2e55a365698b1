/// The refusal that the makers of laws share.
#pragma once
#include <sstream>
#include <stdexcept>

#include "engines/base/real.hpp"

namespace graindrive::laws {

/// @throws std::invalid_argument with the rule and the value received, unless the rule holds
inline void require(bool holds, const char* rule, Real got)
{
	if (holds) return;
	std::ostringstream message;
	message << rule << ", got " << got;
	throw std::invalid_argument(message.str());
}

}  // namespace graindrive::laws
