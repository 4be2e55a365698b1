/// Moves a YADE scene of disks into the loop and back: which of YADE's bodies are free grains, which are rigid bodies.
#pragma once
#include <vector>

#include "engines/loop/scene.hpp"
#include "engines/seam/yade.hpp"

namespace graindrive::loop {

/// The bodies of YADE in the loop's order, and who they are there.
struct YadeBodies {
	std::vector<int> grain_id;     ///< YADE's id of each grain
	std::vector<int> grain_of_id;  ///< and back; -1 for what is no grain
	std::vector<int>
		body_id;  ///< YADE's id of each rigid body: a clump, or a disk that is driven, held or large; -1 for the frozen
	std::vector<int> body_of_id;   ///< and back; -1 for others
	std::vector<int> frozen_id;    ///< YADE's ids of the frozen
	std::size_t known_bodies = 0;  ///< size of O.bodies when read

	/// How YADE's body was turned when it was read. A clump may be turned out of the plane (to its principal axes), and its members'
	/// places refer to that: the loop turns it on from there.
	struct Turned {
		Real x, y, z, w;  ///< quaternion
		Real angle;       ///< of the loop's body then [rad]
	};
	std::vector<Turned> turned;  ///< by rigid body
};

/// Reads grains and bodies from YADE into `scene`.
///
/// Free grains are disks whose x, y and rotation about z are free. Frozen disks (everything blocked, at rest) make one body together.
/// Every other disk is a body of its own, and so is one that is `watched` or more than 1.5 times the median radius.
/// @throws std::invalid_argument for a body that is neither disk nor clump, or that YADE's collider or integrator would treat in a way
/// that the loop does not know, with its id
YadeBodies read_yade(const yade::Scene& yade_scene, const std::vector<int>& watched, Scene& scene);

/// True if a disk counts as frozen.
bool is_frozen(const yade::State& state);

/// Velocities and freedoms of a rigid body as YADE's state says now.
void read_state(const yade::State& state, RigidBody& body);
void write_state(const RigidBody& body, const YadeBodies::Turned& turned, yade::State& state);
/// YADE's orientation of a body that the loop has turned.
Quaternionr orientation(const RigidBody& body, const YadeBodies::Turned& turned);

}  // namespace graindrive::loop
