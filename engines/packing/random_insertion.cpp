/// One cell grid holds the grains; obstacles, which may be large, are in a separate grid.
#include "engines/packing/random_insertion.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

#include "engines/packing/random.hpp"

namespace graindrive::packing {

namespace {

enum Stream : std::uint64_t { diameters = 1, places = 2 };

template <int D>
constexpr const char* grain_word = D == 2 ? "disk" : "sphere";

Real largest(const std::vector<Real>& radii) { return radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end()); }

/// Area of a disk, volume of a sphere.
template <int D>
Real extent_of(Real radius)
{
	return D == 2 ? pi * radius * radius : 4 * pi / 3 * radius * radius * radius;
}

std::vector<std::size_t> largest_first(const std::vector<Real>& radii)
{
	std::vector<std::size_t> order(radii.size());
	std::iota(order.begin(), order.end(), std::size_t(0));
	std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return radii[i] > radii[j]; });
	return order;
}

template <int D>
bool touch(const Box<D>& box, const Point<D>& a, Real radius_a, const Point<D>& b, Real radius_b)
{
	const Real reach = radius_a + radius_b;
	return box.between(a, b).squaredNorm() < reach * reach;
}

/// Grains in a grid that tests whether a place is free.
template <int D>
class Occupied {
public:
	Occupied(const Box<D>& box, Real largest_radius, Real largest_asking, std::size_t expected)
		: box_(box),
		  grid_(box, largest_radius + largest_asking, expected)
	{
	}

	void add(const Point<D>& centre, Real radius)
	{
		grid_.add(centres_.size(), centre);
		centres_.push_back(centre);
		radii_.push_back(radius);
	}

	bool blocks(const Point<D>& centre, Real radius) const
	{
		return grid_.any_near(centre, [&](std::size_t i) { return touch(box_, centre, radius, centres_[i], radii_[i]); });
	}

private:
	Box<D> box_;
	CellGrid<D> grid_;
	Points<D> centres_;
	std::vector<Real> radii_;
};

template <int D>
void require_room(const Box<D>& box, Real radius)
{
	bool fits = true;
	for (int k = 0; k < D; ++k) fits = fits && box.side(k) >= 2 * radius;
	if (fits) return;
	std::ostringstream message;
	message << "the box must hold the largest " << grain_word<D> << ", got one of diameter " << 2 * radius << " for a box of "
			<< box.side(0);
	for (int k = 1; k < D; ++k) message << " x " << box.side(k);
	message << "; enlarge the box";
	throw std::invalid_argument(message.str());
}

struct Reached {
	std::size_t placed = 0, asked = 0;
	Real extent = 0;
};

template <int D>
[[noreturn]] void throw_full(const Box<D>& box, const Reached& reached, Real radius, long attempts)
{
	std::ostringstream message;
	message << grain_word<D> << "s must find a free place in " << attempts << " random trials, but " << reached.placed << " of "
			<< reached.asked << " were placed (" << (D == 2 ? "area" : "volume") << " fraction " << reached.extent / box.extent()
			<< " of the box) and the next, of diameter " << 2 * radius << ", found none; ask for fewer "
			<< grain_word<D> << "s or a larger box (above " << (D == 2 ? "0.5" : "0.35") << " compress a looser packing instead)";
	throw std::invalid_argument(message.str());
}

template <int D>
Point<D> random_place(const Box<D>& box, Real radius, Uniform& random)
{
	Point<D> place;
	for (int k = 0; k < D; ++k) {
		const Real margin = box.periodic[k] ? 0 : radius;
		place[k] = random(box.low[k] + margin, box.high[k] - margin);
	}
	return place;
}

template <int D>
bool reaches_into(const KeepOut<D>& keep_out, const Point<D>& centre, Real radius)
{
	if (!keep_out) return false;
	const Real distance = keep_out(centre);
	if (!std::isnan(distance)) return distance < radius;
	std::ostringstream message;
	message << "keep_out must give a distance at every point of the box, got nan at (" << centre.transpose() << ")";
	throw std::invalid_argument(message.str());
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

template <int D>
Points<D> random_insertion(const Box<D>& box, const std::vector<Real>& radii, const Obstacles<D>& obstacles, std::uint64_t seed,
	long attempts, const KeepOut<D>& keep_out)
{
	require_box(box);
	require_grains<D>(radii, {}, grain_word<D>);
	require_grains(obstacles.radii, obstacles.centres, "obstacle");
	if (obstacles.centres.size() != obstacles.radii.size()) throw std::invalid_argument("obstacles need one centre per radius");
	if (attempts < 1) throw std::invalid_argument("attempts must be at least 1, got " + std::to_string(attempts));
	const Real r_max = largest(radii);
	require_room(box, r_max);
	Occupied<D> fixed(box, largest(obstacles.radii), r_max, obstacles.radii.size());
	for (std::size_t i = 0; i < obstacles.radii.size(); ++i) fixed.add(obstacles.centres[i], obstacles.radii[i]);
	Occupied<D> grains(box, r_max, r_max, radii.size());
	Uniform random(seed, places);
	Points<D> centres(radii.size());
	Reached reached{ 0, radii.size(), 0 };
	for (const std::size_t i : largest_first(radii)) {
		long trial = 0;
		do {
			if (trial++ == attempts) throw_full(box, reached, radii[i], attempts);
			centres[i] = random_place(box, radii[i], random);
		} while (grains.blocks(centres[i], radii[i]) || fixed.blocks(centres[i], radii[i]) ||
				 reaches_into(keep_out, centres[i], radii[i]));
		grains.add(centres[i], radii[i]);
		reached.extent += extent_of<D>(radii[i]);
		++reached.placed;
	}
	return centres;
}

template <int D>
Overlap overlaps(const Box<D>& box, const Points<D>& centres, const std::vector<Real>& radii)
{
	require_box(box);
	require_grains(radii, centres, grain_word<D>);
	if (centres.size() != radii.size()) throw std::invalid_argument("overlaps needs as many centres as radii");
	CellGrid<D> grid(box, 2 * largest(radii), radii.size());
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

template Points<2> random_insertion(
	const Box<2>&, const std::vector<Real>&, const Obstacles<2>&, std::uint64_t, long, const KeepOut<2>&);
template Points<3> random_insertion(
	const Box<3>&, const std::vector<Real>&, const Obstacles<3>&, std::uint64_t, long, const KeepOut<3>&);
template Overlap overlaps(const Box<2>&, const Points<2>&, const std::vector<Real>&);
template Overlap overlaps(const Box<3>&, const Points<3>&, const std::vector<Real>&);

}  // namespace graindrive::packing
