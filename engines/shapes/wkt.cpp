/// Reads WKT. The reader of Boost.Geometry is not used, because it ignores a third number and takes a missing one for 0.
#include "engines/shapes/wkt.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include "engines/shapes/outline_checks.hpp"
#include "engines/shapes/plain_text.hpp"
#include "engines/shapes/words.hpp"

namespace graindrive::shapes {

namespace {

const char* const srid = "SRID";  // keyword of a coordinate system's number
const char* const an_outline_is = "; an outline is one POLYGON ((x y, x y, ...))";

constexpr std::size_t longest_vertex = 1000;  // [bytes]
constexpr std::size_t most_brackets = 1000;   // an outline needs two or three

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)); }

/// Reads a text from front to back.
class Scanner {
public:
	explicit Scanner(const std::string& text) : text_(text) {}

	std::string word()
	{
		skip_blanks();
		std::string word;
		while (place_ < text_.size() && is_letter(text_[place_]))
			word += std::toupper(static_cast<unsigned char>(text_[place_++]));
		return word;
	}

	bool take(char wanted)
	{
		skip_blanks();
		if (place_ == text_.size() || text_[place_] != wanted) return false;
		++place_;
		return true;
	}

	void require(char wanted)
	{
		if (!take(wanted))
			throw std::invalid_argument(
				std::string("cannot read the WKT: '") + wanted + "' must stand before " + shown(rest()) + an_outline_is);
	}

	/// The text up to the next bracket of either kind.
	std::string up_to_bracket()
	{
		const std::size_t start = place_;
		place_ = std::min(text_.find_first_of("()", place_), text_.size());
		return text_.substr(start, place_ - start);
	}

	std::string rest() const { return text_.substr(place_); }
	char next()
	{
		skip_blanks();
		return place_ < text_.size() ? text_[place_] : '\0';
	}

private:
	void skip_blanks()
	{
		while (place_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[place_]))) ++place_;
	}

	const std::string& text_;
	std::size_t place_ = 0;
};

/// The text without a coordinate system's number in front, which is not part of the shape.
std::string without_srid(const std::string& text)
{
	const std::string plain = stripped(text);
	Scanner scanner(plain);
	const auto end = plain.find(';');
	return scanner.word() == srid && scanner.take('=') && end != std::string::npos ? plain.substr(end + 1) : plain;
}

bool is_dimension(const std::string& word) { return word == "Z" || word == "M" || word == "ZM"; }

bool is_geometry(const std::string& word)
{
	static const std::array<const char*, 17> tags{ "POINT", "LINESTRING", "LINEARRING", "POLYGON", "TRIANGLE", "MULTIPOINT",
		"MULTILINESTRING", "MULTIPOLYGON", "GEOMETRYCOLLECTION", "CIRCULARSTRING", "COMPOUNDCURVE", "CURVEPOLYGON", "MULTICURVE",
		"MULTISURFACE", "POLYHEDRALSURFACE", "TIN", "CURVE" };
	return std::find(tags.begin(), tags.end(), word) != tags.end();
}

/// Name of a geometry, and its suffix Z, M or ZM if both are one word.
struct Tag {
	std::string geometry, dimension;
};

Tag tag_of(const std::string& word)
{
	for (const char* dimension : { "ZM", "Z", "M" }) {
		const std::string ending(dimension);
		if (word.size() <= ending.size() || word.substr(word.size() - ending.size()) != ending) continue;
		const std::string geometry = word.substr(0, word.size() - ending.size());
		if (is_geometry(geometry)) return { geometry, ending };
	}
	return { word, "" };
}

/// The text of each vertex of a ring.
using Ring = std::vector<std::string>;

Ring ring(Scanner& scanner)
{
	scanner.require('(');
	const Ring vertices = split(scanner.up_to_bracket(), ',');
	scanner.require(')');
	return vertices;
}

std::vector<Ring> polygon(Scanner& scanner)
{
	scanner.require('(');
	std::vector<Ring> rings;
	do rings.push_back(ring(scanner));
	while (scanner.take(','));
	scanner.require(')');
	return rings;
}

