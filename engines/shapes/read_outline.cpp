/// Files are read whole and as text; what is not a text of vertices is refused by what it is.
#include "engines/shapes/read_outline.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "engines/shapes/wkt.hpp"
#include "engines/shapes/words.hpp"

namespace graindrive::shapes {

namespace {

constexpr std::uintmax_t largest_file = 4 << 20;  // 5,000 vertices take 200 kB [bytes]

/// A byte-order mark, or every other byte zero as far as anyone looks.
bool is_utf16(const std::string& text)
{
	const std::string mark = text.substr(0, 2);
	if (mark == "\xFF\xFE" || mark == "\xFE\xFF") return true;
	std::array<std::size_t, 2> zeros{};
	const std::size_t seen = std::min<std::size_t>(text.size(), 64) / 2;
	for (std::size_t i = 0; i < 2 * seen; ++i) zeros[i % 2] += text[i] == '\0';
	return seen > 1 && std::max(zeros[0], zeros[1]) == seen && std::min(zeros[0], zeros[1]) == 0;
}

void require_text(const std::string& text)
{
	if (is_utf16(text)) throw std::invalid_argument("an outline must be plain or UTF-8 text, got UTF-16; save it as UTF-8");
	if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' ' && !std::isspace(c); }))
		throw std::invalid_argument("an outline must be plain or UTF-8 text, got binary data; save its vertices as CSV or WKT");
}

/// The lines of a text, without byte-order mark and comments, whatever system ended them.
std::vector<std::string> lines_of(const std::string& text)
{
	std::string unix_text = text.rfind("\xEF\xBB\xBF", 0) == 0 ? text.substr(3) : text;
	for (std::size_t at = 0; (at = unix_text.find("\r\n", at)) != std::string::npos;) unix_text.erase(at, 1);
	std::replace(unix_text.begin(), unix_text.end(), '\r', '\n');
	std::vector<std::string> lines = split(unix_text, '\n');
	for (std::string& line : lines) line = stripped(line.substr(0, line.find('#')));
	return lines;
}

std::string joined(const std::vector<std::string>& lines)
{
	std::string text;
	for (const std::string& line : lines) text += line + '\n';
	return text;
}

/// What stands between double quotes, as tables hold a geometry.
std::vector<std::string> quoted_geometries(const std::string& text)
{
	std::vector<std::string> found;
	const auto parts = split(text, '"');
	for (std::size_t i = 1; i + 1 < parts.size(); i += 2)
		if (is_wkt(parts[i])) found.push_back(parts[i]);
	return found;
}

std::vector<std::string> fields_of(const std::string& line)
{
	std::string plain = line;
	plain.erase(std::remove(plain.begin(), plain.end(), '"'), plain.end());
	for (const char separator : { ';', ',', '\t' }) {
		if (plain.find(separator) == std::string::npos) continue;
		auto fields = split(plain, separator);
		if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
		return fields;
	}
	return words_of(plain);
}

/// Names of columns: no field opens as a number would.
bool is_header(const std::vector<std::string>& fields)
{
	return std::none_of(fields.begin(), fields.end(), [](const std::string& field) {
		return field.empty() || std::isdigit(static_cast<unsigned char>(field[0])) || field.find_first_of("+-.,{}[(<") == 0 ||
		       number(field);
	});
}

Vector2r vertex_in(const std::string& line, const std::vector<std::string>& fields, std::size_t line_number)
{
	if (fields.size() == 2) {
		const auto x = number(fields[0]), y = number(fields[1]);
		if (x && y) return { *x, *y };
	}
	throw std::invalid_argument("line " + std::to_string(line_number) + " must hold two numbers x, y, got " + shown(line) +
								"; comments start with #, decimals take a point");
}

Points vertices_in_table(const std::vector<std::string>& lines)
{
	Points vertices;
	bool header_possible = true;
	for (std::size_t i = 0; i < lines.size(); ++i) {
		if (lines[i].empty()) continue;
		const auto fields = fields_of(lines[i]);
		const bool header = header_possible && is_header(fields);
		header_possible = false;
		if (!header) vertices.push_back(vertex_in(lines[i], fields, i + 1));
	}
	return vertices;
}

/// The text of a file, read only if it can end: a pipe or a device may not.
std::string contents_of(const std::string& path)
{
	namespace fs = std::filesystem;
	const auto refuse = [&](const std::string& why) {
		throw std::invalid_argument("cannot read an outline from " + shown(path) + ": " + why);
	};
	if (path.find('\0') != std::string::npos) refuse("a path must not hold the byte 0");
	std::error_code error;
	const fs::file_status status = fs::status(path, error);
	if (!fs::status_known(status) || !fs::exists(status)) refuse(error.message() + "; name a file with vertices in WKT or CSV");
	if (!fs::is_regular_file(status))
		refuse(std::string("it must be a readable file with vertices in WKT or CSV, got ") +
			   (fs::is_directory(status) ? "a folder" : "a pipe or a device"));
	std::ifstream file(path, std::ios::binary);
	std::string text(largest_file + 1, '\0');
	if (!file || (file.read(text.data(), static_cast<std::streamsize>(text.size())), file.bad()))
		refuse("it must be a readable file with vertices in WKT or CSV; look at its permissions");
	text.resize(static_cast<std::size_t>(file.gcount()));
	if (text.size() > largest_file)
		refuse("it must not be larger than 4 MiB; leave out vertices that are finer than a bead can show");
	return text;
}

}  // namespace

Points vertices_in(const std::string& text)
{
	require_text(text);
	const auto lines = lines_of(text);
	const std::string plain = joined(lines);
	if (is_wkt(plain)) return vertices_in_wkt(plain);
	const auto geometries = quoted_geometries(plain);
	if (geometries.size() > 1)
		throw std::invalid_argument("a table of geometries must hold one outline, got " + std::to_string(geometries.size()) +
									"; keep the row that is meant");
	return geometries.empty() ? vertices_in_table(lines) : vertices_in_wkt(geometries[0]);
}

Outline read_outline(const std::string& path)
{
	const std::string text = contents_of(path);
	try {
		return Outline(vertices_in(text));
	} catch (const std::invalid_argument& error) {
		throw std::invalid_argument(path + ": " + error.what());
	}
}

}  // namespace graindrive::shapes
