/// Sampled functions that are accepted as distances, and others that are refused.
#include "engines/solids/sampled_recipe.hpp"

#include "engines/geometry/solids.hpp"
#include "engines/geometry/test_support.hpp"
#include "engines/solids/recipe.hpp"

namespace graindrive::solids {
namespace {

using namespace geometry;

template <class Function>
std::vector<double> samples(const SampleGrid<3>& grid, Function&& function)
{
	std::vector<double> values;
	for (std::size_t k = 0; k < grid.count[2]; ++k)
		for (std::size_t j = 0; j < grid.count[1]; ++j)
			for (std::size_t i = 0; i < grid.count[0]; ++i) values.push_back(function(grid.node({ i, j, k })));
	return values;
}

SampleGrid<3> around(double reach, std::size_t nodes)
{
	return { Vec<3>::all(-reach), Vec<3>::all(2 * reach / double(nodes - 1)), { nodes, nodes, nodes } };
}

TEST(SampledRecipe, IsTheSampledDistance)
{
	const SampleGrid<3> grid = around(2, 21);
	const Ball<3> ball({}, 1);
	const std::vector<double> values = samples(grid, [&](const Vec<3>& at) { return ball.nearest(at).distance; });
	const SharedSurface<3> rebuilt = surface_of(sampled_recipe(grid, values));
	const SampledDistance<3> direct(grid, values);
	RandomPoints<3> random(1.9);
	for (int i = 0; i < 300; ++i) {
		const Vec<3> at = random();
		EXPECT_EQ(rebuilt->nearest(at).distance, direct.nearest(at).distance);
	}
}

TEST(SampledRecipe, TakesABallOfFourSpacings)
{
	// As coarse as the limit of the slope allows.
	const SampleGrid<3> grid = around(2, 17);
	EXPECT_NO_THROW(sampled_recipe(grid, samples(grid, [](const Vec<3>& at) { return norm(at) - 1; })));
}

TEST(SampledRecipe, RefusesWhatIsNoDistanceSayingItsSlope)
{
	const SampleGrid<3> grid = around(2, 21);
	const auto refusal = [&](auto function) { return complaint([&] { sampled_recipe(grid, samples(grid, function)); }); };
	const std::string half = refusal([](const Vec<3>& at) { return 0.5 * (norm(at) - 1); });
	EXPECT_TRUE(mentions(half, "must have the length 1 near the surface, got half of them between 0.49")) << half;
	const std::string squared = refusal([](const Vec<3>& at) { return squared_norm(at) - 1; });
	EXPECT_TRUE(mentions(squared, "near the surface, got half of them between ")) << squared;
	EXPECT_TRUE(mentions(refusal([](const Vec<3>& at) { return norm(at) < 1 ? -NAN : 1.0; }), "finite"));
	const std::string reaching = refusal([](const Vec<3>& at) { return at[2]; });
	EXPECT_TRUE(mentions(reaching, "with distances > 0 at all outer nodes, got the least of them -2")) << reaching;
}

}  // namespace
}  // namespace graindrive::solids
