/// Shifts edges inwards, adds arcs at corners, cuts off what is too close to another edge, and joins the rest into a ring.
#include "engines/shapes/inset.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "engines/shapes/edge_index.hpp"
#include "engines/shapes/straighten.hpp"

namespace graindrive::shapes {

namespace {

// Lengths over the distance of the inset [-]:
constexpr Real straight_within = 1e-6;  // vertices closer than this to a straight line are left out
constexpr Real round_off = 1e-12;       // neighbouring edges may be closer by this, other edges must be farther by this
constexpr Real joint = 1e-5;            // stretches whose ends are this close are joined
constexpr Real nudge = 1e-7;            // the inset is moved inwards by this if round-off has left it open

[[noreturn]] void throw_too_thin(const std::string& what, Real distance)
{
	std::ostringstream message;
	message << "outline is too thin for beads of diameter " << 2 * distance << ": " << what
			<< "; take smaller beads or a thicker shape";
	throw std::invalid_argument(message.str());
}

/// A piece of the path before trimming, with the first and the last edge that it touches.
struct Raw {
	Stretch stretch;
	std::size_t first, last;
};

std::vector<Raw> shifted_edges_and_arcs(const EdgeIndex& edges, Real distance)
{
	std::vector<Raw> raw;
	for (std::size_t i = 0, n = edges.size(); i < n; ++i) {
		const Vector2r &start = edges.corner(i), &end = edges.corner(i + 1);
		const Vector2r in = edges.corner(i + n - 1), shift = distance * left_of(end - start);
		if (cross(start - in, end - start) < 0)
			raw.push_back({ arc(start + distance * left_of(start - in), start + shift, start), (i + n - 1) % n, i });
		raw.push_back({ straight(start + shift, end + shift), i, i });
	}
	return raw;
}

/// Cuts off what is closer to edge i than the inset's distance. On an arc the interval may lie a full turn before or after the
/// arc's start.
void trim(std::vector<Interval>& parts, const Raw& raw, const EdgeIndex& edges, std::size_t i, Real distance)
{
	if (i == raw.first || i == raw.last || parts.empty()) return;
	const std::size_t n = edges.size();
	const bool is_neighbour = raw.first == raw.last && (i == (raw.first + 1) % n || raw.first == (i + 1) % n);
	const Real reach = distance * (is_neighbour ? 1 - round_off : 1 + round_off);
	const auto hole = closer_than(reach, raw.stretch, edges.corner(i), edges.corner(i + 1));
	if (!hole) return;
	const Real circumference = 2 * pi * raw.stretch.radius;
	for (const int turns : { -1, 0, 1 }) {
		parts = without(parts, { hole->begin + turns * circumference, hole->end + turns * circumference });
		if (circumference == 0) break;
	}
}

/// Cuts off what is too close to any edge near the part.
void trim_by_search(std::vector<Interval>& parts, const Interval& part, const Raw& raw, const EdgeIndex& edges, Real distance)
{
	const Stretch piece = raw.stretch.part(part.begin, part.end);
	const Vector2r middle = piece.at(piece.length / 2);
	const Real reach = distance * (1 + round_off), far = reach + piece.length / 2;
	for (const std::size_t i : edges.near(grown(piece.box(), reach)))
		if (distance_to_segment(middle, edges.corner(i), edges.corner(i + 1)) < far) trim(parts, raw, edges, i, distance);
}

/// The pieces that are left. The next three edges on both sides are tried first, because they often leave little or nothing to
/// search.
std::vector<Stretch> trimmed(const Raw& raw, const EdgeIndex& edges, Real distance)
{
	const std::size_t n = edges.size();
	std::vector<Interval> parts{ { 0, raw.stretch.length } };
	for (const std::size_t beside : { 1, 2, 3 }) {
		trim(parts, raw, edges, (raw.last + beside) % n, distance);
		trim(parts, raw, edges, (raw.first + 3 * n - beside) % n, distance);
	}
	const std::vector<Interval> left = parts;
	for (const Interval& part : left) trim_by_search(parts, part, raw, edges, distance);
	std::sort(parts.begin(), parts.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
	std::vector<Stretch> pieces;
	for (const Interval& part : parts) pieces.push_back(raw.stretch.part(part.begin, part.end));
	return pieces;
}

std::vector<Stretch> touching(const EdgeIndex& edges, Real distance)
{
	std::vector<Stretch> pieces;
	for (const Raw& raw : shifted_edges_and_arcs(edges, distance))
		for (const Stretch& piece : trimmed(raw, edges, distance)) pieces.push_back(piece);
	return pieces;
}

using Ring = std::vector<Stretch>;

/// Joins pieces into rings. Along one ring the pieces have the order of the outline; a second ring lies between two pieces of the
/// first, as one pair of brackets within another, so an open ring stays on a stack until a piece continues it.
std::vector<Ring> rings_of(const std::vector<Stretch>& pieces, Real tolerance)
{
	const auto meet = [&](const Vector2r& a, const Vector2r& b) { return (a - b).norm() <= tolerance; };
	std::vector<Ring> open, closed;
	for (const Stretch& piece : pieces) {
		if (!open.empty() && meet(open.back().back().to, piece.from))
			open.back().push_back(piece);
		else
			open.push_back({ piece });
		while (open.size() > 1 && meet(open.back().back().to, open.back().front().from)) {
			closed.push_back(open.back());
			open.pop_back();
		}
	}
	closed.insert(closed.end(), open.begin(), open.end());
	return closed;
}

Real length_of(const Ring& ring)
{
	Real length = 0;
	for (const Stretch& stretch : ring) length += stretch.length;
	return length;
}

bool is_closed(const Ring& ring, Real tolerance) { return (ring.back().to - ring.front().from).norm() <= tolerance; }

/// The single ring that the pieces form; empty if some ring stays open.
Ring only_ring(const std::vector<Stretch>& pieces, const Vector2r& origin, Real distance)
{
	std::vector<Ring> rings = rings_of(pieces, joint * distance);
	const auto is_speck = [&](const Ring& ring) { return length_of(ring) <= joint * distance; };
	rings.erase(std::remove_if(rings.begin(), rings.end(), is_speck), rings.end());
	if (rings.empty()) throw_too_thin("not one bead fits inside", distance);
	for (const Ring& ring : rings)
		if (!is_closed(ring, joint * distance)) return {};
	if (rings.size() > 1)
		throw_too_thin("their centres fall into " + std::to_string(rings.size()) + " separate rings, one at " +
						   vertex_name(0, origin + rings.back().front().from).substr(9),
			distance);
	return rings.front();
}

}  // namespace

std::vector<Stretch> inset(const Outline& outline, Real distance)
{
	const EdgeIndex edges(straightened(outline.corners(), straight_within * distance));
	for (const int nudges : { 0, 1, 2 }) {
		const Real from_outline = distance * (1 + nudges * nudge);
		Ring ring = only_ring(touching(edges, from_outline), outline.origin(), from_outline);
		const auto is_speck = [&](const Stretch& stretch) { return stretch.length <= straight_within * distance; };
		ring.erase(std::remove_if(ring.begin(), ring.end(), is_speck), ring.end());
		if (!ring.empty()) return ring;
	}
	std::ostringstream message;
	message << "outline must let beads of diameter " << 2 * distance
			<< " roll along its inside, but no inset was found; change the bead diameter a little";
	throw std::invalid_argument(message.str());
}

}  // namespace graindrive::shapes
