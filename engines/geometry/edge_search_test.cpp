/// Edges and corners of random compositions: the point found lies in all parts, and no other common point is nearer.
#include "engines/geometry/edge_search.hpp"

#include "engines/geometry/set_algebra.hpp"
#include "engines/geometry/solids.hpp"
#include "engines/geometry/test_support.hpp"

namespace graindrive::geometry {
namespace {

using Shapes = std::vector<SharedSurface<3>>;

/// Random parts that all contain the ball of radius 0.2 about the origin, so that they have common points.
Shapes random_parts(RandomPoints<3>& random, int count)
{
	Shapes parts;
	for (int i = 0; i < count; ++i) {
		const Vec<3> way = unit(random());
		const double radius = 0.8 + 0.3 * random.number();
		const int kind = static_cast<int>(std::abs(random.number()) * 3);
		if (kind == 0) parts.push_back(shared(HalfSpace<3>((0.25 + 0.2 * std::abs(random.number())) * way, way)));
		if (kind == 1) parts.push_back(shared(Ball<3>(0.9 * (radius - 0.25) * way, radius)));
		if (kind == 2) parts.push_back(shared(Cylinder(0.9 * (radius - 0.25) * way, unit(random()), radius)));
	}
	return parts;
}

double excess(const Shapes& parts, const Vec<3>& at)
{
	double most = -1e300;
	for (const auto& part : parts) most = std::max(most, part->nearest(at).distance);
	return most;
}

/// A point beside the edge of two parts, or anywhere near them if they have no edge.
Vec<3> beside_an_edge(const Shapes& parts, RandomPoints<3>& random)
{
	Vec<3> at = random();
	for (int k = 0; k < 30; ++k) {
		const Nearest<3> part = parts[k % 2]->nearest(at);
		at -= part.distance * part.normal;
	}
	return at + 0.03 * random();
}

/// Samples points closer to p than the point found, most of them near it, and returns the smallest distance of a common point
/// among them.
double nearest_sample(const Shapes& parts, const Vec<3>& p, const Vec<3>& foot, RandomPoints<3>& random)
{
	double best = norm(p - foot);
	const double reach = best;
	for (int i = 0; i < 200; ++i) {
		const Vec<3> at = i % 2 ? p + reach * random() : foot + std::pow(10, -3 * std::abs(random.number())) * reach * random();
		if (norm(at - p) < best && excess(parts, at) <= 0) best = norm(at - p);
	}
	return best;
}

TEST(EdgeSearch, NoCommonPointIsNearerThanTheAnswer)
{
	RandomPoints<3> random(1);
	int edges = 0;
	for (int scene = 0; scene < 150; ++scene) {
		const Shapes parts = random_parts(random, 2 + scene % 3);
		const Intersection<3> all(parts);
		for (int i = 0; i < 20; ++i) {
			const Vec<3> p = beside_an_edge(parts, random);
			const Nearest<3> found = all.nearest(p);
			if (found.distance <= 0 || found.distance > 0.05) continue;
			const Vec<3> foot = p - found.distance * found.normal;
			edges += found.distance != excess(parts, p);
			EXPECT_LT(excess(parts, foot), 1e-13) << scene << " " << i;
			// 1e-9 covers the round-off of the point found.
			EXPECT_GT(nearest_sample(parts, p, foot, random), found.distance * (1 - 1e-9)) << scene << " " << i;
		}
	}
	EXPECT_GT(edges, 200);
}

TEST(Cuts, TheNearestCommonPointOfHalfSpaces)
{
	const std::vector<Cut<2>> quarter{ { { 1, 0 }, 1 }, { { 0, 1 }, 2 } };
	EXPECT_TRUE((nearest_common_point<2>(quarter, { 0, 0 }).at == Vec<2>{ 0, 0 }));
	EXPECT_TRUE((nearest_common_point<2>(quarter, { 3, 0 }).at == Vec<2>{ 1, 0 }));
	EXPECT_TRUE((nearest_common_point<2>(quarter, { 3, 4 }).at == Vec<2>{ 1, 2 }));
	// A wedge so blunt that the point violates both sides, but only one of them is active.
	const std::vector<Cut<2>> blunt{ { { 1, 0 }, 0 }, { { 0.8, 0.6 }, 0 } };
	const CutPoint<2> point = nearest_common_point<2>(blunt, { 1, -0.5 });
	EXPECT_TRUE(point.count == 1 && (point.at == Vec<2>{ 0, -0.5 }));
	EXPECT_FALSE(nearest_common_point<2>({ { { 1, 0 }, -1 }, { { -1, 0 }, -1 } }, { 0, 0 }).found);  // x <= -1 and x >= 1
}

}  // namespace
}  // namespace graindrive::geometry
