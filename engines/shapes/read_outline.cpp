/// WKT by Boost.Geometry, CSV by hand: locale plays no part in either.
#include "engines/shapes/read_outline.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cctype>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace graindrive::shapes {

namespace {

std::string without_comments(const std::string& text)
{
	std::istringstream lines(text.rfind("\xEF\xBB\xBF", 0) == 0 ? text.substr(3) : text);  // less a byte-order mark
	std::string kept;
	for (std::string line; std::getline(lines, line);) kept += line.substr(0, line.find('#')) + '\n';
	return kept;
}

/// "POLYGON" of "polygon ((0 0, ...": the leading letters in capitals.
std::string leading_word(const std::string& text)
{
	std::string word;
	const auto start = std::find_if(text.begin(), text.end(), [](unsigned char c) { return !std::isspace(c); });
	for (auto c = start; c != text.end() && std::isalpha(static_cast<unsigned char>(*c)); ++c)
		word += std::toupper(static_cast<unsigned char>(*c));
	return word;
}

bool is_wkt(const std::string& word)
{
	for (const char* tag : { "POINT", "LINESTRING", "LINEARRING", "POLYGON", "TRIANGLE", "MULTIPOINT", "MULTILINESTRING",
			 "MULTIPOLYGON", "GEOMETRYCOLLECTION" })
		if (word == tag) return true;
	return false;
}

/// Boost's reader takes blanks for white space, but not line ends, nor the semicolon with which databases end a statement.
std::string one_line(std::string text)
{
	for (char& c : text)
		if (std::isspace(static_cast<unsigned char>(c))) c = ' ';
	text.erase(text.find_last_not_of(" ;") + 1);
	return text;
}

Points from_wkt(const std::string& text, const std::string& word)
{
	namespace bg = boost::geometry;
	if (word != "POLYGON")
		throw std::invalid_argument(
			"an outline must be one WKT POLYGON, got a " + word + "; save the outer ring alone as POLYGON ((x y, ...))");
	bg::model::polygon<bg::model::d2::point_xy<Real>> polygon;
	try {
		bg::read_wkt(one_line(text), polygon);
	} catch (const bg::read_wkt_exception& error) {
		throw std::invalid_argument(
			std::string("cannot read the WKT (") + error.what() + "); an outline is one POLYGON ((x y, x y, ...))");
	}
	if (!polygon.inners().empty())
		throw std::invalid_argument(
			"an outline must not have holes, got " + std::to_string(polygon.inners().size()) + "; keep the outer ring alone");
	Points vertices;
	for (const auto& p : polygon.outer()) vertices.emplace_back(p.x(), p.y());
	return vertices;
}

std::vector<std::string> fields_of(std::string line)
{
	const bool has_empty = line.find(",,") != std::string::npos || line.find(";;") != std::string::npos;
	std::replace_if(
		line.begin(), line.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
	std::istringstream words(line);
	std::vector<std::string> fields{ std::istream_iterator<std::string>(words), {} };
	if (has_empty) fields.emplace_back();
	return fields;
}

std::optional<Real> number(const std::string& field)
{
	const char* start = field.data() + (field.size() > 1 && field[0] == '+');
	const char* end = field.data() + field.size();
	Real value;
	const auto [stop, failure] = std::from_chars(start, end, value);
	if (failure != std::errc() || stop != end) return std::nullopt;
	return value;
}

Points from_csv(const std::string& text)
{
	Points vertices;
	bool header_possible = true;
	std::istringstream lines(text);
	int line_number = 0;
	for (std::string line; std::getline(lines, line);) {
		++line_number;
		const auto fields = fields_of(line);
		if (fields.empty()) continue;
		const auto x = number(fields[0]), y = fields.size() > 1 ? number(fields[1]) : std::nullopt;
		const bool is_header = header_possible && !x && !y;
		header_possible = false;
		if (is_header) continue;
		if (!x || !y || fields.size() != 2)
			throw std::invalid_argument("line " + std::to_string(line_number) + " must hold two numbers x, y, got '" +
										line.substr(0, line.find_last_not_of(" \t\r") + 1) +
										"'; comments start with #, decimals take a point");
		vertices.emplace_back(*x, *y);
	}
	return vertices;
}

}  // namespace

Points vertices_in(const std::string& text)
{
	const std::string plain = without_comments(text), word = leading_word(plain);
	return is_wkt(word) ? from_wkt(plain, word) : from_csv(plain);
}

Outline read_outline(const std::string& path)
{
	std::ifstream file(path);
	std::ostringstream text;
	if (!(file && text << file.rdbuf()))
		throw std::invalid_argument(
			"cannot read an outline from '" + path + "': it must be a readable file with vertices in WKT or CSV");
	try {
		return Outline(vertices_in(text.str()));
	} catch (const std::invalid_argument& error) {
		throw std::invalid_argument(path + ": " + error.what());
	}
}

}  // namespace graindrive::shapes
