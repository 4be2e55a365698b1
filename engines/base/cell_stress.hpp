/// Stress and coordination of the disks in a periodic cell that is sheared.
#pragma once
#include "engines/base/grain_view.hpp"

namespace graindrive {

/// Of one moment; stresses are > 0 in compression, their index is 2 a + b for a force along a and a branch along b (0 is x, 1 is y).
struct CellState {
	Real contact[4] = {};    ///< sum of F_a b_b over the cell's area [N/m]
	Real kinetic[4] = {};    ///< sum of m v'_a v'_b over the area, v' against the mean flow [N/m]
	Real coordination = 0;   ///< contacts of a grain [-]
	Real area_fraction = 0;  ///< sum of the disks' areas over the cell's [-]

	Real pressure() const { return (contact[0] + contact[3] + kinetic[0] + kinetic[3]) / 2; }
	Real shear_stress() const { return -(contact[1] + kinetic[1]); }
};

/// The mean flow is v = (shear_rate y, growth y) besides a constant velocity. A grain may stand in any image, with that image's velocity.
inline CellState state_of_cell(const SceneView& view, Real shear_rate, Real growth)
{
	CellState state;
	const Real area = view.periods[0] * view.periods[1], pi = 3.14159265358979323846;
	const auto against_flow = [&](const GrainState& g) {
		return Vector3r(g.velocity[0] - shear_rate * g.position[1], g.velocity[1] - growth * g.position[1], 0);
	};
	Vector3r momentum = Vector3r::Zero();
	Real mass = 0;
	for (const GrainState& g : view.grains) momentum += g.mass * against_flow(g), mass += g.mass;
	for (const GrainState& g : view.grains) {
		const Vector3r v = against_flow(g) - momentum / mass;
		for (int a = 0; a < 2; ++a)
			for (int b = 0; b < 2; ++b) state.kinetic[2 * a + b] += g.mass * v[a] * v[b] / area;
		state.area_fraction += pi * g.radius * g.radius / area;
	}
	for (const GrainContact& c : view.contacts) {
		if (c.second == no_grain) continue;
		const Real reach = view.grains[c.first].radius + view.grains[c.second].radius - c.overlap;
		for (int a = 0; a < 2; ++a)
			for (int b = 0; b < 2; ++b) state.contact[2 * a + b] += c.force[a] * reach * c.normal[b] / area;
		state.coordination += c.force.isZero(0) ? 0 : 2.0 / view.grains.size();
	}
	return state;
}

}  // namespace graindrive
