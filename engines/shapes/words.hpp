/// What the readers of outlines share: words, numbers, and text as messages show it. Locale plays no part.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engines/base/real.hpp"

namespace graindrive::shapes {

std::string stripped(const std::string& text);                            ///< without white space at both ends
std::vector<std::string> words_of(const std::string& text);               ///< parts between white space
std::vector<std::string> split(const std::string& text, char separator);  ///< stripped; "" has one part
std::optional<Real> number(const std::string& word);                      ///< the whole word as a number, if it is one
std::string shown(const std::string& text);                               ///< 'text' on one short line of plain letters

}  // namespace graindrive::shapes
