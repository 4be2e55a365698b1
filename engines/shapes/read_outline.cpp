/// Reads a whole file. A line that holds no vertex is refused; only the first line may name the columns x and y instead.
#include "engines/shapes/read_outline.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "engines/shapes/outline_checks.hpp"
#include "engines/shapes/plain_text.hpp"
#include "engines/shapes/wkt.hpp"
#include "engines/shapes/words.hpp"

namespace graindrive::shapes {

namespace {

constexpr std::uintmax_t largest_file = 4 << 20;  // 5,000 vertices take 200 kB [bytes]
constexpr std::size_t longest_line = 1000;        // of a table [bytes]

std::string joined(const std::vector<std::string>& lines)
{
	std::string text;
	for (const std::string& line : lines) text += line + '\n';
	return text;
}

/// The geometries between double quotes, as tables hold them.
std::vector<std::string> quoted_geometries(const std::string& text)
{
	std::vector<std::string> found;
	for (std::size_t start = text.find('"'); start != std::string::npos;) {
		const std::size_t end = text.find('"', start + 1);
		if (end == std::string::npos) break;
		const std::string part = text.substr(start + 1, end - start - 1);
		if (is_wkt(part)) found.push_back(part);
		start = text.find('"', end + 1);
	}
	return found;
}

std::string unquoted(const std::string& field)
{
	return field.size() > 1 && field.front() == '"' && field.back() == '"' ? stripped(field.substr(1, field.size() - 2)) : field;
}

/// The fields of a line; none if the line is too long to hold two numbers.
std::vector<std::string> fields_of(const std::string& line)
{
	if (line.size() > longest_line) return {};
	std::vector<std::string> fields = words_of(line);
	for (const char separator : { ';', ',', '\t' }) {
		if (line.find(separator) == std::string::npos) continue;
		fields = split(line, separator);
		if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
		break;
	}
	std::transform(fields.begin(), fields.end(), fields.begin(), unquoted);
	return fields;
}

bool is_unit(const std::string& text)
{
	return text.size() > 1 && ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'));
}

/// Refuses a unit in brackets other than d, because numbers are taken as grain diameters whatever a header says.
void require_diameters(const std::string& unit, const std::string& line, std::size_t line_number)
{
	if (stripped(unit.substr(1, unit.size() - 2)) == "d") return;
	throw std::invalid_argument("line " + std::to_string(line_number) + " gives lengths in " + shown(unit) + ", in " +
								shown(line) +
								"; an outline has them in grain diameters: divide them by d and write [d] or no unit");
}

/// True if the field is the letter `name`, lower or upper case, alone or with a unit in brackets.
bool names_column(const std::string& field, char name)
{
	if (field.empty() || std::tolower(static_cast<unsigned char>(field[0])) != name) return false;
	const std::string rest = stripped(field.substr(1));
	return rest.empty() || is_unit(rest);
}

/// True if the fields name the columns x and y. Any other first line is read as a vertex, so that one with a mistyped digit is
/// not skipped as a header. Throws std::invalid_argument for a header with a unit other than d.
bool is_header(std::vector<std::string> fields, const std::string& line, std::size_t line_number)
{
	if (fields.size() == 4 && is_unit(fields[1]) && is_unit(fields[3]))  // blanks separate names from units too
		fields = { fields[0] + fields[1], fields[2] + fields[3] };
	if (fields.size() != 2 || !names_column(fields[0], 'x') || !names_column(fields[1], 'y')) return false;
	for (const std::string& field : fields)
		if (const std::string unit = stripped(field.substr(1)); !unit.empty()) require_diameters(unit, line, line_number);
	return true;
}

Vector2r vertex_in(const std::string& line, const std::vector<std::string>& fields, std::size_t line_number, bool header_possible)
{
	if (fields.size() == 2) {
		const auto x = number(fields[0]), y = number(fields[1]);
		if (x && y) return { *x, *y };
	}
	const std::string header = header_possible ? "; a header names x and y alone, as in x [d], y [d]" : "";
	throw std::invalid_argument("line " + std::to_string(line_number) + " must hold two numbers x, y, got " + shown(line) +
								note_on_foreign(line) + header + "; comments start with #, decimals take a point");
}

Points vertices_in_table(const std::vector<std::string>& lines)
{
	const std::size_t filled = lines.size() - std::count(lines.begin(), lines.end(), "");
	require_count(filled, most_given + 1, "lines that are not blank");  // one more, for a header
	Points vertices;
	bool header_possible = true;
	for (std::size_t i = 0; i < lines.size(); ++i) {
		if (lines[i].empty()) continue;
		const auto fields = fields_of(lines[i]);
		if (!header_possible || !is_header(fields, lines[i], i + 1))
			vertices.push_back(vertex_in(lines[i], fields, i + 1, header_possible));
		header_possible = false;
	}
	return vertices;
}

/// The text of a regular file. Pipes and devices are refused, because reading them may never end.
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
