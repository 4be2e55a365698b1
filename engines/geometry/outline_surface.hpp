/// Outlines as surfaces: a polygon or circle in the plane, and the prism that it sweeps along an axis in space.
#pragma once
#include <array>
#include <vector>

#include "engines/geometry/surface.hpp"
#include "engines/shapes/outline.hpp"

namespace graindrive::geometry {

/// The solid inside an outline. The distance is exact on both sides, corners included.
///
/// The nearest edge is found in a tree of boxes. On an edge the sign is that of the edge's side; where a corner is nearest, outside
/// is what sees it as a convex one.
class OutlineSurface : public Surface<2> {
public:
	explicit OutlineSurface(const shapes::Outline& outline);

	/// @throws std::invalid_argument as `shapes::Outline` does: not finite, fewer than 3 vertices, no area, edges that meet
	explicit OutlineSurface(const std::vector<Vec<2>>& vertices);

	Nearest<2> nearest(const Vec<2>& at) const override;
	Bounds<2> bounds() const override;

private:
	struct Edge {
		Vec<2> from, to;  ///< seen from `origin_`; the solid lies on the left [m]
		Vec<2> along;     ///< of unit length
		double length;    ///< [m]

		Vec<2> normal() const { return { along[1], -along[0] }; }
	};
	/// What of an edge is nearest: a point along it, or the corner where it ends.
	struct Feature {
		double squared_distance = std::numeric_limits<double>::infinity();  ///< [m^2]
		std::size_t edge = 0;
		int corner = 0;  ///< -1 where the edge begins, 1 where it ends, 0 between
	};

	void grow_tree(std::size_t node, std::size_t begin, std::size_t end);
	void search(std::size_t node, std::size_t begin, std::size_t end, const Vec<2>& at, Feature& best) const;
	void look_at(std::size_t edge, const Vec<2>& at, Feature& best) const;
	double squared_distance_to_box(std::size_t node, const Vec<2>& at) const;
	Nearest<2> answer(const Feature& feature, const Vec<2>& at) const;
	const Edge& edge(std::size_t i) const { return edges_[i % edges_.size()]; }

	Vec<2> origin_;
	double disk_radius_ = 0;  // > 0: a circle about the origin [m]
	std::vector<Edge> edges_;
	std::vector<Bounds<2>> boxes_;  // of node k, whose halves are 2k + 1 and 2k + 2
};

/// An outline swept along an axis: a prism, infinite or with flat ends.
///
/// d = max(q, z) inside and beside, |(q, z)| off the edges of the ends, with the distance q in the outline's plane and z beyond the
/// ends: exact.
class SweptOutline : public Surface<3> {
public:
	static constexpr double endless = std::numeric_limits<double>::infinity();

	/// @param middle where the outline's point (0, 0) lies, half-way between the ends [m]
	/// @param x, y the outline's axes in space, perpendicular to each other, of any length
	/// @param length between the ends [m]
	/// @throws std::invalid_argument unless all are finite, the axes perpendicular and the length positive
	SweptOutline(OutlineSurface outline, const Vec<3>& middle, const Vec<3>& x, const Vec<3>& y, double length = endless);
	Nearest<3> nearest(const Vec<3>& at) const override;
	Bounds<3> bounds() const override;

private:
	OutlineSurface outline_;
	Vec<3> middle_;
	std::array<Vec<3>, 3> axes_;
	double half_length_;
};

}  // namespace graindrive::geometry
