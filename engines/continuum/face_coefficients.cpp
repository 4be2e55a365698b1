/// What coefficients are refused, and how.
#include "engines/continuum/face_coefficients.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "engines/geometry/refuse.hpp"

namespace graindrive::continuum {
namespace {

using geometry::require;

void check_sizes(const FaceCoefficients& b)
{
	require(b.nx > 0 && b.ny > 0, "a grid needs at least one cell each way", std::to_string(b.nx) + " x " + std::to_string(b.ny),
		"give nx and ny > 0");
	geometry::require_positive("the spacing of the grid", b.spacing);
	const std::size_t nx = b.nx, ny = b.ny;
	require(b.x.size() == (nx + 1) * ny, "there must be (nx + 1) ny coefficients on x-faces", b.x.size(),
		"make their array fit the grid");
	require(b.y.size() == nx * (ny + 1), "there must be nx (ny + 1) coefficients on y-faces", b.y.size(),
		"make their array fit the grid");
}

// The largest of the numbers; negative if one of them is not a finite number >= 0. Eight at a time, since it is done in every step.
double largest_or_wrong(const std::vector<double>& numbers)
{
	double largest[8] = {}, wrong[8] = {};
	const std::size_t whole = numbers.size() / 8 * 8;
	for (std::size_t i = 0; i < numbers.size(); i += i < whole ? 8 : 1)
		for (std::size_t lane = 0; lane < (i < whole ? 8 : 1); ++lane) {
			const double b = numbers[i + lane];
			largest[lane] = b > largest[lane] ? b : largest[lane];
			wrong[lane] = b >= 0 && b <= std::numeric_limits<double>::max() ? wrong[lane] : 1;
		}
	double most = 0;
	for (int lane = 0; lane < 8; ++lane) {
		if (wrong[lane] > 0) return -1;
		most = std::max(most, largest[lane]);
	}
	return most;
}

std::string place(const char* kind, int i, int j)
{
	return std::string(kind) + "-face (" + std::to_string(i) + ", " + std::to_string(j) + ")";
}

void refuse_wrong(const std::vector<double>& numbers, const char* kind, int per_row)
{
	for (std::size_t k = 0; k < numbers.size(); ++k)
		require(numbers[k] >= 0 && std::isfinite(numbers[k]), "coefficients of the pressure must be finite and not negative",
			numbers[k], "correct " + place(kind, int(k % per_row), int(k / per_row)));
}

void refuse_open_boundary(const FaceCoefficients& b)
{
	const std::string rule = "coefficients on the boundary of the box must be 0";
	for (int j = 0; j < b.ny; ++j)
		for (const int i : { 0, b.nx }) require(b.left(i, j) == 0, rule, b.left(i, j), "close " + place("x", i, j));
	for (int i = 0; i < b.nx; ++i)
		for (const int j : { 0, b.ny }) require(b.below(i, j) == 0, rule, b.below(i, j), "close " + place("y", i, j));
}

}  // namespace

double checked_largest(const FaceCoefficients& b)
{
	check_sizes(b);
	const double x = largest_or_wrong(b.x), y = largest_or_wrong(b.y);
	if (x < 0) refuse_wrong(b.x, "x", b.nx + 1);
	if (y < 0) refuse_wrong(b.y, "y", b.nx);
	refuse_open_boundary(b);
	return std::max(x, y);
}

}  // namespace graindrive::continuum
