/// Distances from combined solids: most follow directly from the parts, the others need a search for the nearest point on an
/// edge.
#include "engines/geometry/set_algebra.hpp"

#include "engines/geometry/edge_search.hpp"
#include "engines/geometry/refuse.hpp"

namespace graindrive::geometry {
namespace {

/// The nearest point of an intersection if it lies on an edge or corner; `bound` if none is found.
template <int D>
Nearest<D> off_the_edge(const Parts<D>& parts, const Vec<D>& p, const Nearest<D>& bound)
{
	Nearest<D> best = bound;
	bool found = false;
	for (const Vec<D>& start : { p - bound.distance * bound.normal, p }) {
		NearestOfAll<D> search(parts, p, start);
		if (!search.run()) continue;
		const double distance = norm(p - search.at());
		if (!(distance > bound.distance) || (found && distance >= best.distance)) continue;
		best = { distance, (p - search.at()) / distance };
		found = true;
	}
	return best;
}

template <int D>
Nearest<D> nearest_of_intersection(const Parts<D>& parts, const Vec<D>& p)
{
	const auto [bound, which] = parts.farthest(p);
	if (!(bound.distance > 0)) return bound;
	const Vec<D> on_part = p - bound.distance * bound.normal;
	if (parts.all_hold(on_part, distance_error(bound.distance, p, on_part))) return bound;
	return off_the_edge(parts, p, bound);
}

template <int D>
void require_parts(const std::string& what, const std::vector<SharedSurface<D>>& parts)
{
	require(!parts.empty(), what + " needs at least one part", "none", "give the solids to combine");
	for (std::size_t i = 0; i < parts.size(); ++i)
		require(parts[i] != nullptr, what + " needs a shape for each part", "none for part " + std::to_string(i), "give one");
}

}  // namespace

template <int D>
Complement<D>::Complement(SharedSurface<D> solid) : solid_(std::move(solid))
{
	require(solid_ != nullptr, "a complement needs a shape", "none", "give one");
}

template <int D>
Intersection<D>::Intersection(std::vector<SharedSurface<D>> parts) : parts_(std::move(parts))
{
	require_parts("an intersection", parts_);
}

template <int D>
Nearest<D> Intersection<D>::nearest(const Vec<D>& at) const
{
	return nearest_of_intersection(Parts<D>{ parts_, 1 }, at);
}

template <int D>
Bounds<D> Intersection<D>::bounds() const
{
	Bounds<D> all;
	for (const auto& part : parts_) {
		const Bounds<D> box = part->bounds();
		for (int k = 0; k < D; ++k) {
			all.low[k] = std::max(all.low[k], box.low[k]);
			all.high[k] = std::min(all.high[k], box.high[k]);
		}
	}
	return all;
}

template <int D>
Union<D>::Union(std::vector<SharedSurface<D>> parts) : parts_(std::move(parts))
{
	require_parts("a union", parts_);
}

template <int D>
Nearest<D> Union<D>::nearest(const Vec<D>& at) const
{
	const Nearest<D> outside = nearest_of_intersection(Parts<D>{ parts_, -1 }, at);
	return { -outside.distance, -outside.normal };
}

template <int D>
Bounds<D> Union<D>::bounds() const
{
	Bounds<D> all = parts_.front()->bounds();
	for (const auto& part : parts_) {
		const Bounds<D> box = part->bounds();
		for (int k = 0; k < D; ++k) {
			all.low[k] = std::min(all.low[k], box.low[k]);
			all.high[k] = std::max(all.high[k], box.high[k]);
		}
	}
	return all;
}

template class Complement<2>;
template class Complement<3>;
template class Intersection<2>;
template class Intersection<3>;
template class Union<2>;
template class Union<3>;

}  // namespace graindrive::geometry
