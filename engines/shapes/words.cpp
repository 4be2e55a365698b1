/// Splits and reads words and numbers. std::from_chars takes a point for the decimals in every locale.
#include "engines/shapes/words.hpp"

#include <algorithm>
#include <charconv>

namespace graindrive::shapes {

namespace {

constexpr const char* blanks = " \t\n\r\v\f";
constexpr std::size_t longest_shown = 60;

}  // namespace

std::string stripped(const std::string& text)
{
	const auto start = text.find_first_not_of(blanks);
	return start == std::string::npos ? "" : text.substr(start, text.find_last_not_of(blanks) + 1 - start);
}

std::vector<std::string> words_of(const std::string& text)
{
	std::vector<std::string> words;
	for (std::size_t start = text.find_first_not_of(blanks); start != std::string::npos;) {
		const std::size_t end = std::min(text.find_first_of(blanks, start), text.size());
		words.push_back(text.substr(start, end - start));
		start = text.find_first_not_of(blanks, end);
	}
	return words;
}

std::vector<std::string> split(const std::string& text, char separator)
{
	std::vector<std::string> parts;
	std::size_t start = 0;
	for (std::size_t end = text.find(separator); end != std::string::npos; end = text.find(separator, start)) {
		parts.push_back(stripped(text.substr(start, end - start)));
		start = end + 1;
	}
	parts.push_back(stripped(text.substr(start)));
	return parts;
}

std::optional<Real> number(const std::string& word)
{
	const char* start = word.data() + (word.size() > 1 && word[0] == '+' && word[1] != '-');
	const char* end = word.data() + word.size();
	Real value;
	const auto [stop, failure] = std::from_chars(start, end, value);
	if (failure != std::errc() || stop != end) return std::nullopt;
	return value;
}

std::string shown(const std::string& text)
{
	std::string line = stripped(text).substr(0, longest_shown + 1);
	std::replace_if(
		line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
	return "'" + (line.size() > longest_shown ? line.substr(0, longest_shown - 3) + "..." : line) + "'";
}

}  // namespace graindrive::shapes
