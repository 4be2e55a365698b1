/// Moves a YADE scene of disks or spheres into the loop and back: which of YADE's bodies are free grains, which are rigid bodies.
#pragma once
#include <vector>

#include "engines/loop/scene.hpp"
#include "engines/seam/yade.hpp"

namespace graindrive::loop {

/// The bodies of YADE in the loop's order, and who they are there.
struct YadeBodies {
	std::vector<int> grain_id;     ///< YADE's id of each grain
	std::vector<int> grain_of_id;  ///< and back; -1 for bodies that are no grains
	std::vector<int>
		body_id;  ///< YADE's id of each rigid body: a clump, a solid, or a grain that is driven, held or large; -1 for the frozen
	std::vector<int> body_of_id;   ///< and back; -1 for others
	std::vector<int> frozen_id;    ///< YADE's ids of the frozen
	std::size_t known_bodies = 0;  ///< size of O.bodies when read

	/// In the plane: how YADE's body was turned when it was read. A clump may be turned out of the plane (to its principal axes), and its
	/// members' places refer to that: the loop turns it on from there.
	struct Turned {
		Real x, y, z, w;  ///< quaternion
		Real angle;       ///< of the loop's body then [rad]
	};
	std::vector<Turned> turned;  ///< by rigid body
};

/// Reads grains and bodies from YADE into `scene`.
///
/// Free grains are disks whose x, y and rotation about z are free, or spheres whose every degree of freedom is. Frozen ones
/// (everything blocked, at rest) make one body together. Every other grain is a body of its own, and so is one that is `watched` or more
/// than 1.5 times the median radius.
/// @throws std::invalid_argument for a body that is neither grain nor clump nor solid, or that YADE's collider or integrator would treat
/// in a way that the loop does not know, with its id
template <int D>
YadeBodies read_yade(const yade::Scene& yade_scene, const std::vector<int>& watched, Scene<D>& scene);

/// True if a grain counts as frozen.
bool is_frozen(const yade::State& state);

template <int D>
Vec<D> in_loop(const Vector3r& v)
{
	Vec<D> to;
	for (int k = 0; k < D; ++k) to[k] = v[k];
	return to;
}
template <int D>
Vector3r in_yade(const Vec<D>& v)
{
	return { v[0], v[1], D == 3 ? v[D - 1] : 0 };
}

/// Spins and torques: about z in the plane.
template <int D>
Spin<D> spin_in_loop(const Vector3r& v)
{
	if constexpr (D == 2)
		return v[2];
	else
		return in_loop<3>(v);
}
inline Vector3r spin_in_yade(double spin) { return { 0, 0, spin }; }
inline Vector3r spin_in_yade(const Vec<3>& spin) { return in_yade<3>(spin); }

/// Velocities and freedoms of a rigid body as YADE's state says now.
template <int D>
void read_state(const yade::State& state, RigidBody<D>& body);
/// Place, motion and turn of a body into YADE's state; in the plane z stays.
template <int D>
void write_state(const RigidBody<D>& body, const YadeBodies::Turned& turned, yade::State& state);
/// Place, velocity and spin of a grain or a body into YADE's state; in the plane z and turns about x and y stay.
template <int D>
void write_motion(const Vec<D>& place, const Vec<D>& velocity, const Spin<D>& spin, yade::State& state);
/// YADE's orientation of a body that the loop has turned.
Quaternionr orientation(const RigidBody<2>& body, const YadeBodies::Turned& turned);
Quaternionr orientation(const RigidBody<3>& body, const YadeBodies::Turned&);

/// How a body has been turned since, as somebody wrote it into YADE's state: added to the loop's. @throws std::runtime_error where a disk
/// was turned out of the plane
void follow_orientation(const yade::State& state, const YadeBodies::Turned& turned, int id, RigidBody<2>& body);
void follow_orientation(const yade::State& state, const YadeBodies::Turned& turned, int id, RigidBody<3>& body);

}  // namespace graindrive::loop
