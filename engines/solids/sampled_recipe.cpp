/// Slopes near the surface, and the text.
#include "engines/solids/sampled_recipe.hpp"

#include <algorithm>

#include "engines/geometry/refuse.hpp"
#include "engines/solids/recipe.hpp"

namespace graindrive::solids {
namespace {

using namespace geometry;

constexpr double most_off =
	0.1;  // of the slope's length from 1 [-]: a distance's own error on a grid of four nodes a radius is less

/// Lengths of the slope at the nodes inside the grid that lie within two spacings of the surface, in rising order.
std::vector<double> slopes_near_surface(const SampleGrid<3>& grid, const std::vector<double>& distances)
{
	const auto [nx, ny, nz] = grid.count;
	const std::size_t stride[3] = { 1, nx, nx * ny };
	const double near = 2 * largest(grid.spacing);
	std::vector<double> lengths;
	for (std::size_t k = 1; k + 1 < nz; ++k)
		for (std::size_t j = 1; j + 1 < ny; ++j)
			for (std::size_t i = 1; i + 1 < nx; ++i) {
				const std::size_t node = i + nx * (j + ny * k);
				if (!(std::abs(distances[node]) < near)) continue;
				Vec<3> slope;
				for (int axis = 0; axis < 3; ++axis)
					slope[axis] = (distances[node + stride[axis]] - distances[node - stride[axis]]) / (2 * grid.spacing[axis]);
				lengths.push_back(norm(slope));
			}
	std::sort(lengths.begin(), lengths.end());
	return lengths;
}

void require_distance(const SampleGrid<3>& grid, const std::vector<double>& distances)
{
	const std::vector<double> slopes = slopes_near_surface(grid, distances);
	if (slopes.empty()) return;
	const double lower = slopes[slopes.size() / 4], upper = slopes[slopes.size() * 3 / 4];
	std::ostringstream got;
	got << "half of them between " << lower << " and " << upper << " at " << slopes.size() << " nodes";
	require(lower > 1 - most_off && upper < 1 + most_off, "the slope of a distance must have the length 1 near the surface",
		got.str(), "give the distance itself: for another function f with f = 0 on the surface f/|grad f| is near it");
}

}  // namespace

std::string sampled_recipe(const SampleGrid<3>& grid, const std::vector<double>& distances)
{
	// Check the slopes first if possible: they show more about a wrong function than the difference of two neighbours.
	if (distances.size() == grid.size() &&
		std::all_of(distances.begin(), distances.end(), [](double d) { return std::isfinite(d); }))
		require_distance(grid, distances);
	const SampledDistance<3> checked(grid, distances);
	require(checked.margin() > 0, "a sampled solid must lie inside its grid, with distances > 0 at all outer nodes",
		"the least of them " + number_text(checked.margin()),
		"widen low and high, change the sign of a function that is > 0 inside, or sample a cavity and take the complement");
	std::string text = "sampled";
	for (const std::size_t count : grid.count) text += ' ' + std::to_string(count);
	for (const Vec<3>& v : { grid.low, grid.spacing })
		for (int k = 0; k < 3; ++k) text += ' ' + number_text(v[k]);
	for (const double distance : distances) text += ' ' + number_text(distance);
	return text;
}

}  // namespace graindrive::solids
