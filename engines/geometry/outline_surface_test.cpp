/// Outlines as surfaces: edges and corners, inside and outside, in the plane and swept through space.
#include "engines/geometry/outline_surface.hpp"

#include "engines/geometry/set_algebra.hpp"
#include "engines/geometry/solids.hpp"
#include "engines/geometry/test_support.hpp"

namespace graindrive::geometry {
namespace {

constexpr double pi = 3.14159265358979323846;
const std::vector<Vec<2>> hook{ { 0, 0 }, { 3, 0 }, { 3, 2 }, { 2, 2 }, { 2, 1 }, { 0, 1 } };  // an L lying on its long side

/// A star whose arms differ in length, so that nothing is symmetric.
std::vector<Vec<2>> star(int tips, double size = 1, const Vec<2>& middle = {})
{
	std::vector<Vec<2>> vertices;
	for (int i = 0; i < 2 * tips; ++i) {
		const double angle = pi * i / tips, reach = size * (i % 2 ? 0.4 : 0.7 + 0.3 * std::sin(1.7 * i));
		vertices.push_back(middle + reach * Vec<2>{ std::cos(angle), std::sin(angle) });
	}
	return vertices;
}

/// Distance by testing all edges; a point is inside if the angles of the edges as seen from it sum to 2 pi.
double by_angles(const std::vector<Vec<2>>& vertices, const Vec<2>& at)
{
	double nearest = 1e300, around = 0;
	for (std::size_t i = 0; i < vertices.size(); ++i) {
		const Vec<2> a = vertices[i] - at, b = vertices[(i + 1) % vertices.size()] - at, edge = b - a;
		const double part = std::clamp(-dot(a, edge) / squared_norm(edge), 0.0, 1.0);
		nearest = std::min(nearest, norm(a + part * edge));
		around += std::atan2(cross(a, b), dot(a, b));
	}
	return std::abs(around) > pi ? -nearest : nearest;
}

TEST(OutlineSurface, KnowsEdgesAndCornersOfBothKinds)
{
	const OutlineSurface surface(hook);
	const auto expect = [&](const Vec<2>& at, double distance, const Vec<2>& normal) {
		EXPECT_DOUBLE_EQ(surface.nearest(at).distance, distance);
		EXPECT_LT(norm(surface.nearest(at).normal - normal), 1e-15);
	};
	expect({ 1, -2 }, 2, { 0, -1 });
	expect({ 1, 0.25 }, -0.25, { 0, -1 });
	expect({ 6, 6 }, 5, { 0.6, 0.8 });          // off a convex corner
	expect({ 2.3, 0.6 }, -0.5, { -0.6, 0.8 });  // before the reentrant corner
	expect({ 1.875, 1.25 }, 0.125, { -1, 0 });  // in the notch
	expect({ 3, 1 }, 0, { 1, 0 });
	expect({ 3, 2 }, 0, { std::sqrt(0.5), std::sqrt(0.5) });  // a corner itself: between its edges' normals
	EXPECT_TRUE((surface.bounds().low == Vec<2>{ 0, 0 } && surface.bounds().high == Vec<2>{ 3, 2 }));
}

TEST(OutlineSurface, AgreesWithTheSearchThroughAllEdges)
{
	for (const double size : { 1.0, 1e-6, 1e6 })
		for (const int tips : { 2, 3, 7, 500 }) {
			const std::vector<Vec<2>> vertices = star(tips, size);
			const OutlineSurface surface(vertices);
			RandomPoints<2> random(1.5 * size);
			for (int i = 0; i < 500; ++i) {
				const Vec<2> at = random();
				EXPECT_NEAR(surface.nearest(at).distance, by_angles(vertices, at), 2e-15 * size) << tips << " " << i;
			}
			for (const Vec<2>& vertex : vertices) EXPECT_NEAR(surface.nearest(vertex).distance, 0, 1e-15 * size);
		}
}

TEST(OutlineSurface, IsADistanceFieldInBothSenses)
{
	EXPECT_GT(expect_distance(OutlineSurface(star(5)), 1.2), 0.9);
	std::vector<Vec<2>> clockwise = star(5, 1, { 1e6, -2e6 });
	std::reverse(clockwise.begin(), clockwise.end());
	const OutlineSurface far(clockwise);
	EXPECT_GT(expect_distance<2>(far, 1.2, { 1e6, -2e6 }), 0.9);
	const Vec<2> at{ 0.3, 0.5 };
	EXPECT_NEAR(far.nearest(at + Vec<2>{ 1e6, -2e6 }).distance, by_angles(star(5), at), 1e-9);  // coordinates hold 5e-10
}

TEST(OutlineSurface, ADiskIsExact)
{
	const OutlineSurface disk(shapes::Outline::disk(4).seen_from(Vector2r(-1, -1)));
	EXPECT_DOUBLE_EQ(disk.nearest({ 4, 5 }).distance, 3);
	EXPECT_DOUBLE_EQ(disk.nearest({ 2, 1 }).distance, -1);
	EXPECT_EQ(disk.bounds().high[1], 3);
}

TEST(SweptOutline, ASquareMakesABlock)
{
	// The outline lies in the plane of x and z, so it is swept along -y.
	const std::vector<Vec<2>> rectangle{ { -1, -0.5 }, { 1, -0.5 }, { 1, 0.5 }, { -1, 0.5 } };
	const Vec<3> middle{ 1, 2, 3 };
	const SweptOutline block(OutlineSurface(rectangle), middle, { 1, 0, 0 }, { 0, 0, 2 }, 1.4);
	RandomPoints<3> random(2);
	const Vec<3> half{ 1, 0.7, 0.5 };
	for (int i = 0; i < 1000; ++i) {
		const Vec<3> at = random();
		Vec<3> beyond;
		double most = -9;
		for (int k = 0; k < 3; ++k) {
			beyond[k] = std::max(0.0, std::abs(at[k]) - half[k]);
			most = std::max(most, std::abs(at[k]) - half[k]);
		}
		EXPECT_NEAR(block.nearest(middle + at).distance, most > 0 ? norm(beyond) : most, 2e-15);
	}
	EXPECT_LT(norm(block.bounds().low - (middle - half)), 1e-15);
	EXPECT_LT(norm(block.bounds().high - (middle + half)), 1e-15);
}

TEST(SweptOutline, IsADistanceFieldAlongAnyAxis)
{
	const Vec<3> x{ 1, 2, -1 }, y{ 1, 0, 1 };
	EXPECT_GT(expect_distance(SweptOutline(OutlineSurface(star(3)), {}, x, y, 1.1), 1.2), 0.9);
	const SweptOutline endless(OutlineSurface(star(3)), {}, x, y);
	EXPECT_GT(expect_distance(endless, 1.2), 0.9);
	const Vec<3> at{ 0.3, -0.2, 0.8 }, axis = unit(cross(x, y));
	EXPECT_NEAR(endless.nearest(at).distance, by_angles(star(3), { dot(at, unit(x)), dot(at, unit(y)) }), 1e-15);
	EXPECT_NEAR(endless.nearest(at + 1e3 * axis).distance, endless.nearest(at).distance, 1e-12);
	EXPECT_EQ(endless.bounds().high[1], std::numeric_limits<double>::infinity());
}

TEST(SweptOutline, ADiskMakesACylinder)
{
	const Vec<3> x{ 1, 2, -1 }, y{ 1, 0, 1 };
	const SweptOutline swept(OutlineSurface(shapes::Outline::disk(1)), { 1, 0, 0 }, x, y, 0.7);
	const Cylinder cylinder({ 1, 0, 0 }, cross(x, y), 0.5, 0.7);
	RandomPoints<3> random(1.5);
	for (int i = 0; i < 500; ++i) {
		const Vec<3> at = random();
		EXPECT_NEAR(swept.nearest(at).distance, cylinder.nearest(at).distance, 2e-15);
	}
}

TEST(OutlineSurface, RefusesWhatEnclosesNothing)
{
	using Vertices = std::vector<Vec<2>>;
	const auto said = [](const Vertices& vertices) { return complaint([&] { OutlineSurface{ vertices }; }); };
	EXPECT_TRUE(mentions(said({ { 0, 0 }, { 1, 0 } }), "at least 3 different vertices, got 2"));
	EXPECT_TRUE(mentions(said({}), "at least 3 different vertices, got 0"));
	EXPECT_TRUE(mentions(said({ { 0, 0 }, { 2, 2 }, { 2, 0 }, { 0, 2 } }), "must not cross or touch itself"));
	EXPECT_TRUE(mentions(said({ { 0, 0 }, { 2, 0 }, { std::nan(""), 2 } }), "must be finite numbers, got vertex 2"));
	const OutlineSurface fine(hook);
	EXPECT_TRUE(mentions(complaint([&] {
		SweptOutline(fine, {}, { 1, 0, 0 }, { 1, 1, 0 });
	}),
		"must be perpendicular, got 0.707"));
	EXPECT_TRUE(mentions(complaint([&] { SweptOutline(fine, {}, { 1, 0, 0 }, { 0, 0, 0 }); }), "outline's y must not be zero"));
	EXPECT_TRUE(mentions(complaint([&] { SweptOutline(fine, {}, { 1, 0, 0 }, { 0, 1, 0 }, -2); }), "got -2; give a length > 0"));
}

}  // namespace
}  // namespace graindrive::geometry
