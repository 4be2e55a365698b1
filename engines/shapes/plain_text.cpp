/// Recognises encodings by their bytes: byte order marks, zeros at fixed places, EBCDIC's digits.
#include "engines/shapes/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <stdexcept>

#include "engines/shapes/outline_checks.hpp"
#include "engines/shapes/words.hpp"

namespace graindrive::shapes {

namespace {

constexpr std::size_t most_lines = 2 * most_given;  // leaves room for as many blank lines and comments as vertices

bool opens_with(const std::string& bytes, const std::string& mark) { return bytes.compare(0, mark.size(), mark) == 0; }

/// True if in each group of `width` bytes, among the first 64 bytes, all are zero but one, which is always at the same place.
bool is_wide(const std::string& bytes, std::size_t width)
{
	std::array<std::size_t, 4> zeros{};
	const std::size_t seen = std::min<std::size_t>(bytes.size(), 64) / width;
	for (std::size_t i = 0; i < width * seen; ++i) zeros[i % width] += bytes[i] == '\0';
	const auto end = zeros.begin() + width;
	return seen > 1 && std::count(zeros.begin(), end, seen) == static_cast<long>(width) - 1 &&
	       std::count(zeros.begin(), end, 0u) == 1;
}

bool is_utf32(const std::string& bytes)
{
	return opens_with(bytes, std::string("\xFF\xFE\0\0", 4)) || opens_with(bytes, std::string("\0\0\xFE\xFF", 4)) ||
	       is_wide(bytes, 4);
}

bool is_utf16(const std::string& bytes)
{
	return opens_with(bytes, "\xFF\xFE") || opens_with(bytes, "\xFE\xFF") || is_wide(bytes, 2);
}

bool continues(unsigned char c) { return (c & 0xC0) == 0x80; }

/// EBCDIC has its digits at F0 to F9; in UTF-8 these bytes are always followed by a byte that continues the character. A text of
/// coordinates consists of digits to a large part, and in EBCDIC it has no ASCII digit.
bool is_ebcdic(const std::string& bytes)
{
	std::size_t digits = 0;
	for (std::size_t i = 0; i < bytes.size(); ++i) {
		const unsigned char c = bytes[i];
		if (std::isdigit(c)) return false;
		digits += c >= 0xF0 && c <= 0xF9 && (i + 1 == bytes.size() || !continues(bytes[i + 1]));
	}
	return 8 * digits > bytes.size();
}

[[noreturn]] void refuse(const std::string& what, const std::string& way_out)
{
	throw std::invalid_argument("an outline must be plain or UTF-8 text, got " + what + "; " + way_out);
}

/// Length of the UTF-8 character of more than one byte that begins with `c`; 0 if none does.
std::size_t length_from(unsigned char c)
{
	if (c >= 0xC2 && c < 0xE0) return 2;
	if ((c & 0xF0) == 0xE0) return 3;
	return c >= 0xF0 && c < 0xF5 ? 4 : 0;
}

}  // namespace

void require_text(const std::string& bytes)
{
	if (is_utf32(bytes)) refuse("UTF-32", "save it as UTF-8");
	if (is_utf16(bytes)) refuse("UTF-16", "save it as UTF-8");
	if (is_ebcdic(bytes)) refuse("EBCDIC", "save it as UTF-8");
	if (std::any_of(bytes.begin(), bytes.end(), [](unsigned char c) { return c < ' ' && !std::isspace(c); }))
		refuse("binary data", "save its vertices as CSV or WKT");
}

std::vector<std::string> lines_of(const std::string& text)
{
	std::string unix_text;
	unix_text.reserve(text.size());
	for (std::size_t i = opens_with(text, "\xEF\xBB\xBF") ? 3 : 0; i < text.size(); ++i) {
		if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') continue;
		unix_text += text[i] == '\r' ? '\n' : text[i];
	}
	require_count(
		1 + std::count(unix_text.begin(), unix_text.end(), '\n'), most_lines, "lines", "leave out blank lines and comments");
	std::vector<std::string> lines = split(unix_text, '\n');
	for (std::string& line : lines) line = stripped(line.substr(0, line.find('#')));
	return lines;
}

std::string foreign_character(const std::string& text)
{
	const auto at = std::find_if(text.begin(), text.end(), [](unsigned char c) { return c > '~'; });
	if (at == text.end()) return "";
	const unsigned char first = *at;
	const std::size_t length = length_from(first), left = text.end() - at;
	const bool whole = length > 0 && length <= left && std::all_of(at + 1, at + length, continues);
	unsigned code = whole ? first & (0xFF >> (length + 1)) : first;
	for (std::size_t i = 1; whole && i < length; ++i) code = code << 6 | (static_cast<unsigned char>(at[i]) & 0x3F);
	char name[32];
	std::snprintf(name, sizeof name, whole ? "U+%04X" : "a byte 0x%02X", code);
	return name;
}

std::string note_on_foreign(const std::string& text)
{
	const std::string found = foreign_character(text);
	return found.empty() ? "" : " (with " + found + "; numbers are written with 0 to 9, +, -, . and e alone)";
}

void require_count(std::size_t count, std::size_t most, const std::string& what, const std::string& way_out)
{
	if (count <= most) return;
	throw std::invalid_argument(
		"outline must have at most " + std::to_string(most) + " " + what + ", got " + std::to_string(count) + "; " + way_out);
}

}  // namespace graindrive::shapes
