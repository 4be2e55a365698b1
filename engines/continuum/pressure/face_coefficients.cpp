/// Checks the coefficients of faces.
#include "engines/continuum/pressure/face_coefficients.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engines/continuum/pressure/split_grid.hpp"
#include "engines/geometry/refuse.hpp"

namespace graindrive::continuum {
namespace {

using geometry::require;

void check_sizes(const FaceCoefficients& b)
{
	const auto refuse = [](const char* rule, const auto& value, const char* way_out) { require(false, rule, value, way_out); };
	if (b.nx < 1 || b.ny < 1)
		refuse(
			"a grid needs at least one cell each way", std::to_string(b.nx) + " x " + std::to_string(b.ny), "give nx and ny > 0");
	if (!(b.spacing > 0 && std::isfinite(b.spacing)))
		refuse("the spacing of the grid must be positive and finite", b.spacing, "give a length > 0");
	const std::size_t nx = b.nx, ny = b.ny;
	if (b.x.size() != (nx + 1) * ny)
		refuse("there must be (nx + 1) ny coefficients on x-faces", b.x.size(), "make them fit the grid");
	if (b.y.size() != nx * (ny + 1))
		refuse("there must be nx (ny + 1) coefficients on y-faces", b.y.size(), "make them fit the grid");
}

// The largest of the numbers; negative if one of them is not a finite number >= 0.
double largest_or_wrong(const std::vector<double>& numbers)
{
	const Pack<double> zero = {};
	Pack<double> largest = zero, wrong = zero;
	std::size_t i = 0;
	for (; i + lanes <= numbers.size(); i += lanes) {
		const Pack<double> b = pack(numbers.data() + i);
		largest = b > largest ? b : largest;
		wrong = b >= zero ? wrong : zero + 1;
	}
	double most = 0;
	bool bad = false;
	for (int lane = 0; lane < lanes; ++lane) {
		most = std::max(most, largest[lane]);
		bad |= wrong[lane] > 0;
	}
	for (; i < numbers.size(); ++i) {
		most = std::max(most, numbers[i]);
		bad |= !(numbers[i] >= 0);
	}
	return bad || most > std::numeric_limits<double>::max() ? -1 : most;
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
	const auto check = [](double value, const char* kind, int i, int j) {
		if (value != 0) require(false, "coefficients on the boundary of the box must be 0", value, "close " + place(kind, i, j));
	};
	for (int j = 0; j < b.ny; ++j)
		for (const int i : { 0, b.nx }) check(b.left(i, j), "x", i, j);
	for (int i = 0; i < b.nx; ++i)
		for (const int j : { 0, b.ny }) check(b.below(i, j), "y", i, j);
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
