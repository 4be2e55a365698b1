/// Recipes: surfaces as words, so that a scene, a checkpoint or a pickle brings them back to the last bit.
///
/// A recipe names a kind of surface, then gives its numbers and, for a surface made of others, their recipes:
///
///   ball x y z radius                                  half_space x y z nx ny nz
///   cylinder x y z ax ay az radius length              (length `inf` without ends)
///   swept_outline x y z  xx xy xz  yx yy yz length n x1 y1 ... xn yn
///   sampled nx ny nz  x y z  hx hy hz  d1 d2 ...       (low corner, spacings, distances with x fastest)
///   placed x y z qw qx qy qz RECIPE                    complement RECIPE
///   union n RECIPE ... RECIPE                          intersection n RECIPE ... RECIPE
///
/// Numbers are decimals. Written with as many digits as `number_text` and Python's repr give, they come back as the same bits.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engines/geometry/surface.hpp"

namespace graindrive::solids {

using geometry::SharedSurface;
using geometry::Vec;

/// A surface and the words that it was made of.
struct Described {
	std::string recipe;
	SharedSurface<3> surface;
};

/// The surface of a recipe.
/// @throws std::invalid_argument naming the word and its place where it is no recipe, and what the surface itself refuses
SharedSurface<3> surface_of(const std::string& recipe);

/// The shortest decimals that come back as the same bits.
std::string number_text(double number);

/// Reads a recipe from left to right. A kind of surface asks for what it needs, in the order of its words.
class RecipeReader {
public:
	explicit RecipeReader(std::string_view text) : rest_(text) {}

	double number(const char* what);
	Vec<3> vector(const char* what);
	/// A whole number; refused unless at least as many words follow.
	std::size_t count(const char* what);
	std::vector<double> numbers(std::size_t count, const char* what);
	/// The surface that the next words describe.
	SharedSurface<3> surface();
	std::vector<SharedSurface<3>> surfaces(std::size_t count);
	/// Refuses words behind the end.
	void end();

private:
	std::string_view next(const char* wanted, const char* what = "");
	[[noreturn]] void refuse(const std::string& rule, std::string_view got, const std::string& way_out) const;

	std::string_view rest_;
	std::string_view kind_ = "the recipe";
	std::size_t place_ = 0;  // of the word read last, from 1
	int depth_ = 0;
};

using ReadSurface = SharedSurface<3> (*)(RecipeReader&);

/// Gives a kind of surface a name in recipes. For a class of one's own, in a source of the module:
///
///   static const bool known = add_kind("torus", [](RecipeReader& r) -> SharedSurface<3> {
///       return shared(Torus{ r.number("ring"), r.number("thickness") });
///   });
///
/// (in braces the numbers are read in the order in which they stand).
/// @throws std::invalid_argument for a name that there is, or one that is no word
bool add_kind(const std::string& name, ReadSurface read);

/// All names, in alphabetical order.
std::vector<std::string> kinds();

}  // namespace graindrive::solids