std::vector<Real> numbers(const std::string& vertex, std::size_t count, std::size_t index)
{
	std::vector<Real> values;
	const auto words = vertex.size() > longest_vertex ? Ring() : words_of(vertex);
	for (const std::string& word : words)
		if (const auto value = number(word)) values.push_back(*value);
	if (values.size() == count && words.size() == count) return values;
	throw std::invalid_argument("vertex " + std::to_string(index) + " of the WKT must hold " + std::to_string(count) +
								" numbers, got " + shown(vertex) + note_on_foreign(vertex) +
								"; write x y, a blank between the two, a comma between vertices, decimals with a point");
}

Points vertices_of(const Ring& ring, const std::string& dimension)
{
	Points vertices;
	Real height = 0;
	for (std::size_t i = 0; i < ring.size(); ++i) {
		const auto values = numbers(ring[i], 2 + dimension.size(), i);
		vertices.emplace_back(values[0], values[1]);
		if (dimension.empty() || dimension[0] != 'Z') continue;
		if (i == 0) height = values[2];
		if (values[2] != height)
			throw std::invalid_argument("all vertices of a POLYGON Z must be at one height, for an outline is flat, got " +
										shown(words_of(ring[i])[2]) + " at vertex " + std::to_string(i) +
										"; save it without heights");
	}
	return vertices;
}

std::vector<std::vector<Ring>> polygons(Scanner& scanner, const Tag& tag)
{
	if (tag.geometry == "POLYGON") return { polygon(scanner) };
	std::vector<std::vector<Ring>> members;
	scanner.require('(');
	do members.push_back(polygon(scanner));
	while (scanner.take(','));
	scanner.require(')');
	return members;
}

/// Refuses very long texts before they are read, by their commas and brackets. Exact numbers of rings and vertices are checked
/// later.
void require_short(const std::string& text)
{
	require_count(std::count(text.begin(), text.end(), '('), most_brackets, "opening brackets in its WKT",
		"keep the outer ring of one polygon");
	require_count(1 + std::count(text.begin(), text.end(), ','), most_given, "vertices in all");
}

void require_one(std::size_t count, const std::string& what, const std::string& way_out)
{
	if (count != 1) throw std::invalid_argument("an outline must be " + what + ", got " + std::to_string(count) + "; " + way_out);
}

}  // namespace

bool is_wkt(const std::string& text)
{
	const std::string plain = without_srid(text);
	Scanner scanner(plain);
	const std::string name = scanner.word();
	if (name == srid && scanner.take('=')) return true;  // a second number of a coordinate system is WKT too, and refused later
	if (!is_geometry(tag_of(name).geometry)) return false;
	const char next = scanner.next();
	if (!is_letter(next)) return next != ',' && next != ';' && next != '\0';  // otherwise it is the name of a column
	const std::string word = scanner.word();
	return word == "EMPTY" || is_dimension(word);
}

Points vertices_in_wkt(const std::string& text)
{
	const std::string plain = without_srid(text);
	require_short(plain);
	Scanner scanner(plain);
	Tag tag = tag_of(scanner.word());
	if (tag.geometry == srid)
		throw std::invalid_argument(std::string("an outline must have at most one SRID=...; before it, got a second at ") +
									shown(plain) + "; keep the one that is meant, or none");
	if (tag.geometry != "POLYGON" && tag.geometry != "MULTIPOLYGON")
		throw std::invalid_argument(
			"an outline must be one WKT POLYGON, got a " + tag.geometry + "; save the outer ring alone as POLYGON ((x y, ...))");
	std::string word = scanner.word();
	if (is_dimension(word)) tag.dimension = word, word = scanner.word();
	if (word == "EMPTY") throw std::invalid_argument("the WKT " + tag.geometry + " is EMPTY" + an_outline_is);
	const auto members = polygons(scanner, tag);
	scanner.take(';');
	if (scanner.next() != '\0')
		throw std::invalid_argument("cannot read the WKT: after the polygon stands " + shown(scanner.rest()) + an_outline_is);
	require_one(members.size(), "one POLYGON", "save the one that is meant");
	if (members[0].size() > 1)
		throw std::invalid_argument(
			"an outline must not have holes, got " + std::to_string(members[0].size() - 1) + "; keep the outer ring alone");
	return vertices_of(members[0][0], tag.dimension);
}

}  // namespace graindrive::shapes
