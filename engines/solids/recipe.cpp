/// The table of kinds, and the reader.
#include "engines/solids/recipe.hpp"

#include <charconv>
#include <map>
#include <stdexcept>

#include "engines/geometry/outline_surface.hpp"
#include "engines/geometry/rigid_motion.hpp"
#include "engines/geometry/sampled_distance.hpp"
#include "engines/geometry/set_algebra.hpp"
#include "engines/geometry/solids.hpp"

namespace graindrive::solids {
namespace {

using namespace geometry;

constexpr int deepest = 200;                    // surfaces within surfaces: each costs a call in every evaluation
constexpr std::size_t longest_word_shown = 40;  // in messages on damaged recipes
constexpr const char* own_recipe = "use the text of Surface.recipe";

/// The reader's error, as distinct from the std::invalid_argument of a surface.
class Damaged : public std::invalid_argument {
	using std::invalid_argument::invalid_argument;
};

/// Members of an initialiser list in braces are read in the order in which they stand.
struct Posed {
	Vec<3> at, direction;
};

SharedSurface<3> read_half_space(RecipeReader& r)
{
	const Posed plane{ r.vector("point"), r.vector("normal") };
	return shared(HalfSpace<3>(plane.at, plane.direction));
}

SharedSurface<3> read_ball(RecipeReader& r)
{
	const Vec<3> centre = r.vector("centre");
	return shared(Ball<3>(centre, r.number("radius")));
}

SharedSurface<3> read_cylinder(RecipeReader& r)
{
	const Posed line{ r.vector("middle"), r.vector("axis") };
	const double radius = r.number("radius");
	return shared(Cylinder(line.at, line.direction, radius, r.number("length")));
}

SharedSurface<3> read_swept_outline(RecipeReader& r)
{
	const Vec<3> middle = r.vector("middle");
	const Posed axes{ r.vector("x axis"), r.vector("y axis") };
	const double length = r.number("length");
	const std::vector<double> numbers = r.numbers(2 * r.count("number of vertices"), "vertex");
	std::vector<Vec<2>> vertices;
	for (std::size_t i = 0; i < numbers.size(); i += 2) vertices.push_back({ numbers[i], numbers[i + 1] });
	return shared(SweptOutline(OutlineSurface(vertices), middle, axes.at, axes.direction, length));
}

SharedSurface<3> read_sampled(RecipeReader& r)
{
	SampleGrid<3> grid;
	std::size_t nodes = 1;
	for (std::size_t& count : grid.count) nodes *= count = r.count("number of nodes along an axis");
	grid.low = r.vector("low corner");
	grid.spacing = r.vector("spacing");
	return shared(SampledDistance<3>(grid, r.numbers(nodes, "distance")));
}

SharedSurface<3> read_placed(RecipeReader& r)
{
	const Vec<3> place = r.vector("place");
	Turn<3> turn;
	turn.w = r.number("orientation");
	turn.u = r.vector("orientation");
	require(turn.is_finite() && (turn.w != 0 || largest(turn.u) > 0),
		"an orientation must be a quaternion that is finite and not zero", turn.u, "give w x y z");
	return shared(Placed<3>(r.surface(), place, turn));
}

SharedSurface<3> read_complement(RecipeReader& r) { return shared(Complement<3>(r.surface())); }
SharedSurface<3> read_union(RecipeReader& r) { return shared(Union<3>(r.surfaces(r.count("number of parts")))); }
SharedSurface<3> read_intersection(RecipeReader& r) { return shared(Intersection<3>(r.surfaces(r.count("number of parts")))); }

/// One line for each kind of surface.
std::map<std::string, ReadSurface, std::less<>>& table()
{
	static std::map<std::string, ReadSurface, std::less<>> kinds{
		{ "ball", read_ball },
		{ "complement", read_complement },
		{ "cylinder", read_cylinder },
		{ "half_space", read_half_space },
		{ "intersection", read_intersection },
		{ "placed", read_placed },
		{ "sampled", read_sampled },
		{ "swept_outline", read_swept_outline },
		{ "union", read_union },
	};
	return kinds;
}

std::string all_kinds()
{
	std::string all;
	for (const std::string& name : kinds()) all += (all.empty() ? "" : ", ") + name;
	return all;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string shortened(std::string_view word)
{
	return std::string(word.substr(0, longest_word_shown)) + (word.size() > longest_word_shown ? "..." : "");
}

}  // namespace

SharedSurface<3> surface_of(const std::string& recipe)
{
	RecipeReader reader(recipe);
	const SharedSurface<3> surface = reader.surface();
	reader.end();
	return surface;
}

std::string number_text(double number)
{
	char digits[32];
	return { digits, std::to_chars(digits, digits + sizeof digits, number).ptr };
}

bool add_kind(const std::string& name, ReadSurface read)
{
	const bool is_word = !name.empty() && std::none_of(name.begin(), name.end(), is_space);
	require(is_word, "a kind of surface needs one word as its name", "'" + name + "'", "give one such as torus");
	require(
		table().emplace(name, read).second, "a kind of surface needs a new name", "'" + name + "'", "taken are " + all_kinds());
	return true;
}

std::vector<std::string> kinds()
{
	std::vector<std::string> names;
	for (const auto& [name, read] : table()) names.push_back(name);
	return names;
}

void RecipeReader::refuse(const std::string& rule, std::string_view got, const std::string& way_out) const
{
	throw Damaged(rule + ", got '" + shortened(got) + "' as word " + std::to_string(place_) + " of the recipe; " + way_out);
}

std::string_view RecipeReader::next(const char* wanted, const char* what)
{
	while (!rest_.empty() && is_space(rest_.front())) rest_.remove_prefix(1);
	if (rest_.empty())
		throw Damaged("a recipe must be complete, got one that ends after word " + std::to_string(place_) + ", where " +
					  std::string(kind_) + " needs " + wanted + what + "; " + own_recipe);
	std::size_t length = 0;
	while (length < rest_.size() && !is_space(rest_[length])) ++length;
	const std::string_view word = rest_.substr(0, length);
	rest_.remove_prefix(length);
	++place_;
	return word;
}

double RecipeReader::number(const char* what)
{
	const std::string_view word = next("a number, its ", what);
	double value = 0;
	const auto [stopped, error] = std::from_chars(word.data(), word.data() + word.size(), value);
	if (error != std::errc() || stopped != word.data() + word.size() || std::isnan(value))
		refuse(std::string(what) + " of " + std::string(kind_) + " must be a number", word, own_recipe);
	return value;
}

Vec<3> RecipeReader::vector(const char* what)
{
	Vec<3> v;
	for (int k = 0; k < 3; ++k) v[k] = number(what);
	return v;
}

std::size_t RecipeReader::count(const char* what)
{
	const std::string_view word = next("its ", what);
	std::size_t value = 0;
	const auto [stopped, error] = std::from_chars(word.data(), word.data() + word.size(), value);
	const bool is_whole = error == std::errc() && stopped == word.data() + word.size();
	if (!is_whole || value == 0 || value > rest_.size())
		refuse(std::string(what) + " of " + std::string(kind_) + " must be a whole number from 1 to that of the words behind it",
			word, own_recipe);
	return value;
}

std::vector<double> RecipeReader::numbers(std::size_t count, const char* what)
{
	std::vector<double> values;
	values.reserve(std::min(count, rest_.size()));
	for (std::size_t i = 0; i < count; ++i) values.push_back(number(what));
	return values;
}

SharedSurface<3> RecipeReader::surface()
{
	const std::string_view outer = kind_;
	kind_ = next("a surface");
	const std::size_t place = place_;
	const auto found = table().find(kind_);
	if (found == table().end()) refuse("a recipe must begin with the name of a surface, of " + all_kinds(), kind_, own_recipe);
	if (++depth_ > deepest)
		refuse(
			"a recipe must not nest more than " + std::to_string(deepest) + " surfaces", kind_, "put many parts into one union");
	SharedSurface<3> surface;
	try {
		surface = found->second(*this);
	} catch (const Damaged&) {
		throw;
	} catch (const std::invalid_argument& refused) {
		throw Damaged(
			std::string(refused.what()) + " (" + std::string(kind_) + ", word " + std::to_string(place) + " of the recipe)");
	}
	--depth_;
	kind_ = outer;
	return surface;
}

std::vector<SharedSurface<3>> RecipeReader::surfaces(std::size_t count)
{
	std::vector<SharedSurface<3>> all;
	for (std::size_t i = 0; i < count; ++i) all.push_back(surface());
	return all;
}

void RecipeReader::end()
{
	while (!rest_.empty() && is_space(rest_.front())) rest_.remove_prefix(1);
	if (rest_.empty()) return;
	const std::string_view word = next("nothing");
	refuse("a recipe must end with its one surface", word, "join solids with union or intersection");
}

}  // namespace graindrive::solids
