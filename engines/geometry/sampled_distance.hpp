/// A surface from distances on a regular grid: for shapes that are measured or computed, not written as a formula.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "engines/geometry/surface.hpp"

namespace graindrive::geometry {

/// Where distances are sampled: nodes at low + i spacing along each axis.
template <int D>
struct SampleGrid {
	Vec<D> low;                        ///< first node [m]
	Vec<D> spacing;                    ///< > 0 [m]
	std::array<std::size_t, D> count;  ///< nodes along each axis, at least 4

	Vec<D> node(const std::array<std::size_t, D>& index) const
	{
		Vec<D> at = low;
		for (int k = 0; k < D; ++k) at[k] += index[k] * spacing[k];
		return at;
	}
	Vec<D> high() const
	{
		std::array<std::size_t, D> last = count;
		for (std::size_t& index : last) --index;
		return node(last);
	}
	std::size_t size() const
	{
		std::size_t product = 1;
		for (const std::size_t nodes : count) product *= nodes;
		return product;
	}
};

/// Distances between nodes by cubic convolution (Keys, IEEE Trans. Acoust. 29, 1153 (1981), a = -1/2), along each axis in turn.
///
/// Inside the grid, with spacing h:
///
/// - distance and normal are continuous; the normal is the slope of the interpolated distance, made to unit length
/// - where the distance is smooth, with curvature radii of R and more, the error is of the order h^3/R^2 in the distance and
///   h^2/R^2 in the normal; quadratic functions are exact
/// - within 2 h of an edge, a corner or a point with several nearest points the error is of the order h: edges are rounded off
///
/// Outside the grid:
///
/// - if all nodes of the grid's outer layer are outside the solid, the result is a lower bound: the distance to the grid plus
///   `margin`, the least distance in that layer. Bodies of a radius less than `margin` never touch the solid there.
/// - if the solid reaches the outer layer the point is refused, because nothing is known about it
template <int D>
class SampledDistance : public Surface<D> {
public:
	/// @param distances at the nodes, x fastest [m]
	/// @throws std::invalid_argument unless grid and distances are finite, as many as nodes, some > 0 and some <= 0, and no two
	/// neighbours differ by more than their spacing (and 1 %), which distances cannot
	SampledDistance(const SampleGrid<D>& grid, std::vector<double> distances);

	/// Sampled from a function; anything with a distance will do, such as `[&](const Vec<3>& at) { return torus(at); }`.
	SampledDistance(const SampleGrid<D>& grid, const std::function<double(const Vec<D>&)>& distance);

	/// @throws std::invalid_argument for points outside the grid that the solid may reach
	Nearest<D> nearest(const Vec<D>& at) const override;
	Bounds<D> bounds() const override { return bounds_; }

	/// The least distance in the grid's outer layer [m]; <= 0 where the solid reaches it.
	double margin() const { return margin_; }
	double largest_sphere() const override { return margin_ > 0 ? margin_ : Bounds<D>::infinity; }  // without it none is answered

private:
	/// Four nodes along an axis and what they count for at a point between the middle two; slopes per spacing.
	struct Weights {
		std::size_t first;
		std::array<double, 4> value, slope;
	};
	using Index = std::array<std::size_t, D>;

	SampleGrid<D> grid_;
	std::vector<double> distances_;
	Bounds<D> bounds_;
	double margin_ = std::numeric_limits<double>::infinity();

	void check() const;
	void check_slopes() const;
	void survey();
	Index index_of(std::size_t node) const;
	Weights weights(int axis, double at) const;
	Nearest<D> inside(const Vec<D>& at) const;
	Nearest<D> beyond(const Vec<D>& at, const Vec<D>& in_grid) const;
};

}  // namespace graindrive::geometry
