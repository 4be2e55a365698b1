/// One cell grid for the grains; obstacles, which may be large, stand in a grid of their own.
#include "engines/packing/random_insertion.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "engines/packing/random.hpp"

namespace graindrive::packing {

namespace {

enum Stream : std::uint64_t { diameters = 1, places = 2 };

Real largest(const std::vector<Real>& radii) { return radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end()); }

std::vector<std::size_t> largest_first(const std::vector<Real>& radii)
{
	std::vector<std::size_t> order(radii.size());
	std::iota(order.begin(), order.end(), std::size_t(0));
	std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return radii[i] > radii[j]; });
	return order;
}

bool touch(const Box& box, const Vector2r& a, Real radius_a, const Vector2r& b, Real radius_b)
{
	const Real reach = radius_a + radius_b;
	return box.between(a, b).squaredNorm() < reach * reach;
}

/// Disks in a grid, to be asked whether a place is free.
class Occupied {
public:
	Occupied(const Box& box, Real largest_radius, Real largest_asking, std::size_t expected)
		: box_(box),
		  grid_(box, largest_radius + largest_asking, expected)
	{
	}

	void add(const Vector2r& centre, Real radius)
	{
		grid_.add(centres_.size(), centre);
		centres_.push_back(centre);
		radii_.push_back(radius);
	}

	bool blocks(const Vector2r& centre, Real radius) const
	{
		return grid_.any_near(centre, [&](std::size_t i) { return touch(box_, centre, radius, centres_[i], radii_[i]); });
	}

private:
	Box box_;
	CellGrid grid_;
	Points centres_;
	std::vector<Real> radii_;
};

void require_room(const Box& box, Real radius)
{
	const bool fits = box.height() >= 2 * radius && box.width() >= 2 * radius;
	if (fits) return;
	std::ostringstream message;
	message << "the box must hold the largest disk, got one of diameter " << 2 * radius << " for a box of " << box.width()
			<< " x " << box.height() << "; enlarge the box";
	throw std::invalid_argument(message.str());
}

[[noreturn]] void throw_full(
	const Box& box, std::size_t placed, const std::vector<Real>& radii, Real radius, Real area, long attempts)
{
	std::ostringstream message;
	message << "disks must find a free place in " << attempts << " random trials, but " << placed << " of " << radii.size()
			<< " were placed (area fraction " << area / (box.width() * box.height()) << " of the box) and the next, of diameter "
			<< 2 * radius << ", found none; ask for fewer disks or a larger box (above 0.5 compress a looser packing instead)";
	throw std::invalid_argument(message.str());
}

Vector2r random_place(const Box& box, Real radius, Uniform& random)
{
	const Real x_margin = box.periodic_x ? 0 : radius;
	const Real x = random(box.x_min + x_margin, box.x_max - x_margin);
	return { x, random(box.y_min + radius, box.y_max - radius) };
}

}  // namespace

std::vector<Real> uniform_radii(std::size_t n, Real d_min, Real d_max, std::uint64_t seed)
{
	if (!(0 < d_min && d_min <= d_max && std::isfinite(d_max))) {
		std::ostringstream message;
		message << "diameters must satisfy 0 < d_min <= d_max, got " << d_min << " and " << d_max;
		throw std::invalid_argument(message.str());
	}
	Uniform random(seed, diameters);
	std::vector<Real> radii(n);
	for (Real& radius : radii) radius = random(d_min, d_max) / 2;
	return radii;
}

Points random_insertion(
	const Box& box, const std::vector<Real>& radii, const Obstacles& obstacles, std::uint64_t seed, long attempts)
{
	require_box(box);
	require_disks(radii, {}, "disk");
	require_disks(obstacles.radii, obstacles.centres, "obstacle");
	if (obstacles.centres.size() != obstacles.radii.size()) throw std::invalid_argument("obstacles need one centre a radius");
	if (attempts < 1) throw std::invalid_argument("attempts must be at least 1, got " + std::to_string(attempts));
	const Real r_max = largest(radii);
	require_room(box, r_max);
	Occupied fixed(box, largest(obstacles.radii), r_max, obstacles.radii.size());
	for (std::size_t i = 0; i < obstacles.radii.size(); ++i) fixed.add(obstacles.centres[i], obstacles.radii[i]);
	Occupied grains(box, r_max, r_max, radii.size());
	Uniform random(seed, places);
	Points centres(radii.size());
	Real area = 0;
	std::size_t placed = 0;
	for (const std::size_t i : largest_first(radii)) {
		long trial = 0;
		do {
			if (trial++ == attempts) throw_full(box, placed, radii, radii[i], area, attempts);
			centres[i] = random_place(box, radii[i], random);
		} while (grains.blocks(centres[i], radii[i]) || fixed.blocks(centres[i], radii[i]));
		grains.add(centres[i], radii[i]);
		area += pi * radii[i] * radii[i];
		++placed;
	}
	return centres;
}

Overlap overlaps(const Box& box, const Points& centres, const std::vector<Real>& radii)
{
	require_box(box);
	require_disks(radii, centres, "disk");
	if (centres.size() != radii.size()) throw std::invalid_argument("overlaps needs as many centres as radii");
	CellGrid grid(box, 2 * largest(radii), radii.size());
	Overlap deepest;
	for (std::size_t i = 0; i < radii.size(); ++i) {
		grid.any_near(centres[i], [&](std::size_t j) {
			const Real depth = radii[i] + radii[j] - box.between(centres[i], centres[j]).norm();
			const Real relative = depth / std::min(radii[i], radii[j]);
			if (relative > deepest.relative) deepest = { relative, j, i, true };
			return false;
		});
		grid.add(i, centres[i]);
	}
	return deepest;
}

}  // namespace graindrive::packing
