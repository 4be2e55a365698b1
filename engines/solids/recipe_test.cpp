/// Recipes bring back the same surface; damaged ones are refused.
#include "engines/solids/recipe.hpp"

#include "engines/geometry/outline_surface.hpp"
#include "engines/geometry/rigid_motion.hpp"
#include "engines/geometry/sampled_distance.hpp"
#include "engines/geometry/set_algebra.hpp"
#include "engines/geometry/solids.hpp"
#include "engines/geometry/test_support.hpp"

namespace graindrive::solids {
namespace {

using namespace geometry;

/// Compares distances and normals at random points to the last digit.
void expect_same(const Surface<3>& a, const Surface<3>& b)
{
	RandomPoints<3> random(3);
	for (int i = 0; i < 200; ++i) {
		const Vec<3> at = random();
		const Nearest<3> one = a.nearest(at), other = b.nearest(at);
		ASSERT_EQ(one.distance, other.distance) << i;
		ASSERT_EQ(one.normal, other.normal) << i;
	}
}

std::string refusal(const std::string& recipe)
{
	return complaint([&] { surface_of(recipe); });
}

TEST(Recipe, GivesTheSurfaceThatItNames)
{
	const double third = 1.0 / 3, tenth = 0.1;
	const std::string digits = number_text(third) + " " + number_text(tenth);
	expect_same(*surface_of("ball " + digits + " -1 0.7"), Ball<3>({ third, tenth, -1 }, 0.7));
	expect_same(*surface_of("half_space " + digits + " 1 1 2 3"), HalfSpace<3>({ third, tenth, 1 }, { 1, 2, 3 }));
	expect_same(*surface_of("cylinder 0 0 1 " + digits + " 1 0.5 inf"), Cylinder({ 0, 0, 1 }, { third, tenth, 1 }, 0.5));
	expect_same(*surface_of("cylinder 0 0 1 1 1 0 0.5 2"), Cylinder({ 0, 0, 1 }, { 1, 1, 0 }, 0.5, 2));
	expect_same(*surface_of("swept_outline 0 0 1 1 0 0 0 1 0 2 3  0 0  1 0  0 " + number_text(third)),
		SweptOutline(
			OutlineSurface(std::vector<Vec<2>>{ { 0, 0 }, { 1, 0 }, { 0, third } }), { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 }, 2));
}

TEST(Recipe, NestsSurfaces)
{
	const SharedSurface<3> ball = shared(Ball<3>({ 1, 0, 0 }, 1)), plane = shared(HalfSpace<3>({}, { 0, 0, 1 }));
	expect_same(*surface_of("complement ball 1 0 0 1"), Complement<3>(ball));
	expect_same(*surface_of("union 2 ball 1 0 0 1 half_space 0 0 0 0 0 1"), Union<3>({ ball, plane }));
	expect_same(*surface_of("intersection 2 ball 1 0 0 1 complement half_space 0 0 0 0 0 1"),
		Intersection<3>({ ball, shared(Complement<3>(plane)) }));
	expect_same(*surface_of("placed 1 2 3  0.5 0.5 0.5 0.5  union 1 ball 1 0 0 1"),
		Placed<3>(ball, { 1, 2, 3 }, { 0.5, { 0.5, 0.5, 0.5 } }));
}

TEST(Recipe, KeepsEveryBitOfANumber)
{
	RandomPoints<3> random(1);
	for (int i = 0; i < 1000; ++i) {
		const double number = random.number() * std::pow(10, 300 * random.number());
		EXPECT_EQ(std::stod(number_text(number)), number);
	}
}

TEST(Recipe, KeepsSampledDistances)
{
	std::string recipe = "sampled 4 5 6 -1 -1.5 -2 0.7 0.8 0.9";
	SampleGrid<3> grid{ { -1, -1.5, -2 }, { 0.7, 0.8, 0.9 }, { 4, 5, 6 } };
	const Ball<3> ball({}, 0.7);
	for (int k = 0; k < 6; ++k)
		for (int j = 0; j < 5; ++j)
			for (int i = 0; i < 4; ++i)
				recipe += " " + number_text(ball.nearest(grid.low + Vec<3>{ i * 0.7, j * 0.8, k * 0.9 }).distance);
	const SharedSurface<3> sampled = surface_of(recipe);
	RandomPoints<3> random(0.9);
	for (int i = 0; i < 100; ++i) {
		const Vec<3> at = random();
		// With a spacing of 1.3 radii cubic interpolation is inaccurate, but still follows the ball.
		ASSERT_NEAR(sampled->nearest(at).distance, ball.nearest(at).distance, 0.2) << i;
	}
}

TEST(Recipe, RefusesDamageNamingWordAndPlace)
{
	EXPECT_EQ(refusal(""),
		"a recipe must be complete, got one that ends after word 0, where the recipe needs a surface; use the text of "
		"Surface.recipe");
	EXPECT_TRUE(mentions(refusal("bal 0 0 0 1"), "got 'bal' as word 1")) << refusal("bal 0 0 0 1");
	EXPECT_TRUE(mentions(refusal("bal 0 0 0 1"), "ball, complement, cylinder"));
	EXPECT_TRUE(mentions(refusal("ball 0 0 0"), "ends after word 4, where ball needs a number, its radius"));
	EXPECT_TRUE(mentions(refusal("ball 0 zero 0 1"), "centre of ball must be a number, got 'zero' as word 3"));
	EXPECT_TRUE(mentions(refusal("ball 0 0.1.2 0 1"), "got '0.1.2' as word 3"));
	EXPECT_TRUE(mentions(refusal("ball 0 nan 0 1"), "got 'nan' as word 3"));
	EXPECT_TRUE(mentions(refusal("ball 0 0 0 1 7"), "must end with its one surface, got '7' as word 6"));
	EXPECT_TRUE(mentions(refusal("union 2 ball 0 0 0 1 ball 0 0 0 x"), "radius of ball must be a number, got 'x' as word 12"));
	EXPECT_TRUE(mentions(refusal("union 2 ball 0 0 0 1"), "ends after word 7, where union needs a surface"));
	EXPECT_TRUE(mentions(refusal("union 1.5 ball 0 0 0 1"), "number of parts of union must be a whole number"));
	EXPECT_TRUE(mentions(refusal("union 99999999 ball 0 0 0 1"), "got '99999999' as word 2"));
	EXPECT_TRUE(mentions(refusal("placed 0 0 0 0 0 0 0 ball 0 0 0 1"), "orientation must be a quaternion"));
}

TEST(Recipe, SaysWhichSurfaceRefusedItsNumbers)
{
	EXPECT_EQ(refusal("complement ball 0 0 0 -1"),
		"ball radius must be positive and finite, got -1; give a length > 0 (ball, word 2 of the recipe)");
	EXPECT_TRUE(
		mentions(refusal("sampled 4 4 4 0 0 0 1 1 1 0"), "ends after word 11, where sampled needs a number, its distance"));
	EXPECT_TRUE(mentions(refusal("swept_outline 0 0 0 1 0 0 1 1 0 inf 3 0 0 1 0 0 1"), "must be perpendicular"));
}

TEST(Recipe, RefusesToNestWithoutEnd)
{
	std::string deep;
	for (int i = 0; i < 100000; ++i) deep += "complement ";
	EXPECT_TRUE(mentions(refusal(deep + "ball 0 0 0 1"), "must not nest more than 200 surfaces"));
}

/// A ring about z, as a user's own class.
class Torus : public Surface<3> {
public:
	Torus(double ring, double thickness) : ring_(ring), thickness_(thickness) {}
	Nearest<3> nearest(const Vec<3>& at) const override
	{
		const Vec<3> core = ring_ * unit(Vec<3>{ at[0], at[1], 0 });
		return { norm(at - core) - thickness_, unit(at - core) };
	}

private:
	double ring_, thickness_;
};

const bool known = add_kind("torus", [](RecipeReader& r) -> SharedSurface<3> {
	return shared(Torus{ r.number("ring"), r.number("thickness") });
});

TEST(Recipe, LearnsAShapeOfOnesOwnInOneLine)
{
	ASSERT_TRUE(known);
	EXPECT_EQ(surface_of("placed 0 0 1 1 0 0 0 torus 2 0.5")->nearest({ 3, 0, 1 }).distance, 0.5);
	EXPECT_TRUE(mentions(complaint([] { add_kind("torus", nullptr); }), "needs a new name, got 'torus'"));
	EXPECT_TRUE(mentions(complaint([] { add_kind("two words", nullptr); }), "needs one word as its name"));
}

}  // namespace
}  // namespace graindrive::solids
