/// Places beads at equal steps along the inset of an outline, and checks that they represent the outline.
#include "engines/shapes/clump.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "engines/shapes/edge_index.hpp"
#include "engines/shapes/inset.hpp"
#include "engines/shapes/solid.hpp"

namespace graindrive::shapes {

namespace {

constexpr Real curve_turn = 0.1;   // a smaller turn counts as part of a curve; beads miss it by 0.1 % of their radius [rad]
constexpr Real largest_gap = 2.0;  // a corner may be this many bead diameters outside the beads (reached at 23 degrees) [-]
constexpr Real touch = 1e-5;       // beads touch the outline if they are within this part of their radius of it [-]
constexpr Real most_beads = 1e5;   // more would take minutes without an effect on grains
constexpr Real step_slack = 1e-5;  // relative; without it rounded digits in a file would make 13 beads of 6 / 0.5 [-]

void require(bool holds, const char* rule, Real got)
{
	if (holds) return;
	std::ostringstream message;
	message << rule << ", got " << got;
	throw std::invalid_argument(message.str());
}

void require_few_beads(Real length, Real longest_step)
{
	if (length <= most_beads * longest_step) return;
	std::ostringstream message;
	message << "an outline takes at most 1e5 beads, but steps of " << longest_step << " along " << length
			<< " would take more; take larger beads or a wider spacing";
	throw std::invalid_argument(message.str());
}

int steps(Real length, Real longest_step) { return std::max(1, static_cast<int>(std::ceil(length / longest_step - step_slack))); }

Points ring(Real disk_radius, Real bead_radius, Real longest_step)
{
	const Real radius = disk_radius - bead_radius;
	if (radius <= 0) return { Vector2r::Zero() };
	require_few_beads(2 * pi * radius, longest_step);
	const Real chord = std::min(1.0, longest_step / (2 * radius));
	const int quarter = steps(pi / 2, 2 * std::asin(chord));
	Points centres;
	for (int i = 0; i < 4 * quarter; ++i) {
		const Real angle = (pi / 2) * (i % quarter) / quarter;
		Vector2r out(radius * std::cos(angle), radius * std::sin(angle));
		for (int turn = 0; turn < i / quarter; ++turn) out = Vector2r(-out.y(), out.x());  // exact quarter turns
		centres.push_back(out);
	}
	return centres;
}

/// The angle by which the path turns to the left between two stretches [rad].
Real turn_between(const Stretch& before, const Stretch& after)
{
	const Vector2r in = before.heading(before.length), out = after.heading(0);
	return std::atan2(cross(in, out), in.dot(out));
}

bool is_corner(const Stretch& before, const Stretch& after) { return std::abs(turn_between(before, after)) > curve_turn; }

/// The same closed path, starting at a corner if it has one.
std::vector<Stretch> from_a_corner(std::vector<Stretch> path)
{
	for (std::size_t i = 0; i < path.size(); ++i) {
		if (!is_corner(path[(i + path.size() - 1) % path.size()], path[i])) continue;
		std::rotate(path.begin(), path.begin() + i, path.end());
		break;
	}
	return path;
}

/// The number of quarter turns of the path from the start of stretch `first` to the start of stretch `last`, rounded up.
int quarter_turns(const std::vector<Stretch>& path, std::size_t first, std::size_t last)
{
	Real turn = 0;
	for (std::size_t i = first; i < last; ++i) {
		if (path[i].radius > 0) turn -= path[i].length / path[i].radius;
		if (i > first) turn += turn_between(path[i - 1], path[i]);
	}
	return static_cast<int>(std::ceil(std::abs(turn) / (pi / 2) - curve_turn));
}

/// Places beads at equal steps from the start of stretch `first` up to the start of stretch `last`, which gets none. There is at
/// least one for each quarter turn, because large beads on a short curve would otherwise all lie on one side.
void place(const std::vector<Stretch>& path, std::size_t first, std::size_t last, Real longest_step, Points& centres)
{
	Real length = 0;
	for (std::size_t i = first; i < last; ++i) length += path[i].length;
	const int n = std::max(steps(length, longest_step), quarter_turns(path, first, last));
	Real start = 0;
	for (int k = 0; k < n; ++k) {
		const Real distance = length * k / n;
		while (first + 1 < last && distance >= start + path[first].length) start += path[first++].length;
		centres.push_back(path[first].at(distance - start));
	}
}

Points along(const std::vector<Stretch>& path, Real longest_step)
{
	Real length = 0;
	for (const Stretch& stretch : path) length += stretch.length;
	require_few_beads(length, longest_step);
	Points centres;
	std::size_t first = 0;
	for (std::size_t i = 1; i <= path.size(); ++i) {
		if (i < path.size() && !is_corner(path[i - 1], path[i])) continue;
		place(path, first, i, longest_step, centres);
		first = i;
	}
	return centres;
}

/// An index that finds the beads near a point.
BoxIndex index_of(const Points& centres)
{
	std::vector<Box> boxes;
	for (const Vector2r& centre : centres) boxes.emplace_back(centre);
	return BoxIndex(boxes);
}

Real nearest_of(const Points& centres, const Vector2r& vertex)
{
	Real nearest = std::numeric_limits<Real>::infinity();
	for (const Vector2r& centre : centres) nearest = std::min(nearest, (centre - vertex).norm());
	return nearest;
}

/// Refuses an outline if its beads have left out an arm thinner than a bead or a very sharp corner.
void require_covered(const Outline& outline, const Points& centres, Real bead_radius)
{
	const Real far = bead_radius * (1 + 2 * largest_gap);
	const BoxIndex index = index_of(centres);
	for (std::size_t i = 0; i < outline.corners().size(); ++i) {
		const Vector2r& corner = outline.corners()[i];
		const auto near = index.near(grown(Box(corner), far));
		if (std::any_of(near.begin(), near.end(), [&](std::size_t k) { return (centres[k] - corner).norm() <= far; })) continue;
		std::ostringstream message;
		message << "outline is too thin for beads of diameter " << 2 * bead_radius << ": the nearest bead stays "
				<< (nearest_of(centres, corner) - bead_radius) / (2 * bead_radius) << " diameters away from "
				<< vertex_name(i, outline.origin() + corner) << ", allowed are " << largest_gap
				<< "; take smaller beads, or blunt or thicken the shape there";
		throw std::invalid_argument(message.str());
	}
}

/// Checks that every bead touches the outline. The inset cannot ensure it: it ignores nearly straight vertices and joins within a
/// tolerance.
void require_touching(const Outline& outline, const Points& centres, Real bead_radius)
{
	const EdgeIndex edges(outline.corners());
	for (const Vector2r& centre : centres) {
		const Real off = edges.distance(centre, 2 * bead_radius) / bead_radius - 1;
		if (std::abs(off) <= touch) continue;
		std::ostringstream message;
		message << "beads of diameter " << 2 * bead_radius << " must touch the outline, but one is off by " << off
				<< " of its radius; change the bead diameter a little, or leave out vertices that are finer than a bead";
		throw std::invalid_argument(message.str());
	}
}

/// Centres of the beads relative to the outline's origin.
Points beads_about_origin(const Outline& outline, Real bead_diameter, Real spacing)
{
	require(std::isfinite(bead_diameter) && bead_diameter > 0, "bead diameter must be positive and finite", bead_diameter);
	require(std::isfinite(spacing) && spacing > 0 && spacing <= 1,
		"bead spacing must lie in (0, 1] bead diameters, or grains could fall between beads", spacing);
	const Real radius = bead_diameter / 2, longest_step = spacing * bead_diameter;
	require(bead_diameter <= outline.extent(),
		"bead diameter must not exceed the outline's extent, or not one bead fits inside; take smaller beads", bead_diameter);
	require_few_beads(2 * outline.extent(), longest_step);
	if (outline.is_disk()) return ring(outline.disk_radius(), radius, longest_step);
	const Points centres = along(from_a_corner(inset(outline, radius)), longest_step);
	require_covered(outline, centres, radius);
	require_touching(outline, centres, radius);
	return centres;
}

}  // namespace

Points beads(const Outline& outline, Real bead_diameter, Real spacing)
{
	Points centres = beads_about_origin(outline, bead_diameter, spacing);
	for (Vector2r& centre : centres) centre += outline.origin();
	return centres;
}

Clump clump_of(const Outline& outline, Real bead_diameter, Real mass, Real spacing)
{
	require(std::isfinite(mass) && mass > 0, "mass must be positive and finite", mass);
	const Solid solid = solid_of(outline);
	const Real inertia = mass * solid.second_moment;
	require(std::isnormal(inertia), "mass must give a moment of inertia that is a positive and finite number; change it", mass);
	Clump clump{ beads_about_origin(outline, bead_diameter, spacing), bead_diameter / 2, mass, inertia };
	for (Vector2r& centre : clump.beads) centre -= solid.from_origin;
	return clump;
}

}  // namespace graindrive::shapes
