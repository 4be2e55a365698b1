/// Beads at equal steps along the inset of an outline, and the checks that they stand for the outline.
#include "engines/shapes/clump.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "engines/shapes/inset.hpp"
#include "engines/shapes/solid.hpp"

namespace graindrive::shapes {

namespace {

constexpr Real curve_turn = 0.1;  // gentler turns belong to a curve: a bead beside one misses it by 0.1 % of its radius [rad]
constexpr Real largest_gap =
	2.0;  // a corner may stand out of the envelope by this many bead diameters (sharper than 23 degrees) [-]
constexpr Real degeneracy = 1e-9;  // beads may stand this part of their radius off the outline where CGAL needs a nudge [-]
constexpr Real most_steps = 1e5;   // between two corners: more would take minutes, and no grain could tell
constexpr Real step_slack = 1e-9;  // a step may pass the asked one by round-off, or 6 / 0.5 would give 13 beads [-]

void require(bool holds, const char* rule, Real got)
{
	if (holds) return;
	std::ostringstream message;
	message << rule << ", got " << got;
	throw std::invalid_argument(message.str());
}

int steps(Real length, Real longest_step)
{
	const Real n = std::ceil(length / longest_step - step_slack);
	require(n <= most_steps, "an outline takes at most 1e5 beads from corner to corner; take larger beads or a wider spacing", n);
	return std::max(1, static_cast<int>(n));
}

Points ring(const Outline& disk, Real bead_radius, Real longest_step)
{
	const Real radius = disk.disk_radius() - bead_radius;
	require(radius >= 0, "bead diameter must not exceed the disk's; take smaller beads", 2 * bead_radius);
	if (radius == 0) return { disk.disk_centre() };
	const Real chord = std::min(1.0, longest_step / (2 * radius));
	const int quarter = steps(pi / 2, 2 * std::asin(chord));
	Points centres;
	for (int i = 0; i < 4 * quarter; ++i) {
		const Real angle = (pi / 2) * (i % quarter) / quarter;
		Vector2r out(radius * std::cos(angle), radius * std::sin(angle));
		for (int turn = 0; turn < i / quarter; ++turn) out = Vector2r(-out.y(), out.x());  // exact quarter turns
		centres.push_back(disk.disk_centre() + out);
	}
	return centres;
}

bool is_corner(const Stretch& before, const Stretch& after)
{
	const Vector2r in = before.heading(before.length), out = after.heading(0);
	return std::abs(std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out))) > curve_turn;
}

/// The path turned so that it starts at a corner, if it has one.
std::vector<Stretch> from_a_corner(std::vector<Stretch> path)
{
	for (std::size_t i = 0; i < path.size(); ++i) {
		if (!is_corner(path[(i + path.size() - 1) % path.size()], path[i])) continue;
		std::rotate(path.begin(), path.begin() + i, path.end());
		break;
	}
	return path;
}

/// Beads at equal steps from the start of stretch `first` up to, and without, the start of stretch `last`.
void place(const std::vector<Stretch>& path, std::size_t first, std::size_t last, Real longest_step, Points& centres)
{
	Real length = 0;
	for (std::size_t i = first; i < last; ++i) length += path[i].length;
	const int n = steps(length, longest_step);
	Real start = 0;
	for (int k = 0; k < n; ++k) {
		const Real distance = length * k / n;
		while (first + 1 < last && distance >= start + path[first].length) start += path[first++].length;
		centres.push_back(path[first].at(distance - start));
	}
}

Points along(const std::vector<Stretch>& path, Real longest_step)
{
	Points centres;
	std::size_t first = 0;
	for (std::size_t i = 1; i <= path.size(); ++i) {
		if (i < path.size() && !is_corner(path[i - 1], path[i])) continue;
		place(path, first, i, longest_step, centres);
		first = i;
	}
	return centres;
}

/// Where arms thinner than a bead or very sharp corners were lost, the envelope is no longer the outline.
void require_covered(const Outline& outline, const Points& centres, Real bead_radius)
{
	for (std::size_t i = 0; i < outline.vertices().size(); ++i) {
		const Vector2r& vertex = outline.vertices()[i];
		Real nearest = std::numeric_limits<Real>::infinity();
		for (const Vector2r& centre : centres) nearest = std::min(nearest, (centre - vertex).norm());
		const Real gap = (nearest - bead_radius) / (2 * bead_radius);
		if (gap <= largest_gap) continue;
		std::ostringstream message;
		message << "outline is too thin for beads of diameter " << 2 * bead_radius << ": the nearest bead stays " << gap
				<< " diameters away from " << vertex_name(i, vertex) << ", allowed are " << largest_gap
				<< "; take smaller beads, or blunt or thicken the shape there";
		throw std::invalid_argument(message.str());
	}
}

bool stay_inside(const Outline& outline, const Points& centres, Real bead_radius)
{
	return std::all_of(centres.begin(), centres.end(),
		[&](const Vector2r& centre) { return distance_to(outline, centre) >= bead_radius * (1 - degeneracy); });
}

/// CGAL's offset may go wrong if an edge shrinks to nothing at just this distance, as on a tooth exactly one bead wide.
Points inside(const Outline& outline, Real bead_radius, Real longest_step)
{
	for (const Real distance : { bead_radius, bead_radius * (1 + degeneracy) }) {
		const Points centres = along(from_a_corner(inset(outline, distance)), longest_step);
		if (stay_inside(outline, centres, bead_radius)) return centres;
	}
	std::ostringstream message;
	message << "outline must let beads of diameter " << 2 * bead_radius
			<< " roll along its inside, but no inset was found; change the bead diameter a little";
	throw std::invalid_argument(message.str());
}

}  // namespace

Points beads(const Outline& outline, Real bead_diameter, Real spacing)
{
	require(bead_diameter > 0 && std::isfinite(bead_diameter), "bead diameter must be positive and finite", bead_diameter);
	require(spacing > 0 && spacing <= 1, "bead spacing must lie in (0, 1] bead diameters, or grains could fall between beads",
		spacing);
	const Real radius = bead_diameter / 2, longest_step = spacing * bead_diameter;
	if (outline.is_disk()) return ring(outline, radius, longest_step);
	const Points centres = inside(outline, radius, longest_step);
	require_covered(outline, centres, radius);
	return centres;
}

Clump clump_of(const Outline& outline, Real bead_diameter, Real mass, Real spacing)
{
	require(mass > 0 && std::isfinite(mass), "mass must be positive and finite", mass);
	const Solid solid = solid_of(outline);
	Clump clump{ beads(outline, bead_diameter, spacing), bead_diameter / 2, mass, mass * solid.second_moment };
	for (Vector2r& centre : clump.beads) centre -= solid.centroid;
	return clump;
}

}  // namespace graindrive::shapes
