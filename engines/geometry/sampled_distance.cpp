/// Interpolates sampled distances, checks samples, and gives results for points outside the grid.
#include "engines/geometry/sampled_distance.hpp"

#include "engines/geometry/refuse.hpp"

namespace graindrive::geometry {
namespace {

constexpr std::size_t most_nodes = std::size_t(1) << 31;
constexpr double steepest = 1.01;  // largest allowed difference of two neighbours over their spacing [-]

template <int D>
std::string text(const Vec<D>& v)
{
	std::ostringstream out;
	out.precision(10);
	out << v;
	return out.str();
}

template <int D>
void require_grid(const SampleGrid<D>& grid)
{
	require_finite("a sample grid's low corner", grid.low);
	double product = 1;
	for (int k = 0; k < D; ++k) {
		require(grid.spacing[k] > 0 && std::isfinite(grid.spacing[k]), "a sample grid's spacing must be positive and finite",
			grid.spacing, "give a length > 0 for each axis");
		require(grid.count[k] >= 4, "a sample grid needs at least 4 nodes along each axis", grid.count[k], "refine it");
		product *= static_cast<double>(grid.count[k]);
	}
	require(product <= most_nodes, "a sample grid must have at most 2^31 nodes", product, "take a coarser one");
}

template <int D>
std::vector<double> sampled(const SampleGrid<D>& grid, const std::function<double(const Vec<D>&)>& distance)
{
	require_grid(grid);
	require(static_cast<bool>(distance), "a sampled distance needs a function", "none", "give one");
	std::vector<double> distances;
	distances.reserve(grid.size());
	for (std::size_t node = 0; node < grid.size(); ++node) {
		std::array<std::size_t, D> index;
		std::size_t rest = node;
		for (int k = 0; k < D; ++k) {
			index[k] = rest % grid.count[k];
			rest /= grid.count[k];
		}
		distances.push_back(distance(grid.node(index)));
	}
	return distances;
}

}  // namespace

template <int D>
SampledDistance<D>::SampledDistance(const SampleGrid<D>& grid, std::vector<double> distances)
	: grid_(grid),
	  distances_(std::move(distances))
{
	require_grid(grid_);
	check();
	check_slopes();
	survey();
}

template <int D>
SampledDistance<D>::SampledDistance(const SampleGrid<D>& grid, const std::function<double(const Vec<D>&)>& distance)
	: SampledDistance(grid, sampled(grid, distance))
{
}

template <int D>
typename SampledDistance<D>::Index SampledDistance<D>::index_of(std::size_t node) const
{
	Index index;
	for (int k = 0; k < D; ++k) {
		index[k] = node % grid_.count[k];
		node /= grid_.count[k];
	}
	return index;
}

template <int D>
void SampledDistance<D>::check() const
{
	require(distances_.size() == grid_.size(), "sampled distances must be as many as nodes, " + std::to_string(grid_.size()),
		distances_.size(), "give one distance per node, x fastest");
	// Of millions of nodes only a wrong one needs the text of its place.
	for (std::size_t node = 0; node < distances_.size(); ++node)
		if (!std::isfinite(distances_[node]))
			require(false, "sampled distances must be finite", distances_[node],
				"correct the one at " + text(grid_.node(index_of(node))));
	const auto [least, most] = std::minmax_element(distances_.begin(), distances_.end());
	require(*least <= 0 && *most > 0, "sampled distances must be <= 0 at some nodes, inside the solid, and > 0 at others",
		text(Vec<2>{ *least, *most }), "extend the grid beyond the surface, with a spacing smaller than the solid's thickness");
}

template <int D>
void SampledDistance<D>::check_slopes() const
{
	for (std::size_t node = 0; node < distances_.size(); ++node) {
		const Index index = index_of(node);
		for (std::size_t k = 0, stride = 1; k < D; stride *= grid_.count[k++]) {
			if (index[k] + 1 == grid_.count[k]) continue;
			const double slope = std::abs(distances_[node + stride] - distances_[node]) / grid_.spacing[k];
			if (!(slope <= steepest))
				require(false, "sampled distances of neighbours must not differ by more than their spacing", slope,
					"give true distances at " + text(grid_.node(index)));
		}
	}
}

/// Finds the solid's box and the smallest distance on the grid's border. Each point of the solid has a node within half a
/// diagonal of a cell, and the distance at this node is at most that half diagonal.
template <int D>
void SampledDistance<D>::survey()
{
	const double half_diagonal = norm(grid_.spacing) / 2;
	std::swap(bounds_.low, bounds_.high);  // an empty box
	for (std::size_t node = 0; node < distances_.size(); ++node) {
		const Index index = index_of(node);
		const Vec<D> at = grid_.node(index);
		for (int k = 0; k < D; ++k) {
			if (index[k] == 0 || index[k] + 1 == grid_.count[k]) margin_ = std::min(margin_, distances_[node]);
			if (distances_[node] > half_diagonal * steepest) continue;
			bounds_.low[k] = std::min(bounds_.low[k], at[k] - grid_.spacing[k] / 2);
			bounds_.high[k] = std::max(bounds_.high[k], at[k] + grid_.spacing[k] / 2);
		}
	}
	if (margin_ <= 0) bounds_ = {};
}

/// Weights of Keys' kernel. For the node that is missing in the outermost cells f(-1) = 3 f(0) - 3 f(1) + f(2) is used, which
/// keeps the order of the error (Keys' eq. (19)).
template <int D>
typename SampledDistance<D>::Weights SampledDistance<D>::weights(int axis, double at) const
{
	const std::size_t cells = grid_.count[axis] - 1;
	const double place = (at - grid_.low[axis]) / grid_.spacing[axis];
	const std::size_t cell = std::min(static_cast<std::size_t>(std::max(0.0, place)), cells - 1);
	const double s = place - static_cast<double>(cell);
	const std::array<double, 4> value{ ((-0.5 * s + 1) * s - 0.5) * s, (1.5 * s - 2.5) * s * s + 1,
		((-1.5 * s + 2) * s + 0.5) * s, (0.5 * s - 0.5) * s * s };
	const std::array<double, 4> slope{ (-1.5 * s + 2) * s - 0.5, (4.5 * s - 5) * s, (-4.5 * s + 4) * s + 0.5, (1.5 * s - 1) * s };
	const auto without_first = [](const std::array<double, 4>& w) {
		return std::array<double, 4>{ w[1] + 3 * w[0], w[2] - 3 * w[0], w[3] + w[0], 0 };
	};
	const auto without_last = [](const std::array<double, 4>& w) {
		return std::array<double, 4>{ 0, w[0] + w[3], w[1] - 3 * w[3], w[2] + 3 * w[3] };
	};
	if (cell == 0) return { 0, without_first(value), without_first(slope) };
	if (cell == cells - 1) return { cell - 2, without_last(value), without_last(slope) };
	return { cell - 1, value, slope };
}

template <int D>
Nearest<D> SampledDistance<D>::inside(const Vec<D>& at) const
{
	std::array<Weights, D> along;
	for (int k = 0; k < D; ++k) along[k] = weights(k, at[k]);
	double distance = 0;
	Vec<D> slope;
	for (int corner = 0; corner < (D == 2 ? 16 : 64); ++corner) {
		std::size_t node = 0;
		double value = 1;
		Vec<D> part = Vec<D>::all(1);
		for (int k = D - 1; k >= 0; --k) {
			const int i = corner >> (2 * k) & 3;
			node = node * grid_.count[k] + along[k].first + i;
			value *= along[k].value[i];
			for (int j = 0; j < D; ++j) part[j] *= j == k ? along[k].slope[i] / grid_.spacing[k] : along[k].value[i];
		}
		distance += value * distances_[node];
		slope += distances_[node] * part;
	}
	return { distance, largest(slope) > 0 ? unit(slope) : Vec<D>::along(0) };
}

template <int D>
Nearest<D> SampledDistance<D>::beyond(const Vec<D>& at, const Vec<D>& in_grid) const
{
	if (!(margin_ > 0))
		require(false, "a sampled distance is known only inside its grid if the solid reaches the grid's outer layer", at,
			"sample a larger grid, from " + text(grid_.low) + " to " + text(grid_.high()) + " now");
	const double way = norm(at - in_grid);
	return { way + margin_, (at - in_grid) / way };
}

template <int D>
Nearest<D> SampledDistance<D>::nearest(const Vec<D>& at) const
{
	const Vec<D> high = grid_.high();
	Vec<D> in_grid = at;
	for (int k = 0; k < D; ++k) in_grid[k] = std::clamp(at[k], grid_.low[k], high[k]);
	return in_grid == at ? inside(at) : beyond(at, in_grid);
}

template class SampledDistance<2>;
template class SampledDistance<3>;

}  // namespace graindrive::geometry
