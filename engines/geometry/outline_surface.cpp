/// Finds the nearest edge or corner of a polygon by branch and bound in a tree of boxes.
#include "engines/geometry/outline_surface.hpp"

#include "engines/geometry/refuse.hpp"
#include "engines/geometry/solids.hpp"

namespace graindrive::geometry {
namespace {

constexpr std::size_t edges_in_a_leaf = 4;

Vec<2> vec(const Vector2r& v) { return { v.x(), v.y() }; }

shapes::Points points_of(const std::vector<Vec<2>>& vertices)
{
	shapes::Points points;
	for (const Vec<2>& vertex : vertices) points.emplace_back(vertex[0], vertex[1]);
	return points;
}

double square(double x) { return x * x; }

}  // namespace

OutlineSurface::OutlineSurface(const std::vector<Vec<2>>& vertices) : OutlineSurface(shapes::Outline(points_of(vertices))) {}

OutlineSurface::OutlineSurface(const shapes::Outline& outline)
	: origin_(vec(outline.origin())),
	  disk_radius_(outline.disk_radius())
{
	const shapes::Points& corners = outline.corners();
	for (std::size_t i = 0; i < corners.size(); ++i) {
		const Vec<2> from = vec(corners[i]), to = vec(corners[(i + 1) % corners.size()]);
		edges_.push_back({ from, to, unit(to - from), norm(to - from) });
	}
	grow_tree(0, 0, edges_.size());
}

void OutlineSurface::grow_tree(std::size_t node, std::size_t begin, std::size_t end)
{
	if (boxes_.size() <= node) boxes_.resize(node + 1);
	Bounds<2> box{ edges_[begin].from, edges_[begin].from };
	for (std::size_t i = begin; i < end; ++i)
		for (int k = 0; k < 2; ++k) {
			box.low[k] = std::min({ box.low[k], edges_[i].from[k], edges_[i].to[k] });
			box.high[k] = std::max({ box.high[k], edges_[i].from[k], edges_[i].to[k] });
		}
	boxes_[node] = box;
	if (end - begin <= edges_in_a_leaf) return;
	const std::size_t middle = (begin + end) / 2;
	grow_tree(2 * node + 1, begin, middle);
	grow_tree(2 * node + 2, middle, end);
}

double OutlineSurface::squared_distance_to_box(std::size_t node, const Vec<2>& at) const
{
	double sum = 0;
	for (int k = 0; k < 2; ++k) sum += square(std::max({ boxes_[node].low[k] - at[k], at[k] - boxes_[node].high[k], 0.0 }));
	return sum;
}

void OutlineSurface::search(std::size_t node, std::size_t begin, std::size_t end, const Vec<2>& at, Feature& best) const
{
	if (end - begin <= edges_in_a_leaf) {
		for (std::size_t i = begin; i < end; ++i) look_at(i, at, best);
		return;
	}
	const std::size_t middle = (begin + end) / 2, left = 2 * node + 1, right = 2 * node + 2;
	const double to_left = squared_distance_to_box(left, at), to_right = squared_distance_to_box(right, at);
	const bool left_first = to_left <= to_right;
	if (left_first && to_left < best.squared_distance) search(left, begin, middle, at, best);
	if (to_right < best.squared_distance) search(right, middle, end, at, best);
	if (!left_first && to_left < best.squared_distance) search(left, begin, middle, at, best);
}

void OutlineSurface::look_at(std::size_t i, const Vec<2>& at, Feature& best) const
{
	const Edge& edge = edges_[i];
	const Vec<2> from = at - edge.from;
	const double along = dot(from, edge.along);
	const int corner = along <= 0 ? -1 : along >= edge.length ? 1 : 0;
	const double squared = corner < 0   ? squared_norm(from)
	                       : corner > 0 ? squared_norm(at - edge.to)
	                                    : square(dot(from, edge.normal()));
	if (squared < best.squared_distance) best = { squared, i, corner };
}

Nearest<2> OutlineSurface::answer(const Feature& feature, const Vec<2>& at) const
{
	const Edge& nearest_edge = edges_[feature.edge];
	if (feature.corner == 0) return { dot(at - nearest_edge.from, nearest_edge.normal()), nearest_edge.normal() };
	const std::size_t after = feature.corner > 0 ? feature.edge + 1 : feature.edge + edges_.size();
	const Edge &into = edge(after + edges_.size() - 1), &out = edge(after);
	const double side = cross(into.along, out.along) > 0 ? 1 : -1;
	const Vec<2> from = at - out.from;
	const double distance = norm(from);
	if (!(distance > 0)) return { 0, unit(into.normal() + out.normal()) };
	return { side * distance, side * from / distance };
}

Nearest<2> OutlineSurface::nearest(const Vec<2>& point) const
{
	const Vec<2> at = point - origin_;
	if (disk_radius_ > 0) return Ball<2>({}, disk_radius_).nearest(at);
	Feature best;
	search(0, 0, edges_.size(), at, best);
	return answer(best, at);
}

Bounds<2> OutlineSurface::bounds() const
{
	if (disk_radius_ > 0) return Ball<2>(origin_, disk_radius_).bounds();
	return { origin_ + boxes_[0].low, origin_ + boxes_[0].high };
}

SweptOutline::SweptOutline(OutlineSurface outline, const Vec<3>& middle, const Vec<3>& x, const Vec<3>& y, double length)
	: outline_(std::move(outline)),
	  middle_(middle),
	  axes_{ direction("swept outline's x", x), direction("swept outline's y", y), {} },
	  half_length_(length / 2)
{
	require_finite("swept outline's middle", middle);
	require(length > 0, "swept outline's length must be positive", length, "give a length > 0, or SweptOutline::endless");
	require(std::abs(dot(axes_[0], axes_[1])) < 1e-12, "swept outline's x and y must be perpendicular", dot(axes_[0], axes_[1]),
		"give axes whose directions have the scalar product 0");
	axes_[2] = cross(axes_[0], axes_[1]);
}

Nearest<3> SweptOutline::nearest(const Vec<3>& at) const
{
	const Vec<3> from = at - middle_;
	const Nearest<2> in_plane = outline_.nearest({ dot(from, axes_[0]), dot(from, axes_[1]) });
	const Nearest<3> mantle{ in_plane.distance, in_plane.normal[0] * axes_[0] + in_plane.normal[1] * axes_[1] };
	if (half_length_ == endless) return mantle;
	const double along = dot(from, axes_[2]);
	return perpendicular_intersection(mantle, { std::abs(along) - half_length_, along < 0 ? -axes_[2] : axes_[2] });
}

Bounds<3> SweptOutline::bounds() const
{
	const Bounds<2> flat = outline_.bounds();
	const Vec<3> low{ flat.low[0], flat.low[1], -half_length_ }, high{ flat.high[0], flat.high[1], half_length_ };
	return moved_bounds<3>({ low, high }, axes_, middle_);
}

}  // namespace graindrive::geometry
