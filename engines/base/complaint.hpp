/// What the C++ tests of bad input share: the message that an action throws.
#pragma once
#include <stdexcept>
#include <string>

namespace graindrive {

/// What `action` complains about; empty if it does not.
template <class Action>
std::string complaint(Action action)
{
	try {
		action();
	} catch (const std::invalid_argument& error) {
		return error.what();
	}
	return "";
}

inline bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace graindrive
