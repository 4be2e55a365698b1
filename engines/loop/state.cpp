/// Computes quantities that follow from a state.
#include "engines/loop/pair_geometry.hpp"

namespace graindrive::loop {

/// The reach of a body is computed from its members' places in the body's frame, which do not change, so that a restart finds the
/// same numbers to the last bit.
template <int D>
void State<D>::derive()
{
	n = scene.grains.size(), n_free = n - members.size();
	row_of.resize(n);
	typical_diameter = largest_free_radius = 0;
	for (std::uint32_t at = 0; at < n; ++at) row_of[index_of[at]] = at;
	double sum = 0;  // summed in the order of grains, which no sorting of rows changes
	for (const Grain<D>& grain : scene.grains) {
		if (grain.body != free_grain) continue;
		largest_free_radius = std::max(largest_free_radius, grain.radius);
		sum += 2 * grain.radius;
	}
	for (std::uint32_t at = n_free; at < n; ++at) sum += 2 * scene.grains[index_of[at]].radius;
	typical_diameter = sum / n;
	first_member.assign(scene.bodies.size() + 1, 0);
	reach.assign(scene.bodies.size(), 0);
	for (std::size_t m = 0; m < members.size(); ++m) {
		++first_member[members[m].body + 1];
		double& farthest = reach[members[m].body];
		farthest = std::max(farthest, length(members[m].at) + scene.grains[index_of[n_free + m]].radius);
	}
	middles.clear();
	for (const Solid<D>& solid : scene.solids) middles.push_back(solid.middle());
	for (std::size_t b = 0; b < scene.bodies.size(); ++b) first_member[b + 1] += first_member[b];
}

template struct State<2>;
template struct State<3>;

}  // namespace graindrive::loop
