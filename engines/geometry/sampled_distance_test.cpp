/// Distances interpolated from grids: exact cases, how errors fall with the spacing, and results beside the grid.
#include "engines/geometry/sampled_distance.hpp"

#include "engines/geometry/solids.hpp"
#include "engines/geometry/test_support.hpp"

namespace graindrive::geometry {
namespace {

/// A cube of nodes about a point; the spacings differ a little.
template <int D>
SampleGrid<D> grid_about(const Vec<D>& middle, double reach, std::size_t count)
{
	SampleGrid<D> grid{ middle - Vec<D>::all(reach), Vec<D>::all(2 * reach / (count - 1)), {} };
	grid.count.fill(count);
	grid.count[0] = count + 3;
	grid.spacing[0] = 2 * reach / (count + 2);
	return grid;
}

template <int D>
std::function<double(const Vec<D>&)> distance_to(const Surface<D>& surface)
{
	return [&surface](const Vec<D>& at) { return surface.nearest(at).distance; };
}

/// Largest errors of distance and normal in a layer about the surface.
template <int D>
Nearest<D> errors(const Surface<D>& exact, const Surface<D>& sampled, double size, double layer, const Vec<D>& middle = {})
{
	RandomPoints<D> random(size, middle);
	Nearest<D> worst{ 0, {} };
	for (int i = 0; i < 4000; ++i) {
		const Vec<D> at = random();
		const Nearest<D> truth = exact.nearest(at), found = sampled.nearest(at);
		if (std::abs(truth.distance) > layer) continue;
		worst.distance = std::max(worst.distance, std::abs(found.distance - truth.distance));
		worst.normal[0] = std::max(worst.normal[0], norm(found.normal - truth.normal));
		EXPECT_NEAR(norm(found.normal), 1, 1e-15);
	}
	return worst;
}

TEST(SampledDistance, PlanesAreExact)
{
	const HalfSpace<2> line({ 0.1, 0.2 }, { 1, 3 });
	const HalfSpace<3> plane({ 0.1, 0.2, 0 }, { 1, 3, -2 });
	const Nearest<2> flat = errors(line, SampledDistance<2>(grid_about<2>({}, 1, 4), distance_to(line)), 1.0, 1.0);
	const Nearest<3> deep = errors(plane, SampledDistance<3>(grid_about<3>({}, 1, 5), distance_to(plane)), 1.0, 1.0);
	EXPECT_LT(flat.distance + deep.distance + flat.normal[0] + deep.normal[0], 3e-14);
}

TEST(SampledDistance, ParabolasAreExactUpToTheSides)
{
	// Not a distance, but its slope is small enough to be accepted as one: f = (x^2 + x y)/8 - 0.1.
	const auto f = [](const Vec<2>& at) { return (at[0] * at[0] + at[0] * at[1]) / 8 - 0.1; };
	const SampledDistance<2> sampled(grid_about<2>({}, 1, 6), f);
	RandomPoints<2> random(1);
	for (int i = 0; i < 500; ++i) {
		const Vec<2> at = random();
		EXPECT_NEAR(sampled.nearest(at).distance, f(at), 1e-15);
		EXPECT_LT(norm(sampled.nearest(at).normal - unit(Vec<2>{ 2 * at[0] + at[1], at[0] })),
			1e-11);  // divided by a slope that may be small
	}
	EXPECT_NEAR(sampled.nearest({ 1, 1 }).distance, 0.15, 1e-15);  // the last node
}

template <int D>
void expect_third_order(double unit, const Vec<D>& middle)
{
	const Ball<D> ball(middle + 0.05 * unit * Vec<D>::along(1), 0.6 * unit);
	const auto error_with = [&](std::size_t count) {
		const SampledDistance<D> sampled(grid_about<D>(middle, unit, count), distance_to(ball));
		return errors(ball, sampled, unit, 0.25 * unit, middle);
	};
	const Nearest<D> coarse = error_with(21), fine = error_with(41);
	const double ratio = coarse.distance / fine.distance, normals = coarse.normal[0] / fine.normal[0];
	EXPECT_GT(ratio, 6.5);  // 8 for the third order, 4 for the second
	EXPECT_GT(normals, 3.3);
	EXPECT_LT(coarse.distance, std::pow(0.1, 3) / std::pow(0.35, 2) * unit);  // h^3/R^2 with the smallest R of the layer
	EXPECT_LT(coarse.normal[0], std::pow(0.1 / 0.35, 2));
}

TEST(SampledDistance, ErrorsFallWithTheThirdPowerOfTheSpacing)
{
	expect_third_order<2>(1, {});
	expect_third_order<3>(1, {});
	expect_third_order<2>(1e-6, { 1e-3, -2e-3 });
	expect_third_order<2>(1, { 1e6, -1e6 });
}

TEST(SampledDistance, DistanceAndNormalFitTogetherAndAreContinuous)
{
	const Ball<2> ball({ 0.05, 0 }, 0.6);
	const SampleGrid<2> grid = grid_about<2>({}, 1, 21);
	const SampledDistance<2> sampled(grid, distance_to(ball));
	RandomPoints<2> random(0.9);
	for (int i = 0; i < 200; ++i) {
		const Vec<2> at = random();
		if (std::abs(sampled.nearest(at).distance) > 0.3) continue;
		EXPECT_LT(norm(unit(slope(sampled, at, 1e-6)) - sampled.nearest(at).normal), 1e-8);
	}
	for (std::size_t i = 1; i < 19; ++i) {
		const double side = grid.node({ i, 0 })[0];
		const Nearest<2> before = sampled.nearest({ side - 1e-12, 0.43 }), after = sampled.nearest({ side + 1e-12, 0.43 });
		EXPECT_NEAR(before.distance, after.distance, 1e-11);
		EXPECT_LT(norm(before.normal - after.normal), 1e-10);
	}
}

TEST(SampledDistance, BesideTheGridIsABoundIfTheSolidLiesWithin)
{
	const Ball<3> ball({}, 0.6);
	const SampledDistance<3> sampled(grid_about<3>({}, 1, 21), distance_to(ball));
	EXPECT_NEAR(sampled.margin(), 0.4, 0.01);
	EXPECT_EQ(sampled.largest_sphere(), sampled.margin());
	RandomPoints<3> random(3);
	for (int i = 0; i < 1000; ++i) {
		const Vec<3> at = random();
		if (largest(at) < 1) continue;
		EXPECT_LE(sampled.nearest(at).distance, ball.nearest(at).distance + 1e-14);
		EXPECT_GE(sampled.nearest(at).distance, sampled.margin());
	}
	for (int k = 0; k < 3; ++k) {
		EXPECT_LE(sampled.bounds().low[k], -0.6);
		EXPECT_GE(sampled.bounds().low[k], -0.8);
		EXPECT_GE(sampled.bounds().high[k], 0.6);
	}
}

TEST(SampledDistance, BesideTheGridIsRefusedIfTheSolidReachesItsSide)
{
	const HalfSpace<2> ground({ 0, 0 }, { 0, 1 });
	const SampledDistance<2> sampled(grid_about<2>({}, 1, 5), distance_to(ground));
	EXPECT_NO_THROW(sampled.nearest({ 1, 1 }));
	const std::string message = complaint([&] { sampled.nearest({ 0, 1.5 }); });
	EXPECT_TRUE(mentions(message, "outer layer, got (0, 1.5); sample a larger grid, from (-1, -1) to (1, 1) now")) << message;
	EXPECT_TRUE(mentions(complaint([&] { sampled.nearest({ std::nan(""), 0 }); }), "got (nan, 0)"));
	EXPECT_EQ(sampled.bounds().low[1], -std::numeric_limits<double>::infinity());
}

TEST(SampledDistance, RefusesSamplesThatAreNoDistances)
{
	const SampleGrid<2> grid{ { 0, 0 }, { 1, 1 }, { 4, 5 } };
	std::vector<double> heights;
	for (int i = 0; i < 20; ++i) heights.push_back(i / 4 - 1.5);
	const auto said = [&](std::size_t node, double value) {
		std::vector<double> changed = heights;
		changed[node] = value;
		return complaint([&] { SampledDistance<2>{ grid, changed }; });
	};
	EXPECT_EQ(said(0, -1.5), "");
	EXPECT_TRUE(mentions(said(6, std::nan("")), "must be finite, got nan; correct the one at (2, 1)"));
	EXPECT_TRUE(mentions(said(6, 3), "must not differ by more than their spacing, got 4.5; give true distances")) << said(6, 3);
	const auto with = [&](const SampleGrid<2>& other, const std::vector<double>& values) {
		return complaint([&] { SampledDistance<2>{ other, values }; });
	};
	EXPECT_TRUE(mentions(with(grid, { 1, 2, 3 }), "as many as nodes, 20, got 3; give one distance per node, x fastest"));
	EXPECT_TRUE(mentions(with(grid, std::vector<double>(20, 1)), "and > 0 at others, got (1, 1); extend the grid"));
	EXPECT_TRUE(mentions(with({ { 0, 0 }, { 1, 0 }, { 4, 5 } }, heights), "spacing must be positive and finite, got (1, 0)"));
	EXPECT_TRUE(mentions(with({ { 0, 0 }, { 1, 1 }, { 10, 2 } }, heights), "at least 4 nodes along each axis, got 2; refine"));
	EXPECT_TRUE(mentions(with({ { 0, 0 }, { 1, 1 }, { 1ul << 40, 5 } }, heights), "at most 2^31 nodes"));
	EXPECT_TRUE(mentions(with({ { 0, std::nan("") }, { 1, 1 }, { 4, 5 } }, heights), "low corner must be finite"));
	EXPECT_TRUE(
		mentions(complaint([&] { SampledDistance<2>(grid, std::function<double(const Vec<2>&)>()); }), "needs a function"));
}

}  // namespace
}  // namespace graindrive::geometry
